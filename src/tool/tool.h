// tool: tools, holders and the tables they come in.
// A tool assembly is a stack of solids of revolution about +Z with the tip at z = 0 and the gauge
// face of the spindle at z = gauge_length. Units mm, rad.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/base.h"
#include "geometry/geometry.h"

namespace aircut::tool {

enum class PieceRole : unsigned char { cutter, shank, holder };

/// One solid of revolution of the assembly, in assembly coordinates (tip at z = 0).
struct Piece {
  PieceRole role = PieceRole::cutter;
  std::string name;  ///< "cutter", "shank", "holder", …: used in findings
  Profile profile;
};

/// A part of a lathe tool that is not round: a convex outline in X and Z and how far it reaches
/// along Y, seen from the controlled point in the directions of the machine's axes; mm.
struct Block {
  PieceRole role = PieceRole::holder;
  std::string name;
  std::vector<std::array<double, 2>> outline;  ///< (x, z), one after the other around it
  double y_low = 0, y_high = 0;
};

/// What a cut may ask of a tool; 0 = no limit.
struct CuttingLimits {
  double depth = 0;      ///< mm along the axis
  double width = 0;      ///< mm across the feed
  double angle = 0;      ///< rad of the circumference in material
  double removal = 0;    ///< mm³/s
  double chip_load = 0;  ///< mm per tooth

  bool any() const { return depth > 0 || width > 0 || angle > 0 || removal > 0 || chip_load > 0; }
};

struct Tool {
  int number = 0;
  int pocket = 0;
  std::string name;            ///< "10 mm 3-flute end mill"
  AxisValues offset;           ///< length offset of the tool table (G43 H), mm and rad
  double diameter = 0;         ///< mm, of the tool table (G41 D)
  double front_angle = 0;      ///< rad, lathe
  double back_angle = 0;       ///< rad, lathe
  int orientation = 0;         ///< 0-9, lathe
  std::vector<Piece> pieces;   ///< from the tip up
  std::vector<Block> blocks;   ///< of a lathe tool
  double gauge_length = 0;     ///< tip to gauge face, mm; 0 when there is no geometry
  double flute_length = 0;     ///< mm
  double max_rpm = 0;          ///< 0: no limit given
  bool center_cutting = true;  ///< false: it can't be moved into solid stock along its axis
  bool left_hand = false;      ///< it cuts turning counter-clockwise (M4)
  int teeth = 0;               ///< 0: not told
  CuttingLimits limits;
  std::string unknown;  ///< what of its body the file does not tell, in words; empty: nothing
  SourceSpan span;      ///< where it was defined
};

struct ToolTable {
  std::vector<Tool> tools;  ///< in file order
  bool random_changer = false;

  const Tool* find(int number) const;
};

/// LinuxCNC tool table (`.tbl`): `T1 P1 Z50 D10 ;comment`. `unit_mm` is the machine unit.
/// Such a table has no solids.
Expected<ToolTable> read_tbl(const SourceText& text, double unit_mm, Diagnostics& out);

/// tools.toml: `[[tool]]` with number, name, diameter, flute_length, length, corner radius or point
/// angle, shank and holder pieces (docs/machine-package.md). `holders` resolves a holder's name to
/// the text of `holders/NAME.toml`.
Expected<ToolTable> read_toml(const SourceText& text, const SourceReader& holders,
                              Diagnostics& out);

/// A tool of FreeCAD (`.fctb`, JSON) as number `number`. It names no holder.
Expected<ToolTable> read_fctb(const SourceText& text, int number, Diagnostics& out);
/// A library of FreeCAD (`.fctl`, JSON): numbers and files of tools, which `tools` resolves.
Expected<ToolTable> read_fctl(const SourceText& text, const SourceReader& tools, Diagnostics& out);
/// A tool library of Fusion (`.json`): tools with shaft and holder.
Expected<ToolTable> read_fusion(const SourceText& text, Diagnostics& out);

/// By extension: .tbl, .toml, .fctb, .fctl or .json; holders and tools that a file names are looked
/// for beside it.
Expected<ToolTable> read_tools(const std::string& path, double unit_mm, SourceMap& sources,
                               Diagnostics& out);

}  // namespace aircut::tool
