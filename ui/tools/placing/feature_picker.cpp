#include "ui/tools/placing/feature_picker.h"

#include <QApplication>
#include <QKeyEvent>
#include <QShortcut>
#include <QTimer>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "ui/model/shown_poses.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/names.h"

namespace nearfit::ui {
namespace {

/// Max distance of the pointer from a corner or edge to pick it [pixels].
constexpr double kReach = 8.0;
/// Where an outline is looked for around a pointer beside it [pixels]; within kReach, so that some of it is left.
constexpr std::array kOutlineRadii{2, 4, 6};
/// A straight outline at the pointer crosses a ring of so many places, whatever its direction.
constexpr int kOutlineDirections = 8;

/// A diameter in as many figures as measured distances have.
QString diameterText(double radius) {
  const LengthUnit unit = shownLengthUnit();
  return lengthIn(unit, 2.0 * radius, measuredDecimals(unit, 2.0 * radius));
}

QString withSmallInitial(const QString& text) {
  return text.left(1).toLower() + text.mid(1);
}

QString describeTorus(const AlignFeature& torus) {
  return QObject::tr("Torus ⌀ %1, tube ⌀ %2")
      .arg(diameterText(torus.radius), diameterText(torus.minorRadius));
}

QString describeAxis(const AlignFeature& axis) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  if (axis.flats > 0) return QObject::tr("Axis of a prism with %1 flats").arg(axis.flats);
  if (axis.halfAngle > 0.0)
    return QObject::tr("Axis of a cone, half angle %1°").arg(formatFixed(axis.halfAngle / kDegree, 1));
  if (axis.radius > 0.0) return QObject::tr("Axis of a cylinder ⌀ %1").arg(diameterText(axis.radius));
  return QObject::tr("Straight edge");
}

QString describeShape(const AlignFeature& feature) {
  switch (feature.shape) {
    case FeatureShape::Plane:
      return QObject::tr("Flat face");
    case FeatureShape::Circle:
      return feature.surface == SurfaceKind::Torus
                 ? describeTorus(feature)
                 : QObject::tr("Circle ⌀ %1").arg(diameterText(feature.radius));
    case FeatureShape::Axis:
      return describeAxis(feature);
    default:
      return feature.surface == SurfaceKind::Sphere
                 ? QObject::tr("Centre of a sphere ⌀ %1").arg(diameterText(feature.radius))
                 : QObject::tr("Point");
  }
}

}  // namespace

QString describeFeature(const AlignFeature& feature) {
  const QString shape = describeShape(feature);
  return feature.isExact ? QObject::tr("Exact %1").arg(withSmallInitial(shape)) : shape;
}

QString describeFeatureWithin(const AlignFeature& feature) {
  return withSmallInitial(describeFeature(feature));
}

FeaturePicker::FeaturePicker(const Session& session, Viewport& view, const QColor& colour, QObject* parent)
    : QObject(parent),
      session_(session),
      view_(view),
      highlight_(view.overlay(), colour),
      escape_(new QShortcut(QKeySequence(Qt::Key_Escape), &view, nullptr, nullptr, Qt::WindowShortcut)) {
  escape_->setEnabled(false);
  connect(escape_, &QShortcut::activated, this, &FeaturePicker::cancelled);
  connect(&view_, &Viewport::clicksTaken, this, [this](QObject* tool) {
    if (isActive_ && tool != this) emit cancelled();
  });
  connect(&view_, &Viewport::posesChanged, this, [this] {
    const Part* part = hovered_ ? session_.scene().find(hovered_->part) : nullptr;
    if (part != nullptr) highlight_.setPose(view_.poses().shownPoseOf(*part));
  });
}

FeaturePicker::~FeaturePicker() = default;

void FeaturePicker::start(Refusal refusal) {
  refusal_ = std::move(refusal);
  view_.takeClicks(this);
  if (isActive_) return forgetHover();
  isActive_ = true;
  escape_->setEnabled(true);
  view_.installEventFilter(this);
  view_.setCursor(Qt::CrossCursor);
  view_.setFocus();
}

void FeaturePicker::stop() {
  if (!isActive_) return;
  isActive_ = false;
  escape_->setEnabled(false);
  view_.removeEventFilter(this);
  view_.unsetCursor();
  pressed_.reset();
  forgetHover();
}

void FeaturePicker::setFilter(FeatureFilter filter) {
  filter_ = filter;
  forgetHover();
}

bool FeaturePicker::eventFilter(QObject* watched, QEvent* event) {
  if (!isActive_ || isReplaying_) return QObject::eventFilter(watched, event);
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
      return press(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseMove:
      return move(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseButtonRelease:
      return release(*static_cast<QMouseEvent*>(event));
    case QEvent::KeyPress:
      return key(*event);
    case QEvent::Leave:
      forgetHover();
      return false;
    default:
      return false;
  }
}

bool FeaturePicker::press(const QMouseEvent& event) {
  if (event.button() != Qt::LeftButton || event.modifiers() != Qt::NoModifier) return false;
  pressed_ = std::make_unique<QMouseEvent>(event);
  return true;
}

bool FeaturePicker::move(const QMouseEvent& event) {
  if (pressed_ != nullptr) {
    if ((event.pos() - pressed_->pos()).manhattanLength() < QApplication::startDragDistance()) return true;
    // A drag: pass it to the view, from the press on.
    const std::unique_ptr<QMouseEvent> beginning = std::exchange(pressed_, nullptr);
    isReplaying_ = true;
    QApplication::sendEvent(&view_, beginning.get());
    isReplaying_ = false;
    return false;
  }
  if (event.buttons() != Qt::NoButton) return false;
  pointer_ = event.pos();
  if (isHoverQueued_) return false;
  // Pick once for all moves queued by then.
  isHoverQueued_ = true;
  QTimer::singleShot(0, this, [this] {
    isHoverQueued_ = false;
    if (isActive_) hoverAt(pointer_);
  });
  return false;
}

bool FeaturePicker::release(const QMouseEvent& event) {
  if (pressed_ == nullptr || event.button() != Qt::LeftButton) return false;
  pressed_.reset();
  hoverAt(event.pos());
  if (hovered_) emit picked(FeaturePick(*hovered_));
  return true;
}

bool FeaturePicker::key(QEvent& event) {
  const int key = static_cast<QKeyEvent&>(event).key();
  if (key != Qt::Key_Return && key != Qt::Key_Enter) return false;
  emit accepted();
  return true;
}

QString FeaturePicker::refusalOf(PartId id) const {
  const Part* part = session_.scene().find(id);
  return part != nullptr && refusal_ ? refusal_(*part) : QString();
}

std::optional<PickedPoint> FeaturePicker::meantAt(const QPoint& position) const {
  std::optional<PickedPoint> seen = view_.pointAt(position, SeenThrough::Last);
  if (!seen || refusalOf(seen->part).isEmpty()) return seen;
  // It cannot be meant if a part before it can.
  std::optional<PickedPoint> nearest = view_.pointAt(position);
  return nearest && refusalOf(nearest->part).isEmpty() ? nearest : seen;
}

void FeaturePicker::hoverAt(const QPoint& position) {
  const std::optional<PickedPoint> seen = meantAt(position);
  const Part* part = seen ? session_.scene().find(seen->part) : nullptr;
  hovered_.reset();
  QString text = part != nullptr ? refusalOf(part->id) : QString();
  if (part != nullptr && text.isEmpty()) hovered_ = featureOf(*part, *seen, kReach);
  // An outline can be meant from either side.
  if (!hovered_ || hovered_->picked.vertices.empty()) {
    if (auto outline = outlineNear(position, seen)) hovered_ = std::move(outline);
  }
  part = hovered_ ? session_.scene().find(hovered_->part) : nullptr;
  if (part != nullptr)
    text = tr("%1 of %2").arg(describeFeature(hovered_->picked.feature), shortName(part->name));
  showHovered();
  emit told(text);
}

std::optional<FeaturePick> FeaturePicker::featureOf(const Part& part, const PickedPoint& seen,
                                                    double pixels) const {
  const RigidTransform pose = view_.poses().shownPoseOf(part);
  SurfaceHit hit{seen.triangle, pose.inverse().applyToPoint(seen.point)};
  const double reach = pixels * view_.projection().metresPerPixel(seen.point);
  auto found = seen.cut
                   ? pickFeature(*seen.cut, hit.point, reach, filter_)
                   : pickFeature(part.geometry->mesh, hit, reach, filter_, part.geometry->surfaces.get());
  if (!found) return std::nullopt;
  return FeaturePick{part.id, std::move(*found), hit.point};
}

std::optional<FeaturePick> FeaturePicker::outlineNear(const QPoint& position,
                                                      const std::optional<PickedPoint>& seen) const {
  if (filter_ == FeatureFilter::Faces) return std::nullopt;
  const ViewProjection projection = view_.projection();
  for (const int radius : kOutlineRadii) {
    for (int turn = 0; turn < kOutlineDirections; ++turn) {
      const double angle = 2.0 * std::numbers::pi * turn / kOutlineDirections;
      const QPointF aside = radius * QPointF(std::cos(angle), std::sin(angle));
      const std::optional<PickedPoint> beside = meantAt(position + aside.toPoint());
      const Part* part = beside ? session_.scene().find(beside->part) : nullptr;
      if (part == nullptr || !refusalOf(part->id).isEmpty()) continue;
      const double reach = kReach * projection.metresPerPixel(beside->point);
      // On the far side of an outline the view jumps to what is behind.
      if (seen && projection.depthOf(seen->point) - projection.depthOf(beside->point) <= reach) continue;
      auto found = featureOf(*part, *beside, kReach - radius);
      if (found && !found->picked.vertices.empty()) return found;
    }
  }
  return std::nullopt;
}

void FeaturePicker::forgetHover() {
  hovered_.reset();
  showHovered();
  emit told({});
}

void FeaturePicker::showHovered() {
  const Part* part = hovered_ ? session_.scene().find(hovered_->part) : nullptr;
  if (part != nullptr) {
    highlight_.show(part->geometry->mesh, hovered_->picked, view_.poses().shownPoseOf(*part));
  } else if (highlight_.isShown()) {
    highlight_.clear();
  } else {
    return;
  }
  view_.requestRender();
}

}  // namespace nearfit::ui
