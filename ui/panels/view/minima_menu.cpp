#include "ui/panels/view/minima_menu.h"

#include <QActionGroup>
#include <QSettings>
#include <algorithm>
#include <array>

namespace nearfit::ui {
namespace {

const QString kForms[] = {QStringLiteral("minima/segments"), QStringLiteral("minima/points"),
                          QStringLiteral("minima/normals")};
const QString kMax = QStringLiteral("minima/most"), kNearerThan = QStringLiteral("minima/nearerThanPercent");
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
  return choice;
}

void keep(const MinimaChoice& choice) {
  QSettings settings;
  settings.setValue(kForms[0], choice.hasSegments);
  settings.setValue(kForms[1], choice.hasPoints);
  settings.setValue(kForms[2], choice.hasNormals);
  settings.setValue(kMax, static_cast<qulonglong>(choice.most));
  settings.setValue(kNearerThan, qRound(100.0 * choice.nearerThan));
}

}  // namespace

MinimaMenu::MinimaMenu(QWidget* parent) : QMenu(tr("Minima &drawn"), parent), choice_(kept()) {
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
  QMenu* threshold = addChoices(tr("How n&ear"));
  for (const int percent : kPercents) {
    addNumber(*threshold, QStringLiteral("minimaWithin%1").arg(percent),
              percent == 100 ? tr("&Within the cutoff") : tr("Within %1 % of the cutoff").arg(percent),
              &MinimaChoice::nearerThan, 0.01 * percent);
  }
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

}  // namespace nearfit::ui
