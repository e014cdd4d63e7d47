#include "ui/model/joint_names.h"

#include <QObject>
#include <QStringList>
#include <algorithm>
#include <iterator>
#include <unordered_set>

#include "ui/widgets/names.h"

namespace nearfit::ui {
namespace {

QString nameOfBase(const Scene& scene, const Joint& joint) {
  return joint.base ? shortName(scene.get(*joint.base).name) : QObject::tr("the world");
}

}  // namespace

std::vector<Joint> jointsOfParts(const Scene& scene, const std::vector<PartId>& parts) {
  const std::unordered_set<PartId> wanted(parts.begin(), parts.end());
  std::vector<Joint> joints;
  std::ranges::copy_if(scene.joints(), std::back_inserter(joints),
                       [&](const Joint& joint) { return wanted.contains(joint.part); });
  return joints;
}

QString jointText(const Scene& scene, const Joint& joint) {
  const QString base = nameOfBase(scene, joint);
  switch (joint.kind) {
    case JointKind::OnAxis:
      return QObject::tr("Kept on axis of %1").arg(base);
    case JointKind::InPlane:
      return QObject::tr("Kept in plane of %1").arg(base);
    default:
      return QObject::tr("Kept to point of %1").arg(base);
  }
}

int startOfJointText(const Scene& scene, const Joint& joint) {
  return std::max(0, jointText(scene, joint).lastIndexOf(nameOfBase(scene, joint)));
}

QString jointTexts(const Scene& scene, const std::vector<Joint>& joints) {
  QStringList lines;
  for (const Joint& joint : joints) {
    const QString text = jointText(scene, joint);
    lines << (joint.isOn ? text : QObject::tr("%1 (off)").arg(text));
  }
  return lines.join(QChar('\n'));
}

QString heldText(const Scene& scene, const std::vector<PartId>& parts) {
  for (const Joint& joint : jointsOfParts(scene, parts)) {
    const bool isInner = joint.base && std::ranges::count(parts, *joint.base) > 0;
    if (!joint.isOn || isInner) continue;
    const QString part = shortName(scene.get(joint.part).name), base = nameOfBase(scene, joint);
    switch (joint.kind) {
      case JointKind::OnAxis:
        return QObject::tr("%1 is kept on axis of %2: it moves along it and turns about it").arg(part, base);
      case JointKind::InPlane:
        return QObject::tr("%1 is kept in plane of %2: it moves in it and turns across it").arg(part, base);
      default:
        return QObject::tr("%1 is kept to point of %2: it only turns about it").arg(part, base);
    }
  }
  return {};
}

}  // namespace nearfit::ui
