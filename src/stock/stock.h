// stock: the material that is being cut, and what a cutter takes from it.
//
// A Stock is a lattice of rays in three directions with pitch h, in the frame of its carrier (the
// link that it is clamped to). Every ray holds the intervals on it that are material; a cut takes
// from each ray exactly what the straight sweep of the cutter covers. Where a ray ends is therefore
// exact (to h/7680); between rays the surface is known to h/2 (docs/stock.md). Cutting is a set
// difference: the order of the pieces, how they are batched and the number of threads change
// nothing, bit for bit. Units mm, rad.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/base.h"
#include "geometry/geometry.h"

namespace aircut::stock {

class Outline;

/// A solid of revolution about +Z that removes material or asks for it: the cutting part of a tool,
/// a shank, a holder. The tip is z = 0 of the outline it was made from. Cheap to copy.
class CutterProfile {
 public:
  /// Errors of all of these: kind `cutter_shape`, with the parameter that is wrong.
  static Expected<CutterProfile> flat(double diameter, double height);
  static Expected<CutterProfile> ball(double diameter, double height);
  static Expected<CutterProfile> bull(double diameter, double corner_radius, double height);
  /// A cone from `tip_diameter` at the tip to `diameter` at `cone_height`, then straight.
  static Expected<CutterProfile> cone(double tip_diameter, double diameter, double cone_height,
                                      double height);
  /// Any outline (geometry/profile.h). Chains of tangents around an arc, as the tool library makes
  /// them, are found and become exact arcs again. Outlines that are not convex are cut as several
  /// convex bodies that overlap.
  static Expected<CutterProfile> from_outline(const Profile& outline);

  /// The same body larger by `distance` on all sides (at most √2 times that at edges): for
  /// clearance.
  CutterProfile grown(double distance) const;

  double radius() const;  ///< the largest
  double low() const;     ///< lowest and highest z
  double high() const;

  const std::vector<Outline>& bodies() const { return *bodies_; }  ///< private to the library

 private:
  explicit CutterProfile(std::vector<Outline> bodies);
  std::shared_ptr<const std::vector<Outline>> bodies_;
};

/// The part of a motion that is cut at once: a straight move of the tip with a fixed tool axis.
struct Piece {
  const CutterProfile* cutter = nullptr;  ///< borrowed for the call
  Vec3 start = Vec3::Zero();              ///< tool tip, stock frame
  Vec3 end = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  ///< unit, from the tip towards the spindle
  std::uint32_t move = 0;     ///< what the removed material is credited to
};

/// Initial solids, in the frame of the stock.
struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};
/// Round bar or, with inner_radius > 0, a tube.
struct Cylinder {
  Vec3 base = Vec3::Zero();  ///< middle of the face with the smallest coordinate
  int direction = 2;         ///< 0, 1, 2: along X, Y, Z
  double radius = 0, inner_radius = 0, length = 0;
};
/// A closed mesh, outward oriented; brought to the lattice's quanta (h/3840) when it is cast.
struct MeshSolid {
  std::shared_ptr<const TriangleMesh> mesh;
};
using Solid = std::variant<Box, Cylinder, MeshSolid>;

struct StockOptions {
  std::size_t memory_limit = std::size_t{2} << 30;  ///< bytes
  unsigned threads = 1;
  std::size_t batch = 256;  ///< pieces that are binned together
};

/// What one move took.
struct Removal {
  std::uint32_t move = 0;
  std::int64_t quanta = 0;  ///< length lost on Z rays; exact, in h/3840
  double volume = 0;        ///< mm³, the same
};

/// What a piece would take, of the three families of rays.
struct Touch {
  double depth = 0;  ///< mm, the longest material on one ray
  /// mm, the same measured across the material's surface: a ray that grazes a wall is long in a
  /// body that is hardly in it.
  double across = 0;
  double volume = 0;          ///< mm³, the largest of the three families' sums
  Vec3 point = Vec3::Zero();  ///< middle of that longest material
};

/// How a piece is in the material: extents of what it would take, seen from the moving tool. They
/// are measured at rays, so they are at most a pitch smaller than they are, never larger.
struct Engagement {
  double depth = 0;   ///< mm along the axis
  double left = 0;    ///< mm to the left of the tip's way, seen from above the tool
  double right = 0;   ///< mm to its right; both 0 when the tool goes along its axis
  double volume = 0;  ///< mm³, of the Z rays
  bool any() const { return volume > 0 || depth > 0 || left > -right; }
};

/// How a piece was in the material over a part of its way, as cut() found it.
struct Slice {
  std::size_t piece = 0;    ///< place in cut()'s list
  double from = 0, to = 0;  ///< fractions of its way at which the cutter's front passes
  Engagement in;            ///< of the Z rays
};

enum class Contact { clear, hit, unresolved };

/// Answer of a body that must not touch the material (docs/stock.md).
struct ContactAnswer {
  Contact contact = Contact::clear;
  Touch touch;       ///< of the body itself, on the rays
  double least = 0;  ///< depth across the surface as the rays measure it, mm
  double most = 0;   ///< with what may hide between the rays
};

/// Whether an answer about a hit says how deep it is. Without that it comes much sooner, and its
/// touch is that of the first places that were looked at.
enum class HowDeep { measured, left_open };

/// Which triangles a mesh has.
enum class Facets {
  merged,   ///< flat stretches across an axis in as few as can be; the surface is the same
  lattice,  ///< a vertex in every cell: for colours by place
};

/// A part of the material that no ray joins to the rest.
struct Separate {
  std::int64_t quanta = 0;  ///< length of its Z rays, h/3840
  double volume = 0;        ///< mm³, the same
  Box3 box;                 ///< of its rays
};

struct MeshStatistics {
  std::size_t disagreeing_nodes = 0;  ///< the three families disagree: rounding only when few
  std::size_t missing_ends = 0;       ///< edges that cross the surface without an end nearby
};

class Stock {
 public:
  /// Errors: `stock_shape` (size, pitch), `stock_mesh` (open mesh), `stock_memory` (names the
  /// finest pitch that fits).
  static Expected<Stock> make(const Solid& solid, double pitch, const StockOptions& options = {});
  /// Whether make() has the memory to begin with: its error `stock_memory`, else nothing.
  static Expected<void> fits(const Solid& solid, double pitch, const StockOptions& options = {});
  /// A stock from save(). Error `stock_file`: what is wrong, and where. `name` is what messages
  /// call it.
  static Expected<Stock> load(std::string_view bytes, const std::string& name,
                              const StockOptions& options = {});
  Stock(Stock&&) noexcept;
  Stock& operator=(Stock&&) noexcept;
  ~Stock();
  /// A copy, e.g. to save the state at a tool change.
  Stock clone() const;

  /// Takes the swept volume of each piece away. One row per move that occurs in `pieces`, in order
  /// of first appearance; a length that several moves cover belongs to the first. Errors:
  /// `stock_memory`; `stock_unsupported`: a motion that is not modelled, nothing was cut.
  Expected<std::vector<Removal>> cut(std::span<const Piece> pieces);
  /// The same, and how each piece was in the material at its turn: slices at most `length` mm long
  /// are added to `slices` in order, those that took nothing left out.
  Expected<std::vector<Removal>> cut(std::span<const Piece> pieces, double length,
                                     std::vector<Slice>& slices);

  /// What the piece would take if it cut now. Changes nothing. Error: `stock_unsupported`.
  Expected<Touch> touch(const Piece& piece) const;
  /// Whether it would be deeper than `depth` mm or take more than `volume` mm³; sooner than
  /// touch().
  Expected<bool> takes(const Piece& piece, double depth, double volume) const;
  /// The same as a proof for a body that must not touch, e.g. a shank or a rapid move. Contact up
  /// to `tolerance` mm is no hit. Error: `stock_unsupported`.
  Expected<ContactAnswer> would_cut(const Piece& piece, double tolerance,
                                    HowDeep how_deep = HowDeep::measured) const;

  /// How the piece would be in the material if it cut now. Error: `stock_unsupported`.
  Expected<Engagement> engagement(const Piece& piece) const;

  /// The largest value (mm, above `ignore`) that a function of the place has in what the piece
  /// would take, sampled along the rays at no more than a pitch; Touch has it as its depth. The
  /// function must not change by more than 1 mm in a millimetre and be at most `at_surface` where
  /// the material ends. Error: `stock_unsupported`.
  Expected<Touch> deepest(const Piece& piece, const std::function<double(const Vec3&)>& depth_at,
                          double ignore, double at_surface) const;
  /// Calls `see` with every place where a ray along `axis` enters or leaves the material.
  void each_end(int axis, const std::function<void(const Vec3&)>& see) const;

  double pitch() const;
  Box3 box() const;           ///< of the initial solid
  std::size_t bytes() const;  ///< resident, of the material itself
  /// Bytes that a stock cut the same way takes at another pitch (they grow as 1/h²).
  std::size_t bytes_at(double pitch) const;
  /// Sum of the lengths on the Z rays, in quanta: what cut() takes away comes off this exactly.
  std::int64_t z_quanta() const;
  double volume_of(std::int64_t quanta) const;  ///< mm³

  /// Material on the lattice's ray along `axis` (0, 1, 2) nearest to a point: intervals of that
  /// coordinate, ascending.
  std::vector<std::pair<double, double>> on_ray(int axis, const Vec3& point) const;

  /// The pieces that the material is in, the largest first, those under `least` mm³ left out. Two Z
  /// rays beside one another belong together where both have material at one height: a web that is
  /// thinner than a pitch and lies between rays is not seen.
  std::vector<Separate> pieces(double least) const;

  /// Volume inside mesh(), mm³: the best figure for the whole stock.
  double volume() const;
  /// The surface as a closed mesh, outward oriented.
  TriangleMesh mesh(Facets facets = Facets::merged, MeshStatistics* statistics = nullptr) const;
  /// The bytes of a file from which load() makes the same stock, bit for bit.
  std::string save() const;
  /// SHA-256 over the material: equal for equal stock, however it came about.
  std::string hash() const;

  struct Impl;  ///< private to the library

 private:
  explicit Stock(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What counts as a difference between a stock and the part that it is to become.
struct PartTolerances {
  double gouge = 0.02;           ///< mm that may be missing
  double excess = 0.05;          ///< mm that may be left …
  double allowance = 0;          ///< … beyond these, which are wanted
  std::vector<Box3> leave = {};  ///< any excess is wanted in here
};

/// A place where a stock differs from the part: neighbouring points beyond the tolerance are one.
struct Spot {
  double depth = 0;           ///< mm, the largest
  Vec3 point = Vec3::Zero();  ///< where
  Box3 box;                   ///< of all its points
};

/// A stock compared with a part, at every place where a ray of its lattice leaves the material.
struct Deviation {
  double gouge = 0, excess = 0;        ///< the largest, mm
  std::vector<Spot> gouges, excesses;  ///< beyond the tolerances, deepest first
  std::size_t points = 0;              ///< that were compared
  /// Not in the lists, which have the 100 deepest.
  std::size_t gouges_dropped = 0, excesses_dropped = 0;
};

class TurnedStock;

/// The part that a stock is to become: a closed mesh, in the stock's frame.
class Part {
 public:
  /// Errors as those of Stock::make.
  static Expected<Part> make(std::shared_ptr<const TriangleMesh> mesh, double pitch,
                             const StockOptions& options = {});
  Part(Part&&) noexcept;
  Part& operator=(Part&&) noexcept;
  ~Part();

  /// How far a point is outside of the part, mm; negative inside.
  double outside(const Vec3& point) const;
  /// How deep the piece goes into the part, as the rays see it, at least `ignore` mm; zero if it
  /// does not. Looks at what take() has left of the part. Error: `stock_unsupported`.
  Expected<Touch> cut_into(const Piece& piece, double ignore) const;
  /// Takes the piece off, which goes so deep into the part, so that only what goes deeper is found
  /// from now on.
  Expected<void> take(const Piece& piece, double depth);

  /// How far the part stands out of a stock's initial solid, given by its surface, and where.
  Spot outside_of(const TriangleMesh& raw) const;
  Deviation compare(const Stock& stock, const PartTolerances& tolerances) const;
  /// The same of a stock of revolution, at eight places around.
  Deviation compare(const TurnedStock& stock, const PartTolerances& tolerances) const;
  /// For each vertex of a mesh how far it is outside, mm.
  std::vector<double> outside(const TriangleMesh& mesh) const;

 private:
  struct Impl;
  explicit Part(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A circular arc or a helix.
struct Arc {
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();
  Vec3 centre = Vec3::Zero();   ///< any point of the arc's axis
  Vec3 normal = Vec3::UnitZ();  ///< of its plane, unit
  double angle = 0;             ///< rad, signed by `normal`; more than 2π for several turns
};
/// Chords of an arc or helix, at most `deviation` mm from it. `pattern` gives cutter, axis, move.
std::vector<Piece> arc_pieces(const Arc& arc, const Piece& pattern, double deviation);

// ---- turning: a spinning stock, cut by what does not spin ----

/// A convex section of a tool in the half plane of radius and height: the hull of some discs. An
/// insert is its nose and the far ends of its edges; a revolved body seen from the side has corners
/// (discs without radius).
struct TurningSection {
  struct Disc {
    double r = 0, z = 0, radius = 0;
  };
  std::vector<Disc> discs;
};

/// A straight move of a section; r and z of its origin. A radius below 0 is on the other side of
/// the spindle's axis.
struct TurningMove {
  const TurningSection* section = nullptr;  ///< borrowed for the call
  double r0 = 0, z0 = 0, r1 = 0, z1 = 0;
};

/// What a turning move would take.
struct TurningTouch {
  double depth = 0;     ///< mm, the longest material on one ray
  double volume = 0;    ///< mm³
  double r = 0, z = 0;  ///< middle of that longest material
};

/// A part of a ray that a turning move would take.
struct TurningStretch {
  bool along_r = false;     ///< the ray leads along the radius, else along Z
  bool beyond = false;      ///< it is taken on the other side of the axis, where radii are negative
  double at = 0;            ///< z of a ray along the radius, else its radius; mm
  double from = 0, to = 0;  ///< mm
};

/// The material of a spinning piece: a solid of revolution about Z, held as rays along the radius
/// and along Z through its section, in whole nanometres. As with Stock, order and repetition of
/// cuts change nothing.
class TurnedStock {
 public:
  /// A bar or, with a bore, a tube from z = 0 to `length`. Error `stock_shape`, `stock_memory`.
  static Expected<TurnedStock> make(double radius, double bore, double length, double pitch,
                                    const StockOptions& options = {});

  /// A stock from save(); as Stock::load.
  static Expected<TurnedStock> load(std::string_view bytes, const std::string& name,
                                    const StockOptions& options = {});

  /// Takes away what the move sweeps while the stock turns; the volume taken, mm³.
  double cut(const TurningMove& move);
  TurningTouch touch(const TurningMove& move) const;
  /// Calls `see` with all that the move would take, ray by ray in each direction.
  void each_stretch(const TurningMove& move,
                    const std::function<void(const TurningStretch&)>& see) const;

  double pitch() const { return pitch_; }
  double radius() const { return radius_; }  ///< of the initial bar, mm
  double length() const { return length_; }
  double volume() const;  ///< mm³
  std::size_t bytes() const;
  /// Material on the ray at the height nearest to z (at the radius nearest to r), mm.
  std::vector<std::pair<double, double>> radii_at(double z) const;
  std::vector<std::pair<double, double>> heights_at(double r) const;
  /// Calls `see` with every place (r, z) where a ray enters or leaves the material.
  void each_end(const std::function<void(double r, double z)>& see) const;
  /// The outlines of the section, closed loops of (r, z) with the material on the left; straight
  /// stretches are one piece (off by at most a hundredth of the pitch).
  std::vector<std::vector<std::pair<double, double>>> outlines() const;
  /// The surface as a closed mesh; circles are polygons at most `facets` mm inside of them.
  TriangleMesh mesh(double facets) const;
  /// The bytes of a file from which load() makes the same stock, bit for bit.
  std::string save() const;
  std::string hash() const;

 private:
  using Nanometres = std::int64_t;
  using Ray = std::vector<std::pair<Nanometres, Nanometres>>;  ///< material, ascending, apart

  TurnedStock() = default;
  template <class See>
  void each_chord(const TurningMove& move, See see) const;

  double pitch_ = 0, radius_ = 0, length_ = 0;
  std::vector<Ray> along_r_;  ///< at z = (k + ½) pitch
  std::vector<Ray> along_z_;  ///< at r = (i + ½) pitch
};

}  // namespace aircut::stock
