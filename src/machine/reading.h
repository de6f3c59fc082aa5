// The parts that the reader of a package is made of. All of them record what is wrong in the table
// that they read from and go on with a harmless value, so that one run names all problems.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "machine/machine.h"
#include "machine/package_files.h"

namespace aircut::machine {

struct ReadState {
  Machine& machine;
  double unit_mm;
  const PackageFiles& files;
  std::size_t triangles = 0;  ///< of all different meshes so far
  std::set<const TriangleMesh*> counted = {};
  std::set<std::string> open_senses = {};  ///< names of axes whose file gives no sense
};

/// A machine.toml from its text; the files it names come through `files`.
Expected<std::shared_ptr<const Machine>> read_machine_text(const SourceText& text,
                                                           const std::string& folder,
                                                           const PackageFiles& files,
                                                           Diagnostics& out,
                                                           const std::string& channel = {});
/// Likewise a setup.toml.
Expected<Setup> read_setup_text(const SourceText& text, const Machine& machine, Diagnostics& out);

/// One error that stands for the errors of a file, at the first one's place.
Diagnostic summary(const Diagnostics& problems, const std::string& kind, const std::string& what);

/// mm per length unit of the file: key `units`.
double read_units(config::Table& top, double fallback);
/// Key `schema`, which must not be newer than ours.
void check_schema(config::Table& top);

/// Links and couples from `[[axis]]`. All are driven that are not passive.
void read_tree(config::Table& top, ReadState& state);

/// One pair of a tool and a workpiece, the axes that move them, and how: what `[kinematics]`,
/// `[work]` and `[spindle]` say, or a `[[channel]]` with these tables.
struct Drive {
  std::string name;  ///< of the channel, or empty
  SourceSpan span;
  std::vector<Joint> tree;
  std::vector<int> driven;
  std::shared_ptr<const Kinematics> kinematics;
  Spindle spindle;
  RapidMode rapid = RapidMode::coordinated;
  double tip_acceleration = std::numeric_limits<double>::infinity();
  LinkId work_link = bed_link;
  Pose X_LM = Pose::Identity();

  void put_on(Machine& machine) const;
};
/// All of them; the machine gets the one that `channel` names (empty: the file's choice).
std::vector<Drive> read_drives(config::Table& top, const std::string& channel, ReadState& state);

/// `[[body]]` tables of a machine.toml or, with a prefix, of a fixture file.
std::vector<Body> read_bodies(config::Table& top, const std::string& prefix, LinkId link,
                              ReadState& state);
/// fixtures/NAME.toml. Its problems go to `out`; the machine that names it has the place `span`.
std::optional<Fixture> read_fixture(const std::string& name, const SourceSpan& span,
                                    ReadState& state, Diagnostics& out);
/// Takes the bodies of all fixtures off the machine, and puts them where `fixtures_` says.
void remove_fixture_bodies(Machine& machine);
void place_fixtures(Machine& machine);

/// A link by name; an unknown one is an error at the key.
LinkId read_link(config::Table& table, const std::string& key, const std::string& fallback,
                 const Machine& machine);

/// `[stock]` of a setup; nothing when there is none or it is wrong (then the table has the errors).
std::optional<SetupStock> read_stock(config::Table& top, double unit_mm);
/// Puts it on the machine, whose fixtures are placed: its surface and its body. Problems go to
/// `out`.
void place_stock(const SetupStock& stock, const PackageFiles& files, Machine& machine,
                 Diagnostics& out);
/// `[part]`, or `part = "FILE"`, of a setup; likewise.
std::optional<SetupPart> read_part(config::Table& top, double unit_mm);
/// Puts it on the machine, whose stock is placed. Problems go to `out`.
void place_part(const SetupPart& part, const PackageFiles& files, Machine& machine,
                Diagnostics& out);
/// `[wait]`: the first and the last M-code with which channels wait for one another.
std::optional<std::pair<int, int>> read_wait_codes(config::Table& top);
/// `color = "#rrggbb"`.
Color read_color(config::Table& table, Color fallback = {});
/// `unit` and `up` of a mesh file.
MeshFileOptions read_mesh_options(config::Table& table, double unit_mm);

/// Compares the kinematics with the link tree at home and at random joints: a model that draws one
/// machine and drives another is refused. Nothing when they agree, else the reason.
std::optional<std::string> tree_disagrees(const Machine& machine);

}  // namespace aircut::machine
