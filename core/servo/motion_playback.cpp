#include "core/servo/motion_playback.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace nearfit {

MotionPlayback::MotionPlayback(std::vector<MotionRow> rows) : rows_(std::move(rows)) {
  assert(!rows_.empty());
}

void MotionPlayback::seek(double time) noexcept {
  time_ = time > 0.0 ? std::min(time, duration()) : 0.0;
  const auto after = std::upper_bound(rows_.begin(), rows_.end(), time_,
                                      [](double t, const MotionRow& row) { return t < row.time; });
  index_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - rows_.begin() - 1, 0));
}

void MotionPlayback::step(std::ptrdiff_t rows) noexcept {
  const auto last = static_cast<std::ptrdiff_t>(rows_.size()) - 1;
  index_ = static_cast<std::size_t>(
      std::clamp(static_cast<std::ptrdiff_t>(index_) + rows, std::ptrdiff_t{0}, last));
  time_ = rows_[index_].time;
}

bool MotionPlayback::advance(double seconds) noexcept {
  double next = time_ + speed_ * seconds;
  if (isLooping_ && next > duration()) next = duration() > 0.0 ? std::fmod(next, duration()) : 0.0;
  seek(next);
  return isLooping_ || time_ < duration();
}

void MotionPlayback::setSpeed(double speed) noexcept {
  if (std::isfinite(speed)) speed_ = std::clamp(speed, kMinSpeed, kMaxSpeed);
}

void takeRow(const MotionRow& row, const Part& moving, ServoSnapshot& out) {
  out = ServoSnapshot{};
  out.time = row.time;
  out.handle = row.handle;
  out.proxy = row.proxy;
  out.wrench = row.wrench;
  out.centre = row.proxy.applyToPoint(moving.geometry ? moving.geometry->mass.centre : glm::dvec3(0.0));
  out.distance = row.distance;
  out.isDistanceBound = row.isDistanceBound;
  out.queryTime = row.queryTime;
  out.tickTime = row.tickTime;
  out.lmdCount = row.lmds;
  out.lateBodies = row.lateBodies;
  out.isTruncated = row.isTruncated;
  out.isClamped = row.isClamped;
  out.fault = row.fault;
  out.moving = moving.id;
  out.energyToHand = row.energyToHand;
  out.proxyTime = row.proxyTime;
  out.wrenchTime = row.wrenchTime;
  out.isBehind = row.isBehind;
  out.subSteps = row.subSteps;
  out.shortenedSteps = row.shortenedSteps;
  out.refusedSteps = row.refusedSteps;
  out.constraintCount = row.constraints;
  out.contactCount = row.contacts;
  out.overlappingCount = 0;  // A recording does not name the parts.
}

}  // namespace nearfit
