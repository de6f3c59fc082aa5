// The grammar behind generate_program(). A program is a row of families, each some lines that
// belong together. The maker keeps what it needs to make most lines right (a feed is set, the
// spindle turns); the rest is for the two interpreters to agree on. What docs/peer.md lists as an
// accepted deviation is left out.
#pragma once

#include <string>

#include "peer/chance.h"

namespace aircut::test {

class ProgramMaker : private Chance {
 public:
  explicit ProgramMaker(std::uint32_t seed) : Chance(seed) {}
  std::string program();

 private:
  // ---- text (generator.cpp)
  void add(const std::string& line);
  std::string label() { return "o" + std::to_string(100 + ++labels_); }
  std::string axis_words(int range);
  std::string offset_words();
  std::string rotation();
  std::string feed() { return inverse_time_ ? " F" + std::to_string(1 + below(9)) : ""; }
  void plane_xy();
  void known_modes();

  // ---- moves (make_moves.cpp)
  void line_move();
  void arc();
  void polar();
  void spline();
  void modal();
  void feed_mode();
  void home();
  void probe();
  void lathe();
  void thread();
  std::string ends(const std::string& a, const std::string& b);
  std::string centre(const std::string& a, const std::string& b);
  std::string third_axis();

  // ---- offsets and tools (make_offsets.cpp)
  void offset();
  void tool_offset();
  void tool_table();
  void change_tool(int number);
  std::string table_tool();

  // ---- canned cycles (make_cycles.cpp)
  void cycle();
  std::string peck();

  // ---- radius compensation (make_contours.cpp)
  void contour();
  void contour_piece(int& x, int& y, int& way);
  void lathe_contour();

  // ---- O-words and parameters (make_flow.cpp)
  void flow();
  void branch();
  void loop();
  void sub();
  void fanuc_sub();
  void file_sub();
  void parameter();
  void stack();

  // ---- M codes and messages (make_codes.cpp)
  void machine_code();
  void message();

  // ---- lines that may be refused (make_wild.cpp)
  void hostile();
  void wild();
  std::string wild_words(const std::string& letters);

  std::string text_, subs_;
  int line_ = 0;
  int labels_ = 0;
  bool rotates_ = false;       // has work systems with a rotation
  bool changes_unit_ = false;  // may switch to inches
  bool has_tool_ = false;      // one was put into the spindle
  bool knows_tool_ = true;     // no M61 so far
  int plane_ = 0;              // 0 XY, 1 ZX, 2 YZ
  bool inverse_time_ = false;
  bool percent_ = false;
};

}  // namespace aircut::test
