// Texts that came from outside, and places in them.
#pragma once

#include <cstddef>
#include <cstdint>
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
  /// Refers to memory that `owner` keeps alive (a mapped file).
  SourceText(std::string name, std::string_view content, std::shared_ptr<const void> owner);
  SourceText(const SourceText&) = delete;
  SourceText& operator=(const SourceText&) = delete;

  const std::string& name() const { return name_; }
  std::string_view content() const { return content_; }

 private:
  std::string name_;
  std::string own_;
  std::shared_ptr<const void> owner_;
  std::string_view content_;
};

struct CallFrame;

/// A range of bytes inside one line of a text, and the calls that led there. An empty span
/// (text == nullptr) means "no place".
struct SourceSpan {
  const SourceText* text = nullptr;  ///< owned by the run's SourceMap, outlives every span
  std::uint64_t begin = 0;           ///< byte offset of the first byte
  std::uint32_t length = 0;          ///< bytes
  std::uint32_t line = 0;            ///< line number from 1
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
  SourceSpan site;   ///< the calling block or the loop's head; its own `calls` go on outwards
  std::string what;  ///< e.g. "o<pocket> call [3]", "o100 while, pass 12"
};

/// Owns all texts of a run.
class SourceMap {
 public:
  const SourceText& add(std::string name, std::string content);
  /// Maps a regular file into memory. Errors (kind `input`): missing, unreadable, not a regular
  /// file.
  Expected<const SourceText*> open(const std::string& path);

 private:
  std::deque<SourceText> texts_;
};

/// How libraries get at files: tests hand in a function that needs no disk.
using SourceReader = std::function<Expected<const SourceText*>(const std::string& path)>;

}  // namespace aircut
