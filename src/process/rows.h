// Private: accuracy.csv, a row per piece of time and contact.
#pragma once

#include "base/output_file.h"
#include "process/elastic.h"

namespace aircut::process {

class Rows {
 public:
  Expected<void> write_to(const std::string& path);
  /// Nothing without write_to().
  void add(std::size_t segment, const Setup& setup, const Engaged& engaged, const Answer& found);
  /// Closes the file.
  Expected<void> result();

 private:
  std::optional<OutputFile> file_;
  std::string line_;
};

}  // namespace aircut::process
