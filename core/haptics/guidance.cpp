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

/// Points nearer to each other are one: no direction of the segment would be left.
constexpr double kLeastSegment = 1e-12;

std::uint64_t nextGuidanceSerial() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// Distance at which the peak is reached, and half the reach.
double riseOf(const GuidanceSettings& settings) noexcept {
  return std::min(settings.maxForce / settings.stiffness, 0.5 * settings.reach);
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
}

GuidanceSettings boundedGuidance(const GuidanceSettings& wish, const DeviceLimits& device,
                                 double period) noexcept {
  GuidanceSettings bounded = wish;
  bounded.stiffness = std::min(wish.stiffness, kGuidanceShare * stiffnessBound(device.damping, 0.0, period));
  bounded.maxForce = std::min(wish.maxForce, kGuidanceForceShare * device.maxForce);
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

GuidancePath::GuidancePath(std::vector<glm::dvec3> points, const GuidanceSettings& settings)
    : points_(std::move(points)), settings_(settings), serial_(nextGuidanceSerial()) {
  checkGuidance(settings);
  if (points_.size() < 2)
    throw UsageError("guidance", "its path has less than two points", "take a longer path");
  if (points_.size() > kMaxPoints)
    throw UsageError("guidance", fmt::format("its path has more than {} points", kMaxPoints), "thin it");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!std::isfinite(points_[i].x + points_[i].y + points_[i].z))
      throw UsageError("guidance", fmt::format("point {} of its path is not finite", i), "correct it");
    if (i > 0 && !(glm::distance(points_[i - 1], points_[i]) > kLeastSegment))
      throw UsageError("guidance", fmt::format("points {} and {} of its path are the same", i - 1, i),
                       "leave one out");
  }
}

glm::dvec3 GuidancePath::nearestOn(std::size_t segment, const glm::dvec3& point) const noexcept {
  const glm::dvec3 &a = points_[segment], along = points_[segment + 1] - a;
  double share = glm::dot(point - a, along) / glm::dot(along, along);
  if (segment > 0) share = std::max(share, 0.0);
  if (segment + 1 < segments()) share = std::min(share, 1.0);
  return a + share * along;
}

GuidancePull GuidanceFollower::follow(const GuidancePath& path, const GuidanceSettings& settings,
                                      const glm::dvec3& point) noexcept {
  const std::size_t count = path.segments();
  if (path.serial() != serial_) {
    serial_ = path.serial();
    segment_ = scanned_ = 0;
  }
  std::size_t nearest = std::min(segment_, count - 1);
  glm::dvec3 to = path.nearestOn(nearest, point);
  double least = glm::distance(to, point);
  const auto look = [&](std::size_t segment) noexcept {
    const glm::dvec3 there = path.nearestOn(segment, point);
    const double distance = glm::distance(there, point);
    if (!(distance < least)) return;
    least = distance;
    nearest = segment;
    to = there;
  };
  const std::size_t first = nearest - std::min(nearest, kWindow),
                    end = std::min(count, nearest + kWindow + 1);
  for (std::size_t i = first; i < end; ++i)
    look(i);
  // Beyond the reach nothing pulls, so that another stretch may be gone over to.
  if (!(least < settings.reach)) {
    for (std::size_t i = 0; i < std::min(kScan, count); ++i) {
      look(scanned_);
      scanned_ = scanned_ + 1 < count ? scanned_ + 1 : 0;
    }
  }
  segment_ = nearest;
  if (!(least > 0.0)) return {};
  const double force = guidanceForce(settings, least);
  return {force / least * (to - point), guidanceEnergy(settings, least)};
}

}  // namespace nearfit
