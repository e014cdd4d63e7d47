#include "core/servo/shown_reach.h"

#include <algorithm>

namespace nearfit {
namespace {

constexpr double kLess = 0.7, kMore = 1.1, kMin = 1e-3;
/// With less work than this, there is room for more.
constexpr std::uint64_t kLittle = ShownReach::kUsualWork / 3;
/// Minima up to this many times as far as the nearest are always included.
constexpr double kAboutAsNear = 1.25;
/// Above any share.
constexpr double kNoShare = 2.0;

}  // namespace

void ShownReach::observe(std::uint64_t work, double nearest) noexcept {
  const double least = nearest < 1.0 ? std::clamp(kAboutAsNear * nearest, kMin, 1.0) : kMin;
  if (work > kUsualWork) {
    calm_ = 0;
    if (share_ > least) {
      // Too much once more, or for the first time.
      wait_ = tooMuch_ < kNoShare ? std::min(2 * wait_, kLongestWait) : kFirstWait;
      tooMuch_ = std::min(tooMuch_, share_);
    }
    share_ = kLess * share_;
  } else {
    calm_ = std::min(calm_ + 1, kLongestWait);
    if (work < kLittle) grow();
  }
  share_ = std::max(share_, least);
}

void ShownReach::grow() noexcept {
  // That share is not too much any more.
  if (share_ >= tooMuch_) tooMuch_ = kNoShare;
  const double more = std::min(1.0, kMore * share_);
  if (more >= tooMuch_) {
    if (calm_ < wait_) return;
    calm_ = 0;
  }
  share_ = more;
}

}  // namespace nearfit
