#include "core/placing/solid_move.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/mesh/mass_properties.h"
#include "core/scene/haptic_limits.h"
#include "core/servo/servo_bodies.h"

namespace nearfit {
namespace {

/// Turn scale that bars rotation, up to rounding, in pure translations: the cost of a rotation grows with the
/// square of this factor.
constexpr double kTurnBarred = 1e4;
/// The parts have settled if they move less than this fraction of the margin for kStillTicks ticks.
constexpr double kStill = 1e-3;
constexpr int kStillTicks = 3;
/// The parts are held if they move less than this fraction of the final margin although the
/// target is farther.
constexpr double kNoMove = 0.02;
/// Max ticks to wait for the candidate lists of a crowded place.
constexpr int kPatience = 40;
/// Ticks between two checks for cancellation.
constexpr int kTicksAtOnce = 50;

bool turns(const RigidTransform& motion) {
  return motion.rotation.x != 0.0 || motion.rotation.y != 0.0 || motion.rotation.z != 0.0;
}

/// Joins the meshes that are searched, in the frame of `worldFromAll`. Where meshes cross, the result has no inside, and
/// contact counts from either side.
PartGeometryPtr joined(std::span<const Part* const> parts, const RigidTransform& worldFromAll) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (const Part* part : parts) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const RigidTransform allFromPart = (worldFromAll.inverse() * part->worldFromPart).normalized();
    const TriangleMesh& mesh = part->geometry->tree().mesh();
    for (const glm::dvec3& vertex : mesh.vertices())
      vertices.push_back(allFromPart.applyToPoint(vertex));
    for (const Triangle& t : mesh.triangles())
      triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  PartGeometry geometry;
  geometry.mesh = TriangleMesh(std::move(vertices), std::move(triangles));
  geometry.mass = massProperties(geometry.mesh);
  return std::make_shared<const PartGeometry>(std::move(geometry));
}

/// Builds a servo scene in which some parts, as one rigid body, are the moving part among all other visible
/// parts. A single part stays as it is, in its own frame; several become one mesh, in the frame of the first.
/// Invisible parts are left out; if no moved part remains, nothing can be touched. Builds missing hierarchies.
/// @param moved  Not empty.
/// Throws UsageError if a part is not in the scene; Cancelled.
std::shared_ptr<const ServoScene> makePlacingScene(const Scene& scene, std::span<const PartId> moved,
                                                   const ProgressCallback& progress) {
  const Part& first = scene.get(moved.front());
  std::vector<const Part*> felt;
  for (const PartId id : moved) {
    const Part& part = scene.get(id);
    if (part.isVisible && part.geometry != nullptr) felt.push_back(&part);
  }
  auto result = std::make_shared<ServoScene>();
  if (moved.size() == 1) result->setJoints(jointsOf(scene, first.id));
  if (felt.empty()) {
    result->setMoving({first.id, nullptr, first.worldFromPart});
    return result;
  }
  const bool isAlone = felt.size() == 1 && felt.front() == &first;
  result->setMoving(
      {first.id, isAlone ? first.geometry : joined(felt, first.worldFromPart), first.worldFromPart});
  const auto isMoved = [&](PartId id) { return std::ranges::find(moved, id) != moved.end(); };
  addBodies(*result, scene, isMoved, progress);
  return result;
}

}  // namespace

SolidMove::SolidMove(const Scene& scene, std::span<const PartId> moved, const ProgressCallback& progress)
    : scene_(makePlacingScene(scene, moved, progress)),
      settings_{scene.haptics().proxy.margin, 0.0},
      reach_{kContactReach * settings_.margin, kContactReach * settings_.margin},
      proxy_(std::make_unique<Proxy>()),
      start_(scene_->moving.worldFromPart),
      pose_(start_),
      margin_(settings_.margin) {
  for (const PartId id : moved) {
    const RigidTransform& worldFromPart = scene.find(id)->worldFromPart;
    startPoses_.push_back(worldFromPart);
    bodyFromPart_.push_back((start_.inverse() * worldFromPart).normalized());
  }
  poses_ = startPoses_;
  tracker_.setScene(scene_);
  proxy_->place(start_);
}

RigidTransform SolidMove::onJoints(const RigidTransform& target, double turnScale) const noexcept {
  if (scene_->joints.isEmpty()) return target;
  MassMetric metric = scene_->metric;
  metric.gyration *= turnScale;
  return scene_->joints.nearestPose(target, scene_->centreInPart, metric);
}

SolidMove::Progress SolidMove::advance(const RigidTransform& motion, int ticks) {
  const double turnScale = turns(motion) ? 1.0 : kTurnBarred;
  const RigidTransform target = onJoints(motion * start_, turnScale);
  if (scene_->moving.geometry == nullptr) pose_ = target;
  if (marginAtEnd_ == 0.0) findStartDistance();
  if (motion != wanted_) keepMargin(margin_);
  wanted_ = motion;
  settle(target, turnScale, ticks);
  updatePoses();
  if (pose_ == target && scene_->joints.isEmpty()) {
    // Exactly at the target, for several parts too.
    for (std::size_t i = 0; i < poses_.size(); ++i)
      poses_[i] = motion * startPoses_[i];
  }
  return {isSettled_, pose_ == target};
}

void SolidMove::settle(const RigidTransform& target, double turnScale, int ticks) {
  isSettled_ = pose_ == target;
  for (int i = 0; i < ticks && !isSettled_; ++i) {
    const RigidTransform before = pose_;
    const bool isWaiting = tick(target, turnScale);
    const bool isStill = travelBetween(*scene_, before, pose_) < kStill * settings_.margin;
    waited_ = isWaiting && isStill ? waited_ + 1 : 0;
    still_ = isStill && !isWaiting ? still_ + 1 : 0;
    isSettled_ = pose_ == target || still_ >= kStillTicks || waited_ >= kPatience;
    // They have gone as far as the margin allows; the final margin allows a little more.
    if (isSettled_ && pose_ != target && settings_.margin > marginAtEnd_) keepMargin(marginAtEnd_);
  }
  // Resting parts end a hundredth nearer than they began. Without this, repeated pushes would
  // make them creep.
  const double gone = travelBetween(*scene_, start_, pose_);
  isHeld_ = isSettled_ && pose_ != target && gone < kNoMove * marginAtEnd_ &&
            gone < 0.5 * travelBetween(*scene_, start_, target);
}

void SolidMove::keepMargin(double margin) {
  settings_.margin = margin;
  still_ = waited_ = 0;
  isSettled_ = false;
}

/// Holds the parts still until their surroundings are known.
void SolidMove::findStartDistance() {
  marginAtEnd_ = margin_;
  if (scene_->moving.geometry == nullptr) return;
  int ticks = 0;
  while (tick(start_, kTurnBarred) && ++ticks < kPatience) {
  }
  if (ticks < kPatience) marginAtEnd_ = std::clamp(proxy_->distance(), kMinMargin, margin_);
}

/// Runs one tick. True if the proxy waits for missing information.
bool SolidMove::tick(const RigidTransform& target, double turnScale) {
  const ProxyAccount& last = proxy_->account();
  tracker_.update({pose_, target, last.isWaiting, last.isStarved}, 1.0);
  if (tracker_.isDue(reach_)) tracker_.refresh(reach_, tracked_);
  proxy_->follow(tracked_, target, settings_, turnScale);
  pose_ = proxy_->pose();
  return proxy_->account().isWaiting || proxy_->account().isStarved;
}

void SolidMove::updatePoses() {
  if (reached() == start_) {
    poses_ = startPoses_;
    return;
  }
  for (std::size_t i = 0; i < poses_.size(); ++i)
    poses_[i] = startPoses_[i] == start_ ? pose_ : (pose_ * bodyFromPart_[i]).normalized();
}

RigidTransform SolidMove::motion() const noexcept {
  return reached() == start_ ? RigidTransform{} : (pose_ * start_.inverse()).normalized();
}

std::vector<PartId> SolidMove::idsOf(const std::vector<std::uint32_t>& bodies) const {
  std::vector<PartId> ids;
  ids.reserve(bodies.size());
  for (const std::uint32_t body : bodies)
    ids.push_back(scene_->bodies[body].id);
  std::ranges::sort(ids);
  const auto repeated = std::ranges::unique(ids);
  ids.erase(repeated.begin(), repeated.end());
  return ids;
}

std::vector<PartId> SolidMove::touching() const {
  std::vector<std::uint32_t> bodies;
  for (const ProxyContact& holding : proxy_->contacts())
    bodies.push_back(holding.contact.body);
  return idsOf(bodies);
}

std::vector<PartId> SolidMove::overlapping() const {
  const auto& bodies = tracked_.clearance.overlapping;
  return bodies ? idsOf(*bodies) : std::vector<PartId>{};
}

std::vector<RigidTransform> movedSolidly(const Scene& scene, std::span<const PartId> moved,
                                         const RigidTransform& motion, const ProgressCallback& progress) {
  SolidMove move(scene, moved, progress);
  for (int ticks = 0; ticks < SolidMove::kMaxTicks; ticks += kTicksAtOnce) {
    if (progress && !progress(static_cast<double>(ticks) / SolidMove::kMaxTicks)) throw Cancelled();
    if (move.advance(motion, kTicksAtOnce).isSettled) break;
  }
  return move.poses();
}

}  // namespace nearfit
