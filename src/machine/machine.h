// machine: an immutable machine, read from a package folder: a tree of links and joints, bodies
// with meshes, limits and kinematics. Units mm, rad, s. Frames: W world = bed axes; L a link; F
// gauge face of the spindle; T tool tip; M the frame of X Y Z positions, fixed to the link that
// carries the work. Link frames: at all joints zero every link frame equals W, so a body's mesh is
// given in bed axes and moves by the product of exponentials of the joints up to its link (pose of
// a couple: Trans(sense q u), or rotation by sense q about the line origin + u).
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/base.h"
#include "config/config.h"
#include "geometry/geometry.h"
#include "tool/tool.h"

namespace aircut::machine {

inline constexpr int max_joints = 16;
/// Values of the driven joints in log order, mm or rad. No heap.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_joints, 1>;

/// Index of a driven joint in log order.
enum class JointId : int {};
constexpr int index(JointId id) { return static_cast<int>(id); }
/// Index into Machine::links(); 0 is the bed.
enum class LinkId : int {};
constexpr int index(LinkId id) { return static_cast<int>(id); }
inline constexpr LinkId bed_link{0};

enum class JointKind : unsigned char { linear, rotary };
enum class Wrap : unsigned char { none, shortest, modulo };

/// One couple of the tree. A driven joint is in the log and has limits; a passive one (a rod of a
/// parallel machine) gets its value from the kinematics.
struct Joint {
  std::string name;
  JointKind kind = JointKind::linear;
  LinkId parent = bed_link;
  LinkId child = bed_link;
  Vec3 origin = Vec3::Zero();      ///< a point of the axis, bed axes, all joints zero
  Vec3 direction = Vec3::UnitZ();  ///< unit vector
  double sense = 1;                ///< child moves by sense · q
  int driven = -1;                 ///< JointId, or -1 for a passive or a held joint
  bool held = false;               ///< of another channel: it stays at home
  std::string passive;             ///< name of the kinematics' passive value, or empty
  int passive_index = -1;          ///< its place in Kinematics::passive(); -1 = found by name
  // Limits, driven joints only: mm or rad, s. Infinity = no limit.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double vmax = 0;
  double amax = 0;
  double jmax = std::numeric_limits<double>::infinity();
  Wrap wrap = Wrap::none;
  double home = 0;
};

struct Link {
  std::string name;
  LinkId parent = bed_link;
  int joint = -1;  ///< index into Machine::tree(): the couple that carries it; -1 for the bed
};

enum class Role : unsigned char {
  machine,
  spindle,
  holder,
  shank,
  cutter,
  fixture,
  stock,
  part,
  probe
};
std::string_view to_string(Role role);

struct Color {
  unsigned char r = 138, g = 143, b = 148;
};

struct Body {
  std::string name;  ///< stable, unique: "head", "vise/fixed-jaw"
  Role role = Role::machine;
  LinkId link = bed_link;
  std::shared_ptr<const TriangleMesh> mesh;  ///< in the frame given by X_LB
  Pose X_LB = Pose::Identity();              ///< mesh frame seen from the link frame
  Color color;
  bool collide = true;
  SourceSpan span;
};

/// A pair of bodies that is not checked, and why. Names of bodies or of links (then all their
/// bodies).
struct Exclusion {
  std::string a, b;
  std::string reason;
};

/// A pose that the controller commands: nine axis values of the tip and the tool length offset.
struct Target {
  AxisValues tip;          ///< M frame, mm and rad
  AxisValues tool_offset;  ///< controlled point = tip + tool_offset
};

/// Why a pose has no joint values.
struct ReachError {
  std::string reason;  ///< "rod 2 is 3.2 mm too short for Z -361.2", ready to be shown
};

/// What the tip does over an interval of time: a box that holds it, and per axis the length of its
/// way (≥ the box's size).
struct TipInterval {
  AxisValues low, high;
  AxisValues travel;
  AxisValues tool_offset;
  /// Joints in whose branch the machine is, as for inverse(). Empty: the bound holds for all
  /// branches.
  JointVector near = JointVector();
};

/// Tool pose ↔ joints, for one family of machines. Stateless and thread-safe.
class Kinematics {
 public:
  virtual ~Kinematics() = default;
  virtual std::string_view type() const = 0;
  /// Axes that a program may use on this machine.
  virtual AxisSet axes() const = 0;
  virtual int joint_count() const = 0;
  /// Names of passive values, in the order of passive(). A name that ends in `_angle` is an angle
  /// for a rotary couple, any other a length for a sliding one.
  virtual std::vector<std::string> passive_names() const { return {}; }
  /// How many there are; called for every pose, so a type with passive values gives it directly.
  virtual int passive_count() const { return static_cast<int>(passive_names().size()); }

  /// Joints for a target; `near` (same size) chooses among turns and branches.
  virtual tl::expected<JointVector, ReachError> inverse(const Target& target,
                                                        const JointVector& near) const = 0;
  /// Tip for joints (tool_offset as in Target); the error says why it can't be assembled.
  virtual tl::expected<AxisValues, ReachError> forward(const JointVector& joints,
                                                       const AxisValues& tool_offset) const = 0;
  /// Sets joints that must follow others (the second drive of a gantry) to where they belong.
  virtual void couple(JointVector& joints) const;
  /// Values of the passive joints (mm or rad) for driven ones that inverse() gave.
  virtual void passive(const JointVector& joints, std::span<double> out) const;

  /// Direction of the tool (from the tip towards the spindle) in M, for types whose joints tilt it.
  virtual std::optional<Vec3> tool_axis(const AxisValues&) const { return std::nullopt; }

  /// First and second derivative of the joints with respect to a path parameter, given those of the
  /// tip. `joints` is what inverse() gave for the target: its branch is the one that counts.
  /// Default false: not available, the caller uses differences of inverse().
  virtual bool rates(const Target& target, const JointVector& joints, const AxisValues& d_tip,
                     const AxisValues& dd_tip, JointVector& dq, JointVector& ddq) const;

  /// A proven upper bound of the way that every driven joint (first) and passive value (after them)
  /// travels while the tip moves anywhere inside `tip.low..high` along a path of `tip.travel`.
  /// False when no finite bound is known (for example, part of the box is out of reach).
  virtual bool travel_bound(const TipInterval& tip, std::span<double> travel) const = 0;
};

/// A joint for each axis, in this order: joint = tip + tool offset − offset. `offset` is the gauge
/// point in M coordinates with all joints at zero.
std::shared_ptr<const Kinematics> make_identity(const std::vector<Axis>& axes,
                                                const Vec3& offset = Vec3::Zero());

/// Two sliders on parallel guides carry a platform by two rods, a third one carries the whole plane
/// along Y (kinematics/ox_glide.cpp has the drawing). Joints: s1, s2, s3. Passive values:
/// `rod1_angle`, `rod2_angle` (about +Y, 0 = the rod hangs straight down), `platform_x`,
/// `platform_z` (the platform point in M coordinates).
struct OxGlide {
  enum class Form : unsigned char { crossed, extended };
  Form form = Form::crossed;
  double l1 = 302, l2 = 432;   ///< lengths of the rods, mm
  double p1 = 55, p2 = 65;     ///< rod joints left and right of the platform point, mm
  double d = 74;               ///< guide 1 lies at z = −d, guide 2 at z = +d, mm
  Vec3 offset = Vec3::Zero();  ///< gauge point seen from the platform point, mm
};
std::shared_ptr<const Kinematics> make_ox_glide(const OxGlide& parameters);

/// Lengths of a six-axis arm, mm (kinematics.md c.1): standard D-H rows d1 a1 | b a2 | a3 | d4 |
/// d6, and the spindle: dt beyond the flange on its axis, on the horizontal machine across it, at.
struct RobotArm {
  double d1 = 0, a1 = 0, b = 0;
  double a2 = 900;  ///< upper arm
  double a3 = 0;
  double d4 = 950;  ///< forearm
  double d6 = 150;  ///< from the wrist's centre to the flange
  double dt = 200, at = 250;
};
/// Five-axis machine with a horizontal spindle, joint 4 of the arm blocked; of the arm's lengths
/// a2, d4, d6, dt, at count. Program axes X Y Z A B, R = Rx(A)·Ry(B).
std::shared_ptr<const Kinematics> make_robot_horizontal(const RobotArm& arm);
/// Five-axis machine with a vertical spindle on the flange's axis, joint 6 blocked. X Y Z A B.
std::shared_ptr<const Kinematics> make_robot_vertical(const RobotArm& arm);
/// All six axes, X Y Z A B C, R = Rx(A)·Ry(B)·Rz(C).
std::shared_ptr<const Kinematics> make_robot_6r(const RobotArm& arm);

/// How a rapid moves.
enum class RapidMode : unsigned char { coordinated, joint, dogleg };

struct Spindle {
  LinkId link = bed_link;
  Vec3 gauge = Vec3::Zero();     ///< F origin, bed axes, all joints zero
  Mat3 R_LF = Mat3::Identity();  ///< axes of F: those of M with all joints zero; the tool is at −Z
  double min_rpm = 0, max_rpm = 0;
  double acceleration = 0;  ///< rev/s²; 0: it is at speed at once
};

struct ToolChange {
  double seconds = 0;
  /// Before it these axes go to this machine position.
  std::optional<std::pair<AxisSet, AxisValues>> position;
  std::string program;  ///< sub that M6 calls instead; its file has that name. Empty: none
  SourceSpan program_span;
};

enum class UserCodeKind : unsigned char { ignore, time, program, unknown, kinematics };
struct UserCodeRule {
  UserCodeKind kind = UserCodeKind::unknown;
  double seconds = 0;
  int model = 0;  ///< kind kinematics: the channel, by number
};

/// One of the kinematics among which a program can switch: the channel of that number. The joints
/// and the tool are those of the driven channel; what its X Y Z mean is its own.
struct KinematicsModel {
  std::string channel;
  std::shared_ptr<const Kinematics> kinematics;  ///< null: can't be switched to
  std::string reason;                            ///< why not, with its subject
};

/// Bodies that belong together and are placed by a setup.
struct Fixture {
  std::string name;
  LinkId link = bed_link;
  Vec3 place = Vec3::Zero();  ///< M coordinates of its origin, mm
  double angle = 0;           ///< about Z, rad
  std::vector<Body> bodies;   ///< X_LB: seen from the fixture's own origin
};

enum class StockShape : unsigned char { box, cylinder, mesh, saved };

/// The raw piece of a job. Its frame S: a box stands on z = 0, its middle at the origin; a cylinder
/// or tube stands on z = 0 about the Z axis; a mesh, or what an earlier job left, is as in its
/// file.
struct RawStock {
  StockShape shape = StockShape::box;
  Vec3 size = Vec3::Zero();                   ///< of a box, mm
  double diameter = 0, bore = 0, height = 0;  ///< of a cylinder, mm; bore > 0: a tube
  std::shared_ptr<const TriangleMesh> mesh;   ///< its closed surface in S, for every shape
  const SourceText* saved = nullptr;          ///< what an earlier job left; of the SourceMap
  LinkId link = bed_link;                     ///< the link that carries it
  Pose X_LS = Pose::Identity();               ///< S seen from that link
  std::optional<double> pitch;                ///< of the lattice that it is cut on, mm
  Color color{207, 178, 122};
  SourceSpan span;
};

/// The part that a job makes, to compare the result with. It goes with the stock and collides with
/// nothing.
struct DesignPart {
  std::shared_ptr<const TriangleMesh> mesh;  ///< closed, seen from the stock's frame S
  double gouge = 0.02;                       ///< mm that may be missing
  double excess = 0.05;                      ///< mm that may be left …
  double allowance = 0;                      ///< … beyond these, which are wanted
  std::vector<Box3> leave;                   ///< any excess is wanted in here; S
  SourceSpan span;
};

/// Scratch space of forward(); the caller keeps it.
struct LinkPoses {
  std::vector<Pose> X_WL;  ///< by LinkId
};

class Machine {
 public:
  const std::string& name() const { return name_; }
  /// Of the programs that it runs: "linuxcnc", "fanuc" or "haas".
  const std::string& dialect() const { return dialect_; }
  const std::string& folder() const { return folder_; }
  /// Names of the channels of a machine with several tools or workpieces, each a pair of them and
  /// the axes that move it; empty when there is just one. One is driven, `channel()`.
  const std::vector<std::string>& channels() const { return channels_; }
  const std::string& channel() const { return channel_; }
  /// Of all channels, in their order; empty when there is just one.
  const std::vector<KinematicsModel>& models() const { return models_; }
  /// The driven channel's place among them.
  int model() const;
  /// Channels that tool centre point control (G43.4, G234) and its end (G49) switch to.
  std::optional<int> tcp_on() const { return tcp_on_; }
  std::optional<int> tcp_off() const { return tcp_off_; }
  const std::vector<Link>& links() const { return links_; }
  /// All couples, parents before children.
  const std::vector<Joint>& tree() const { return tree_; }
  int joint_count() const { return static_cast<int>(driven_.size()); }
  const Joint& joint(JointId id) const {
    return tree_[static_cast<std::size_t>(driven_[static_cast<std::size_t>(index(id))])];
  }
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Exclusion>& exclusions() const { return exclusions_; }
  const std::vector<Fixture>& fixtures() const { return fixtures_; }
  /// The raw piece that a setup put on; it is among bodies(), too, with the role `stock`.
  const std::optional<RawStock>& stock() const { return stock_; }
  /// What it is to become. Not among bodies().
  const std::optional<DesignPart>& part() const { return part_; }
  const Kinematics& kinematics() const { return *kinematics_; }
  const Spindle& spindle() const { return spindle_; }
  const ToolChange& tool_change() const { return tool_change_; }
  RapidMode rapid() const { return rapid_; }
  /// Limit of the tool tip's acceleration as a vector, mm/s²; infinity = none.
  double tip_acceleration() const { return tip_acceleration_; }
  LinkId work_link() const { return work_link_; }
  /// M frame seen from the work link (= from the bed with all joints at zero).
  const Pose& X_LM() const { return X_LM_; }
  double collision_tolerance() const { return collision_tolerance_; }  ///< ε_r, mm
  const std::map<int, UserCodeRule>& user_codes() const { return user_codes_; }
  /// Joints at home.
  JointVector home() const;
  std::optional<LinkId> find_link(const std::string& name) const;

  // Filled by the package reader and by tests that build a machine by hand.
  std::string name_;
  std::string folder_;
  std::vector<std::string> channels_;
  std::string channel_;
  std::vector<KinematicsModel> models_;
  std::optional<int> tcp_on_, tcp_off_;
  std::vector<Link> links_{Link{"bed"}};
  std::vector<Joint> tree_;
  std::vector<int> driven_;  ///< index into tree_ by JointId
  std::vector<Body> bodies_;
  std::vector<Exclusion> exclusions_;
  std::vector<Fixture> fixtures_;  ///< whose bodies are in bodies_, after the machine's own
  std::optional<RawStock> stock_;
  std::optional<DesignPart> part_;
  std::shared_ptr<const Kinematics> kinematics_;
  Spindle spindle_;
  ToolChange tool_change_;
  RapidMode rapid_ = RapidMode::coordinated;
  double tip_acceleration_ = std::numeric_limits<double>::infinity();
  LinkId work_link_ = bed_link;
  Pose X_LM_ = Pose::Identity();
  double collision_tolerance_ = 0.005;
  std::map<int, UserCodeRule> user_codes_;
  std::string default_tools_;       ///< path of the package's tool file, or empty
  std::string default_parameters_;  ///< path of the package's var file, or empty
  std::string dialect_ = "linuxcnc";
};

/// Poses of all links for driven joints.
void forward(const Machine& machine, const JointVector& joints, LinkPoses& out);

/// How far a body can move, seen from another one, while each couple travels at most so far:
/// the sum over the couples on the way between their links; sliding: travel; rotary: travel · ρ,
/// ρ the largest distance of the body's points from that axis at any time of the interval, which
/// the couples between the axis and the body enlarge (verification.md §3).
class MotionBound {
 public:
  explicit MotionBound(const Machine& machine);
  /// Upper bound (mm) of how far any point of the body on link `a` is displaced, seen from link
  /// `b`, or any point of the body on `b` seen from `a`, whichever bound is smaller, between any
  /// two moments of an interval. (Either one bounds how much the distance of the bodies changes.)
  /// `poses` belong to any moment of it. The sphere `centre_a` (world, at that moment), `radius_a`
  /// holds the body on a, likewise b. `travel`: way of each driven joint in the interval, then of
  /// each passive value, as Kinematics::travel_bound gives them.
  double bound(LinkId a, const Vec3& centre_a, double radius_a, LinkId b, const Vec3& centre_b,
               double radius_b, const LinkPoses& poses, std::span<const double> travel) const;

 private:
  struct Ball;
  LinkId common(LinkId a, LinkId b) const;
  double over(int couple, double moved, const Ball& ball, const LinkPoses& poses,
              std::span<const double> travel) const;
  double up(LinkId from, LinkId to, const Ball& ball, const LinkPoses& poses,
            std::span<const double> travel) const;
  double down(LinkId from, LinkId to, double moved, const Ball& ball, const LinkPoses& poses,
              std::span<const double> travel) const;

  const Machine* machine_;
  std::vector<std::size_t> travel_index_;  ///< into `travel`, by index into Machine::tree()
  std::vector<int> depth_;                 ///< couples from the bed, by LinkId
};

/// Bodies that a setup places: fixtures from the package's `fixtures/`.
struct SetupFixture {
  std::string name;
  std::optional<Vec3> place;    ///< M coordinates, mm; as the fixture's file says if not given
  std::optional<double> angle;  ///< about Z, rad; likewise
  bool present = true;
  SourceSpan span;
};

/// `[stock]` of a setup, before it is placed.
struct SetupStock {
  RawStock raw;           ///< shape and sizes; `mesh` only once it is placed
  std::string mesh_path;  ///< of a mesh or a saved stock, relative to the setup's folder
  MeshFileOptions mesh_options;
  SourceSpan mesh_span;
  std::string replaces;  ///< a body that only stands for the piece in pictures; it goes
  SourceSpan replaces_span;
  std::string fixture;  ///< whose frame `place` and `angle` are seen from; empty: M
  SourceSpan fixture_span;
  Vec3 place = Vec3::Zero();  ///< of its origin, mm
  double angle = 0;           ///< about Z, rad
};

/// `[part]` of a setup, before it is placed.
struct SetupPart {
  DesignPart part;        ///< without its mesh; `leave` is in place
  std::string mesh_path;  ///< relative to the setup's folder
  MeshFileOptions mesh_options;
  SourceSpan mesh_span;
  Vec3 place = Vec3::Zero();  ///< of its origin, seen from the stock's frame, mm
  double angle = 0;           ///< about Z, rad
};

/// What a job adds to the machine.
struct Setup {
  std::string folder;  ///< of its file; paths start here
  /// Of a saved stock (StockShape::saved) whoever calls apply_setup() gives pitch and mesh.
  std::optional<SetupStock> stock;
  std::optional<SetupPart> part;
  std::vector<SetupFixture> fixtures;
  std::map<int, AxisValues> offsets;  ///< 1 = G54 … 9 = G59.3
  std::optional<JointVector> start;
};

/// Reads `machine.toml` at `path` (a package folder, or the file itself) with its meshes.
/// `channel` is the one that is driven, by default the one that the file names.
/// All problems go to `out`; the value is there only if there was no error.
Expected<std::shared_ptr<const Machine>> read_machine(const std::string& path, SourceMap& sources,
                                                      Diagnostics& out,
                                                      const std::string& channel = {});
/// Likewise a machine.toml that is a text already; its files are looked for in `folder`.
Expected<std::shared_ptr<const Machine>> read_machine(const SourceText& text,
                                                      const std::string& folder, SourceMap& sources,
                                                      Diagnostics& out,
                                                      const std::string& channel = {});
/// Reads setup.toml and returns the machine with its fixtures placed as the setup says.
Expected<Setup> read_setup(const std::string& path, const Machine& machine, SourceMap& sources,
                           Diagnostics& out);
Expected<std::shared_ptr<const Machine>> apply_setup(const Machine& machine, const Setup& setup,
                                                     SourceMap& sources, Diagnostics& out);

/// `NAME:CHANNEL` in two; a name without a channel, or of a file whose name has a colon, is whole.
std::pair<std::string, std::string> split_channel(const std::string& what);
/// A package by folder, file, or by name among `search` folders; an unknown name lists the nearest.
Expected<std::string> find_package(const std::string& what, const std::vector<std::string>& search);

/// All kinematics types.
std::vector<std::string> kinematics_types();
/// A kinematics by type and parameters (`radius = 120`) alone: driven axes without limits, nothing
/// to draw. Its problems go to `out`.
Expected<std::shared_ptr<const Machine>> bare_machine(const std::string& type,
                                                      const std::vector<std::string>& parameters,
                                                      SourceMap& sources, Diagnostics& out);

/// One line per problem of a machine that was read: meshes that are open, self-contact is not here
/// (it needs the collision library). For `machine check`.
void check_model(const Machine& machine, Diagnostics& out);

}  // namespace aircut::machine
