#include "core/placing/keep.h"

#include <span>
#include <utility>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

bool hasAxis(FeatureShape shape) noexcept {
  return shape == FeatureShape::Axis || shape == FeatureShape::Circle;
}

JointFeature featureOf(JointKind kind, const AlignFeature& feature) {
  if (kind == JointKind::ToPoint) return {feature.point, JointFeature{}.direction};
  return {feature.point, feature.direction};
}

}  // namespace

std::optional<JointKind> jointKindOf(FeatureShape onPart, FeatureShape onBase) noexcept {
  if (hasAxis(onPart) && hasAxis(onBase)) return JointKind::OnAxis;
  if (onPart != onBase) return std::nullopt;
  return onPart == FeatureShape::Plane ? JointKind::InPlane : JointKind::ToPoint;
}

Joint jointBetween(JointKind kind, const FeatureAt& kept, const FeatureAt& base, double gap) {
  Joint joint;
  joint.kind = kind;
  joint.part = kept.part;
  joint.base = base.part;
  joint.onPart = featureOf(kind, kept.inPart);
  joint.onBase = featureOf(kind, base.inPart);
  if (kind == JointKind::ToPoint) return joint;
  const double along = glm::dot(kept.worldFromPart.applyToVector(joint.onPart.direction),
                                base.worldFromPart.applyToVector(joint.onBase.direction));
  // Directions of axes have no sign; a joint in a plane holds them against each other.
  if (kind == JointKind::OnAxis ? along < 0.0 : along > 0.0) joint.onPart.direction = -joint.onPart.direction;
  if (kind == JointKind::InPlane) joint.onBase.point += gap * joint.onBase.direction;
  return joint;
}

RigidTransform worldFromBase(const Scene& scene, const Joint& joint) {
  return joint.base ? scene.get(*joint.base).worldFromPart : RigidTransform{};
}

JointSet::Placed placedJoint(const Joint& joint, const RigidTransform& worldFromBase) {
  const glm::dvec3 direction = glm::normalize(worldFromBase.applyToVector(joint.onBase.direction));
  return {joint.kind, joint.onPart, worldFromBase.applyToPoint(joint.onBase.point),
          joint.kind == JointKind::InPlane ? -direction : direction};
}

std::optional<RigidTransform> keptPose(const Scene& scene, const Joint& joint, const RigidTransform& wanted) {
  Scene kept = scene;
  Part part = kept.get(joint.part);
  kept.addJoint(joint);
  part.worldFromPart = wanted;
  const glm::dvec3 centre = part.geometry != nullptr ? part.geometry->mass.centre : glm::dvec3(0.0);
  kept.replace(std::move(part));
  const JointSet joints = jointsOf(kept, joint.part);
  if (joints.isContradictory()) return std::nullopt;
  return joints.nearestPose(wanted, centre);
}

bool isViolated(const Joint& joint, const RigidTransform& worldFromBase,
                const RigidTransform& worldFromPart) {
  if (!joint.isOn) return false;
  const JointSet::Placed alone = placedJoint(joint, worldFromBase);
  const JointResidual off = JointSet(std::span(&alone, 1), worldFromPart).residual(worldFromPart);
  return off.distance > JointSet::kMaxMisfit || off.angle > JointSet::kMaxMisfitAngle;
}

}  // namespace nearfit
