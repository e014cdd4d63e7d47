#pragma once

#include <cstdint>

namespace nearfit {

/// How much of the cutoff minima are looked for within, where they are only shown: less as long as they take
/// more than a tick has time for, and as far as it was too much only now and then, so that it does not hunt.
class ShownReach {
 public:
  /// Work on minima that a tick has time for: 0.2 ms, and 0.8 on a slow core. A piston in its bore, with 70
  /// of them, takes half of it.
  static constexpr std::uint64_t kUsualWork = 1U << 14;
  /// So many ticks pass before what was too much is tried again; twice as many each time that it is so
  /// again.
  static constexpr std::uint32_t kFirstWait = 16, kLongestWait = 1024;

  double share() const noexcept { return share_; }
  void reset() noexcept { *this = {}; }

  /// After a tick.
  /// @param work     That the minima took.
  /// @param nearest  Distance of the nearest, as a share of the cutoff; infinity when there is none. What is
  ///                 about as near is shown, as much of it as there is work for.
  void observe(std::uint64_t work, double nearest) noexcept;

 private:
  void grow() noexcept;

  double share_ = 1.0;
  double tooMuch_ = 2.0;               ///< The least share that was too much of late; none when above 1.
  std::uint32_t calm_ = 0, wait_ = 0;  ///< Ticks since it was, and how many there are to be.
};

}  // namespace nearfit
