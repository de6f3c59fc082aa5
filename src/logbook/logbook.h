// logbook: joint logs read back. They are checked against limits and the programmed path, compared,
// converted and drawn. Stands on base alone: nothing of the planner, the motion or the writer is
// used, so a mistake there is not repeated here.
// Units are those of the file: mm, degrees, seconds.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/base.h"

namespace aircut::logbook {

using Point = std::array<double, 3>;  ///< X Y Z, mm

struct Joint {
  std::string name, unit;  ///< mm or deg
  double v_max = 0, a_max = 0, j_max = 0;
};

struct Header {
  std::map<std::string, std::string> keys;
  std::vector<std::string> order;  ///< of the keys
  std::vector<Joint> joints;
  std::vector<std::string> columns;
  double period = 0;    ///< s
  double end_time = 0;  ///< s
  std::uint64_t every = 1, samples = 0;
  std::vector<double> feed_factors = {1};  ///< what overrides may make of the programmed feed
};

/// One row of a log.
struct Row {
  std::vector<double> values;
  std::size_t joints = 0;

  double t() const { return values[0]; }
  std::uint64_t line() const { return static_cast<std::uint64_t>(values[1]); }
  std::uint64_t block() const { return static_cast<std::uint64_t>(values[2]); }
  int motion() const { return static_cast<int>(values[3]); }
  double feed_command() const { return values[4]; }
  double feed() const { return values[5]; }
  double q(std::size_t j) const { return values[7 + j]; }
  double v(std::size_t j) const { return values[7 + joints + j]; }
  double a(std::size_t j) const { return values[7 + 2 * joints + j]; }
  /// 0 … 8: X Y Z A B C U V W.
  double tip(std::size_t axis) const { return values[7 + 3 * joints + axis]; }
  Point xyz() const { return {tip(0), tip(1), tip(2)}; }
  double tool() const { return values[16 + 3 * joints]; }
  double rpm() const { return values[17 + 3 * joints]; }
  unsigned flags() const { return static_cast<unsigned>(values[20 + 3 * joints]); }
};

/// Reads a log forward, a row at a time.
class Reader {
 public:
  /// Reads the header. Errors (kind `input`) have the place.
  static Expected<Reader> open(const SourceText& text);

  const Header& header() const { return header_; }
  /// False at the end. An error ends the reading.
  Expected<bool> next(Row& row);
  std::uint64_t rows() const { return rows_; }

 private:
  explicit Reader(const SourceText& text) : text_(&text), reading_(text) {}
  bool next_line();
  Diagnostic wrong(std::size_t begin, std::size_t length, const std::string& message) const;
  Diagnostic wrong_key(const std::string& key, const std::string& message) const;
  Expected<void> read_header();
  Expected<void> read_keys();
  Expected<double> number_of(const char* key) const;
  Expected<std::vector<double>> limits_of(const char* key) const;

  const SourceText* text_;
  Reading reading_;
  std::uint64_t at_ = 0;     ///< begin of the next line
  std::uint64_t begin_ = 0;  ///< of this line
  std::string_view line_;
  std::uint64_t line_number_ = 0;
  std::uint64_t rows_ = 0;
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> places_;  ///< of keys: byte, line
  Header header_;
};

/// Opens a log, text or HDF5 (docs/joint-log.md). One of HDF5 becomes its text; that is done in a
/// child process, because what libhdf5 does with a damaged file is not ours to prove. Only for
/// processes with one thread. Error kind `input`.
Expected<const SourceText*> open_log(SourceMap& sources, const std::string& path);
/// Whether this computer has libhdf5; the error says what to install.
Expected<void> hdf5_ready();
/// The same log as HDF5: complete under its name, or not there.
Expected<void> write_hdf5(const SourceText& log, const std::string& path);

/// A piece of the programmed path: straight, a helix, or a chain of points.
struct IdealPiece {
  std::uint64_t block = 0, line = 0;
  double tolerance = 0;  ///< mm that the path may leave it (P + Q); infinite: any
  double feed = 0;       ///< mm/s or deg/s; 0: a rapid, or not known
  Point start{}, end{};
  bool arc = false;
  Point centre{}, normal{};
  int turns = 1;              ///< as the canonical ARC_FEED
  std::vector<Point> points;  ///< of a chain, with both ends
};
/// The pieces in order; false when there are no more.
using IdealPath = std::function<bool(IdealPiece&)>;

/// The largest use of a limit, and where.
struct Peak {
  std::string what;   ///< speed, acceleration, jerk, feed
  std::string joint;  ///< empty for the feed
  double limit = 0;   ///< 0 for the feed, whose limit changes
  double share = 0;   ///< of the limit
  double t = 0;
  std::uint64_t line = 0;
  std::uint64_t rows_over = 0;  ///< more than a thousandth over the limit
};

struct Check {
  Header header;
  std::uint64_t rows = 0;
  std::vector<Peak> peaks;
  bool has_path = false;
  double deviation = 0;  ///< largest distance from the programmed path, mm, where P is a number
  double deviation_t = 0;
  std::uint64_t deviation_line = 0;
  std::vector<std::string> problems;  ///< what is wrong, at most twenty
  std::size_t more_problems = 0;
  std::vector<std::string> unchecked;
};

/// Checks a log by its text, and against the programmed path if there is one. Error: it is no log.
Expected<Check> check(const SourceText& log, const IdealPath& path);

/// How two logs differ.
struct Comparison {
  struct Difference {
    std::string what, unit;
    double most = 0;
    double t = 0;
    std::uint64_t line_a = 0, line_b = 0;
  };
  double end_a = 0, end_b = 0;
  std::uint64_t rows_a = 0, rows_b = 0;
  std::vector<std::string> headers;     ///< keys that differ, with both values
  std::vector<Difference> differences;  ///< tip, feed, spindle, tool, each joint: at equal times
  std::optional<double> first;          ///< time of the first row that differs
};
/// `tolerance`: in mm and degrees; less is no difference.
Expected<Comparison> compare(const SourceText& a, const SourceText& b, double tolerance);

enum class Table { csv, json, npy };
struct ExportOptions {
  Table table = Table::csv;
  std::vector<std::string> columns;  ///< empty: all
  std::uint64_t every = 1;
  double from = 0, to = 1e300;  ///< s
};
/// Hands the bytes to `write` piece by piece.
Expected<void> export_table(const SourceText& log, const ExportOptions& options,
                            const std::function<void(std::string_view)>& write);

struct PlotOptions {
  int width = 1600;
  double from = 0, to = 1e300;  ///< s
};
/// A PNG file: joints, feed, shares of the limits, and what limited the speed, over time.
Expected<std::string> plot(const SourceText& log, const PlotOptions& options);

/// A line of a diagram, its points with rising x.
struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
};
struct Diagram {
  std::string title, x_name, y_name;
  std::vector<Curve> curves;
  int width = 900, height = 560;
};
/// A plane grid of cells, for a map: what each is, by rows of rising y.
struct MapPlane {
  std::string title, x_name, y_name;
  double x = 0, y = 0, pitch = 1;  ///< middle of the first cell, and the distance of cells
  int columns = 0, rows = 0;
  std::vector<unsigned char> cells;  ///< 0: none; 1, 2: index + 1 into Map::kinds; x fastest
  /// A frame about a part of it: x, y of the lower left and of the upper right corner.
  std::optional<std::array<double, 4>> frame;
};
struct Map {
  std::string title;
  std::vector<std::string> kinds;  ///< what 1 and 2 mean
  std::string frame;               ///< what the frames are
  std::vector<std::string> notes;  ///< lines below
  std::vector<MapPlane> planes;    ///< side by side, all in one scale
  int width = 1400;
};
/// A PNG file: the planes with axes, outlines and a bar of the scale.
Expected<std::string> draw(const Map& map);

/// A PNG file: the curves over one pair of axes, named on the right.
Expected<std::string> draw(const Diagram& diagram);

}  // namespace aircut::logbook
