#include "linuxcnc/hal.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace aircut::linuxcnc {
namespace {

constexpr std::size_t most_pins = 100'000;  // far above any machine

constexpr std::array<std::string_view, 28> other_commands = {
    "addf",      "alias", "delf",    "delsig",  "echo",   "getp",     "gets",
    "help",      "initf", "linkpp",  "list",    "loadrt", "loadusr",  "lock",
    "newthread", "print", "ptype",   "save",    "show",   "start",    "status",
    "stop",      "stype", "unalias", "unlinkp", "unload", "unloadrt", "waitusr"};

bool is_arrow(const std::string& word) { return word == "=>" || word == "<=" || word == "<=>"; }

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

void Hal::not_understood(const SourceSpan& span, const std::string& why) {
  out_.warning("hal_line", span, "this line is not understood: " + why);
}

void Hal::read(const SourceText& text) {
  const std::string_view all = text.content();
  std::string line;
  SourceSpan span;
  std::uint64_t number = 0;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find('\n', at), all.size());
    std::string_view raw = all.substr(at, end - at);
    ++number;
    while (!raw.empty() && raw.back() == '\r') raw.remove_suffix(1);
    if (line.empty()) {
      constexpr std::size_t longest = 4096;
      span = {&text, at, static_cast<std::uint32_t>(std::min(raw.size(), longest)), number};
    }
    at = end + 1;
    const bool goes_on = !raw.empty() && raw.back() == '\\';
    if (goes_on) raw.remove_suffix(1);
    line += raw;
    constexpr std::size_t longest_command = 1 << 16;
    if (goes_on && line.size() < longest_command) {
      line += ' ';
      continue;
    }
    command(line, span);
    line.clear();
  }
  if (!line.empty()) command(line, span);
}

// Words, `"…"` and `'…'` as one, without a comment, with `[SECTION]KEY` put in.
std::optional<std::vector<std::string>> Hal::words_of(const std::string& line,
                                                      const SourceSpan& span) {
  std::vector<std::string> words;
  std::string missing;
  for (std::size_t at = 0; at < line.size();) {
    if (is_blank(line[at])) {
      ++at;
      continue;
    }
    if (line[at] == '#') break;
    std::string word;
    while (at < line.size() && !is_blank(line[at])) {
      const char c = line[at];
      if (c == '"' || c == '\'') {
        const std::size_t close = std::min(line.find(c, at + 1), line.size());
        word += line.substr(at + 1, close - at - 1);
        at = close + 1;
      } else if (c == '[') {
        const std::size_t close = line.find(']', at);
        if (close == line.npos) {
          word += line.substr(at);
          at = line.size();
          continue;
        }
        const std::string section = line.substr(at + 1, close - at - 1);
        at = close + 1;
        const bool brackets = at < line.size() && line[at] == '(';
        std::size_t end = at;
        if (brackets) {
          end = std::min(line.find(')', at), line.size());
        } else {
          const auto in_name = [](char n) {
            return n == '_' || n == '-' || (n >= '0' && n <= '9') || (n >= 'A' && n <= 'Z') ||
                   (n >= 'a' && n <= 'z');
          };
          while (end < line.size() && in_name(line[end])) ++end;
        }
        const std::size_t from = at + (brackets ? 1 : 0);
        const std::string key = line.substr(from, end - from);
        at = brackets ? std::min(end + 1, line.size()) : end;
        if (const ini::Entry* entry = ini_.find(section, key))
          word += entry->value;
        else
          missing = "the set-up has no [" + printable(section) + "]" + printable(key);
      } else {
        word += c;
        ++at;
      }
    }
    words.push_back(std::move(word));
  }
  if (missing.empty()) return words;
  not_understood(span, missing);
  return std::nullopt;
}

void Hal::connect(Signal& signal, const std::string& pin, const SourceSpan& span) {
  if (named_.size() >= most_pins) {
    if (!too_many_) not_understood(span, "the files name more than 100000 pins");
    too_many_ = true;
    return;
  }
  signal.pins.push_back(pin);
  named_.emplace(pin, span);
}

void Hal::net(const std::vector<std::string>& words, const SourceSpan& span) {
  Signal& signal = signals_[words[1]];
  if (!signal.span) signal.span = span;
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (is_arrow(words[i])) continue;
    connect(signal, words[i], span);
    wired_[words[i]] = words[1];
    const bool before = i > 2 && words[i - 1] == "<=";
    const bool behind = i == 2 && i + 1 < words.size() && words[i + 1] == "=>";
    if (before || behind) signal.driver = words[i];
  }
}

// loadrt sum2 names=a,b   or   loadrt sum2 count=2
void Hal::load(const std::vector<std::string>& words) {
  if (words.size() < 2 || words[1] != "sum2") return;
  if (words.size() == 2) sums_.insert("sum2.0");
  for (std::size_t i = 2; i < words.size(); ++i) {
    std::string_view word = words[i];
    if (word.starts_with("count=")) {
      const auto count = parse_number(word.substr(6));
      constexpr double most = 1000;
      for (int k = 0; count && k < std::min(*count, most); ++k)
        sums_.insert("sum2." + std::to_string(k));
    }
    if (!word.starts_with("names=")) continue;
    word.remove_prefix(6);
    while (!word.empty()) {
      const std::size_t comma = std::min(word.find(','), word.size());
      sums_.emplace(word.substr(0, comma));
      word.remove_prefix(std::min(comma + 1, word.size()));
    }
  }
}

void Hal::command(const std::string& line, const SourceSpan& span) {
  const auto found = words_of(line, span);
  if (!found || found->empty()) return;
  const std::vector<std::string>& words = *found;
  const std::string& verb = words.front();
  const auto needs = [&](std::size_t count, const char* form) {
    if (words.size() >= count) return true;
    not_understood(span, std::string("it has the form ") + form);
    return false;
  };
  if (verb == "setp") {
    if (!needs(3, "setp PIN VALUE")) return;
    set_[words[1]] = {words[2], span};
    named_.emplace(words[1], span);
  } else if (verb == "sets") {
    if (needs(3, "sets SIGNAL VALUE")) signals_[words[1]].set = Value{words[2], span};
  } else if (verb == "net") {
    if (needs(3, "net SIGNAL PIN …")) net(words, span);
  } else if (verb == "linksp" || verb == "linkps") {
    if (!needs(3, "linksp SIGNAL PIN")) return;
    std::vector<std::string> both;
    for (const std::string& word : words)
      if (!is_arrow(word)) both.push_back(word);
    if (both.size() < 3) return not_understood(span, "it needs a signal and a pin");
    const bool pin_first = verb == "linkps";
    const std::string& pin = both[pin_first ? 1 : 2];
    Signal& signal = signals_[both[pin_first ? 2 : 1]];
    if (!signal.span) signal.span = span;
    connect(signal, pin, span);
    wired_[pin] = both[pin_first ? 2 : 1];
  } else if (verb == "newsig") {
    if (needs(2, "newsig SIGNAL TYPE")) signals_[words[1]].span = span;
  } else if (verb == "loadrt") {
    load(words);
  } else if (verb == "source") {
    not_understood(span, "files that HAL files name are not read; name them with HALFILE");
  } else if (words.size() >= 3 && words[1] == "=") {
    set_[verb] = {words[2], span};
    named_.emplace(verb, span);
  } else if (std::find(other_commands.begin(), other_commands.end(), verb) ==
             other_commands.end()) {
    not_understood(span, "'" + printable(verb) + "' is no command of HAL files");
  }
}

std::optional<double> Hal::number(const Value& value) {
  const auto number = ini::number_of(value.text);
  if (!number)
    out_.error("hal_value", value.span,
               "'" + printable(value.text) + "' is no number that a pin could get");
  return number;
}

const Hal::Signal* Hal::signal_of(const std::string& pin) const {
  const auto wire = wired_.find(pin);
  if (wire == wired_.end()) return nullptr;
  const auto signal = signals_.find(wire->second);
  return signal == signals_.end() ? nullptr : &signal->second;
}

const std::string* Hal::driver_of(const Signal& signal) const {
  if (signal.driver) return &*signal.driver;
  const auto is_output = [&](const std::string& pin) {
    return pin.starts_with("motion.tooloffset.") || pin.starts_with("motion.analog-out-") ||
           (pin.ends_with(".out") && sums_.contains(pin.substr(0, pin.size() - 4)));
  };
  const auto found = std::find_if(signal.pins.begin(), signal.pins.end(), is_output);
  return found == signal.pins.end() ? nullptr : &*found;
}

std::optional<std::string> Hal::driver(const std::string& pin) const {
  const Signal* signal = signal_of(pin);
  const std::string* from = signal ? driver_of(*signal) : nullptr;
  if (!from || *from == pin) return std::nullopt;
  return *from;
}

std::optional<HalInput> Hal::input(const std::string& pin, int depth) {
  HalInput in;
  const Signal* signal = signal_of(pin);
  if (!signal) {
    const auto set = set_.find(pin);
    if (set == set_.end()) return std::nullopt;
    in.span = set->second.span;
    in.value = number(set->second).value_or(0);
    return in;
  }
  in.span = signal->span;
  const std::string* from = driver_of(*signal);
  if (!from || *from == pin) {
    if (signal->set) {
      in.value = number(*signal->set).value_or(0);
    } else if (signal->pins.size() > 1) {
      in.unknown.push_back("signal " + wired_.at(pin));
    }
    return in;
  }
  if (*from == "motion.tooloffset.z") {
    in.tool_length = true;
    return in;
  }
  const std::string component =
      from->ends_with(".out") ? from->substr(0, from->size() - 4) : std::string();
  constexpr int deepest = 8;  // sums of sums
  if (!sums_.contains(component) || depth >= deepest) {
    in.unknown.push_back(*from);
    return in;
  }
  if (const auto offset = input(component + ".offset", depth + 1)) in.value += offset->value;
  for (const char* number : {"0", "1"}) {
    const auto part = input(component + ".in" + number, depth + 1);
    if (!part) continue;
    const auto gain = input(component + ".gain" + number, depth + 1);
    const double factor = gain ? gain->value : 1;
    in.value += factor * part->value;
    in.unknown.insert(in.unknown.end(), part->unknown.begin(), part->unknown.end());
    if (part->tool_length && factor != 1)
      in.unknown.push_back(component + ".gain" + number);
    else
      in.tool_length = in.tool_length || part->tool_length;
  }
  return in;
}

std::map<std::string, SourceSpan> Hal::pins(const std::string& prefix) const {
  std::map<std::string, SourceSpan> found;
  for (const auto& [pin, span] : named_)
    if (pin.starts_with(prefix)) found.emplace(pin, span);
  return found;
}

}  // namespace aircut::linuxcnc
