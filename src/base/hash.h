#pragma once

#include <string>
#include <string_view>

#include "base/source.h"

namespace aircut {

/// SHA-256 of the bytes as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);
/// The same of a text, whose memory is let go of on the way.
std::string sha256(const SourceText& text);

/// Base64 with padding (RFC 4648).
std::string base64(std::string_view bytes);

}  // namespace aircut
