// Arrays that may grow past what a process should take: the first 2 MiB are ordinary memory, what
// is longer lies in a temporary file without a name that is mapped. Its pages are let go of every
// few MiB that are looked at, so the process stays small however long the array gets; the file
// takes room on the disk instead. When there is no room, growing fails and says so.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <queue>
#include <type_traits>
#include <vector>

namespace aircut {

/// The bytes of such an array.
class SpilledMemory {
 public:
  SpilledMemory() = default;
  ~SpilledMemory();
  SpilledMemory(SpilledMemory&& other) noexcept;
  SpilledMemory& operator=(SpilledMemory&& other) noexcept;

  /// Room for that many bytes; what was written stays, its address does not. False when there is
  /// no temporary file, or no room for it.
  bool grow(std::size_t bytes);
  std::size_t capacity() const { return capacity_; }
  std::byte* data() const { return data_; }
  bool spilled() const { return file_ != nullptr; }
  /// Tells that the bytes around `offset` are looked at. Addresses stay valid.
  void touch(std::size_t offset) {
    if (!file_ || offset / neighbourhood == last_) return;
    last_ = offset / neighbourhood;
    if (++touched_ >= most_touched) let_go();
  }

  static constexpr std::size_t most_in_memory = 2 << 20;

 private:
  static constexpr std::size_t neighbourhood = 64 << 10;  // as far as Linux maps around a place
  static constexpr std::size_t most_touched = 32;

  void let_go();
  void release();

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::byte* data_ = nullptr;
  std::size_t capacity_ = 0;
  std::unique_ptr<std::FILE, Close> file_;
  std::size_t last_ = 0, touched_ = 0;
};

template <class T>
class SpilledArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t at) {
    memory_.touch(at * sizeof(T));
    return begin()[at];
  }
  T& back() { return (*this)[size_ - 1]; }
  /// False when there is no room for it.
  bool push_back(const T& value) {
    if ((size_ + 1) * sizeof(T) > memory_.capacity() && !memory_.grow((size_ + 1) * sizeof(T)))
      return false;
    (*this)[size_++] = value;
    return true;
  }

  /// The first one that is not `less` than `value`, in an array that is sorted by that. What `less`
  /// looks at must not have been changed since the first such search.
  template <class V, class Less>
  std::size_t lower_bound(const V& value, Less less) {
    // Samples say in which stretch it is, so that only the file's pages of that one are looked at.
    for (std::size_t i = samples_.size() * stretch; i < size_; i += stretch)
      samples_.push_back((*this)[i]);
    const auto sample = std::lower_bound(samples_.begin(), samples_.end(), value, less);
    if (sample == samples_.begin()) return 0;
    const std::size_t behind = static_cast<std::size_t>(sample - samples_.begin()) * stretch;
    std::size_t first = behind - stretch + 1, count = std::min(behind, size_) - first;
    while (count > 0) {
      const std::size_t half = count / 2;
      if (less((*this)[first + half], value)) {
        first += half + 1;
        count -= half + 1;
      } else {
        count = half;
      }
    }
    return first;
  }

  /// False when there is no room for it: what is long is sorted in parts, which are merged into a
  /// new array.
  template <class Less>
  bool sort(Less less) {
    samples_.clear();
    if (!memory_.spilled()) {
      std::sort(begin(), begin() + size_, less);
      return true;
    }
    if (is_sorted(less)) return true;
    std::vector<T> part;
    for (std::size_t from = 0; from < size_; from += part_size) {
      part.clear();
      const std::size_t to = std::min(size_, from + part_size);
      for (std::size_t i = from; i < to; ++i) part.push_back((*this)[i]);
      std::sort(part.begin(), part.end(), less);
      for (std::size_t i = from; i < to; ++i) (*this)[i] = part[i - from];
    }
    return merge_parts(less);
  }

 private:
  static constexpr std::size_t part_size = SpilledMemory::most_in_memory / sizeof(T);

  static constexpr std::size_t stretch = 1024;

  T* begin() { return reinterpret_cast<T*>(memory_.data()); }

  template <class Less>
  bool is_sorted(Less less) {
    for (std::size_t i = 1; i < size_; ++i) {
      const T before = (*this)[i - 1];
      if (less((*this)[i], before)) return false;
    }
    return true;
  }

  template <class Less>
  bool merge_parts(Less less) {
    struct Head {
      T value;
      std::size_t at, end;
    };
    const auto later = [&](const Head& a, const Head& b) { return less(b.value, a.value); };
    std::priority_queue<Head, std::vector<Head>, decltype(later)> heads(later);
    for (std::size_t from = 0; from < size_; from += part_size)
      heads.push({(*this)[from], from, std::min(size_, from + part_size)});
    SpilledArray merged;
    while (!heads.empty()) {
      Head head = heads.top();
      heads.pop();
      if (!merged.push_back(head.value)) return false;
      if (++head.at == head.end) continue;
      head.value = (*this)[head.at];
      heads.push(head);
    }
    *this = std::move(merged);
    return true;
  }

  SpilledMemory memory_;
  std::size_t size_ = 0;
  std::vector<T> samples_;  ///< every 1024th, for searches
};

}  // namespace aircut
