#include "ui/model/part_cells.h"

#include <QPainter>
#include <QPixmap>
#include <QPixmapCache>
#include <algorithm>
#include <vector>

#include "core/scene/scene_tree.h"
#include "ui/model/joint_names.h"
#include "ui/model/parts_model.h"
#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Otherwise the style tints icons in selected rows until they look disabled.
QIcon sameWhenSelected(const QPixmap& pixmap) {
  QIcon result(pixmap);
  result.addPixmap(pixmap, QIcon::Selected);
  return result;
}

QIcon listIcon(const QString& name) {
  constexpr int kSize = 36;
  const QString key = QStringLiteral("nearfit-list-%1-%2").arg(name).arg(isThemeDark() ? 1 : 0);
  QPixmap pixmap;
  if (!QPixmapCache::find(key, &pixmap)) {
    pixmap = icon(name).pixmap(kSize, kSize);
    QPixmapCache::insert(key, pixmap);
  }
  return sameWhenSelected(pixmap);
}

/// Draws a square in a part's colour and opacity.
QIcon swatch(const Colour& colour, double opacity) {
  constexpr int kSize = 32;
  QPixmap pixmap(kSize, kSize);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  QColor fill = QColor::fromRgbF(static_cast<double>(colour.r), static_cast<double>(colour.g),
                                 static_cast<double>(colour.b));
  painter.setPen(QPen(fill.darker(150), 2.0));
  fill.setAlphaF(opacity);
  painter.setBrush(fill);
  painter.drawRoundedRect(QRectF(4, 4, 24, 24), 6, 6);
  return sameWhenSelected(pixmap);
}

enum class Shown { None, Some, All };

Shown shownOf(const Scene& scene, const Group& group) {
  const std::vector<PartId> parts = partsOf(scene, {{}, {group.id}});
  const auto shown = std::ranges::count_if(parts, [&](PartId part) { return scene.find(part)->isVisible; });
  if (shown == 0 && !parts.empty()) return Shown::None;
  return static_cast<std::size_t>(shown) == parts.size() ? Shown::All : Shown::Some;
}

}  // namespace

QIcon PartCell::picture(int column) const {
  switch (column) {
    case PartsModel::Name:
      return swatch(part_.colour, part_.opacity);
    case PartsModel::Moving:
      return listIcon(scene_.isMoving(part_.id) ? QStringLiteral("hand") : QStringLiteral("hand-off"));
    case PartsModel::Visible:
      return listIcon(part_.isVisible ? QStringLiteral("eye") : QStringLiteral("eye-off"));
    case PartsModel::Locked:
      return listIcon(scene_.isLocked(part_) ? QStringLiteral("lock") : QStringLiteral("unlock"));
    case PartsModel::Joints: {
      const std::vector<Joint> joints = jointsOfParts(scene_, {part_.id});
      if (joints.empty()) return {};
      const bool isOn = std::ranges::any_of(joints, &Joint::isOn);
      return listIcon(isOn ? QStringLiteral("joint") : QStringLiteral("joint-off"));
    }
    case PartsModel::Findings:
      if (badge_ == nullptr) return {};
      return listIcon(badge_->worst == FindingSeverity::Note ? QStringLiteral("findings-note")
                                                             : QStringLiteral("findings"));
    default:
      return {};
  }
}

QString PartCell::toolTip(int column) const {
  switch (column) {
    case PartsModel::Moving:
      return handText();
    case PartsModel::Visible:
      return part_.isVisible ? tr("Shown and felt. Click to hide it.")
                             : tr("Hidden and not felt. Click to show it.");
    case PartsModel::Locked:
      return lockText();
    case PartsModel::Joints:
      return jointText();
    case PartsModel::Findings:
      if (badge_ == nullptr) return {};
      return (badge_->canBeRepaired ? tr("%1\nClick to see where, and to repair it")
                                    : tr("%1\nClick to see where, and why it cannot be repaired"))
          .arg(badge_->text);
    default:
      return description();
  }
}

QString PartCell::handText() const {
  if (!scene_.isMoving(part_.id)) return tr("Click to take it in hand");
  if (!scene_.movingGroup()) return tr("In hand");
  return tr("In hand with its group %1")
      .arg(QString::fromStdString(scene_.findGroup(*scene_.movingGroup())->name));
}

QString PartCell::lockText() const {
  if (part_.isLocked) return tr("Locked. Click to unlock it.");
  return scene_.isLocked(part_) ? tr("Locked by its group") : tr("Unlocked. Click to lock it.");
}

QString PartCell::jointText() const {
  const std::vector<Joint> joints = jointsOfParts(scene_, {part_.id});
  if (joints.empty()) return tr("Not kept by joints");
  const bool isOn = std::ranges::any_of(joints, &Joint::isOn);
  return jointTexts(scene_, joints) + '\n' + (isOn ? tr("Click to turn off") : tr("Click to turn on"));
}

QString PartCell::description() const {
  const TriangleMesh& mesh = part_.geometry->mesh;
  const glm::dvec3 size = mesh.bounds().upper - mesh.bounds().lower;
  QString text =
      tr("%1\n%2\n%L3 triangles, %4 × %5 × %6")
          .arg(QString::fromStdString(part_.name), QString::fromStdString(part_.geometry->file.string()))
          .arg(mesh.triangles().size())
          .arg(formatLength(size.x), formatLength(size.y), formatLength(size.z));
  if (part_.geometry->isExact) {
    text += '\n' + tr("Of exact surfaces, triangles within %1 of them")
                       .arg(formatLength(part_.geometry->effectiveTessellation.chord));
  }
  for (const std::string& warning : part_.geometry->report.warnings)
    text += '\n' + QString::fromStdString(warning);
  if (!part_.geometry->repairs.empty()) text += '\n' + tr("Repaired in this scene; its file is as it was");
  return text;
}

QIcon GroupCell::picture(int column) const {
  switch (column) {
    case PartsModel::Name:
      return listIcon(QStringLiteral("folder"));
    case PartsModel::Moving:
      return listIcon(scene_.movingGroup() == group_.id ? QStringLiteral("hand")
                                                        : QStringLiteral("hand-off"));
    case PartsModel::Visible: {
      const Shown shown = shownOf(scene_, group_);
      return listIcon(shown == Shown::All    ? QStringLiteral("eye")
                      : shown == Shown::Some ? QStringLiteral("eye-part")
                                             : QStringLiteral("eye-off"));
    }
    case PartsModel::Locked:
      return listIcon(scene_.isLocked(group_) ? QStringLiteral("lock") : QStringLiteral("unlock"));
    default:
      return {};
  }
}

QString GroupCell::toolTip(int column) const {
  switch (column) {
    case PartsModel::Name: {
      const std::size_t parts = partsOf(scene_, {{}, {group_.id}}).size();
      const QString name = QString::fromStdString(group_.name);
      return parts == 1 ? tr("%1\n1 part").arg(name) : tr("%1\n%2 parts").arg(name).arg(parts);
    }
    case PartsModel::Moving:
      return scene_.movingGroup() == group_.id ? tr("In hand: its parts move as one")
                                               : tr("Click to take it in hand: its parts then move as one");
    case PartsModel::Visible:
      return shownOf(scene_, group_) == Shown::All ? tr("All shown and felt. Click to hide them.")
                                                   : tr("Not all shown. Click to show them.");
    case PartsModel::Locked:
      return group_.isLocked           ? tr("Locked with all its contents. Click to unlock it.")
             : scene_.isLocked(group_) ? tr("Locked by its group")
                                       : tr("Unlocked. Click to lock it with all its contents.");
    default:
      return {};
  }
}

}  // namespace nearfit::ui
