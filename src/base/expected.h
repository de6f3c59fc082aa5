#pragma once

#include <tl/expected.hpp>
#include <type_traits>
#include <utility>

namespace aircut {

struct Diagnostic;

/// A value, or the reason why there is none.
template <class T>
using Expected = tl::expected<T, Diagnostic>;

template <class E>
tl::unexpected<std::decay_t<E>> unexpected(E&& error) {
  return tl::unexpected<std::decay_t<E>>(std::forward<E>(error));
}

}  // namespace aircut
