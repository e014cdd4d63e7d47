#include "app/desktop/hands.h"

#include <array>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

#include "core/proximity/lmd_query.h"
#include "device/servo_loop.h"
#include "device/simulated_device.h"

namespace nearfit::desktop {
namespace {

constexpr double kSweepSeconds = 4.0;
/// Part of the gap to the nearest part that the scripted hand closes: near enough to feel, never through.
constexpr double kCloses = 0.8;

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
        findLmds(body.geometry->tree, scene.moving.geometry->tree, bodyFromPart, cutoff, scratch, lmds);
    if (result.count == 0 || lmds[0].distance >= least) continue;
    least = lmds[0].distance;
    approach = Approach{-body.worldFromPart.applyToVector(lmds[0].direction), kCloses * least};
  }
  return approach;
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
  return std::make_unique<PathDevice>(scriptedHandPath(scene.moving.worldFromPart, approach.direction,
                                                       approach.reach, kSweepSeconds, ServoLoop::kPeriod),
                                      true);
}

}  // namespace nearfit::desktop
