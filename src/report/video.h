// Private: pictures as a film, by the ffmpeg that is installed.
#pragma once

#include <span>
#include <string>

#include "base/base.h"

namespace aircut::report {

/// Where ffmpeg is, from PATH. Error kind `output_failed` with what to do.
Expected<std::string> find_ffmpeg();

/// PNG files of one size as `path` (MP4): all of it or nothing.
Expected<void> write_video(const std::string& ffmpeg, const std::string& path,
                           std::span<const std::string> pictures, double seconds_each);

}  // namespace aircut::report
