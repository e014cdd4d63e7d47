#include "ui/panels/clearance/map_probe.h"

#include <QMouseEvent>
#include <QTimer>
#include <algorithm>
#include <utility>

#include "ui/model/shown_poses.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"

namespace nearfit::ui {
namespace {

constexpr QPoint kBesidePointer(16, 18);  ///< [pixels]

}  // namespace

MapProbe::MapProbe(Viewport& view, const Session& session) : QLabel(&view), view_(view), session_(session) {
  setObjectName(QStringLiteral("clearanceProbe"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setStyleSheet(
      QStringLiteral("#clearanceProbe { background: rgba(28, 37, 46, 225); color: white; border-radius: 5px; "
                     "padding: 3px 7px; font-weight: 600; }"));
  hide();
  view.installEventFilter(this);
}

void MapProbe::setMap(std::shared_ptr<const ShownMap> map) {
  map_ = std::move(map);
  if (map_ == nullptr) return hide();
  if (isVisible()) probe();
}

bool MapProbe::eventFilter(QObject* watched, QEvent* event) {
  if (watched != &view_ || map_ == nullptr) return QLabel::eventFilter(watched, event);
  if (event->type() == QEvent::Leave || event->type() == QEvent::MouseButtonPress) hide();
  if (event->type() == QEvent::MouseMove) {
    const auto& mouse = static_cast<const QMouseEvent&>(*event);
    pointer_ = mouse.pos();
    // One pick for all moves that have arrived, and none during a drag.
    if (mouse.buttons() == Qt::NoButton && !std::exchange(isQueued_, true))
      QTimer::singleShot(0, this, &MapProbe::probe);
  }
  return QLabel::eventFilter(watched, event);
}

void MapProbe::probe() {
  isQueued_ = false;
  const QString text = map_ != nullptr ? textAt(pointer_) : QString();
  if (text.isEmpty()) return hide();
  setText(text);
  adjustSize();
  const QPoint at = pointer_ + kBesidePointer, most(view_.width() - width(), view_.height() - height());
  move(std::max(0, std::min(at.x(), most.x())), std::max(0, std::min(at.y(), most.y())));
  show();
}

QString MapProbe::textAt(const QPoint& position) const {
  const auto isNearAt = [this](PartId id, std::uint32_t triangle, const glm::dvec3& point) {
    const MappedSurface* surface = map_->map.find(id);
    return surface != nullptr && clearanceAt(*surface, triangle, point).has_value();
  };
  const std::optional<PickedPoint> seen = view_.pointAt(position, SeenThrough::Never, isNearAt);
  const MappedSurface* mapped = seen && seen->cut == nullptr ? map_->map.find(seen->part) : nullptr;
  const Part* part = mapped != nullptr ? session_.scene().find(seen->part) : nullptr;
  if (part == nullptr) return {};
  const glm::dvec3 point = view_.poses().shownPoseOf(*part).inverse().applyToPoint(seen->point);
  const std::optional<double> clearance = clearanceAt(*mapped, seen->triangle, point);
  if (!clearance) return tr("beyond %1").arg(formatLength(map_->map.range));
  return *clearance < -kContactDistance ? tr("%1 deep").arg(formatLength(-*clearance))
                                        : formatLength(*clearance);
}

}  // namespace nearfit::ui
