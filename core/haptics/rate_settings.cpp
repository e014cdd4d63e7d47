#include "core/haptics/rate_settings.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

void checkRange(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw UsageError(name, fmt::format("{} is out of range", value),
                   fmt::format("choose a number from {} to {}", least, most));
}

}  // namespace

void checkRateSettings(const RateSettings& settings) {
  checkRange("dead zone", settings.deadZone, 0.0, kMaxDeadZone);
  checkRange("curve", settings.exponent, kMinExponent, kMaxExponent);
  checkRange("full speed", settings.fullSpeed, 0.0, kMaxFullSpeed);
  checkRange("full turn", settings.fullTurn, 0.0, kMaxFullTurn);
}

}  // namespace nearfit
