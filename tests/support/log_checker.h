// An independent judge of a joint log: reads the text itself and shares no code with the planner,
// the motion or the writer. Everything is in the file's units (mm, degrees, s).
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace aircut::test {

struct JointLog {
  std::map<std::string, std::string> header;
  std::vector<std::string> header_order;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
  std::vector<std::string> joint_names;
  std::vector<double> v_max, a_max, j_max;
  double period = 0;
  double end_time = 0;
  std::vector<std::string> problems;  ///< of the form; empty when the text is a good log

  std::size_t joints() const { return joint_names.size(); }
  /// Column by name; a row's value.
  std::size_t column(const std::string& name) const;
  double value(std::size_t row, const std::string& name) const { return rows[row][column(name)]; }
};

/// Parses a log and checks its form: header, number of rows, times, rest at both ends.
JointLog read_log(const std::string& text);

/// Worst share of a limit, by finite differences of the logged positions alone.
struct Worst {
  double share = 0;
  std::string where;
};
Worst worst_velocity(const JointLog& log);
Worst worst_acceleration(const JointLog& log);
Worst worst_jerk(const JointLog& log);
/// Tip speed (of XYZ, else ABC) over feed_cmd, between samples of feed moves.
Worst worst_feed(const JointLog& log);
/// Largest distance (mm) between what the v column says and the positions, beyond what the
/// acceleration limit allows within a period.
Worst worst_derivative(const JointLog& log);

/// The programmed path, one piece per line of `text`:
///   BLOCK TOLERANCE line x y z  x y z
///   BLOCK TOLERANCE arc x y z  x y z  cx cy cz  nx ny nz  turns      (as canon::ArcFeed)
/// Returns the largest distance of a logged tip from the pieces of its own block and `around` to
/// either side (more where the tolerance is many pieces long), minus the tolerance. Every piece's
/// end must come near a sample of the neighbourhood too.
Worst worst_path_deviation(const JointLog& log, const std::string& text, std::size_t around = 2);

/// Largest error (mm) of the rods' lengths of an O-X glide with its default parameters.
Worst worst_rod_error(const JointLog& log);

}  // namespace aircut::test
