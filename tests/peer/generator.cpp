#include "peer/generator.h"

#include <array>

#include "peer/program_maker.h"

namespace aircut::test {

std::string ProgramMaker::program() {
  using M = ProgramMaker;
  using Family = void (M::*)();
  // The more important a family, the more often it stands here.
  static constexpr std::array families = {Family(&M::line_move),
                                          &M::line_move,
                                          &M::line_move,
                                          &M::arc,
                                          &M::arc,
                                          &M::arc,
                                          &M::modal,
                                          &M::modal,
                                          &M::feed_mode,
                                          &M::offset,
                                          &M::offset,
                                          &M::offset,
                                          &M::home,
                                          &M::home,
                                          &M::tool_offset,
                                          &M::tool_table,
                                          &M::cycle,
                                          &M::cycle,
                                          &M::cycle,
                                          &M::cycle,
                                          &M::parameter,
                                          &M::parameter,
                                          &M::flow,
                                          &M::flow,
                                          &M::flow,
                                          &M::polar,
                                          &M::contour,
                                          &M::contour,
                                          &M::contour,
                                          &M::lathe_contour,
                                          &M::machine_code,
                                          &M::machine_code,
                                          &M::message,
                                          &M::lathe,
                                          &M::thread,
                                          &M::spline,
                                          &M::probe,
                                          &M::stack,
                                          &M::hostile};
  rotates_ = one_in(2);
  changes_unit_ = one_in(2);
  percent_ = one_in(12);
  if (percent_) text_ += "%\n";
  add("F" + std::to_string(50 + below(200)) + " S300 M3");
  if (one_in(4)) add("G10 L2 P1 " + offset_words() + rotation());
  if (one_in(4)) change_tool(1 + below(2));
  const int count = 4 + below(12);
  for (int i = 0; i < count; ++i)
    (this->*families[static_cast<std::size_t>(below(families.size()))])();
  add("(DEBUG,end #5420 #5421 #5422 #5423 #5424 #5425)");
  if (one_in(4)) wild();
  if (percent_ && one_in(2)) {
    text_ += subs_ + "%\nwhat stands here is not read\n";
  } else {
    text_ += pick({"M2\n", "M2\n", "M30\n", "G0 M2\n", "M99\n"}) + subs_;
    if (percent_) text_ += "%\n";
  }
  return text_;
}

void ProgramMaker::add(const std::string& line) {
  ++line_;
  const bool oword = line[0] == 'o' || line[0] == 'O';
  text_ += (oword ? "" : "N" + std::to_string(line_) + " ") + spelled(line) + "\n";
}

std::string ProgramMaker::axis_words(int range) {
  std::string words;
  for (const char axis : {'X', 'Y', 'Z'})
    if (one_in(2)) words += std::string(" ") + axis + number(-range, range);
  if (one_in(6)) words += pick({" A", " B", " C"}) + decimal(-90, 90);
  if (one_in(20)) words = " A" + decimal(-400, 400) + " C" + decimal(0, 360);
  if (words.empty()) words = " X" + number(-range, range);
  return words;
}

std::string ProgramMaker::offset_words() {
  std::string words;
  for (const char axis : {'X', 'Y', 'Z'})
    if (one_in(2)) words += std::string(" ") + axis + decimal(-20, 20);
  if (one_in(6)) words += pick({" A", " B", " C"}) + decimal(-20, 20);
  return words.empty() ? " X1" : words;
}

std::string ProgramMaker::rotation() {
  return rotates_ && one_in(2) ? " R" + pick({"30", "90", "-45", "0", "12.5"}) : "";
}

void ProgramMaker::plane_xy() {
  if (plane_ == 0) return;
  plane_ = 0;
  add("G17");
}

void ProgramMaker::known_modes() {
  plane_ = 0;
  inverse_time_ = false;
  add("G17 G40 G80 G90 G91.1 G94 F" + std::to_string(50 + below(200)));
}

std::string generate_program(std::uint32_t seed) { return ProgramMaker(seed).program(); }

}  // namespace aircut::test
