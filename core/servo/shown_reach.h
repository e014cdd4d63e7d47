#pragma once

#include <cstdint>

namespace nearfit {

/// The share of the cutoff within which minima are found where they are only shown. It shrinks while they
/// take more work than a tick has time for. A share that was too much is tried again only now and then, so
/// that it does not hunt. Real-time safe.
class ShownReach {
 public:
  /// Work on minima that a tick has time for: 0.2 ms, or 0.4 ms on a slow core. A piston in its bore, with 70
  /// minima, takes most of it.
  static constexpr std::uint64_t kUsualWork = 9U << 10;
  /// Ticks before a share that was too much is tried again; doubled each time that it is too much again.
  static constexpr std::uint32_t kFirstWait = 16, kLongestWait = 1024;

  /// The share for the next tick; > 0, at most 1.
  double share() const noexcept { return share_; }
  void reset() noexcept { *this = {}; }

  /// Records the outcome of a tick.
  /// @param work     Work that the minima took.
  /// @param nearest  Distance of the nearest one, as a fraction of the cutoff; infinity if there is none.
  ///                 Minima about as near are always included, as far as there is work for them.
  void observe(std::uint64_t work, double nearest) noexcept;

 private:
  void grow() noexcept;

  double share_ = 1.0;
  /// The min share that was too much recently; above 1 for none.
  double tooMuch_ = 2.0;
  /// Ticks since then, and ticks to wait.
  std::uint32_t calm_ = 0, wait_ = 0;
};

}  // namespace nearfit
