// A strict reader: every getter notes the key it was asked for; what was never asked for at the end
// is an error. So a reader can't forget to declare its keys, and a mistyped key can't be ignored.
#include "config/config.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "config/places.h"

namespace aircut::config {

// What is known about one table that a getter handed out.
struct Table::Node {
  Document* document = nullptr;
  const toml::table* table = nullptr;
  SourceSpan head;
  std::set<std::string> known;  // keys that somebody asked for
};

struct Document {
  Document(const SourceText& source, std::string kind_of_errors)
      : text(&source), kind(std::move(kind_of_errors)), places(source) {
    parse();
  }

  void parse();
  void error(const SourceSpan& span, std::string message) {
    if (parsed) found.push_back(make_error(kind, span, std::move(message)));
  }
  Table::Node* node(const toml::table& table, const SourceSpan& head);

  const SourceText* text;
  std::string kind;
  Places places;
  toml::table root;
  bool parsed = false;  // when not, the one error is the parser's and nothing is missed
  std::deque<Table::Node> nodes;
  std::map<const toml::table*, Table::Node*> by_table;  // looked up only
  std::vector<Diagnostic> found;
};

namespace {

std::string_view what(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::none:
      return "nothing";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
      return "a date or time";
  }
  return "nothing";
}

std::string quoted(std::string_view text) {
  std::string out(1, '\'');
  out += printable(text);
  out += '\'';
  return out;
}

std::string list_of(const std::vector<std::string>& words, const std::string& last = "or") {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i)
    out += (i == 0 ? "" : i + 1 == words.size() ? " " + last + " " : ", ") + quoted(words[i]);
  return out;
}

// A finite number, or an error at its place.
std::optional<double> finite(Document& document, const std::string& key, const toml::node& node) {
  double value = 0;
  if (const auto* integer = node.as_integer()) {
    value = static_cast<double>(integer->get());
  } else if (const auto* real = node.as_floating_point()) {
    value = real->get();
  } else {
    document.error(document.places.span(node.source()),
                   quoted(key) + " needs a number, this is " + std::string(what(node)));
    return std::nullopt;
  }
  if (std::isfinite(value)) return value;
  document.error(document.places.span(node.source()),
                 quoted(key) + " needs a finite number; inf and nan are not allowed");
  return std::nullopt;
}

std::optional<std::vector<double>> finite_list(Document& document, const std::string& key,
                                               const toml::node& node, std::size_t size) {
  const toml::array* array = node.as_array();
  const std::string wanted =
      size == 0 ? "an array of numbers" : "an array of " + std::to_string(size) + " numbers";
  if (!array || (size != 0 && array->size() != size)) {
    const std::string is =
        array ? "one of " + std::to_string(array->size()) : std::string(what(node));
    document.error(document.places.span(node.source()),
                   quoted(key) + " needs " + wanted + ", this is " + is);
    return std::nullopt;
  }
  std::vector<double> values;
  bool good = true;
  for (const toml::node& item : *array) {
    const auto value = finite(document, key, item);
    good = good && value.has_value();
    values.push_back(value.value_or(0));
  }
  return good ? std::optional(std::move(values)) : std::nullopt;
}

std::optional<std::vector<std::string>> text_list(Document& document, const std::string& key,
                                                  const toml::node& node) {
  const toml::array* array = node.as_array();
  if (!array) {
    document.error(document.places.span(node.source()),
                   quoted(key) + " needs an array of texts, this is " + std::string(what(node)));
    return std::nullopt;
  }
  std::vector<std::string> texts;
  bool good = true;
  for (const toml::node& item : *array) {
    if (const auto* text = item.as_string()) {
      texts.push_back(text->get());
      continue;
    }
    document.error(document.places.span(item.source()),
                   quoted(key) + " needs texts, this is " + std::string(what(item)));
    good = false;
  }
  return good ? std::optional(std::move(texts)) : std::nullopt;
}

}  // namespace

void Document::parse() {
  constexpr std::size_t largest = 16'000'000;  // bytes; a machine file has a few thousand
  const auto refuse = [&](const SourceSpan& span, std::string message) {
    found.push_back(make_error(kind, span, std::move(message)));
  };
  if (text->content().size() > largest)
    return refuse({.text = text, .line = 1}, "the file is larger than 16 MB");
  if (const auto deep = too_deep_key(*text))
    return refuse(*deep, "a dotted key has more than 16 parts; the deepest key has 3");
  if (const auto stray = stray_character(*text))
    return refuse(*stray, "this is not TOML: '" + printable(stray->covered()) +
                              "' may stand only in strings (in quotes) and comments");
  try {
    root = toml::parse(text->content(), std::string_view());
    parsed = true;
  } catch (const toml::parse_error& error) {
    const auto& position = error.source().begin;
    const std::string message(error.description());
    const bool whole_line = message.find("cannot redefine") != std::string::npos;
    refuse(whole_line ? places.line_start(position.line) : places.at(position),
           "this is not TOML: " + message);
  }
}

Table::Node* Document::node(const toml::table& table, const SourceSpan& head) {
  auto& slot = by_table[&table];
  if (!slot) slot = &nodes.emplace_back(Table::Node{this, &table, head, {}});
  return slot;
}

bool Table::has(const std::string& key) const { return node_->table->contains(key); }

SourceSpan Table::span() const { return node_->head; }

SourceSpan Table::span(const std::string& key) const {
  const toml::node* value = node_->table->get(key);
  return value ? node_->document->places.span(value->source()) : node_->head;
}

SourceSpan Table::item_span(const std::string& key, std::size_t item) const {
  const toml::node* value = node_->table->get(key);
  const toml::array* array = value ? value->as_array() : nullptr;
  const toml::node* element = array ? array->get(item) : nullptr;
  return element ? node_->document->places.span(element->source()) : span(key);
}

bool Table::holds_tables(const std::string& key) const {
  const toml::node* value = node_->table->get(key);
  const toml::array* array = value ? value->as_array() : nullptr;
  return array && !array->empty() && array->get(0)->is_table();
}

bool Table::holds_table(const std::string& key) const {
  const toml::node* value = node_->table->get(key);
  return value && value->is_table();
}

void Table::know(const std::string& key) { node_->known.insert(key); }

void Table::error(const std::string& key, const std::string& message) {
  node_->document->error(span(key), message);
}

void Table::report(Diagnostic diagnostic) {
  if (node_->document->parsed) node_->document->found.push_back(std::move(diagnostic));
}

std::optional<double> Table::number(const std::string& key) {
  know(key);
  const toml::node* value = node_->table->get(key);
  return value ? finite(*node_->document, key, *value) : std::nullopt;
}

double Table::number(const std::string& key, double fallback) {
  return number(key).value_or(fallback);
}

double Table::required_number(const std::string& key) {
  if (!has(key)) error(key, quoted(key) + " is missing: it needs a number");
  return number(key, 0);
}

std::optional<long> Table::integer(const std::string& key) {
  know(key);
  const toml::node* value = node_->table->get(key);
  if (!value) return std::nullopt;
  if (const auto* integer = value->as_integer()) return static_cast<long>(integer->get());
  error(key, quoted(key) + " needs a whole number, this is " +
                 (value->is_floating_point() ? "one with decimals" : std::string(what(*value))));
  return std::nullopt;
}

std::optional<bool> Table::boolean(const std::string& key) {
  know(key);
  const toml::node* value = node_->table->get(key);
  if (!value) return std::nullopt;
  if (const auto* boolean = value->as_boolean()) return boolean->get();
  error(key, quoted(key) + " needs true or false, this is " + std::string(what(*value)));
  return std::nullopt;
}

bool Table::boolean(const std::string& key, bool fallback) {
  return boolean(key).value_or(fallback);
}

std::optional<std::string> Table::text(const std::string& key) {
  know(key);
  const toml::node* value = node_->table->get(key);
  if (!value) return std::nullopt;
  if (const auto* text = value->as_string()) return text->get();
  error(key, quoted(key) + " needs a text in quotes, this is " + std::string(what(*value)));
  return std::nullopt;
}

std::string Table::text(const std::string& key, const std::string& fallback) {
  return text(key).value_or(fallback);
}

std::string Table::required_text(const std::string& key) {
  if (!has(key)) error(key, quoted(key) + " is missing: it needs a text");
  return text(key, "");
}

std::string Table::choice(const std::string& key, const std::vector<std::string>& words,
                          const std::string& fallback) {
  const auto word = text(key);
  if (!word) return fallback;
  if (std::find(words.begin(), words.end(), *word) != words.end()) return *word;
  error(key, quoted(key) + " must be " + list_of(words) + ", not " + quoted(*word) + "." +
                 did_you_mean(*word, words));
  return fallback;
}

std::optional<std::vector<double>> Table::numbers(const std::string& key, std::size_t size) {
  know(key);
  const toml::node* value = node_->table->get(key);
  return value ? finite_list(*node_->document, key, *value, size) : std::nullopt;
}

std::optional<std::vector<std::string>> Table::texts(const std::string& key) {
  know(key);
  const toml::node* value = node_->table->get(key);
  return value ? text_list(*node_->document, key, *value) : std::nullopt;
}

std::vector<std::vector<std::string>> Table::text_lists(const std::string& key) {
  know(key);
  std::vector<std::vector<std::string>> lists;
  const toml::node* value = node_->table->get(key);
  if (!value) return lists;
  const toml::array* array = value->as_array();
  if (!array) {
    error(key,
          quoted(key) + " needs an array of arrays of texts, this is " + std::string(what(*value)));
    return lists;
  }
  for (const toml::node& item : *array)
    if (auto list = text_list(*node_->document, key, item)) lists.push_back(std::move(*list));
  return lists;
}

std::optional<std::vector<std::vector<double>>> Table::number_lists(const std::string& key,
                                                                    std::size_t size) {
  know(key);
  const toml::node* value = node_->table->get(key);
  if (!value) return std::nullopt;
  const toml::array* array = value->as_array();
  if (!array) {
    error(key, quoted(key) + " needs an array of arrays of numbers, this is " +
                   std::string(what(*value)));
    return std::nullopt;
  }
  std::vector<std::vector<double>> lists;
  bool good = true;
  for (const toml::node& item : *array) {
    auto list = finite_list(*node_->document, key, item, size);
    good = good && list.has_value();
    if (list) lists.push_back(std::move(*list));
  }
  return good ? std::optional(std::move(lists)) : std::nullopt;
}

std::optional<Table> Table::table(const std::string& key) {
  know(key);
  const toml::node* value = node_->table->get(key);
  if (!value) return std::nullopt;
  if (const toml::table* table = value->as_table())
    return Table(node_->document->node(*table, span(key)));
  const bool many = value->is_array_of_tables();
  error(key, quoted(key) + " needs one table [" + printable(key) + "], this is " +
                 (many ? "an array of tables" : std::string(what(*value))));
  return std::nullopt;
}

std::vector<Table> Table::tables(const std::string& key) {
  know(key);
  std::vector<Table> tables;
  const toml::node* value = node_->table->get(key);
  if (!value) return tables;
  const toml::array* array = value->as_array();
  if (!array) {
    error(key, quoted(key) + " needs tables written [[" + printable(key) + "]], this is " +
                   std::string(what(*value)));
    return tables;
  }
  for (const toml::node& item : *array) {
    const SourceSpan place = node_->document->places.span(item.source());
    if (const toml::table* table = item.as_table())
      tables.push_back(Table(node_->document->node(*table, place)));
    else
      node_->document->error(place,
                             quoted(key) + " needs tables, this is " + std::string(what(item)));
  }
  return tables;
}

std::vector<std::string> Table::keys() {
  std::vector<std::pair<SourceSpan, std::string>> found;
  for (const auto& [key, value] : *node_->table) {
    know(std::string(key.str()));
    found.emplace_back(node_->document->places.span(key.source()), key.str());
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first.begin < b.first.begin; });
  std::vector<std::string> keys;
  for (auto& [place, key] : found) keys.push_back(std::move(key));
  return keys;
}

Reader::Reader(const SourceText& text, std::string kind)
    : document_(std::make_unique<Document>(text, std::move(kind))) {}

Reader::~Reader() = default;

Table Reader::top() {
  return Table(document_->node(document_->root, SourceSpan{.text = document_->text, .line = 1}));
}

Diagnostics Reader::finish() {
  for (const Table::Node& node : document_->nodes) {
    const std::vector<std::string> known(node.known.begin(), node.known.end());
    for (const auto& [key, value] : *node.table) {
      if (node.known.contains(std::string(key.str()))) continue;
      std::string hint = did_you_mean(key.str(), known);
      if (hint.empty() && !known.empty()) hint = " Known here: " + list_of(known, "and") + ".";
      document_->error(document_->places.span(key.source()),
                       "unknown key " + quoted(key.str()) + "." + hint);
    }
  }
  // Within our text by place; what has another place (a mesh file) or none keeps its turn at the
  // end.
  const auto rank = [&](const Diagnostic& d) {
    return d.span.text == document_->text ? d.span.begin : ~std::uint64_t{0};
  };
  std::stable_sort(document_->found.begin(), document_->found.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return rank(a) < rank(b); });
  // A getter that is asked twice complains twice.
  const auto same = [](const Diagnostic& a, const Diagnostic& b) {
    return a.span.text == b.span.text && a.span.begin == b.span.begin && a.message == b.message;
  };
  const auto end = std::unique(document_->found.begin(), document_->found.end(), same);
  Diagnostics out;
  for (auto it = document_->found.begin(); it != end; ++it) out.add(std::move(*it));
  document_->found.clear();
  return out;
}

}  // namespace aircut::config
