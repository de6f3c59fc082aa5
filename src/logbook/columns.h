// Private: the columns of a log's rows.
#pragma once

#include "logbook/logbook.h"

namespace aircut::logbook {

struct Column {
  std::string name, unit, frame;
  bool whole = false;  ///< whole numbers
};

/// Only the joints' number and units count.
std::vector<Column> columns_of(const std::vector<Joint>& joints);
std::vector<std::string> split_list(std::string_view text);
/// The joints of the header's key; a unit that is not mm or deg stays empty.
std::vector<Joint> joints_of(std::string_view list);

}  // namespace aircut::logbook
