#pragma once

#include <atomic>
#include <type_traits>

namespace nearfit {

/// Lowers an atomic to a value if that is less.
template <class T>
void lowerTo(std::atomic<T>& least, std::type_identity_t<T> value) noexcept {
  T now = least.load();
  while (value < now && !least.compare_exchange_weak(now, value)) {
  }
}

}  // namespace nearfit
