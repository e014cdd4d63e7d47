#include "tests/stress/hand_motion.h"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "tests/bench/portable_random.h"

namespace nearfit::stress {
namespace {

constexpr double kImpact = 2.0;  ///< [m/s]
/// Scenes this large meet a hand of that speed; in others it is as fast in diagonals as often as in metres.
constexpr double kHandSize = 0.1;
constexpr double kShake = 20.0;  ///< [1/s]
/// How far out a hand leaps, in sizes of the scene.
constexpr std::array<double, 4> kLeaps{0.5, 1.0, 10.0, 1e3};

struct Stretch {
  MotionKind kind;
  unsigned weight;
  std::uint64_t shortest, longest;  ///< [ticks]
};
constexpr std::array<Stretch, kMotionKinds> kStretches{{{MotionKind::Teleport, 6, 1, 12},
                                                        {MotionKind::Impact, 4, 10, 120},
                                                        {MotionKind::Shake, 3, 100, 400},
                                                        {MotionKind::Grind, 4, 100, 600},
                                                        {MotionKind::GapWalk, 4, 200, 600},
                                                        {MotionKind::Spin, 3, 50, 300},
                                                        {MotionKind::Home, 2, 40, 100},
                                                        {MotionKind::Rest, 2, 10, 100}}};

const Stretch& chosen(std::uint64_t number) {
  unsigned sum = 0;
  for (const Stretch& s : kStretches)
    sum += s.weight;
  auto left = static_cast<unsigned>(number % sum);
  for (const Stretch& s : kStretches) {
    if (left < s.weight) return s;
    left -= s.weight;
  }
  return kStretches.back();
}

}  // namespace

const char* nameOf(MotionKind kind) noexcept {
  constexpr std::array<const char*, kMotionKinds> kNames{"teleport", "impact", "shake", "grind",
                                                         "gap walk", "spin",   "home",  "rest"};
  return kNames[static_cast<std::size_t>(kind)];
}

HandMotion::HandMotion(const StressScene& scene, std::uint64_t seed)
    : scene_(scene), centreInPart_(scene.scene->centreInPart), random_(seed) {
  now_ = placeOf(scene.scene->moving.worldFromPart);
}

double HandMotion::in(double low, double high) {
  return low + (high - low) * bench::uniform(random_);
}

double HandMotion::ofSize(double low, double high) {
  return scene_.size * low * std::pow(high / low, bench::uniform(random_));
}

glm::dquat HandMotion::randomRotation() {
  return rotationOf(in(0.0, std::numbers::pi) * bench::randomDirection(random_));
}

HandMotion::Place HandMotion::placeOf(const RigidTransform& pose) const noexcept {
  return {pose.rotation, pose.applyToPoint(centreInPart_)};
}

RigidTransform HandMotion::poseOf(const Place& place) const noexcept {
  const glm::dquat rotation = glm::normalize(place.rotation);
  return {rotation, place.centre - rotation * centreInPart_};
}

RigidTransform HandMotion::next(const RigidTransform& proxy, double period) {
  const Place part = placeOf(proxy);
  if (ticksLeft_ == 0) begin(part);
  --ticksLeft_;
  time_ += period;
  now_ = placeNow(part, period);
  return poseOf(now_);
}

void HandMotion::begin(const Place& proxy) {
  const Stretch& stretch = chosen(random_());
  kind_ = stretch.kind;
  ticksLeft_ = stretch.shortest + random_() % (stretch.longest - stretch.shortest + 1);
  time_ = 0.0;
  along_ = bench::randomDirection(random_);
  axis_ = bench::randomDirection(random_);
  from_ = random_() % 2 == 0 ? proxy : now_;
  const double scale = random_() % 2 == 0 ? 1.0 : scene_.size / kHandSize;
  if (kind_ == MotionKind::Teleport) beginTeleport();
  if (kind_ == MotionKind::Impact) speed_ = kImpact * scale;
  if (kind_ == MotionKind::Shake) amplitude_ = ofSize(1e-4, 0.5);
  if (kind_ == MotionKind::Grind) beginPress(proxy);
  if (kind_ == MotionKind::GapWalk) from_ = proxy;
  turnSpeed_ = kind_ == MotionKind::Spin ? in(1.0, 200.0) : in(-3.0, 3.0);
}

void HandMotion::beginTeleport() {
  const glm::dvec3 middle = scene_.scene->moving.worldFromPart.applyToPoint(centreInPart_);
  const double reach = kLeaps[random_() % kLeaps.size()] * scene_.size;
  from_ = {randomRotation(), middle + in(0.0, reach) * along_};
}

/// Slowly along a surface that it is pressed into.
void HandMotion::beginPress(const Place& proxy) {
  from_ = proxy;
  amplitude_ = ofSize(1e-5, 0.3);
  across_ = glm::normalize(glm::cross(along_, bench::randomDirection(random_)));
  speed_ = ofSize(1e-3, 0.3);
}

HandMotion::Place HandMotion::placeNow(const Place& proxy, double period) {
  switch (kind_) {
    case MotionKind::Teleport:
      return from_;
    case MotionKind::Impact:
      return {now_.rotation, from_.centre + speed_ * time_ * along_};
    case MotionKind::Shake: {
      const double swing = std::sin(2.0 * std::numbers::pi * kShake * time_);
      return {rotationOf(0.3 * swing * axis_) * from_.rotation, from_.centre + amplitude_ * swing * along_};
    }
    case MotionKind::Grind:
      return {rotationOf(0.2 * turnSpeed_ * time_ * axis_) * from_.rotation,
              from_.centre + amplitude_ * along_ + speed_ * time_ * across_};
    case MotionKind::GapWalk:
      return walked(proxy);
    case MotionKind::Spin:
      return {rotationOf(turnSpeed_ * period * axis_) * now_.rotation, now_.centre};
    case MotionKind::Home:
      return placeOf(scene_.lure);
    case MotionKind::Rest:
      break;
  }
  return now_;
}

/// A step of some margins from where the part is, on the whole towards the narrow place.
HandMotion::Place HandMotion::walked(const Place& proxy) {
  constexpr double kPull = 0.02;
  const Place lure = placeOf(scene_.lure);
  const double step = in(0.0, 4.0) * scene_.margin;
  const double radius = scene_.scene->metric.radius;
  const glm::dvec3 turn = rotationVector(lure.rotation * glm::conjugate(proxy.rotation));
  return {rotationOf(kPull * turn + step / radius * bench::randomDirection(random_)) * proxy.rotation,
          proxy.centre + kPull * (lure.centre - proxy.centre) + step * bench::randomDirection(random_)};
}

}  // namespace nearfit::stress
