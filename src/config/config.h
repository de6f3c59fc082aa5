// config: TOML files read strictly. Every key that nobody asked for is an error with the nearest
// known key, at its line and column. toml++ stays inside this library.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/base.h"

namespace aircut::config {

struct Document;  // the parsed file, private

/// One table of a file. Getters note the key as known; a wrong type or range is recorded in the
/// reader's diagnostics (with the span of the value) and gives the fallback.
/// A Table is a light handle: copy it freely; it must not outlive its Reader.
class Table {
 public:
  bool has(const std::string& key) const;
  /// Span of a key's value; of the table's head when the key is missing.
  SourceSpan span(const std::string& key) const;
  SourceSpan span() const;

  std::optional<double> number(const std::string& key);
  double number(const std::string& key, double fallback);
  double required_number(const std::string& key);
  std::optional<long> integer(const std::string& key);
  std::optional<bool> boolean(const std::string& key);
  bool boolean(const std::string& key, bool fallback);
  std::optional<std::string> text(const std::string& key);
  std::string text(const std::string& key, const std::string& fallback);
  std::string required_text(const std::string& key);
  /// A text that must be one of `words`; the error names the nearest one.
  std::string choice(const std::string& key, const std::vector<std::string>& words,
                     const std::string& fallback);
  /// An array of finite numbers of exactly `size` elements (any size when 0).
  std::optional<std::vector<double>> numbers(const std::string& key, std::size_t size);
  std::optional<std::vector<std::string>> texts(const std::string& key);
  /// An array of arrays of texts: [["a", "b"], …].
  std::vector<std::vector<std::string>> text_lists(const std::string& key);
  /// An array of arrays of numbers, each of `size` elements.
  std::optional<std::vector<std::vector<double>>> number_lists(const std::string& key,
                                                               std::size_t size);
  /// A sub-table `[key]` (or inline), if there.
  std::optional<Table> table(const std::string& key);
  /// An array of tables `[[key]]` (or of inline tables); empty if the key is missing.
  std::vector<Table> tables(const std::string& key);
  /// The keys in the order of the file. For tables whose keys are names (all become known).
  std::vector<std::string> keys();
  /// Is the value an array whose first element is a table? (For keys that take either form.)
  bool holds_tables(const std::string& key) const;
  /// Is the value a table?
  bool holds_table(const std::string& key) const;
  /// Span of the element `item` of an array; of the value when there is no such element.
  SourceSpan item_span(const std::string& key, std::size_t item) const;

  /// Records an error of the reader's kind at a key's value.
  void error(const std::string& key, const std::string& message);
  /// Records a diagnostic of any kind and place; it takes its turn in the order of the file.
  void report(Diagnostic diagnostic);
  /// Declares a key known without reading it, for the "did you mean" of other keys.
  void know(const std::string& key);

 private:
  friend class Reader;
  friend struct Document;
  struct Node;
  explicit Table(Node* node) : node_(node) {}
  Node* node_;
};

/// Parses one text and collects what is wrong with it.
class Reader {
 public:
  /// `kind` is the diagnostics' kind: `machine_invalid`, `setup_invalid`, `tools_invalid`.
  Reader(const SourceText& text, std::string kind);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// The top table. When the text is not TOML, an empty table and one error.
  Table top();
  /// Adds an error for every key that no getter asked for, then hands out all diagnostics in the
  /// order of the file.
  Diagnostics finish();

 private:
  std::unique_ptr<Document> document_;
};

}  // namespace aircut::config
