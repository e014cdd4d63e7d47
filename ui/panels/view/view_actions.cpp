#include "ui/panels/view/view_actions.h"

#include <QAction>
#include <QActionGroup>
#include <QSettings>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/session/session.h"
#include "ui/model/selection.h"
#include "ui/panels/view/colour_range_dialog.h"
#include "ui/panels/view/feeling_view.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

const QString kForms[] = {QStringLiteral("minima/segments"), QStringLiteral("minima/points"),
                          QStringLiteral("minima/normals")};
const QString kMax = QStringLiteral("minima/most"), kNearerThan = QStringLiteral("minima/nearerThanPercent"),
              kColourRange = QStringLiteral("minima/colourRange");
constexpr std::array<std::size_t, 5> kCounts{0, 100, 30, 10, 1};
constexpr std::array kPercents{100, 50, 25, 10};

/// Returns the stored choice, with defaults for values that are not in the menu.
MinimaChoice kept() {
  const QSettings settings;
  MinimaChoice choice;
  choice.hasSegments = settings.value(kForms[0], choice.hasSegments).toBool();
  choice.hasPoints = settings.value(kForms[1], choice.hasPoints).toBool();
  choice.hasNormals = settings.value(kForms[2], choice.hasNormals).toBool();
  const auto most = static_cast<std::size_t>(settings.value(kMax, 0).toULongLong());
  if (std::ranges::find(kCounts, most) != kCounts.end()) choice.most = most;
  const int percent = settings.value(kNearerThan, 100).toInt();
  if (std::ranges::find(kPercents, percent) != kPercents.end()) choice.nearerThan = 0.01 * percent;
  const double range = settings.value(kColourRange, 0.0).toDouble();
  if (std::isfinite(range) && range > 0.0) choice.colourRange = range;
  return choice;
}

void keep(const MinimaChoice& choice) {
  QSettings settings;
  settings.setValue(kForms[0], choice.hasSegments);
  settings.setValue(kForms[1], choice.hasPoints);
  settings.setValue(kForms[2], choice.hasNormals);
  settings.setValue(kMax, static_cast<qulonglong>(choice.most));
  settings.setValue(kNearerThan, qRound(100.0 * choice.nearerThan));
  settings.setValue(kColourRange, choice.colourRange);
}

}  // namespace

MinimaMenu::MinimaMenu(QWidget* parent) : QMenu(tr("&Distance glyphs"), parent), choice_(kept()) {
  setObjectName(QStringLiteral("minimaMenu"));
  addForm(QStringLiteral("minimaSegments"), tr("&Segments"),
          tr("Lines between the two points of each minimum"), &MinimaChoice::hasSegments);
  addForm(QStringLiteral("minimaPoints"), tr("&Points"), tr("The points of each minimum on the two parts"),
          &MinimaChoice::hasPoints);
  addForm(QStringLiteral("minimaNormals"), tr("&Normals"), tr("The direction in which each minimum pushes"),
          &MinimaChoice::hasNormals);
  addSeparator();
  QMenu* count = addChoices(tr("&How many"));
  for (const std::size_t most : kCounts) {
    const int number = static_cast<int>(most);
    const QString text = most == 0   ? tr("&All")
                         : most == 1 ? tr("Only the nearest")
                                     : tr("The %n nearest", nullptr, number);
    addNumber(*count, QStringLiteral("minimaMost%1").arg(number), text, &MinimaChoice::most, most);
  }
  QMenu* threshold = addChoices(tr("&Range"));
  for (const int percent : kPercents) {
    addNumber(*threshold, QStringLiteral("minimaWithin%1").arg(percent),
              percent == 100 ? tr("&Within the cutoff") : tr("Within %1 % of the cutoff").arg(percent),
              &MinimaChoice::nearerThan, 0.01 * percent);
  }
  addColours();
}

void MinimaMenu::addColours() {
  QMenu* menu = addChoices(tr("&Colour range"));
  const auto add = [menu](const char* name, const QString& toolTip) {
    QAction* action = menu->addAction(QString());
    action->setObjectName(QLatin1String(name));
    action->setToolTip(toolTip);
    action->setCheckable(true);
    menu->findChild<QActionGroup*>()->addAction(action);
    return action;
  };
  automaticColours_ = add("minimaColoursAutomatic", tr("Colours span about twice the median distance drawn"));
  chosenColours_ = add("minimaColoursChosen", tr("Choose the distance at which minima become blue"));
  connect(automaticColours_, &QAction::triggered, this, [this] { set(&MinimaChoice::colourRange, 0.0); });
  connect(chosenColours_, &QAction::triggered, this, &MinimaMenu::chooseColours);
  // The unit may have changed.
  connect(menu, &QMenu::aboutToShow, this, &MinimaMenu::showColours);
  showColours();
}

void MinimaMenu::chooseColours() {
  constexpr double kUsual = 1e-3;  // [m]
  const double now = choice_.colourRange > 0.0 ? choice_.colourRange : kUsual;
  if (const std::optional<double> range = askForColourRange(now, parentWidget()))
    set(&MinimaChoice::colourRange, *range);
  showColours();
}

void MinimaMenu::showColours() {
  const double range = choice_.colourRange;
  automaticColours_->setText(tr("&Automatic"));
  automaticColours_->setChecked(!(range > 0.0));
  chosenColours_->setText(range > 0.0 ? tr("&Blue from %1…").arg(formatLength(range)) : tr("&Blue from…"));
  chosenColours_->setChecked(range > 0.0);
}

void MinimaMenu::addForm(const QString& name, const QString& text, const QString& toolTip,
                         bool MinimaChoice::* form) {
  QAction* action = addAction(text);
  action->setToolTip(toolTip);
  action->setObjectName(name);
  action->setCheckable(true);
  action->setChecked(choice_.*form);
  connect(action, &QAction::toggled, this, [this, form](bool isOn) { set(form, isOn); });
}

QMenu* MinimaMenu::addChoices(const QString& title) {
  QMenu* menu = addMenu(title);
  new QActionGroup(menu);
  return menu;
}

template <class Number>
void MinimaMenu::addNumber(QMenu& menu, const QString& name, const QString& text,
                           Number MinimaChoice::* number, Number value) {
  QAction* action = menu.addAction(text);
  action->setObjectName(name);
  action->setCheckable(true);
  action->setChecked(choice_.*number == value);
  menu.findChild<QActionGroup*>()->addAction(action);
  connect(action, &QAction::triggered, this, [this, number, value] { set(number, value); });
}

template <class Value>
void MinimaMenu::set(Value MinimaChoice::* member, Value value) {
  MinimaChoice next = choice_;
  next.*member = value;
  choose(next);
}

void MinimaMenu::choose(const MinimaChoice& choice) {
  if (choice == choice_) return;
  choice_ = choice;
  keep(choice);
  emit choiceChanged(choice);
}

ViewActions::ViewActions(Session& session, Selection& selection, Viewport& view, QWidget* window)
    : QObject(window),
      session_(session),
      selection_(selection),
      view_(view),
      minima_(new MinimaMenu(window)),
      feeling_(new FeelingView(view, window)) {
  setUpLooking();
  setUpDrawing();
  setUpKeptSwitches();
  connect(&selection_, &Selection::changed, this, &ViewActions::update);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

void ViewActions::setUpLooking() {
  fit = makeAction(this, "fit", tr("&Fit all"), QStringLiteral("fit"), Qt::Key_F,
                   tr("Zoom the view to all parts"));
  connect(fit, &QAction::triggered, &view_, &Viewport::fit);
  fitSelection = makeAction(this, "fitSelection", tr("Fit se&lected"), QStringLiteral("fit"),
                            QStringLiteral("Shift+F"), tr("Zoom the view to the selected parts"));
  connect(fitSelection, &QAction::triggered, this, [this] {
    if (!selection_.parts().empty()) view_.fitParts(selection_.parts());
  });
  const auto add = [this](StandardView view, const char* name, const QString& text, const QString& iconName,
                          Qt::Key key, const QString& help) {
    QAction* action = makeAction(this, name, text, iconName, key, help);
    connect(action, &QAction::triggered, this, [this, view] { view_.setView(view); });
    views_ << action;
  };
  // Their keys are digits: the menu has more entries than letters for them.
  add(StandardView::Isometric, "viewIso", tr("Isometric"), QStringLiteral("view-iso"), Qt::Key_0,
      tr("Look from the corner between front, right and top"));
  add(StandardView::Front, "viewFront", tr("Front"), QStringLiteral("view-front"), Qt::Key_1,
      tr("Look from the front, along Y"));
  add(StandardView::Right, "viewRight", tr("Right"), QStringLiteral("view-right"), Qt::Key_2,
      tr("Look from the right, along X"));
  add(StandardView::Top, "viewTop", tr("Top"), QStringLiteral("view-top"), Qt::Key_3,
      tr("Look from above, along Z"));
}

void ViewActions::setUpDrawing() {
  const auto add = [this](void (Viewport::*set)(bool), const char* name, const QString& text,
                          const QString& iconName, const QString& help) {
    QAction* action = makeSwitch(this, name, text, iconName, true, help);
    connect(action, &QAction::toggled, &view_, set);
    switches_ << action;
  };
  add(&Viewport::setSeeThrough, "seeThrough", tr("&See through fixed parts"), QStringLiteral("translucent"),
      tr("Make the other parts translucent, to see the moving part through them"));
  add(&Viewport::setEdgesVisible, "edges", tr("&Edges"), QStringLiteral("edges"),
      tr("Draw the sharp edges of parts as lines"));
  add(&Viewport::setMinimaVisible, "minima", tr("M&inima"), QStringLiteral("minima"),
      tr("Draw each local minimum distance while a part is in hand"));
  add(&Viewport::setContactsVisible, "contacts", tr("C&ontacts"), QStringLiteral("contacts"),
      tr("Mark where the part in hand touches"));
  add(&Viewport::setHandVisible, "handGhost", tr("&Hand offset"), QStringLiteral("ghost"),
      tr("Show where the hand is when contact holds the part back"));
  add(&Viewport::setWrenchVisible, "wrench", tr("Force and torque &arrows"), QStringLiteral("wrench-arrows"),
      tr("Draw the felt force and torque as arrows"));
  view_.setSeeThrough(true);
  view_.setMinimaChoice(minima_->choice());
  connect(minima_, &MinimaMenu::choiceChanged, &view_, &Viewport::setMinimaChoice);
}

void ViewActions::setUpKeptSwitches() {
  orthographic = makeAction(this, "orthographic", tr("Orthographic"), {}, Qt::Key_5,
                            tr("Draw parallel lines parallel, without perspective"));
  orthographic->setCheckable(true);
  connect(orthographic, &QAction::toggled, this, [this](bool isOn) {
    Preferences::setOrthographic(isOn);
    view_.setOrthographic(isOn);
  });
  scaleBar = makeSwitch(this, "scaleBar", tr("Scale &bar"), {}, false,
                        tr("Show a scale bar, true at the point that the camera orbits"));
  connect(scaleBar, &QAction::toggled, this, [this](bool isOn) {
    Preferences::setScaleBar(isOn);
    view_.setScaleBarVisible(isOn);
  });
  orthographic->setChecked(Preferences::isOrthographic());
  scaleBar->setChecked(Preferences::hasScaleBar());
}

QMenu* ViewActions::minimaMenu() const noexcept {
  return minima_;
}

void ViewActions::update() {
  const bool hasParts = !session_.scene().parts().empty();
  fit->setEnabled(hasParts);
  for (QAction* view : views_)
    view->setEnabled(hasParts);
  fitSelection->setEnabled(!selection_.isEmpty());
}

}  // namespace nearfit::ui
