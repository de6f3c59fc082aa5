// Rows of numbers, the language of `aircut kin`: a line of standard input each.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments.h"

namespace aircut::cli {

/// One place of a row: its name, and the size of the user's unit (1 mm, or a degree in rad).
struct Column {
  std::string name;
  double unit;
};

using Row = std::vector<double>;
using RowOrReason = tl::expected<Row, std::string>;
using TextOrReason = tl::expected<std::string, std::string>;

/// 12 significant digits a number, the same in every locale.
std::string text_of(const Row& row);
/// With ` ; ` between them.
std::string text_of_all(const std::vector<Row>& rows);
std::string names_of(const std::vector<Column>& columns);
/// A decimal number, with an exponent if it likes: what a program printed can be read again.
std::optional<double> number_of(std::string_view text);
/// Values in the user's units, by column: plain numbers, or words like `X1 B30 S1=395.3` in any
/// order.
RowOrReason read_row(std::string_view line, const std::vector<Column>& columns);
/// Prints a line per line of `text`: the answer, or `error: …` with the reason. Returns the exit
/// code; `wanted` says what a row is, when there is none.
int answer_rows(std::string_view text, const std::string& wanted, When color,
                const std::function<TextOrReason(std::string_view line)>& answer);

}  // namespace aircut::cli
