// A log as a table for other programs. CSV: names and rows, without the header lines. JSON: one
// object with the header's keys and an array for each column. NPY (numpy's format 1.0): an array of
// records with the columns' names as fields, so `numpy.load(f)["q0"]` is a column.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "logbook/logbook.h"

namespace aircut::logbook {
namespace {

constexpr std::size_t flush_at = 1 << 16;

std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : utf8(text)) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      constexpr char digits[] = "0123456789abcdef";
      out += "\\u00";
      out += digits[static_cast<unsigned char>(c) >> 4];
      out += digits[static_cast<unsigned char>(c) & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

class Exporter {
 public:
  using Write = std::function<void(std::string_view)>;
  Exporter(const SourceText& log, const ExportOptions& options, const Write& write)
      : log_(log), options_(options), write_(write) {}
  Expected<void> run();

 private:
  Expected<void> choose(const Header& header);
  template <class F>
  Expected<void> each_row(F f);
  void put(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() > flush_at) flush();
  }
  void flush() {
    write_(buffer_);
    buffer_.clear();
  }
  Expected<void> csv();
  Expected<void> json(const Header& header);
  Expected<void> npy(const Header& header);

  const SourceText& log_;
  const ExportOptions& options_;
  const Write& write_;
  std::vector<std::size_t> columns_;
  std::vector<std::string> names_;
  std::string buffer_;
};

Expected<void> Exporter::choose(const Header& header) {
  for (const std::string& name : options_.columns.empty() ? header.columns : options_.columns) {
    const auto found = std::find(header.columns.begin(), header.columns.end(), name);
    if (found == header.columns.end())
      return unexpected(make_error("usage", "the log has no column '" + printable(name) + "'." +
                                                did_you_mean(name, header.columns)));
    columns_.push_back(static_cast<std::size_t>(found - header.columns.begin()));
    names_.push_back(name);
  }
  return {};
}

// Calls f(row) for the rows asked for.
template <class F>
Expected<void> Exporter::each_row(F f) {
  auto reader = Reader::open(log_);
  if (!reader) return unexpected(reader.error());
  Row row;
  for (std::uint64_t number = 0;; ++number) {
    const auto more = reader->next(row);
    if (!more) return unexpected(more.error());
    if (!*more) return {};
    if (number % options_.every == 0 && row.t() >= options_.from && row.t() <= options_.to) f(row);
  }
}

Expected<void> Exporter::csv() {
  for (std::size_t i = 0; i < names_.size(); ++i) put((i > 0 ? "," : "") + names_[i]);
  put("\n");
  return each_row([&](const Row& row) {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      put((i > 0 ? "," : "") + shortest(row.values[columns_[i]]));
    put("\n");
  });
}

// The file is read once per column, so that memory does not grow with it.
Expected<void> Exporter::json(const Header& header) {
  put("{\"schema\":1,\"header\":{");
  bool first = true;
  for (const auto& [key, value] : header.keys) {
    put((first ? "" : ",") + json_text(key) + ":" + json_text(value));
    first = false;
  }
  put("},\"columns\":{");
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    put((i > 0 ? "," : "") + json_text(names_[i]) + ":[");
    first = true;
    auto done = each_row([&](const Row& row) {
      put((first ? "" : ",") + shortest(row.values[columns_[i]]));
      first = false;
    });
    if (!done) return done;
    put("]");
  }
  put("}}\n");
  return {};
}

Expected<void> Exporter::npy(const Header&) {
  std::uint64_t rows = 0;
  if (auto done = each_row([&](const Row&) { ++rows; }); !done) return done;
  std::string head = "{'descr': [";
  for (const std::string& name : names_) head += "('" + name + "', '<f8'), ";
  head += "], 'fortran_order': False, 'shape': (" + std::to_string(rows) + ",), }";
  constexpr std::size_t before = 10, block = 64;  // magic, version, length; then filled up
  head.append(block - (before + head.size() + 1) % block, ' ');
  head += '\n';
  put(std::string_view("\x93NUMPY\x01\x00", 8));
  put(std::string{static_cast<char>(head.size() & 255), static_cast<char>(head.size() >> 8)});
  put(head);
  return each_row([&](const Row& row) {
    for (const std::size_t column : columns_) {
      static_assert(std::endian::native == std::endian::little);
      std::array<char, sizeof(double)> bytes;
      std::memcpy(bytes.data(), &row.values[column], bytes.size());
      put(std::string_view(bytes.data(), bytes.size()));
    }
  });
}

Expected<void> Exporter::run() {
  const auto reader = Reader::open(log_);
  if (!reader) return unexpected(reader.error());
  if (auto done = choose(reader->header()); !done) return done;
  Expected<void> done;
  switch (options_.table) {
    case Table::csv:
      done = csv();
      break;
    case Table::json:
      done = json(reader->header());
      break;
    case Table::npy:
      done = npy(reader->header());
      break;
  }
  flush();
  return done;
}

}  // namespace

Expected<void> export_table(const SourceText& log, const ExportOptions& options,
                            const std::function<void(std::string_view)>& write) {
  return Exporter(log, options, write).run();
}

}  // namespace aircut::logbook
