#include "ui/tools/placing/placing_actions.h"

#include <QAction>
#include <QActionGroup>
#include <QMainWindow>
#include <QMenu>
#include <QSettings>
#include <QToolBar>
#include <QToolButton>
#include <algorithm>
#include <numbers>
#include <utility>

#include "ui/widgets/font_scale.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/split_button.h"

namespace nearfit::ui {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kUsualLength = 1e-3, kUsualAngle = 15.0 * kRadiansPerDegree;  ///< [m], [rad]
constexpr double kMinLength = 1e-7, kMaxLength = 1e3;
constexpr double kMinAngleStep = 1e-3 * kRadiansPerDegree, kMaxAngleStep = std::numbers::pi;
constexpr int kDecimals = 4, kFieldWidth = 92;

QVariant kept(const char* key, const QVariant& usual) {
  return QSettings().value(QStringLiteral("placing/") + QLatin1String(key), usual);
}

void keep(const char* key, const QVariant& value) {
  QSettings().setValue(QStringLiteral("placing/") + QLatin1String(key), value);
}

/// Returns the stored step, or the usual one if the settings hold no valid number.
double keptStep(const char* key, double usual, double least, double most) {
  const double value = kept(key, usual).toDouble();
  return value >= least && value <= most ? value : usual;
}

}  // namespace

PlacingActions::PlacingActions(QObject* parent) : QObject(parent) {
  makeModes();
  makeSwitches();
  makePivotActions();
  makeSteps();
  restore();
  const auto tell = [this] {
    remember();
    emit changed();
  };
  for (QAction* action : {noGizmo, move, turn, moveAndTurn, localAxes, snap, solid, movePivot})
    connect(action, &QAction::toggled, this, tell);
  for (NumberField* field : {lengthStep_, angleStep_})
    connect(field, &NumberField::quantityEdited, this, tell);
}

QAction* PlacingActions::make(const char* name, const QString& text, const char* iconName,
                              const QKeySequence& keys, const QString& tip) {
  return makeAction(this, name, text, QLatin1String(iconName), keys, tip);
}

QAction* PlacingActions::makeSwitch(const char* name, const QString& text, const char* iconName,
                                    const QKeySequence& keys, const QString& tip) {
  QAction* action = make(name, text, iconName, keys, tip);
  action->setCheckable(true);
  return action;
}

void PlacingActions::makeModes() {
  noGizmo = makeSwitch("gizmoNone", tr("&No gizmo"), "gizmo-none", Qt::Key_Q,
                       tr("Select and look only: left drags always orbit"));
  move = makeSwitch("gizmoMove", tr("&Move"), "gizmo-move", Qt::Key_W,
                    tr("Move the selected parts with arrows and squares, or drag the parts themselves"));
  turn = makeSwitch("gizmoTurn", tr("&Rotate"), "gizmo-turn", Qt::Key_E,
                    tr("Rotate the selected parts with rings about the pivot"));
  moveAndTurn = makeSwitch("gizmoMoveAndTurn", tr("Mov&e and rotate"), "gizmo-both", Qt::Key_R,
                           tr("Arrows, squares and rings at once"));
  auto* group = new QActionGroup(this);
  for (QAction* action : {noGizmo, move, turn, moveAndTurn})
    group->addAction(action);
}

void PlacingActions::makeSwitches() {
  localAxes = makeSwitch("localAxes", tr("Along the part's a&xes"), "axes-local", Qt::Key_X,
                         tr("Use the part's axes instead of the world's"));
  snap = makeSwitch("snap", tr("&Snap to steps"), "snap", {},
                    tr("Drags go in steps; hold Ctrl during a drag to invert this"));
  solid = makeSwitch("solid", tr("S&olid"), "solid", QKeySequence(QStringLiteral("Shift+S")),
                     tr("Parts that you move stop at contact and slide along it, as when felt"));
}

void PlacingActions::makePivotActions() {
  movePivot = makeSwitch("movePivot", tr("Mo&ve the pivot"), "pivot", Qt::Key_P,
                         tr("Drag the pivot, about which parts rotate, instead of the parts"));
  pivotAtMass = make("pivotAtMass", tr("Pivot at the &centre of mass"), "pivot", {},
                     tr("Move the pivot back to the parts' centre of mass"));
  pivotAtBox = make("pivotAtBox", tr("Pivot at the middle of the &box"), "pivot", {},
                    tr("Move the pivot to the middle of the parts' bounding box"));
}

void PlacingActions::makeSteps() {
  lengthStep_ = makeStep("snapLength", tr("Move step"));
  lengthStep_->setLength(kDecimals);
  lengthStep_->setQuantityRange(kMinLength, kMaxLength);
  lengthStep_->setQuantityStep(kUsualLength);
  lengthStep_->setHelp(tr("Move step, along the gizmo's axes"));
  angleStep_ = makeStep("snapAngle", tr("Rotation step"));
  angleStep_->setUnit(QString(QChar(0xB0)));
  angleStep_->setDecimals(kDecimals);
  angleStep_->setQuantityRange(kMinAngleStep, kMaxAngleStep);
  angleStep_->setHelp(tr("Rotation step"));
}

NumberField* PlacingActions::makeStep(const char* name, const QString& label) {
  auto* field = new NumberField;
  field->setObjectName(QLatin1String(name));
  field->setAccessibleName(label);
  field->setTrimmed(true);
  field->setActingAtOnce();
  field->setFixedWidth(forFont(*field, kFieldWidth));
  return field;
}

void PlacingActions::addTo(QMenu& menu) {
  menu.addActions({noGizmo, move, turn, moveAndTurn, menu.addSeparator(), localAxes, snap, solid,
                   menu.addSeparator(), movePivot, pivotAtMass, pivotAtBox});
}

QToolBar* PlacingActions::makeToolBar(QMainWindow& window) {
  auto* bar = new QToolBar(tr("Placing"), &window);
  bar->setObjectName(QStringLiteral("placingBar"));
  bar->setMovable(false);
  bar->setIconSize(QSize(24, 24));
  bar->addActions({noGizmo, move, turn, moveAndTurn, bar->addSeparator(), localAxes, movePivot});
  auto* pivotButton = qobject_cast<QToolButton*>(bar->widgetForAction(movePivot));
  auto* pivots = new QMenu(pivotButton);
  pivots->addActions({movePivot, pivots->addSeparator(), pivotAtMass, pivotAtBox});
  pivotButton->setMenu(pivots);
  pivotButton->setPopupMode(QToolButton::MenuButtonPopup);
  pivotButton->setStyleSheet(QString::fromLatin1(kSplitButton));
  bar->addSeparator();
  bar->addAction(snap);
  bar->addWidget(lengthStep_);
  bar->addWidget(angleStep_);
  bar->addSeparator();
  bar->addAction(solid);
  qobject_cast<QToolButton*>(bar->widgetForAction(solid))->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  return bar;
}

GizmoMode PlacingActions::mode() const {
  return move->isChecked()          ? GizmoMode::Move
         : turn->isChecked()        ? GizmoMode::Turn
         : moveAndTurn->isChecked() ? GizmoMode::MoveAndTurn
                                    : GizmoMode::Hidden;
}

SnapSteps PlacingActions::steps() const {
  return {lengthStep_->quantity(), angleStep_->quantity()};
}

void PlacingActions::restore() {
  const QString mode = kept("gizmo", move->objectName()).toString();
  QAction* chosen = move;
  for (QAction* action : {noGizmo, move, turn, moveAndTurn}) {
    if (action->objectName() == mode) chosen = action;
  }
  chosen->setChecked(true);
  for (QAction* action : {localAxes, snap, solid})
    action->setChecked(kept(action->objectName().toLatin1().constData(), false).toBool());
  lengthStep_->showQuantity(keptStep("snapLength", kUsualLength, kMinLength, kMaxLength));
  angleStep_->showQuantity(keptStep("snapAngle", kUsualAngle, kMinAngleStep, kMaxAngleStep));
}

void PlacingActions::remember() const {
  for (const QAction* action : {noGizmo, move, turn, moveAndTurn}) {
    if (action->isChecked()) keep("gizmo", action->objectName());
  }
  for (const QAction* action : {localAxes, snap, solid})
    keep(action->objectName().toLatin1().constData(), action->isChecked());
  keep("snapLength", lengthStep_->quantity());
  keep("snapAngle", angleStep_->quantity());
}

}  // namespace nearfit::ui
