#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace nearfit {

/// Bounded lock-free queue from one producer thread to one consumer thread. Counts the values dropped while
/// it is full. Real-time safe.
template <class T, std::size_t kCapacity>
class SpscQueue {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert((kCapacity & (kCapacity - 1)) == 0, "capacity is a power of two");

 public:
  /// Producer: appends `value`. Returns false and counts a drop if the queue is full.
  bool push(const T& value) noexcept {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == kCapacity) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    slots_[tail % kCapacity] = value;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  /// Consumer: takes the oldest value. Returns false if the queue is empty.
  bool pop(T& value) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    value = slots_[head % kCapacity];
    head_.store(head + 1, std::memory_order_release);
    return true;
  }
  /// Any thread: values dropped so far.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::array<T, kCapacity> slots_{};
  alignas(64) std::atomic<std::uint64_t> head_{0};
  alignas(64) std::atomic<std::uint64_t> tail_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace nearfit
