#include "ui/tools/placing/shown_joints.h"

#include <QEvent>
#include <algorithm>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/placing/keep.h"
#include "ui/model/joint_names.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {
namespace {

/// Half the length of a drawn cross, and half the side of a square, as fractions of the part's diagonal.
constexpr double kCrossReach = 0.08, kSquareReach = 0.16;
/// How far an axis is drawn beyond the parts, as a fraction of its length in them.
constexpr double kBeyond = 0.1;

/// Where boxes lie along an axis.
struct Extent {
  double lower = 0.0, upper = 0.0;
};

/// @param origin, direction  In the box's frame.
Extent extentAlong(const Aabb& box, const glm::dvec3& origin, const glm::dvec3& direction) {
  // The box's corners are farthest where each coordinate adds most.
  const double middle = glm::dot(box.centre() - origin, direction);
  const double half = glm::dot(0.5 * (box.upper - box.lower), glm::abs(direction));
  return {middle - half, middle + half};
}

}  // namespace

ShownJoints::ShownJoints(const Session& session, const Selection& selection, Viewport& view, QObject* parent)
    : QObject(parent), session_(session), selection_(selection), view_(view), drawn_(view.overlay()) {
  view.installEventFilter(this);
  connect(&selection, &Selection::changed, this, &ShownJoints::refresh);
  // Comes with each change of the scene too.
  connect(&view, &Viewport::posesChanged, this, &ShownJoints::refresh);
  refresh();
}

ShownJoints::~ShownJoints() = default;

bool ShownJoints::eventFilter(QObject* watched, QEvent* event) {
  // The colours are those of the theme.
  if (event->type() == QEvent::PaletteChange && !marks_.empty()) drawn_.show(marks_);
  return QObject::eventFilter(watched, event);
}

void ShownJoints::refresh() {
  const Scene& scene = session_.scene();
  std::vector<PartId> parts = selection_.parts();
  const std::vector<PartId> moving = scene.movingParts();
  parts.insert(parts.end(), moving.begin(), moving.end());
  std::vector<JointMark> marks;
  for (const Joint& joint : scene.joints().empty() ? std::vector<Joint>{} : jointsOfParts(scene, parts)) {
    const Part& part = scene.get(joint.part);
    if (joint.isOn && part.isVisible && part.geometry != nullptr) marks.push_back(markOf(joint, part));
  }
  if (marks.empty() && marks_.empty()) return;
  marks_ = std::move(marks);
  drawn_.show(marks_);
  view_.requestRender();
}

JointMark ShownJoints::markOf(const Joint& joint, const Part& part) const {
  const Part* base = joint.base ? session_.scene().find(*joint.base) : nullptr;
  const RigidTransform worldFromPart = view_.poses().shownPoseOf(part);
  const RigidTransform worldFromBase = base != nullptr ? view_.poses().shownPoseOf(*base) : RigidTransform{};
  const JointSet::Placed placed = placedJoint(joint, worldFromBase);
  const glm::dvec3 feature = worldFromPart.applyToPoint(joint.onPart.point);
  const double size = part.geometry->mesh.bounds().diagonal();
  JointMark mark{joint.kind, placed.place, placed.target, kCrossReach * size, {}};
  if (joint.kind == JointKind::InPlane) {
    mark.middle = feature + glm::dot(placed.place - feature, placed.target) * placed.target;
    mark.reach = kSquareReach * size;
  } else if (joint.kind == JointKind::OnAxis) {
    const auto extentOf = [&](const Part& along, const RigidTransform& worldFromAlong) {
      const RigidTransform inverse = worldFromAlong.inverse();
      return extentAlong(along.geometry->mesh.bounds(), inverse.applyToPoint(placed.place),
                         inverse.applyToVector(placed.target));
    };
    Extent extent = extentOf(part, worldFromPart);
    if (base != nullptr && base->geometry != nullptr) {
      const Extent ofBase = extentOf(*base, worldFromBase);
      extent = {std::min(extent.lower, ofBase.lower), std::max(extent.upper, ofBase.upper)};
    }
    mark.middle += 0.5 * (extent.lower + extent.upper) * placed.target;
    mark.reach = (0.5 + kBeyond) * (extent.upper - extent.lower);
  }
  if (isViolated(joint, worldFromBase, worldFromPart)) mark.strayed = feature;
  return mark;
}

}  // namespace nearfit::ui
