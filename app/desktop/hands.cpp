#include "app/desktop/hands.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/proximity/lmd_query.h"
#include "device/servo_loop.h"
#include "device/simulated_device.h"

namespace nearfit::desktop {
namespace {

constexpr double kSweepSeconds = 4.0;
/// Part of the gap to the nearest part that the scripted hand closes: near enough to feel, never through.
constexpr double kCloses = 0.75;
/// How far the wobble moves the part's ends, as a part of the approach's reach.
constexpr double kWobble = 0.2;

struct Approach {
  glm::dvec3 direction{0.0};
  double reach = 0.0;
};

/// Towards the nearest other part within the cutoff.
std::optional<Approach> approachOfNearest(const ServoScene& scene, double cutoff) {
  LmdScratch scratch;
  std::array<Lmd, 16> lmds;
  double least = std::numeric_limits<double>::infinity();
  std::optional<Approach> approach;
  for (const ServoScene::Body& body : scene.bodies) {
    const RigidTransform bodyFromPart = body.worldFromPart.inverse() * scene.moving.worldFromPart;
    const LmdResult result =
        findLmds(body.geometry->tree(), scene.moving.geometry->tree(), bodyFromPart, cutoff, scratch, lmds);
    if (result.count == 0 || lmds[0].distance >= least) continue;
    least = lmds[0].distance;
    approach = Approach{-body.worldFromPart.applyToVector(lmds[0].direction), kCloses * least};
  }
  return approach;
}

/// The sweep turns about the part's centre of mass, wherever the file put the origin, and so little that the
/// part's ends move less than the approach leaves of the gap.
std::vector<RigidTransform> sweepAboutCentre(const ServoScene& scene, const Approach& approach) {
  const RigidTransform partFromCentre{{1.0, 0.0, 0.0, 0.0}, scene.centreInPart};
  const double radius = 0.5 * scene.moving.geometry->mesh.bounds().diagonal();
  const double wobble = std::min(kScriptedWobble, kWobble * approach.reach / radius);
  std::vector<RigidTransform> path =
      scriptedHandPath(scene.moving.worldFromPart * partFromCentre, approach.direction, approach.reach,
                       kSweepSeconds, ServoLoop::kPeriod, wobble);
  const RigidTransform centreFromPart = partFromCentre.inverse();
  for (RigidTransform& pose : path)
    pose = pose * centreFromPart;
  return path;
}

/// Towards the middle of the other parts, when nothing is near.
Approach approachOfMiddle(const ServoScene& scene, double cutoff) {
  glm::dvec3 middle(0.0);
  for (const ServoScene::Body& body : scene.bodies) {
    middle += body.worldFromPart.applyToPoint(body.geometry->mesh.bounds().centre());
  }
  if (!scene.bodies.empty()) middle /= static_cast<double>(scene.bodies.size());
  const glm::dvec3 way = middle - scene.moving.worldFromPart.applyToPoint(scene.centreInPart);
  const double length = glm::length(way);
  return {length > 0.0 ? way / length : glm::dvec3(0.0, 0.0, -1.0), cutoff};
}

}  // namespace

std::unique_ptr<HapticDevice> makeHand(ui::Hand hand, const ServoScene& scene, double cutoff) {
  if (hand == ui::Hand::Manual) return std::make_unique<ManualDevice>();
  const std::optional<Approach> nearest = approachOfNearest(scene, cutoff);
  const Approach approach = nearest ? *nearest : approachOfMiddle(scene, cutoff);
  return std::make_unique<PathDevice>(sweepAboutCentre(scene, approach), true);
}

}  // namespace nearfit::desktop
