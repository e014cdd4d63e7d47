#include "ui/tools/measure/measure_tool.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStringList>
#include <numbers>

#include "ui/model/shown_poses.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/elided_label.h"
#include "ui/widgets/format.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kAngleDecimals = 3;

/// Decimals of all lengths of a measurement, by the longest.
int decimalsOf(const Measurement& measurement, LengthUnit unit) {
  return measuredDecimals(unit, measurement.pointToPoint.value_or(measurement.distance));
}

/// Says how two faces lie that point towards each other; empty if they are apart.
QString facesText(const std::optional<double>& gap) {
  if (!gap || *gap > kTouchingGap) return {};
  return *gap < -kTouchingGap ? QObject::tr("behind each other") : QObject::tr("touching");
}

}  // namespace

MeasureBar::MeasureBar(QWidget* view)
    : ViewBar(view, QStringLiteral("measureBar")),
      prompt_(new ElidedLabel(this)),
      hint_(new ElidedLabel(this)),
      copy_(new QPushButton(icon(QStringLiteral("copy")), tr("&Copy"), this)),
      close_(new QPushButton(tr("Close"), this)) {
  prompt_->setObjectName(QStringLiteral("measurePrompt"));
  prompt_->setStyleSheet(QStringLiteral("font-weight: bold"));
  hint_->setObjectName(QStringLiteral("measureHint"));
  hint_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  auto *numbers = new QHBoxLayout, *square = new QHBoxLayout;
  for (QHBoxLayout* row : {numbers, square})
    row->setSpacing(6);
  values_ = {addValue(*numbers, "measureDistance", tr("Distance"), tr("Distance between the two points")),
             addValue(*numbers, "measureX", tr("X"), tr("Along the world's X axis, from the first point")),
             addValue(*numbers, "measureY", tr("Y"), tr("Along the world's Y axis, from the first point")),
             addValue(*numbers, "measureZ", tr("Z"), tr("Along the world's Z axis, from the first point")),
             addValue(*square, "measureApart", tr("Perpendicular"),
                      tr("Perpendicular distance between the faces, axes or points that were clicked")),
             addValue(*square, "measurePoints", tr("Point to point"), tr("Distance between the two clicks")),
             addValue(*square, "measureAngle", tr("Angle"), tr("Angle between the faces or axes")),
             addValue(*square, "measureFaces", tr("Faces"),
                      tr("Faces behind each other: the parts overlap there, or one is beyond the other"))};
  for (int axis = 0; axis < 3; ++axis) {
    values_[static_cast<std::size_t>(axis) + 1].name->setStyleSheet(
        QStringLiteral("font-weight: bold; color: %1").arg(axisColour(axis).name()));
  }
  // Keep the height of the row before there is a measurement.
  for (QWidget* widget : {values_[0].name, values_[0].number}) {
    QSizePolicy policy = widget->sizePolicy();
    policy.setRetainSizeWhenHidden(true);
    widget->setSizePolicy(policy);
  }
  numbers->addStretch();
  square->addStretch();
  square->addSpacing(10);
  square->addWidget(copy_);
  square->addWidget(close_);
  copy_->setObjectName(QStringLiteral("measureCopy"));
  copy_->setToolTip(tr("Copy the numbers to the clipboard, one per line"));
  close_->setObjectName(QStringLiteral("measureClose"));
  close_->setToolTip(tr("Stop measuring (Esc)"));
  connect(copy_, &QPushButton::clicked, this, &MeasureBar::copy);
  connect(close_, &QPushButton::clicked, this, &MeasureBar::closed);
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(14, 6, 12, 6);
  rows->setSpacing(3);
  rows->addWidget(prompt_);
  rows->addWidget(hint_);
  rows->addLayout(numbers);
  rows->addLayout(square);
}

MeasureBar::Value MeasureBar::addValue(QHBoxLayout& row, const char* name, const QString& title,
                                       const QString& toolTip) {
  const Value value{new QLabel(title, this), new QLabel(this)};
  value.name->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  value.number->setObjectName(QLatin1String(name));
  value.number->setTextInteractionFlags(Qt::TextSelectableByMouse);
  value.number->setContentsMargins(0, 0, 10, 0);
  for (QLabel* label : {value.name, value.number})
    label->setToolTip(toolTip);
  row.addWidget(value.name);
  row.addWidget(value.number);
  return value;
}

void MeasureBar::showPrompt(const QString& prompt, const QString& hint) {
  prompt_->setText(prompt);
  prompt_->setToolTip(prompt);
  hint_->setText(hint.isEmpty() ? QStringLiteral(" ") : hint);
  hint_->setToolTip(hint);
  place();
}

void MeasureBar::showMeasurement(const std::optional<Measurement>& measurement, LengthUnit unit) {
  std::array<QString, 8> texts;
  if (measurement) {
    const int decimals = decimalsOf(*measurement, unit);
    const glm::dvec3 way = measurement->to - measurement->from;
    const auto length = [&](double metres) { return lengthIn(unit, metres, decimals); };
    texts = {length(measurement->distance), length(way.x), length(way.y), length(way.z)};
    // Between parallel faces the distance is the perpendicular one already.
    if (measurement->apart && !measurement->pointToPoint) texts[4] = length(*measurement->apart);
    if (measurement->pointToPoint) texts[5] = length(*measurement->pointToPoint);
    if (measurement->angle) {
      const double degrees = *measurement->angle * 180.0 / std::numbers::pi;
      texts[6] = formatFixed(degrees, kAngleDecimals) + QChar(0xB0);
    }
    texts[7] = facesText(measurement->gap);
    values_[0].name->setText(measurement->pointToPoint ? tr("Perpendicular") : tr("Distance"));
  }
  bool hasChanged = false;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const bool isShown = !texts[i].isEmpty();
    hasChanged = hasChanged || isShown == values_[i].number->isHidden() ||
                 texts[i].size() != values_[i].number->text().size();
    values_[i].number->setText(texts[i]);
    values_[i].number->setAccessibleName(values_[i].name->text() + QChar(' ') + texts[i]);
    values_[i].name->setVisible(isShown);
    values_[i].number->setVisible(isShown);
  }
  copy_->setEnabled(measurement.has_value());
  if (hasChanged) place();
}

void MeasureBar::copy() const {
  QStringList lines;
  for (const Value& value : values_) {
    if (!value.number->text().isEmpty())
      lines << value.name->text() + QStringLiteral(": ") + value.number->text();
  }
  QApplication::clipboard()->setText(lines.join(QChar('\n')));
}

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
  setHelp(*action_, tr("Measure between two points, edges or faces that you click"));
  connect(action_, &QAction::toggled, this, [this](bool isOn) { isOn ? start() : stop(); });
  connect(&picker_, &FeaturePicker::picked, this, &MeasureTool::take);
  connect(&picker_, &FeaturePicker::told, this, &MeasureTool::tell);
  connect(&picker_, &FeaturePicker::cancelled, this, &MeasureTool::stop);
  connect(bar_, &MeasureBar::closed, this, &MeasureTool::stop);
  connect(&view_, &Viewport::posesChanged, this, &MeasureTool::refresh);
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
  const PartGeometry& geometry = *part->geometry;
  const End end{pick.part, part->geometry,
                measureEnd(geometry.mesh, pick.picked, pick.hit, geometry.surfaces.get()),
                tr("%1 of %2").arg(describeFeatureWithin(pick.picked.feature), shortName(part->name))};
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
    // Opposite faces of one part are always behind each other.
    if (from_->part == to_->part) measurement->gap.reset();
    mark_.show(*measurement, lengthIn(unit, measurement->distance, decimalsOf(*measurement, unit)));
  }
  bar_->showMeasurement(measurement, unit);
  tell({});
}

void MeasureTool::tell(const QString& hint) {
  if (!picker_.isActive()) return;
  const QString prompt = to_     ? tr("From %1 to %2").arg(from_->name, to_->name)
                         : from_ ? tr("Click what to measure to")
                                 : tr("Click a corner, edge, circle or face to measure from");
  const QString idle = to_     ? tr("Click to start a new measurement; Esc exits")
                       : from_ ? tr("From %1").arg(from_->name)
                               : tr("Dragging still orbits; Esc exits");
  bar_->showPrompt(prompt, hint.isEmpty() ? idle : hint);
}

}  // namespace nearfit::ui
