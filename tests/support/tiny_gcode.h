// A tiny reader of G-code for test programs that were measured on a real controller: absolute mm
// coordinates, G0-G4, G17, G18, G61, G61.1, G64 P Q, G93, G94, F, comments. Anything else that
// could move stops the test.
#pragma once

#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "support/plan_machines.h"

namespace aircut::test {

class TinyGcode {
 public:
  /// Problems are in `problem`; block numbers are line numbers.
  Program read(const std::string& text) {
    std::istringstream in(text);
    std::string line;
    while (std::getline(in, line)) {
      ++line_;
      block(line);
    }
    return program_;
  }
  std::string problem;

 private:
  void block(const std::string& line) {
    std::map<char, double> words;
    std::vector<int> codes;  // tenths
    for (std::size_t i = 0; i < line.size();) {
      if (line[i] == '(') {
        i = line.find(')', i) + 1;
        continue;
      }
      if (line[i] == ' ') {
        ++i;
        continue;
      }
      char* end = nullptr;
      const double value = std::strtod(line.c_str() + i + 1, &end);
      if (line[i] == 'G')
        codes.push_back(static_cast<int>(std::lround(10 * value)));
      else
        words[line[i]] = value;
      i = static_cast<std::size_t>(end - line.c_str());
    }
    bool dwell = false;
    for (const int code : codes) {
      if (code <= 30 && code >= 0) motion_ = code / 10;
      if (code == 40) dwell = true;
      if (code == 170) normal_ = 2;
      if (code == 180) normal_ = 1;
      if (code == 610) add(canon::SetPathMode{canon::PathMode::exact_path, 0});
      if (code == 611) add(canon::SetPathMode{canon::PathMode::exact_stop, 0});
      if (code == 640) {
        const double p = words.contains('P') ? words['P'] : 0;
        add(canon::SetPathMode{canon::PathMode::continuous, p});
        add(canon::SetNaiveCam{words.contains('Q') ? words['Q'] : p});
        words.erase('P');
      }
      if (code == 930) add(canon::SetFeedMode{canon::FeedMode::inverse_time});
      if (code == 940) add(canon::SetFeedMode{canon::FeedMode::per_minute});
      if (code == 930 || code == 940) inverse_ = code == 930;
      if (code == 910 || code == 330 || code == 331 || code == 950) problem = line;
    }
    if (words.contains('F'))
      add(canon::SetFeedRate{words['F'] / 60, inverse_ ? 0 : words['F'] / 60 * rad});
    if (dwell) {
      add(canon::Dwell{words['P']});
      return;
    }
    AxisValues end = tip_;
    bool moves = false;
    for (const Axis axis : all_axes)
      if (words.contains(letter(axis))) {
        end[axis] = words[letter(axis)] * (is_rotary(axis) ? rad : 1);
        moves = true;
      }
    if (!moves) return;
    if (motion_ == 0) add(canon::Rapid{end});
    if (motion_ == 1) add(canon::LinearFeed{end});
    if (motion_ >= 2) arc(end, words);
    tip_ = end;
  }

  void arc(const AxisValues& end, std::map<char, double>& words) {
    canon::ArcFeed out;
    out.end = end;
    out.normal = Vec3::Unit(normal_);
    const int sign = motion_ == 3 ? 1 : -1;
    const Vec3 from(tip_[Axis::x], tip_[Axis::y], tip_[Axis::z]);
    const Vec3 to(end[Axis::x], end[Axis::y], end[Axis::z]);
    if (words.contains('R')) {
      const double r = words['R'];
      const Vec3 half = (to - from) / 2;
      const double h = std::sqrt(std::max(r * r - half.squaredNorm(), 0.0));
      // The centre of a counter-clockwise short arc is on the left of the chord.
      out.centre = from + half + sign * (r > 0 ? h : -h) * out.normal.cross(half).normalized();
    } else {
      out.centre = from + Vec3(words['I'], words['J'], words['K']);
    }
    out.turns = sign * (words.contains('P') ? static_cast<int>(words['P']) : 1);
    add(out);
  }

  void add(canon::Action action) { program_.add_at(line_, std::move(action)); }

  Program program_;
  AxisValues tip_;
  std::uint32_t line_ = 0;
  int motion_ = 1;
  Eigen::Index normal_ = 2;
  bool inverse_ = false;
};

}  // namespace aircut::test
