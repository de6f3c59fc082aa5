// Numbers, expressions and choices by chance: the same seed gives the same on every machine.
#pragma once

#include <initializer_list>
#include <random>
#include <string>

namespace aircut::test {

class Chance {
 public:
  explicit Chance(std::uint32_t seed) : random_(seed) {}

  /// 0 … limit - 1.
  template <class T>
  int below(T limit) {
    return static_cast<int>(random_() % static_cast<std::uint32_t>(limit));
  }
  bool one_in(int n) { return below(n) == 0; }
  std::string pick(std::initializer_list<const char*> words) {
    return *(words.begin() + below(words.size()));
  }

  /// `-3`, `4.25`: from … to in steps of a hundredth, often whole.
  std::string decimal(int from, int to);
  /// A number in one of its spellings. Its value lies between `from` and `to`, mostly.
  std::string number(int from, int to);
  /// What may stand between brackets; `depth` bounds its nesting.
  std::string expression(int depth);
  /// A text with mixed case, blanks inside words and other harmless spellings.
  std::string spelled(const std::string& line);

 private:
  std::string value();

  std::mt19937 random_;
};

}  // namespace aircut::test
