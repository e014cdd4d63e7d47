#include "ui/tools/section/section_tool.h"

#include <QAction>
#include <QKeyEvent>
#include <QSettings>
#include <QStringList>
#include <QWidget>
#include <numbers>

#include <glm/geometric.hpp>

#include "ui/model/shown_poses.h"
#include "ui/tools/placing/gizmo_control.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QString kAxisKey = QStringLiteral("section/axis"), kSpareKey = QStringLiteral("section/sparesMoving");
/// Step of tilts with Ctrl [rad].
constexpr double kTiltStep = std::numbers::pi / 12.0;

bool isAxis(SectionAxis axis) {
  return axis <= SectionAxis::Z;
}

/// Returns axes of which the third is that direction.
glm::dmat3 axesAbout(const glm::dvec3& direction) {
  const auto [right, up] = axesOf(CutPlane{direction, 0.0});
  return {right, up, direction};
}

}  // namespace

SectionTool::SectionTool(const Session& session, Viewport& view, QWidget* window)
    : QObject(window),
      session_(session),
      view_(view),
      action_(new QAction(icon(QStringLiteral("section")), tr("Se&ction plane"), this)),
      bar_(new SectionBar(&view)),
      handle_(new GizmoControl(view, QStringLiteral("sectionHandle"), QStringLiteral("sectionReadout"))),
      picker_(session, view, colours::kAccent, this),
      sheet_(view.overlay()) {
  action_->setObjectName(QStringLiteral("section"));
  action_->setCheckable(true);
  action_->setShortcut(QKeySequence(Qt::Key_C));
  setHelp(*action_, tr("Cut the view open by a plane"));
  connect(action_, &QAction::toggled, this, [this](bool isOn) { isOn ? start() : stop(); });
  connectBar();
  connectHandle();
  connectPicker();
  connect(&view_, &Viewport::posesChanged, this, &SectionTool::follow);
  connect(&view_, &Viewport::drawn, this, &SectionTool::tell);
  window->installEventFilter(this);
}

SectionTool::~SectionTool() = default;

/// Gets only keys that nothing else in the window has handled, so active tools see Escape first.
bool SectionTool::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress || !action_->isChecked()) return QObject::eventFilter(watched, event);
  if (static_cast<QKeyEvent*>(event)->key() != Qt::Key_Escape) return false;
  action_->setChecked(false);
  return true;
}

void SectionTool::connectBar() {
  connect(bar_, &SectionBar::axisChosen, this, [this](SectionAxis axis) {
    QSettings().setValue(kAxisKey, static_cast<int>(axis));
    pickFace(false);
    layAcross(axis);
  });
  connect(bar_, &SectionBar::faceWanted, this, &SectionTool::pickFace);
  connect(bar_, &SectionBar::positionEdited, this, &SectionTool::moveTo);
  connect(bar_, &SectionBar::flipped, this, [this] {
    isFarSideCut_ = !isFarSideCut_;
    show();
  });
  connect(bar_, &SectionBar::sparingEdited, this, [this](bool isSpared) {
    QSettings().setValue(kSpareKey, isSpared);
    show();
  });
  connect(bar_, &SectionBar::closed, action_, [this] { action_->setChecked(false); });
}

void SectionTool::connectHandle() {
  handle_->setSteps({0.0, kTiltStep});
  handle_->setReadout([this] { return isArrow(handle_->handle()) ? positionText() : QString(); });
  connect(handle_, &GizmoControl::began, this, [this] {
    frameAtStart_ = frame_;
    axisAtStart_ = axis_;
    originAtStart_ = origin_;
  });
  connect(handle_, &GizmoControl::dragged, this, &SectionTool::drag);
  connect(handle_, &GizmoControl::cancelled, this,
          [this] { lay(axisAtStart_, *frameAtStart_, across_, originAtStart_); });
}

void SectionTool::connectPicker() {
  picker_.setFilter(FeatureFilter::Faces);
  connect(&picker_, &FeaturePicker::picked, this, [this](const FeaturePick& pick) {
    pickFace(false);
    layOn(pick);
  });
  connect(&picker_, &FeaturePicker::cancelled, this, [this] { pickFace(false); });
  connect(&picker_, &FeaturePicker::told, this, [this](const QString& text) {
    if (!picker_.isActive()) return;
    asked_ = text.isEmpty() ? tr("Click a flat face for the plane to go through") : text;
    tell();
  });
}

void SectionTool::start() {
  bar_->spareMoving(QSettings().value(kSpareKey, false).toBool());
  bar_->show();
  const Aabb box = view_.visibleBounds();
  if (isLaid_ && !box.isEmpty()) {
    const auto [low, high] = reachAlong(box, direction());
    const double offset = glm::dot(frame_.pivot, direction());
    // Keep the last plane, unless the parts are elsewhere now.
    if (offset >= low && offset <= high) return lay(axis_, frame_, across_, origin_);
  }
  const int kept = QSettings().value(kAxisKey, 0).toInt();
  const bool isKnown = kept >= 0 && kept <= static_cast<int>(SectionAxis::Sight);
  layAcross(isKnown ? static_cast<SectionAxis>(kept) : SectionAxis::X);
}

void SectionTool::stop() {
  pickFace(false);
  bar_->hide();
  handle_->abandon();
  handle_->setFrame({});
  sheet_.clear();
  view_.setCut({});
}

void SectionTool::layAcross(SectionAxis axis) {
  const glm::dvec3 away = view_.projection().away();
  GizmoFrame frame;
  const Aabb box = view_.visibleBounds();
  if (!box.isEmpty()) frame.pivot = box.centre();
  if (!isAxis(axis)) frame.axes = axesAbout(-away);
  const int across = isAxis(axis) ? static_cast<int>(axis) : 2;
  const glm::dvec3 direction = frame.axes[across];
  isFarSideCut_ = glm::dot(direction, away) > 0.0;
  lay(axis, frame, across, isAxis(axis) ? 0.0 : glm::dot(frame.pivot, direction));
}

void SectionTool::layOn(const FeaturePick& pick) {
  const Part* part = session_.scene().find(pick.part);
  if (part == nullptr || pick.picked.feature.shape != FeatureShape::Plane) return;
  const RigidTransform pose = view_.poses().shownPoseOf(*part);
  const glm::dvec3 normal = pose.applyToVector(pick.picked.feature.direction);
  const GizmoFrame frame{pose.applyToPoint(pick.hit), axesAbout(normal)};
  isFarSideCut_ = false;
  lay(SectionAxis::Face, frame, 2, glm::dot(frame.pivot, normal));
}

void SectionTool::lay(std::optional<SectionAxis> axis, const GizmoFrame& frame, int across, double origin) {
  axis_ = axis;
  frame_ = frame;
  across_ = across;
  origin_ = origin;
  box_ = view_.visibleBounds();
  isLaid_ = !box_.isEmpty();
  show();
}

void SectionTool::pickFace(bool isWanted) {
  bar_->showPicking(isWanted);
  if (isWanted == picker_.isActive()) return;
  asked_.clear();
  if (isWanted) {
    picker_.start({});
    asked_ = tr("Click a flat face for the plane to go through");
  } else {
    picker_.stop();
  }
  tell();
}

void SectionTool::drag(const RigidTransform& motion) {
  GizmoFrame frame = *frameAtStart_;
  if (isArrow(handle_->handle())) {
    const glm::dvec3 along = frame.axes[across_];
    frame.pivot += glm::dot(motion.translation, along) * along;
    lay(axis_, frame, across_, origin_);
  } else {
    for (int axis = 0; axis < 3; ++axis)
      frame.axes[axis] = glm::normalize(motion.applyToVector(frame.axes[axis]));
    lay(std::nullopt, frame, across_, glm::dot(frame.pivot, frame.axes[across_]));
  }
  handle_->showReached(motion, {});
}

double SectionTool::position() const {
  return glm::dot(frame_.pivot, direction()) - origin_;
}

void SectionTool::moveTo(double position) {
  frame_.pivot += (position - this->position()) * direction();
  show();
}

CutPlane SectionTool::plane() const {
  const double offset = glm::dot(frame_.pivot, direction());
  return isFarSideCut_ ? CutPlane{-direction(), -offset} : CutPlane{direction(), offset};
}

void SectionTool::follow() {
  if (!action_->isChecked()) return;
  const Aabb box = view_.visibleBounds();
  if (box.lower == box_.lower && box.upper == box_.upper) return;
  // Parts that come into an empty scene are cut through their middle.
  if (!isLaid_) return layAcross(axis_ && *axis_ != SectionAxis::Face ? *axis_ : SectionAxis::X);
  box_ = box;
  show();
}

void SectionTool::show() {
  if (!action_->isChecked()) return;
  bar_->showAxis(axis_);
  if (box_.isEmpty()) {
    handle_->setFrame({});
    sheet_.clear();
    return view_.setCut({});
  }
  const auto [low, high] = reachAlong(box_, direction());
  bar_->showPosition(position(), {low - origin_, high - origin_});
  handle_->setMode(static_cast<GizmoMode>(static_cast<int>(GizmoMode::AcrossX) + across_));
  handle_->setFrame(frame_);
  sheet_.show(plane(), box_, axisColour(across_));
  view_.setCut(ViewCut{plane(), bar_->isMovingSpared()});
}

QString SectionTool::positionText() const {
  const LengthUnit unit = Preferences::lengthUnit();
  const QString length = lengthIn(unit, position(), measuredDecimals(unit, box_.diagonal()));
  return axis_ && isAxis(*axis_) ? QChar('X' + static_cast<int>(*axis_)) + QString(QChar(0xA0)) + length
                                 : length;
}

void SectionTool::tell() {
  if (!action_->isChecked() || !asked_.isEmpty()) return bar_->showNote(asked_);
  QStringList open, intricate;
  for (const PartId id : view_.openlyCut()) {
    const Part* part = session_.scene().find(id);
    if (part == nullptr) continue;
    const bool isClosed = part->geometry->mesh.topology().isClosed();
    (isClosed ? intricate : open) << QString::fromStdString(part->name);
  }
  constexpr int kNamed = 3;
  QStringList notes;
  if (!open.isEmpty())
    notes << tr("Cut without a cap because the mesh is open: %1").arg(listOfNames(open, kNamed));
  if (!intricate.isEmpty())
    notes
        << tr("Cut without a cap because the outline is too complex: %1").arg(listOfNames(intricate, kNamed));
  bar_->showNote(notes.join(QStringLiteral("; ")));
}

}  // namespace nearfit::ui
