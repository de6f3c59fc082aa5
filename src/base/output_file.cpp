#include "base/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/diagnostic.h"
#include "base/text.h"

namespace aircut {

namespace {

Diagnostic output_failed(const std::string& path, const std::string& why) {
  return make_error("output_failed", "can't write '" + printable(path) + "': " + why);
}

}  // namespace

Expected<OutputFile> OutputFile::create(const std::string& path) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode))
    return unexpected(output_failed(path, "it exists and is not a regular file"));
  OutputFile out;
  out.path_ = path;
  out.temporary_ = path + ".partial-XXXXXX";
  const int fd = ::mkstemp(out.temporary_.data());
  if (fd < 0) {
    out.temporary_.clear();
    return unexpected(output_failed(path, std::strerror(errno)));
  }
  ::fchmod(fd, 0644);
  out.file_ = ::fdopen(fd, "wb");
  if (!out.file_) {
    ::close(fd);
    return unexpected(output_failed(path, std::strerror(errno)));
  }
  return out;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      file_(std::exchange(other.file_, nullptr)),
      failed_(other.failed_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    discard();
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
    file_ = std::exchange(other.file_, nullptr);
    failed_ = other.failed_;
  }
  return *this;
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard() {
  if (file_) std::fclose(std::exchange(file_, nullptr));
  if (!temporary_.empty()) ::unlink(std::exchange(temporary_, {}).c_str());
}

void OutputFile::write(std::string_view bytes) {
  if (file_ && std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) failed_ = true;
}

Expected<void> OutputFile::commit() {
  std::FILE* file = std::exchange(file_, nullptr);
  if (!file) return unexpected(output_failed(path_, "it is already closed"));
  errno = 0;
  const bool flushed = std::fflush(file) == 0 && !failed_ && ::fsync(::fileno(file)) == 0;
  const bool closed = std::fclose(file) == 0;
  if (!flushed || !closed || ::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const std::string why = errno != 0 ? std::strerror(errno) : "the disk is full";
    discard();
    return unexpected(output_failed(path_, why));
  }
  temporary_.clear();
  return {};
}

Expected<void> write_file(const std::string& path, std::string_view bytes) {
  auto file = OutputFile::create(path);
  if (!file) return unexpected(file.error());
  file->write(bytes);
  return file->commit();
}

}  // namespace aircut
