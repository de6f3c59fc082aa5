#include "base/source.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/diagnostic.h"
#include "base/text.h"

namespace aircut {

SourceText::SourceText(std::string name, std::string content)
    : name_(std::move(name)), own_(std::move(content)), content_(own_) {}

SourceText::SourceText(std::string name, std::string_view content,
                       std::shared_ptr<const void> owner)
    : name_(std::move(name)), owner_(std::move(owner)), content_(content) {}

std::string_view SourceSpan::line_text() const {
  if (!text) return {};
  const std::string_view all = text->content();
  const std::size_t at = std::min<std::size_t>(begin, all.size());
  const auto is_end = [](char c) { return c == '\n' || c == '\r'; };
  std::size_t first = at;
  while (first > 0 && !is_end(all[first - 1])) --first;
  std::size_t last = at;
  while (last < all.size() && !is_end(all[last])) ++last;
  return all.substr(first, last - first);
}

std::size_t SourceSpan::column() const {
  if (!text) return 0;
  const std::string_view whole = line_text();
  const std::size_t start = static_cast<std::size_t>(whole.data() - text->content().data());
  return count_characters(whole.substr(0, std::min<std::size_t>(begin - start, whole.size()))) + 1;
}

std::string_view SourceSpan::covered() const {
  if (!text || begin >= text->content().size()) return {};
  return text->content().substr(begin, length);
}

std::string SourceSpan::place() const {
  if (!text) return {};
  return printable(text->name()) + ":" + std::to_string(line) + ":" + std::to_string(column());
}

const SourceText& SourceMap::add(std::string name, std::string content) {
  return texts_.emplace_back(std::move(name), std::move(content));
}

Expected<const SourceText*> SourceMap::open(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    return unexpected(make_error("input", "can't read '" + printable(path) + "': " + why));
  };
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return fail(std::strerror(errno));
  struct stat info {};
  if (::fstat(fd, &info) != 0) {
    const std::string why = std::strerror(errno);
    ::close(fd);
    return fail(why);
  }
  if (!S_ISREG(info.st_mode)) {
    ::close(fd);
    return fail(S_ISDIR(info.st_mode) ? "it is a folder, not a file" : "it is not a regular file");
  }
  const std::size_t size = static_cast<std::size_t>(info.st_size);
  if (size == 0) {
    ::close(fd);
    return &texts_.emplace_back(path, std::string());
  }
  void* memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  const int error = errno;
  ::close(fd);
  if (memory == MAP_FAILED) return fail(std::strerror(error));
  std::shared_ptr<const void> owner(memory, [size](void* p) { ::munmap(p, size); });
  return &texts_.emplace_back(path, std::string_view(static_cast<const char*>(memory), size),
                              std::move(owner));
}

}  // namespace aircut
