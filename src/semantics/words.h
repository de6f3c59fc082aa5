// Words of a line that was read before. Private to semantics.
#pragma once

#include <optional>

#include "base/base.h"

namespace aircut::semantics {

/// The place of the first word with that letter (and number, if one is given) among what `block`
/// covers. Comments, names and expressions are passed over.
std::optional<SourceSpan> find_word(const SourceSpan& block, char letter,
                                    std::optional<double> number = std::nullopt);
/// The same, or the block itself when there is no such word.
SourceSpan word_in(const SourceSpan& block, char letter,
                   std::optional<double> number = std::nullopt);
/// `place` without the blanks that it begins with.
SourceSpan trimmed(const SourceSpan& place);
/// The whole line in which `place` lies.
SourceSpan line_of(const SourceSpan& place);

}  // namespace aircut::semantics
