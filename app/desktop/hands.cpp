#include "app/desktop/hands.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/haptics/virtual_coupling.h"
#include "core/proximity/query/lmd_query.h"
#include "device/servo/servo_loop.h"
#include "device/simulated/replay_device.h"
#include "device/simulated/simulated_device.h"
#include "ui/widgets/paths.h"

namespace nearfit::desktop {
namespace {

constexpr double kSweepSeconds = 4.0;
/// Share of the gap to the nearest part that the scripted hand closes against springs: near enough to
/// feel, never through.
constexpr double kCloses = 0.75;
/// Travel of the part's ends in the wobble, as a share of the approach's reach.
constexpr double kWobble = 0.2;
/// Force of the scripted hand against contact [N]: clearly felt, and with what sliding adds still within the
/// limits of usual devices.
constexpr double kPress = 7.0;
/// Radius of its circle on contact, as a share of the depth that it presses beyond.
constexpr double kSlides = 0.5;
/// Largest depth beyond contact, as a share of the moving part's diagonal.
constexpr double kMaxBeyond = 0.05;

/// Direction in which the hand goes straight on, before it circles across.
struct Approach {
  glm::dvec3 direction{0.0};
  double gap = 0.0;  ///< Distance to the nearest part [m].
};

struct Sweep {
  glm::dvec3 direction{0.0};
  double reach, slide, wobble;  ///< [m], [m], [rad]
};

double sizeOf(const ServoScene& scene) {
  return scene.moving.geometry->mesh.bounds().diagonal();
}

/// Returns the approach to the nearest other part within the cutoff; std::nullopt if there is none.
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
    approach = Approach{-body.worldFromPart.applyToVector(lmds[0].direction), least};
  }
  return approach;
}

/// Returns the approach to the middle of the other parts, for when none is near.
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

/// Turns so little that the part's ends move less than the approach leaves of the gap.
Sweep sweepOfSprings(const ServoScene& scene, const Approach& approach) {
  const double reach = kCloses * approach.gap;
  return {approach.direction, reach, kScriptedSlide * reach,
          std::min(kScriptedWobble, kWobble * reach / (0.5 * sizeOf(scene)))};
}

/// Goes beyond contact, and in a circle on it.
Sweep sweepOfProxy(const ServoScene& scene, const Approach& approach, const CouplingSettings& wish) {
  const CouplingState coupling = boundedCoupling(wish, DeviceLimits{}, scene.metric, ServoLoop::kPeriod);
  const double most = kMaxBeyond * sizeOf(scene);
  const double beyond = coupling.stiffness > 0.0 ? std::min(kPress / coupling.stiffness, most) : most;
  return {approach.direction, approach.gap + beyond, kSlides * beyond, kScriptedWobble};
}

/// Turns about the part's centre of mass, wherever the file has its origin.
std::vector<RigidTransform> pathAboutCentre(const ServoScene& scene, const Sweep& sweep) {
  const RigidTransform partFromCentre{{1.0, 0.0, 0.0, 0.0}, scene.centreInPart};
  std::vector<RigidTransform> path =
      scriptedHandPath(scene.moving.worldFromPart * partFromCentre, sweep.direction, sweep.reach,
                       kSweepSeconds, ServoLoop::kPeriod, sweep.wobble, sweep.slide / sweep.reach);
  const RigidTransform centreFromPart = partFromCentre.inverse();
  for (RigidTransform& pose : path)
    pose = pose * centreFromPart;
  return path;
}

}  // namespace

std::optional<std::filesystem::path> recordingOf(const QString& device) {
  const QString prefix = QString::fromStdString(std::string(ReplayDevice::kPrefix));
  if (!device.startsWith(prefix)) return std::nullopt;
  return ui::toPath(device.mid(prefix.size()));
}

std::unique_ptr<HapticDevice> makeHand(ui::Hand hand, const ServoScene& scene,
                                       const HapticSettings& settings) {
  if (hand == ui::Hand::Manual) return std::make_unique<ManualDevice>();
  const double cutoff = settings.springs.cutoff;
  const std::optional<Approach> nearest = approachOfNearest(scene, cutoff);
  const Approach approach = nearest ? *nearest : approachOfMiddle(scene, cutoff);
  const Sweep sweep = settings.mode == HapticMode::Proxy ? sweepOfProxy(scene, approach, settings.coupling)
                                                         : sweepOfSprings(scene, approach);
  return std::make_unique<PathDevice>(pathAboutCentre(scene, sweep), true);
}

}  // namespace nearfit::desktop
