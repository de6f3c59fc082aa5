// Texts that came from outside, and places in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/expected.h"

namespace aircut {

/// One input text: a program, a tool table, a machine.toml. Immutable; its address is stable.
class SourceText {
 public:
  /// Takes a copy of `content`; `name` is what messages call it (the path as the user wrote it).
  SourceText(std::string name, std::string content);
  /// Refers to a mapped file that `owner` keeps mapped.
  SourceText(std::string name, std::string_view content, std::shared_ptr<const void> owner);
  SourceText(const SourceText&) = delete;
  SourceText& operator=(const SourceText&) = delete;

  const std::string& name() const { return name_; }
  std::string_view content() const { return content_; }

  /// Gives back the memory of a mapped file. The content stays: what is looked at again is read in
  /// again.
  void let_go() const;

 private:
  std::string name_;
  std::string own_;
  std::shared_ptr<const void> owner_;
  std::string_view content_;
};

/// Somebody who goes through a text and lets go of it now and then, so that a program of any length
/// is read in a few MiB.
class Reading {
 public:
  explicit Reading(const SourceText& text) : text_(text) {}
  /// Tells that the bytes from `begin` to `end` are being looked at, or have been.
  void at(std::uint64_t begin, std::uint64_t end) {
    // A jump brings in the neighbourhood of the place as well.
    unreleased_ += (begin == last_ ? 0 : neighbourhood) + (end - begin);
    last_ = end;
    if (unreleased_ < most_held) return;
    text_.let_go();
    unreleased_ = 0;
  }

 private:
  static constexpr std::uint64_t most_held = 16 << 20;
  static constexpr std::uint64_t neighbourhood = 2 << 20;  // as far as Linux maps around a place

  const SourceText& text_;
  std::uint64_t last_ = 0;
  std::uint64_t unreleased_ = 0;
};

struct CallFrame;

/// A range of bytes inside one line of a text, and the calls that led there. An empty span
/// (text == nullptr) means "no place".
struct SourceSpan {
  const SourceText* text = nullptr;  ///< owned by the run's SourceMap, outlives every span
  std::uint64_t begin = 0;           ///< byte offset of the first byte
  std::uint32_t length = 0;          ///< bytes
  std::uint64_t line = 0;            ///< line number from 1
  std::shared_ptr<const CallFrame> calls = {};  ///< null in the main program outside of loops

  explicit operator bool() const { return text != nullptr; }
  /// The whole line without its line end.
  std::string_view line_text() const;
  /// Column of the first byte, counted in characters (UTF-8) from 1.
  std::size_t column() const;
  /// The bytes that the span covers.
  std::string_view covered() const;
  /// `sub.ngc:12:5`, or `` without a place.
  std::string place() const;
};

/// One step of the way to a place: a call, or a pass of a loop.
struct CallFrame {
  SourceSpan site;         ///< the calling block or the loop's head; its own `calls` go on outwards
  std::string what;        ///< e.g. "o<pocket> call [3]", "o100 while"
  std::uint64_t pass = 0;  ///< of a loop, from 1; 0: a call

  /// `what` with the pass: "o100 while, pass 12".
  std::string text() const { return pass == 0 ? what : what + ", pass " + std::to_string(pass); }
};

/// Owns all texts of a run.
class SourceMap {
 public:
  const SourceText& add(std::string name, std::string content);
  /// Maps a regular file into memory. Errors (kind `input`): missing, unreadable, not a regular
  /// file.
  Expected<const SourceText*> open(const std::string& path);
  /// Reads a stream to its end, e.g. standard input; a regular file is mapped, what is long goes
  /// through a temporary file. Error kind `input`, also above 1 GiB from a pipe.
  Expected<const SourceText*> read(std::FILE* stream, const std::string& name);

 private:
  Expected<const SourceText*> map(int fd, std::string name);

  std::deque<SourceText> texts_;
};

/// How libraries get at files: tests hand in a function that needs no disk.
using SourceReader = std::function<Expected<const SourceText*>(const std::string& path)>;

}  // namespace aircut
