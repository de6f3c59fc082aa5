#include "base/source.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
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

void SourceText::let_go() const {
  if (!owner_) return;
  // Advice about memory that is mapped from a file and never written: nothing can be lost.
  ::madvise(const_cast<char*>(content_.data()), content_.size(), MADV_DONTNEED);
}

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

namespace {

tl::unexpected<Diagnostic> cant_read(const std::string& name, const std::string& why) {
  return unexpected(make_error("input", "can't read '" + printable(name) + "': " + why));
}

}  // namespace

Expected<const SourceText*> SourceMap::map(int fd, std::string name) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) return cant_read(name, std::strerror(errno));
  if (!S_ISREG(info.st_mode))
    return cant_read(
        name, S_ISDIR(info.st_mode) ? "it is a folder, not a file" : "it is not a regular file");
  const std::size_t size = static_cast<std::size_t>(info.st_size);
  if (size == 0) return &texts_.emplace_back(std::move(name), std::string());
  void* memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  if (memory == MAP_FAILED) return cant_read(name, std::strerror(errno));
  std::shared_ptr<const void> owner(memory, [size](void* p) { ::munmap(p, size); });
  return &texts_.emplace_back(
      std::move(name), std::string_view(static_cast<const char*>(memory), size), std::move(owner));
}

Expected<const SourceText*> SourceMap::open(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return cant_read(path, std::strerror(errno));
  auto text = map(fd, path);
  ::close(fd);
  return text;
}

// What comes through a pipe is kept in memory up to `most_in_memory` and in a nameless file above.
Expected<const SourceText*> SourceMap::read(std::FILE* stream, const std::string& name) {
  constexpr std::size_t most_in_memory = 8 << 20;
  constexpr std::uint64_t most = std::uint64_t{1} << 30;
  struct stat info {};
  const int fd = ::fileno(stream);
  if (::fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && ::lseek(fd, 0, SEEK_CUR) == 0)
    return map(fd, name);
  const auto close = [](std::FILE* file) { std::fclose(file); };
  std::unique_ptr<std::FILE, decltype(close)> file(nullptr, close);
  std::string text;
  std::uint64_t size = 0;
  std::array<char, 65536> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), stream)) {
    size += n;
    if (size > most)
      return cant_read(name, "it is longer than 1 GiB; write the text to a file and name it");
    text.append(buffer.data(), n);
    if (text.size() < most_in_memory) continue;
    if (!file) file.reset(std::tmpfile());
    if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size())
      return cant_read(name, std::string("no temporary file: ") + std::strerror(errno));
    text.clear();
  }
  if (std::ferror(stream)) return cant_read(name, "reading ended with an error");
  if (!file) return &texts_.emplace_back(name, std::move(text));
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
      std::fflush(file.get()) != 0)
    return cant_read(name, std::string("no temporary file: ") + std::strerror(errno));
  return map(::fileno(file.get()), name);
}

}  // namespace aircut
