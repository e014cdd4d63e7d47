#include "core/haptics/guidance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/haptics/virtual_coupling.h"

namespace nearfit {
namespace {

/// Poses nearer to each other are one: no direction of the segment would be left. In metres, and for quaternions.
constexpr double kLeastSegment = 1e-12;

/// Lengths of quaternions that differ by no more from 1 are rounded so.
constexpr double kUnitQuaternion = 1e-6;

/// Max turn of a segment [rad]: a straight line between quaternions then leaves the sphere by less than 1/3000.
constexpr double kMaxSegmentTurn = 0.1;

std::uint64_t nextGuidanceSerial() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// Distance at which the peak is reached, and half the reach.
double riseOf(const GuidanceSettings& settings) noexcept {
  return std::min(settings.maxForce / settings.stiffness, 0.5 * settings.reach);
}

double chordOf(const glm::dquat& a, const glm::dquat& b) noexcept {
  const glm::dquat d = b - a;
  return std::sqrt(glm::dot(d, d));
}

/// The offset to a point (place, 2 arm q) of the path.
/// @param hand  Of the same hemisphere as q.
GuidanceOffset offsetBetween(const GuidancePose& hand, const glm::dvec3& place, const glm::dquat& q,
                             double arm) noexcept {
  GuidanceOffset offset;
  offset.shift = place - hand.place;
  const glm::dquat off = q - hand.rotation;
  const double weight = 4.0 * arm * arm;
  offset.distance = std::sqrt(glm::dot(offset.shift, offset.shift) + weight * glm::dot(off, off));
  // A turn by w moves the hand's quaternion by half of w times it.
  const glm::dquat turn = off * glm::conjugate(hand.rotation);
  offset.turn = 0.5 * weight * glm::dvec3(turn.x, turn.y, turn.z);
  return offset;
}

bool isUsableGuidance(const GuidanceSettings& settings) noexcept {
  return settings.stiffness > 0.0 && settings.maxForce > 0.0 && settings.reach > 0.0;
}

}  // namespace

void checkGuidance(const GuidanceSettings& settings) {
  const auto check = [](const char* what, double value, double max, const char* unit) {
    if (value > 0.0 && value <= max) return;
    throw UsageError("guidance", fmt::format("{} {} is not a valid {}", value, unit, what),
                     fmt::format("give more than 0 and at most {} {}", max, unit));
  };
  check("stiffness", settings.stiffness, kMaxGuidanceStiffness, "N/m");
  check("max force", settings.maxForce, kMaxGuidanceForce, "N");
  check("reach", settings.reach, kMaxGuidanceReach, "m");
  if (settings.turnReach != 0.0) check("reach of turns", settings.turnReach, kMaxGuidanceTurn, "rad");
}

double guidanceArm(const GuidanceSettings& settings) noexcept {
  return settings.turnReach > 0.0 ? settings.reach / settings.turnReach : 0.0;
}

GuidanceSettings boundedGuidance(const GuidanceSettings& wish, const DeviceLimits& device,
                                 double period) noexcept {
  GuidanceSettings bounded = wish;
  bounded.stiffness = std::min(wish.stiffness, kGuidanceShare * stiffnessBound(device.damping, 0.0, period));
  bounded.maxForce = std::min(wish.maxForce, kGuidanceForceShare * device.maxForce);
  const double arm = guidanceArm(wish);
  if (!isUsableGuidance(bounded) || !(arm > 0.0)) return bounded;
  const double peak = bounded.stiffness * riseOf(bounded);
  const double stiffest = kGuidanceShare * stiffnessBound(device.rotationalDamping, 0.0, period);
  const double most =
      std::min(kGuidanceForceShare * device.maxTorque / peak, std::sqrt(stiffest / bounded.stiffness));
  if (arm <= most) return bounded;
  bounded.turnReach = wish.reach / most;
  if (!(bounded.turnReach <= kMaxGuidanceTurn)) bounded.turnReach = 0.0;
  return bounded;
}

double guidanceForce(const GuidanceSettings& settings, double distance) noexcept {
  if (!isUsableGuidance(settings) || !(distance < settings.reach)) return 0.0;
  const double rise = riseOf(settings), peak = settings.stiffness * rise, half = 0.5 * settings.reach;
  if (distance <= rise) return settings.stiffness * distance;
  return distance <= half ? peak : peak * (settings.reach - distance) / half;
}

double guidanceEnergy(const GuidanceSettings& settings, double distance) noexcept {
  if (!isUsableGuidance(settings)) return 0.0;
  const double rise = riseOf(settings), peak = settings.stiffness * rise, half = 0.5 * settings.reach;
  const double within = std::min(distance, settings.reach);
  if (within <= rise) return 0.5 * settings.stiffness * within * within;
  const double rising = 0.5 * peak * rise;
  if (within <= half) return rising + peak * (within - rise);
  const double left = settings.reach - within;
  return rising + peak * (half - rise) + 0.5 * peak * (half - left * left / half);
}

GuidancePath::GuidancePath(std::vector<GuidancePose> poses, const GuidanceSettings& settings)
    : settings_(settings), serial_(nextGuidanceSerial()) {
  checkGuidance(settings);
  if (poses.size() < 2)
    throw UsageError("guidance", "its path has less than two poses", "take a longer path");
  const auto checkCount = [](std::size_t count) {
    if (count > kMaxPoints)
      throw UsageError("guidance", fmt::format("its path has more than {} poses", kMaxPoints), "thin it");
  };
  checkCount(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    GuidancePose& pose = poses[i];
    const double length = glm::length(pose.rotation);
    if (!std::isfinite(pose.place.x + pose.place.y + pose.place.z + length))
      throw UsageError("guidance", fmt::format("pose {} of its path is not finite", i), "correct it");
    if (std::abs(length - 1.0) > kUnitQuaternion)
      throw UsageError("guidance",
                       fmt::format("the rotation of pose {} of its path is not of unit length", i),
                       "normalise it");
    pose.rotation = glm::normalize(pose.rotation);
    if (i == 0) {
      poses_.push_back(pose);
      continue;
    }
    // Both signs of a quaternion are the same rotation: that on the way of the one before.
    const GuidancePose before = poses_.back();
    if (glm::dot(before.rotation, pose.rotation) < 0.0) pose.rotation = -pose.rotation;
    const double chord = chordOf(before.rotation, pose.rotation);
    if (!(glm::distance(before.place, pose.place) > kLeastSegment || chord > kLeastSegment))
      throw UsageError("guidance", fmt::format("poses {} and {} of its path are the same", i - 1, i),
                       "leave one out");
    const double turn = 4.0 * std::asin(std::min(1.0, 0.5 * chord));
    const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil(turn / kMaxSegmentTurn)));
    checkCount(poses_.size() + pieces);
    for (std::size_t k = 1; k < pieces; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(pieces);
      poses_.push_back({before.place + share * (pose.place - before.place),
                        glm::normalize(glm::slerp(before.rotation, pose.rotation, share))});
    }
    poses_.push_back(pose);
  }
}

GuidanceOffset GuidancePath::offsetTo(std::size_t segment, const GuidancePose& from,
                                      double arm) const noexcept {
  const GuidancePose &a = poses_[segment], &b = poses_[segment + 1];
  const double weight = 4.0 * arm * arm;
  GuidancePose hand = from;
  if (glm::dot(a.rotation, hand.rotation) < 0.0) hand.rotation = -hand.rotation;
  const glm::dvec3 along = b.place - a.place, off = hand.place - a.place;
  const glm::dquat turning = b.rotation - a.rotation, turnedOff = hand.rotation - a.rotation;
  const double lengthSquared = glm::dot(along, along);
  const double square = lengthSquared + weight * glm::dot(turning, turning);
  // Where turns do not count, one in place has no length.
  const double wanted =
      square > 0.0 ? (glm::dot(off, along) + weight * glm::dot(turnedOff, turning)) / square : 0.0;
  const double share = std::clamp(wanted, 0.0, 1.0);
  GuidanceOffset nearest = offsetBetween(hand, a.place + share * along, a.rotation + turning * share, arm);
  const auto goOn = [&](const GuidancePose& end, double beyond) noexcept {
    const GuidanceOffset there = offsetBetween(hand, end.place + beyond * along, end.rotation, arm);
    if (there.distance < nearest.distance) nearest = there;
  };
  if (lengthSquared > 0.0) {
    const double straight = glm::dot(off, along) / lengthSquared;
    if (segment == 0 && straight < 0.0) goOn(a, straight);
    if (segment + 1 == segments() && straight > 1.0) goOn(b, straight - 1.0);
  }
  return nearest;
}

GuidancePull GuidanceFollower::follow(const GuidancePath& path, const GuidanceSettings& settings,
                                      const GuidancePose& hand) noexcept {
  const std::size_t count = path.segments();
  if (path.serial() != serial_) {
    serial_ = path.serial();
    segment_ = scanned_ = 0;
  }
  const double arm = guidanceArm(settings);
  std::size_t nearest = std::min(segment_, count - 1);
  GuidanceOffset to = path.offsetTo(nearest, hand, arm);
  const auto look = [&](std::size_t segment) noexcept {
    const GuidanceOffset there = path.offsetTo(segment, hand, arm);
    if (!(there.distance < to.distance)) return;
    nearest = segment;
    to = there;
  };
  const std::size_t first = nearest - std::min(nearest, kWindow),
                    end = std::min(count, nearest + kWindow + 1);
  for (std::size_t i = first; i < end; ++i)
    look(i);
  // Beyond the reach nothing pulls, so that another stretch may be gone over to.
  if (!(to.distance < settings.reach)) {
    for (std::size_t i = 0; i < std::min(kScan, count); ++i) {
      look(scanned_);
      scanned_ = scanned_ + 1 < count ? scanned_ + 1 : 0;
    }
  }
  segment_ = nearest;
  if (!(to.distance > 0.0)) return {};
  const double slope = guidanceForce(settings, to.distance) / to.distance;
  return {slope * to.shift, slope * to.turn, guidanceEnergy(settings, to.distance)};
}

}  // namespace nearfit
