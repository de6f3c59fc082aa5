// The accuracy set-up: bodies, tools, works, materials, contacts, scatter, limits and named sizes,
// as read from a TOML file (docs/accuracy.md lists its keys). Units inside are mm, N, rad, N·mm.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/matrices.h"
#include "accuracy/milling.h"
#include "accuracy/scatter.h"
#include "accuracy/size.h"
#include "accuracy/stability.h"
#include "base/base.h"

namespace aircut::accuracy {

struct Settings {
  Repair repair;
  bool angular = true;         ///< false: bodies only shift, xi and coupling are left out
  bool coupled = false;        ///< the depth shrinks as the tool is pushed away
  bool second_order = false;   ///< tangential displacements change a turned radius
  bool mean_diameter = false;  ///< V of the mean instead of the outer diameter
};

/// A drill or another tool that is fed along its axis.
struct Drill {
  double diameter = 0, point_angle = 0, chisel_factor = 1;
};

/// Coefficients of a material and tool, as far as they are known.
struct Material {
  std::optional<TurningLaw> turning;
  std::optional<KienzleTerm> kienzle;
  double thrust_ratio = 0.4, feed_ratio = 0.5;
  std::optional<MillingCoefficients> milling;
  std::string source;
};

struct ToolEntry {
  long id = 0;
  int body = ground;
  std::string law;   ///< name of a material; empty: the work's
  double kappa = 0;  ///< entering angle
  double nose_radius = 0;
  std::optional<Cutter> cutter;
  std::optional<Drill> drill;
  double dt = 0;             ///< along a program: allowance of its depth
  std::optional<Mode> mode;  ///< of its tip against the work; else the machine's
  bool peak = false;         ///< along a program: the largest force of a turn instead of its mean
  SourceSpan place;
};

struct WorkEntry {
  long spindle = 0;
  int body = ground;
  std::string material;
  Vec3 axis = Vec3::UnitZ();  ///< of the spindle; it turns about it by the right-hand rule
  Vec3 axis_point = Vec3::Zero();
  SourceSpan place;
};

/// One engaged tool as the file describes it, with its force worked out.
struct ContactEntry {
  std::string name;
  std::size_t tool = 0, work = 0;  ///< places in Setup::tools and works
  Contact contact;
  DepthForce force;
  Vec3 normal = Vec3::Zero();  ///< out of the material; zero when not given
  double t = 0, dt = 0;        ///< depth and its allowance; 0 when the force does not know them
  double S = 0, V = 0;         ///< mm/rev, m/min; 0 when not given
  double diameter = 0;         ///< mm; 0 when not given
  double chip = 0;             ///< largest chip thickness, mm; 0 when unknown
  PowerTerm cut_law;           ///< C = 0: no power law
  double torque = 0;           ///< of the tool's own spindle (milling, drilling), N·mm
  double power = 0;            ///< of the tool's own spindle, kW without losses
  std::optional<Span> span;
  std::string source;  ///< of the coefficients
  SourceSpan place;
};

struct ScatterSettings {
  Bands bands;
  bool exact = false;
  bool independent_bodies = false;
  std::optional<Draws> draws;
};

struct Limits {
  std::optional<double> cut_force, power_kW, torque_Nm, chip, deflection;  ///< N, kW, N·m, mm, mm
  double efficiency = 1;
};

struct Dimension {
  std::string name;
  std::vector<std::size_t> tools;  ///< places in Setup::tools; two of a width
  SizeKind kind = SizeKind::profile;
  double nominal = 0;
  std::optional<Interval> tolerance;  ///< of the error
  bool compensate = false;
  /// Along a program: the cuts that make it. Of these lines, with their point in this box (M).
  std::optional<Interval> lines;
  std::array<std::optional<Interval>, 3> at;
  SourceSpan place;
};

struct Setup {
  Settings settings;
  std::vector<Body> bodies;
  std::vector<double> epsilon;  ///< per body: the band of its own stiffness
  /// Per body: the link of the machine that it and its base point go with; empty: none.
  std::vector<std::string> links;
  std::vector<SourceSpan> link_places;
  std::vector<std::string> changes;  ///< what the repairs did: "body 'x', e: row z turned"
  std::map<std::string, Material> materials;
  std::optional<Mode> mode;  ///< along a program: of the machine with any tool
  std::vector<ToolEntry> tools;
  std::vector<WorkEntry> works;
  std::vector<ContactEntry> contacts;
  ScatterSettings scatter;
  Limits limits;
  std::vector<Dimension> dimensions;
};

/// What a what-if changes against the file.
struct WhatIf {
  /// By contact and key: `t`, `S`, `V`, `dt`, or `start` (the begin of its interval, s).
  std::map<std::pair<std::string, std::string>, double> contacts;
  std::map<long, std::string> tool_bodies;  ///< by the tool's id
  std::optional<std::string> sign_policy;
  std::optional<bool> angular, coupled;
};

/// Everything that is wrong or doubtful goes to `out`; nothing is returned when there are errors.
std::optional<Setup> read_setup(const SourceText& text, Diagnostics& out,
                                const WhatIf& what_if = {});

}  // namespace aircut::accuracy
