// Private: a queue whose items keep their memory: what goes out at the front comes in again at the
// back, as it was left.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace aircut::plan {

template <class T>
class Ring {
 public:
  bool empty() const { return count_ == 0; }
  std::size_t size() const { return count_; }
  T& operator[](std::size_t i) { return items_[place(i)]; }
  const T& operator[](std::size_t i) const { return items_[place(i)]; }
  T& front() { return items_[first_]; }
  T& back() { return items_[place(count_ - 1)]; }

  /// An item that is new, or one that was in use before.
  T& push_back() {
    if (count_ == items_.size()) grow();
    ++count_;
    return back();
  }
  void pop_front() {
    first_ = place(1);
    --count_;
  }

 private:
  std::size_t place(std::size_t i) const {
    const std::size_t at = first_ + i;
    return at < items_.size() ? at : at - items_.size();
  }
  void grow() {
    std::vector<T> more(items_.empty() ? 16 : 2 * items_.size());
    for (std::size_t i = 0; i < count_; ++i) more[i] = std::move(items_[place(i)]);
    items_ = std::move(more);
    first_ = 0;
  }

  std::vector<T> items_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace aircut::plan
