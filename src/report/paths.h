// Paths as reports name them. Private to report.
#pragma once

#include <string>

namespace aircut::report {

/// A relative reference of RFC 3986: absolute paths below `folder` relative to it, other absolute
/// ones as file:// addresses; what is not unreserved or a slash is percent-encoded.
std::string uri_of(const std::string& path, const std::string& folder);

}  // namespace aircut::report
