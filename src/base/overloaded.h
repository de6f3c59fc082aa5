#pragma once

namespace aircut {

/// Visitor of a std::variant made of one lambda per alternative; a missing one fails to compile.
template <class... Ts>
struct overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
overloaded(Ts...) -> overloaded<Ts...>;

}  // namespace aircut
