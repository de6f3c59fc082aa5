#include "base/spilled.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <utility>

namespace aircut {
namespace {

constexpr std::size_t least = 4 << 10;
constexpr std::size_t longest_step = 256 << 20;

}  // namespace

SpilledMemory::~SpilledMemory() { release(); }

SpilledMemory::SpilledMemory(SpilledMemory&& other) noexcept { *this = std::move(other); }

SpilledMemory& SpilledMemory::operator=(SpilledMemory&& other) noexcept {
  if (this == &other) return *this;
  release();
  data_ = std::exchange(other.data_, nullptr);
  capacity_ = std::exchange(other.capacity_, 0);
  file_ = std::move(other.file_);
  last_ = std::exchange(other.last_, 0);
  touched_ = std::exchange(other.touched_, 0);
  return *this;
}

void SpilledMemory::release() {
  if (file_)
    ::munmap(data_, capacity_);
  else
    std::free(data_);
  data_ = nullptr;
  capacity_ = 0;
  file_.reset();
}

bool SpilledMemory::grow(std::size_t bytes) {
  if (bytes <= capacity_) return true;
  const std::size_t step = std::min(std::max(capacity_, least), longest_step);
  const std::size_t wanted = std::max(bytes, capacity_ + step);
  if (!file_ && wanted <= most_in_memory) {
    void* const longer = std::realloc(data_, wanted);
    if (!longer) return false;
    data_ = static_cast<std::byte*>(longer);
    capacity_ = wanted;
    return true;
  }
  std::unique_ptr<std::FILE, Close> file = file_ ? nullptr : decltype(file)(std::tmpfile());
  std::FILE* const to = file_ ? file_.get() : file.get();
  // Room is taken now: a page of a file without room could not be written later.
  if (!to || ::posix_fallocate(::fileno(to), 0, static_cast<off_t>(wanted)) != 0) return false;
  void* const mapped = ::mmap(nullptr, wanted, PROT_READ | PROT_WRITE, MAP_SHARED, ::fileno(to), 0);
  if (mapped == MAP_FAILED) return false;
  if (file_) {
    ::munmap(data_, capacity_);
  } else {
    if (data_) std::memcpy(mapped, data_, capacity_);
    std::free(data_);
    file_ = std::move(file);
  }
  data_ = static_cast<std::byte*>(mapped);
  capacity_ = wanted;
  return true;
}

// Pages of a shared file: what was written is in the file.
void SpilledMemory::let_go() {
  ::madvise(data_, capacity_, MADV_DONTNEED);
  touched_ = 0;
}

}  // namespace aircut
