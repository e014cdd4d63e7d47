// The servo's tick over small meshes, led by a hand that says anything: numbers that are none come to nothing
// but a fault, what is shown and sent are poses and finite wrenches within the limits, and in the proxy mode
// the part meets nothing that it did not meet at the start.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/mesh/mass_properties.h"
#include "core/scene/haptic_limits.h"
#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/exact/pose_certifier.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/small_mesh.h"

namespace nearfit::fuzz {
namespace {

constexpr double kPeriod = 1e-3;
constexpr int kMaxTicks = 12;

PartGeometryPtr geometryOf(TriangleMesh mesh) {
  const MassProperties mass = massProperties(mesh);
  auto geometry = std::make_shared<const PartGeometry>(PartGeometry{.file = "/fuzz.obj",
                                                                    .sha256 = std::string(64, '0'),
                                                                    .metresPerUnit = 1.0,
                                                                    .mesh = std::move(mesh),
                                                                    .report = {},
                                                                    .mass = mass});
  geometry->tree();
  return geometry;
}

std::shared_ptr<ServoScene> makeScene(ByteSource& bytes) {
  auto scene = std::make_shared<ServoScene>();
  const std::size_t bodies = 1 + bytes.below(2);
  const RigidTransform start = smallPose(bytes);
  auto part = smallMesh(bytes);
  if (!part) return nullptr;
  scene->setMoving({PartId{1}, geometryOf(std::move(*part)), start});
  for (std::uint32_t i = 0; i < bodies; ++i) {
    const RigidTransform pose = smallPose(bytes);
    if (auto mesh = smallMesh(bytes)) {
      scene->bodies.push_back({PartId{2 + i}, geometryOf(std::move(*mesh)), pose});
    }
  }
  scene->prepareSurfaces();
  return scene;
}

/// Mostly such as may be set; else anything.
ServoParameters makeParameters(ByteSource& bytes) {
  ServoParameters p;
  const std::uint8_t bits = bytes.byte();
  p.haptics.mode = (bits & 1U) != 0 ? HapticMode::Springs : HapticMode::Proxy;
  p.haptics.springs.law = (bits & 2U) != 0 ? SpringLaw::Printed : SpringLaw::Linear;
  p.haptics.weight = {(bits & 4U) != 0, (bits & 8U) != 0, p.haptics.weight.gravity};
  p.haptics.mapping.translationLocks[0] = (bits & 16U) != 0;
  p.haptics.mapping.rotationLocks[1] = (bits & 32U) != 0;
  p.haptics.springs.cutoff = std::abs(bytes.number());
  p.haptics.proxy.margin = 0.1 * std::abs(bytes.number());
  p.haptics.proxy.friction = (bits & 64U) != 0 ? std::abs(bytes.number()) : 0.0;
  if ((bits & 128U) != 0) {
    p.haptics.coupling.isAutomatic = false;
    p.haptics.coupling.stiffness = std::abs(bytes.number());
    p.haptics.coupling.damping = std::abs(bytes.number());
    p.haptics.mapping.scale = std::abs(bytes.number());
    p.limits.maxForce = bytes.number();
  }
  return p;
}

bool areAllowed(const ServoParameters& p) {
  try {
    checkHaptics(p.haptics);
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

void checkSnapshot(const ServoSnapshot& s, const ServoParameters& p) {
  require(isPose(s.proxy), "the part's pose is one");
  require(isPose(s.handle), "the handle's pose is one");
  require(isFinite(s.wrench.force) && isFinite(s.wrench.torque), "the wrench is finite");
  require(isFinite(s.deviceWrench.force) && isFinite(s.deviceWrench.torque), "what is sent is finite");
  require(!std::isnan(s.distance) && std::isfinite(s.energyToHand), "distance and energy are numbers");
  require(s.storedLmds <= ServoSnapshot::kMaxLmds && s.storedContacts <= ServoSnapshot::kMaxContacts,
          "no more is shown than there is room for");
  if (s.fault != ServoFault::None) {
    require(s.wrench.force == glm::dvec3(0.0) && s.wrench.torque == glm::dvec3(0.0), "a fault sends nothing");
    return;
  }
  constexpr double kRounding = 1.0 + 1e-12;
  require(glm::length(s.deviceWrench.force) <= p.limits.maxForce * kRounding,
          "the force is within its limit");
  for (std::size_t i = 0; i < s.storedContacts; ++i) {
    require(isFinite(s.contacts[i].point) && isFinite(s.contacts[i].direction) &&
                std::isfinite(s.contacts[i].force),
            "contacts are finite");
  }
}

/// Which bodies the part is clear of at the start and must never meet.
class Guard {
 public:
  Guard(const ServoScene& scene, const RigidTransform& start) : scene_(scene) {
    for (const ServoScene::Body& body : scene.bodies) {
      certifiers_.emplace_back(body.geometry->mesh, scene.moving.geometry->mesh);
      isClear_.push_back(isPromised(body.geometry->mesh, scene.moving.geometry->mesh, poseIn(body, start)) &&
                         !certifiers_.back().doMeet(poseIn(body, start)));
    }
  }

  /// Such as count as overlapping since nothing tells them apart from touching.
  void releaseThoseOf(const ServoSnapshot& s) {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      for (std::uint32_t k = 0; k < s.overlappingCount; ++k) {
        if (s.overlapping[k] == scene_.bodies[i].id) isClear_[i] = false;
      }
    }
  }

  void check(const RigidTransform& pose) const {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const ServoScene::Body& body = scene_.bodies[i];
      require(!isClear_[i] || !certifiers_[i].doMeet(poseIn(body, pose)),
              "the part meets nothing that it did not meet at the start");
    }
  }

 private:
  static RigidTransform poseIn(const ServoScene::Body& body, const RigidTransform& pose) {
    return (body.worldFromPart.inverse() * pose).normalized();
  }

  const ServoScene& scene_;
  std::vector<test::PoseCertifier> certifiers_;
  std::vector<bool> isClear_;
};

void run(ByteSource& bytes) {
  const ServoParameters parameters = makeParameters(bytes);
  const bool isTracked = bytes.flag() && areAllowed(parameters);
  const std::shared_ptr<ServoScene> scene = makeScene(bytes);
  if (!scene) return;
  const RigidTransform start = scene->moving.worldFromPart;
  const bool isGuarded = parameters.haptics.mode == HapticMode::Proxy && areAllowed(parameters);
  Guard guard(*scene, start);
  TrackedScene tracked = untracked(scene);
  // With their megabytes of work space kept: another part is all that they remember nothing across.
  static SceneTracker tracker;
  static const auto tick = std::make_unique<ServoTick>();
  static const auto snapshot = std::make_unique<ServoSnapshot>();
  if (isTracked) tracker.setScene(scene);
  tick->reset();
  *snapshot = {};
  snapshot->proxy = snapshot->handle = start;
  RigidTransform hand = start;
  bool isFirst = true;
  for (int i = 0; i < kMaxTicks && !bytes.isEmpty(); ++i) {
    const std::uint8_t kind = bytes.byte();
    if (kind < 16) {
      hand = bytes.anyPose();
    } else if (kind < 128) {
      hand.translation += bytes.vector();
    } else if (kind < 200) {
      hand = smallPose(bytes);
    }
    const SearchReach reach = searchReach(parameters.haptics);
    if (isTracked) {
      if (i > 0) tracker.update(observationOf(*snapshot), 1.0);
      if (tracker.isDue(reach)) tracker.refresh(reach, tracked);
    }
    const double period = kind == 255 ? bytes.number() : kPeriod;
    const HandleInput input{
        .pose = hand, .age = kind == 254 ? bytes.number() : 0.0, .isClutched = kind == 253};
    tick->run(tracked, parameters, input, period, *snapshot);
    ++snapshot->tick;
    checkSnapshot(*snapshot, parameters);
    if (snapshot->isWaiting || !isGuarded) continue;
    if (isFirst) guard.releaseThoseOf(*snapshot);
    isFirst = false;
    guard.check(snapshot->proxy);
  }
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
