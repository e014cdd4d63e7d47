#pragma once

#include <cstddef>

namespace nearfit::test {

/// Sanitized builds, many times slower, take one in so many of the random trials: what they look for shows in few.
#ifdef NEARFIT_SANITIZED
constexpr std::size_t kTrialShare = 8;
#else
constexpr std::size_t kTrialShare = 1;
#endif

}  // namespace nearfit::test
