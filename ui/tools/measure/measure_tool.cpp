#include "ui/tools/measure/measure_tool.h"

#include <QAction>
#include <QSignalBlocker>

#include "ui/model/shown_poses.h"
#include "ui/tools/measure/measure_bar.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/names.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

MeasureTool::MeasureTool(const Session& session, Viewport& view, QObject* parent)
    : QObject(parent),
      session_(session),
      view_(view),
      action_(new QAction(icon(QStringLiteral("measure")), tr("&Measure distance"), this)),
      bar_(new MeasureBar(&view)),
      picker_(session, view, colours::kAccent, this),
      mark_(view),
      fromLight_(view.overlay(), colours::kHand),
      toLight_(view.overlay(), colours::kHand) {
  action_->setObjectName(QStringLiteral("measure"));
  action_->setCheckable(true);
  action_->setShortcut(QKeySequence(Qt::Key_M));
  action_->setToolTip(tr("Measure between two points, edges or faces that you click (M)"));
  connect(action_, &QAction::toggled, this, [this](bool isOn) { isOn ? start() : stop(); });
  connect(&picker_, &FeaturePicker::picked, this, &MeasureTool::take);
  connect(&picker_, &FeaturePicker::told, this, &MeasureTool::tell);
  connect(&picker_, &FeaturePicker::cancelled, this, &MeasureTool::stop);
  connect(bar_, &MeasureBar::closed, this, &MeasureTool::stop);
  connect(&view_, &Viewport::posesChanged, this, &MeasureTool::refresh);
  connect(&view_, &Viewport::drawn, this, [this] { mark_.placeLabel(); });
}

MeasureTool::~MeasureTool() = default;

void MeasureTool::start() {
  bar_->show();
  picker_.start({});
  refresh();
}

void MeasureTool::stop() {
  const QSignalBlocker blocker(action_);
  action_->setChecked(false);
  if (!picker_.isActive()) return;
  picker_.stop();
  bar_->hide();
  forget();
  view_.requestRender();
}

void MeasureTool::forget() {
  from_.reset();
  to_.reset();
  mark_.clear();
  fromLight_.clear();
  toLight_.clear();
}

void MeasureTool::take(const FeaturePick& pick) {
  const Part* part = session_.scene().find(pick.part);
  if (part == nullptr) return;
  const End end{pick.part, part->geometry, measureEnd(part->geometry->mesh, pick.picked, pick.hit),
                tr("%1 of %2").arg(describeFeature(pick.picked.feature), shortName(part->name))};
  if (!from_ || to_) {
    forget();
    from_ = end;
    light(fromLight_, pick);
  } else {
    to_ = end;
    light(toLight_, pick);
  }
  refresh();
  view_.requestRender();
}

void MeasureTool::light(FeatureHighlight& highlight, const FeaturePick& pick) {
  const Part& part = *session_.scene().find(pick.part);
  highlight.show(part.geometry->mesh, pick.picked, view_.poses().shownPoseOf(part));
}

std::optional<MeasureEnd> MeasureTool::shown(const End& end) const {
  const Part* part = session_.scene().find(end.part);
  if (part == nullptr || part->geometry != end.geometry) return std::nullopt;
  return placed(end.inPart, view_.poses().shownPoseOf(*part));
}

void MeasureTool::refresh() {
  if (!picker_.isActive()) return;
  const std::optional<MeasureEnd> from = from_ ? shown(*from_) : std::nullopt;
  const std::optional<MeasureEnd> to = to_ ? shown(*to_) : std::nullopt;
  if ((from_ && !from) || (to_ && !to)) forget();
  const LengthUnit unit = Preferences::lengthUnit();
  std::optional<Measurement> measurement;
  const auto pose = [this](const End& end) {
    return view_.poses().shownPoseOf(*session_.scene().find(end.part));
  };
  if (from_) fromLight_.setPose(pose(*from_));
  if (to_) {
    toLight_.setPose(pose(*to_));
    measurement = measure(*from, *to);
    mark_.show(*measurement,
               lengthIn(unit, measurement->distance, measuredDecimals(unit, measurement->distance)));
  }
  bar_->showMeasurement(measurement, unit);
  tell({});
}

void MeasureTool::tell(const QString& hint) {
  if (!picker_.isActive()) return;
  const QString prompt = to_     ? tr("From %1 to %2").arg(from_->name, to_->name)
                         : from_ ? tr("Click what to measure to")
                                 : tr("Click a corner, edge, circle or face to measure from");
  const QString idle = to_     ? tr("Click to start a new measurement; Escape ends")
                       : from_ ? tr("From %1").arg(from_->name)
                               : tr("Drags still orbit; Escape ends");
  bar_->showPrompt(prompt, hint.isEmpty() ? idle : hint);
}

}  // namespace nearfit::ui
