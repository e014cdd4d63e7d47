#include "tests/app/desktop/monkey/random_user.h"

#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QDropEvent>
#include <QLineEdit>
#include <QMenuBar>
#include <QMimeData>
#include <QPointer>
#include <QUrl>

#include "tests/app/desktop/monkey/monkey_hands.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/feel/feel_control.h"
#include "ui/tools/placing/placing_tools.h"

namespace nearfit::test {

using namespace monkey;

namespace {

constexpr std::size_t kMaxParts = 24;
constexpr int kPatienceMs = 60'000;

QString placeText(const QPoint& at) {
  return QStringLiteral("%1,%2").arg(at.x()).arg(at.y());
}

void collect(const QList<QAction*>& from, QList<QAction*>& into) {
  for (QAction* action : from) {
    if (action->menu() != nullptr) {
      collect(action->menu()->actions(), into);
    } else if (!action->isSeparator() && action->isEnabled() && action->isVisible()) {
      into << action;
    }
  }
}

}  // namespace

RandomUser::RandomUser(DesktopDriver& driver, FakeSource& devices, MonkeyFiles& files, unsigned seed)
    : d_(driver), devices_(devices), files_(files), random_(seed), answers_(files, seed + 1) {}

const std::vector<RandomUser::Act>& RandomUser::acts() {
  static const std::vector<Act> acts = {
      {16, &RandomUser::dragInView},    {8, &RandomUser::clickInView}, {3, &RandomUser::wheelInView},
      {22, &RandomUser::useWidget},     {6, &RandomUser::typeNumber},  {16, &RandomUser::pressKey},
      {12, &RandomUser::triggerAction}, {2, &RandomUser::openMenu},    {8, &RandomUser::useList},
      {4, &RandomUser::dropFiles},      {5, &RandomUser::feel},        {2, &RandomUser::changeDevices},
      {1, &RandomUser::changeFile},     {1, &RandomUser::resize},      {4, &RandomUser::wait}};
  return acts;
}

void RandomUser::act() {
  // The window takes nothing while a dialog or a menu is open.
  (void)QTest::qWaitFor([] { return !DialogAnswers::isSomethingOpen(); }, kPatienceMs);
  if (!window().isVisible()) {
    window().show();
    QApplication::setActiveWindow(&window());
  }
  if (QApplication::activeWindow() == nullptr) QApplication::setActiveWindow(&window());
  keepSmall();
  double total = 0.0;
  for (const Act& each : acts())
    total += each.weight;
  double chosen = random_.in(0.0, total);
  std::fprintf(stdout, "%d ", ++acts_);
  for (const Act& each : acts()) {
    chosen -= each.weight;
    if (chosen > 0.0) continue;
    (this->*each.act)();
    break;
  }
  QCoreApplication::processEvents();
}

/// Copies of copies of all would be more than any machine holds.
void RandomUser::keepSmall() {
  if (d_.session().scene().parts().size() <= kMaxParts) return;
  say(QStringLiteral("too many parts: a new scene"));
  emit window().feel().servoStopRequested();
  d_.session().reset();
}

bool RandomUser::settle() {
  say(QStringLiteral("settle"));
  const auto isAtRest = [this] {
    if (d_.application.servo().status().isTaken()) emit window().feel().servoStopRequested();
    const auto isMoved = [this](const Scene::PartPtr& part) {
      return window().viewport().poses().isDragged(part->id);
    };
    return !DialogAnswers::isSomethingOpen() && !window().document().isBusy() &&
           !d_.application.servo().status().isTaken() &&
           std::ranges::none_of(d_.session().scene().parts(), isMoved);
  };
  return QTest::qWaitFor(isAtRest, kPatienceMs);
}

/// Most often about what is selected: there is the gizmo.
QPoint RandomUser::placeInView() {
  ui::Viewport& view = window().viewport();
  const std::optional<PartId> current = window().selection().current();
  const Part* part = current ? d_.session().scene().find(*current) : nullptr;
  if (part != nullptr && part->geometry && random_.flip(0.6)) {
    const auto seen =
        view.projection().pixelOf(part->worldFromPart.applyToPoint(part->geometry->mass.centre));
    if (seen && std::abs(seen->x) < 1e4 && std::abs(seen->y) < 1e4) {
      const auto near = [this](double middle) { return static_cast<int>(middle + random_.in(-90.0, 90.0)); };
      const QPoint place(near(seen->x), near(seen->y));
      if (view.rect().contains(place)) return place;
    }
  }
  return placeIn(view, random_);
}

void RandomUser::dragInView() {
  const QPoint from = placeInView(), to = placeInView();
  const Qt::MouseButton button = random_.flip(0.75)  ? Qt::LeftButton
                                 : random_.flip(0.5) ? Qt::RightButton
                                                     : Qt::MiddleButton;
  const Qt::KeyboardModifiers modifiers = someModifiers(random_);
  say(QStringLiteral("drag in the view %1 to %2, button %3, modifiers %4")
          .arg(placeText(from), placeText(to))
          .arg(button)
          .arg(static_cast<int>(modifiers), 0, 16));
  drag(&window().viewport(), from, to, button, modifiers);
}

void RandomUser::clickInView() {
  const QPoint at = placeInView();
  const Qt::KeyboardModifiers modifiers = someModifiers(random_);
  const bool isDouble = random_.flip(0.1);
  say(QStringLiteral("click in the view %1, modifiers %2, double %3")
          .arg(placeText(at))
          .arg(static_cast<int>(modifiers), 0, 16)
          .arg(isDouble));
  click(&window().viewport(), at, random_.flip(0.85) ? Qt::LeftButton : Qt::RightButton, modifiers, isDouble);
}

void RandomUser::wheelInView() {
  const QPoint at = placeInView();
  const int delta = random_.flip(0.5) ? 120 : -360;
  const Qt::KeyboardModifiers modifiers = someModifiers(random_);
  say(QStringLiteral("wheel in the view %1 by %2").arg(placeText(at)).arg(delta));
  wheel(&window().viewport(), at, delta, modifiers);
}

void RandomUser::useWidget() {
  QList<QWidget*> usable;
  for (QWidget* widget : window().findChildren<QWidget*>()) {
    if (widget->isVisible() && widget->isEnabled() && !widget->visibleRegion().isEmpty()) usable << widget;
  }
  if (usable.isEmpty()) return say(QStringLiteral("no widget"));
  QWidget* widget = usable[pick(random_, usable.size())];
  const QPoint at = placeIn(*widget, random_), to = placeIn(*widget, random_);
  const double how = random_.in(0.0, 1.0);
  // Lists and texts take drags along to other windows, and wait for those.
  const bool isTaken = qobject_cast<QAbstractItemView*>(widget->parentWidget()) != nullptr ||
                       qobject_cast<QLineEdit*>(widget) != nullptr;
  say(QStringLiteral("use %1 at %2: %3").arg(nameOf(*widget), placeText(at)).arg(how));
  if (how < 0.1) return wheel(widget, at, random_.flip(0.5) ? 120 : -120, {});
  if (how < 0.2 && !isTaken) return drag(widget, at, to, Qt::LeftButton, {});
  if (how < 0.25) return click(widget, at, Qt::RightButton);
  click(widget, at, Qt::LeftButton, how > 0.9 ? someModifiers(random_) : Qt::NoModifier, how > 0.85);
}

void RandomUser::typeNumber() {
  QList<QAbstractSpinBox*> fields;
  for (auto* field : window().findChildren<QAbstractSpinBox*>()) {
    if (field->isVisible() && field->isEnabled()) fields << field;
  }
  if (fields.isEmpty()) return say(QStringLiteral("no field"));
  const QPointer<QAbstractSpinBox> field = fields[pick(random_, fields.size())];
  // Most often one that brings parts together.
  const QString text =
      random_.flip(0.5) ? QString::number(random_.in(-60.0, 60.0), 'f', 2) : someText(random_);
  say(QStringLiteral("type '%1' into %2").arg(text, nameOf(*field)));
  field->setFocus();
  field->selectAll();
  type(field, text);
  if (field.isNull()) return;
  press(field, random_.flip(0.8) ? Qt::Key_Return : random_.flip(0.5) ? Qt::Key_Tab : Qt::Key_Escape);
}

void RandomUser::pressKey() {
  QWidget* widget = QApplication::focusWidget();
  if (widget == nullptr || random_.flip(0.3)) widget = &window().viewport();
  const int key = someKey(random_);
  Qt::KeyboardModifiers modifiers = someModifiers(random_);
  if (random_.flip(0.05)) modifiers |= Qt::AltModifier;
  say(QStringLiteral("key %1, modifiers %2 to %3")
          .arg(QKeySequence(key).toString())
          .arg(static_cast<int>(modifiers), 0, 16)
          .arg(nameOf(*widget)));
  press(widget, key, modifiers);
}

QList<QAction*> RandomUser::actions() const {
  QList<QAction*> found;
  collect(d_.application.window().menuBar()->actions(), found);
  return found;
}

void RandomUser::triggerAction() {
  const QList<QAction*> all = actions();
  QAction* action = all[pick(random_, all.size())];
  say(QStringLiteral("action %1 '%2'").arg(action->objectName(), action->text()));
  action->trigger();
}

void RandomUser::openMenu() {
  QMenuBar* bar = window().menuBar();
  QAction* menu = bar->actions().at(pick(random_, bar->actions().size()));
  say(QStringLiteral("menu '%1'").arg(menu->text()));
  click(bar, bar->actionGeometry(menu).center());
}

void RandomUser::useList() {
  QTreeView* view = d_.partsView();
  if (!view->isVisible() || view->model()->rowCount() == 0) return say(QStringLiteral("no list"));
  QModelIndex row = view->model()->index(pick(random_, view->model()->rowCount()), 0);
  if (view->model()->rowCount(row) > 0 && random_.flip(0.5))
    row = view->model()->index(pick(random_, view->model()->rowCount(row)), 0, row);
  const QModelIndex cell = row.siblingAtColumn(pick(random_, view->model()->columnCount()));
  view->scrollTo(cell);
  const QPoint at = view->visualRect(cell).center();
  const double how = random_.in(0.0, 1.0);
  say(QStringLiteral("list row %1 column %2: %3").arg(cell.row()).arg(cell.column()).arg(how));
  if (how < 0.1) return click(view->viewport(), at, Qt::RightButton);
  if (how < 0.25) {
    // Dropped on itself or on another.
    const std::unique_ptr<QMimeData> data(view->model()->mimeData(view->selectionModel()->selectedIndexes()));
    if (!data) return;
    const QPoint place = placeIn(*view->viewport(), random_);
    QDropEvent drop(place, Qt::MoveAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(view->viewport(), &drop);
    return;
  }
  click(view->viewport(), at, Qt::LeftButton, someModifiers(random_), how > 0.85);
  QWidget* editor = QApplication::focusWidget();
  if (how < 0.8 || qobject_cast<QLineEdit*>(editor) == nullptr) return;
  type(editor, someText(random_));
  if (QWidget* still = QApplication::focusWidget()) press(still, Qt::Key_Return);
}

void RandomUser::dropFiles() {
  const QStringList files = files_.some(random_);
  say(QStringLiteral("drop ") + files.join(QStringLiteral(" ")));
  QMimeData data;
  QList<QUrl> urls;
  for (const QString& file : files)
    urls << QUrl::fromLocalFile(file);
  data.setUrls(urls);
  QDragEnterEvent enter({50, 50}, Qt::CopyAction, &data, Qt::LeftButton, {});
  QApplication::sendEvent(&window(), &enter);
  QDropEvent drop({50, 50}, Qt::CopyAction, &data, Qt::LeftButton, {});
  QApplication::sendEvent(&window(), &drop);
}

void RandomUser::feel() {
  const double how = random_.in(0.0, 1.0);
  say(QStringLiteral("feel: %1").arg(how));
  if (how < 0.3) {
    press(d_.widget<QComboBox>("hand"), random_.flip(0.5) ? Qt::Key_Down : Qt::Key_Up);
  } else if (how < 0.6) {
    d_.action("start")->trigger();
  } else if (how < 0.75) {
    d_.action("stop")->trigger();
  } else {
    moveBesideTheHand();
  }
}

void RandomUser::moveBesideTheHand() {
  devices_.handle->moveTo(random_.vector(0.03));
  devices_.handle->isFaulty = random_.flip(0.2);
  devices_.handle->isUnplugged = random_.flip(0.1);
  devices_.handle->needsCalibration = random_.flip(0.2);
}

void RandomUser::changeDevices() {
  ui::DeviceChoice arm;
  arm.id = QStringLiteral("fake");
  arm.name = QStringLiteral("Fake arm");
  arm.isUsable = true;
  devices_.devices = random_.flip(0.7) ? QVector<ui::DeviceChoice>{arm} : QVector<ui::DeviceChoice>{};
  say(QStringLiteral("%1 devices").arg(devices_.devices.size()));
  d_.application.watcher().poll();
}

void RandomUser::changeFile() {
  say(files_.change(random_));
}

void RandomUser::resize() {
  const QSize size(static_cast<int>(random_.in(500.0, 1000.0)), static_cast<int>(random_.in(300.0, 700.0)));
  say(QStringLiteral("resize to %1x%2").arg(size.width()).arg(size.height()));
  window().resize(size);
}

void RandomUser::wait() {
  const int ms = pick(random_, 120);
  say(QStringLiteral("wait %1 ms").arg(ms));
  QTest::qWait(ms);
}

}  // namespace nearfit::test
