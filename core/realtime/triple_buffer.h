#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace nearfit {

/// Passes the newest value from one writer thread to one reader thread. Lock-free; neither ever waits.
///
/// Only the writer constructs, changes and destroys values; the reader only reads. So T need not be
/// trivially copyable.
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  explicit TripleBuffer(const T& initial) { slots_.fill(initial); }

  /// Writer: the slot to fill; it holds some older value.
  T& back() noexcept { return slots_[back_]; }
  /// Writer: makes the filled slot the newest value.
  void publish() noexcept {
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }
  /// Writer: publishes a copy of `value`.
  void publish(const T& value) noexcept
    requires std::is_trivially_copyable_v<T>
  {
    back() = value;
    publish();
  }

  /// Reader: takes the newest value. Returns false if the reader already has it.
  bool update() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// Reader: the value taken by the last update(); before that, the initial value.
  const T& front() const noexcept { return slots_[front_]; }

 private:
  static constexpr std::uint8_t kIndex = 3, kFresh = 4;
  std::array<T, 3> slots_{};
  alignas(64) std::uint8_t back_ = 0;
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t front_ = 2;
};

}  // namespace nearfit
