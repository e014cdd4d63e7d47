#include "ui/shell/window_shell.h"

#include <QAbstractButton>
#include <QAction>
#include <QActionGroup>
#include <QDockWidget>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QMessageBox>
#include <QToolBar>
#include <QWidget>
#include <algorithm>
#include <utility>

#include "ui/files/file_commands.h"
#include "ui/shell/guide_dialog.h"
#include "ui/shell/shortcuts_dialog.h"
#include "ui/shell/tour.h"
#include "ui/shell/window_layout.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

QAction* addAction(QMenu* menu, const char* name, const QString& text, const QString& help) {
  QAction* action = menu->addAction(text);
  action->setObjectName(QLatin1String(name));
  setHelp(*action, help);
  return action;
}

/// True if each action's tooltip says more than its text.
bool areExplained(const QList<QAction*>& actions) {
  return std::ranges::all_of(actions, [](const QAction* action) {
    return action->isSeparator() || action->menu() != nullptr ||
           action->toolTip() != QAction(action->text()).toolTip();
  });
}

QString plain(QString text) {
  text.remove(QChar('&')).remove(QChar(':'));
  return text.section('\n', 0, 0).trimmed();
}

/// Returns the text of a label whose buddy is the widget, or one that contains it.
QString nameByBuddy(const QWidget& widget) {
  const QList<QLabel*> labels = widget.window()->findChildren<QLabel*>();
  for (const QWidget* part = &widget; part != nullptr && !part->isWindow(); part = part->parentWidget()) {
    for (const QLabel* label : labels) {
      if (label->buddy() == part) return plain(label->text());
    }
  }
  return {};
}

/// Returns the text of the nearest label before the widget in its row.
QString nameByRow(const QWidget& widget) {
  const QWidget* parent = widget.parentWidget();
  auto* grid = parent != nullptr ? qobject_cast<QGridLayout*>(parent->layout()) : nullptr;
  const int index = grid != nullptr ? grid->indexOf(const_cast<QWidget*>(&widget)) : -1;
  if (index < 0) return {};
  int row = 0, column = 0, rows = 0, columns = 0;
  grid->getItemPosition(index, &row, &column, &rows, &columns);
  for (--column; column >= 0; --column) {
    QLayoutItem* item = grid->itemAtPosition(row, column);
    const auto* label = item != nullptr ? qobject_cast<const QLabel*>(item->widget()) : nullptr;
    if (label != nullptr && !label->text().isEmpty()) return plain(label->text());
  }
  return {};
}

/// True if a screen reader can say more about the widget than its kind.
bool hasAccessibleName(const QWidget& widget) {
  if (!widget.accessibleName().isEmpty()) return true;
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) return !button->text().isEmpty();
  if (const auto* group = qobject_cast<const QGroupBox*>(&widget)) return !group->title().isEmpty();
  if (qobject_cast<const QLabel*>(&widget) != nullptr) return true;  // Names itself.
  const QList<QLabel*> labels = widget.window()->findChildren<QLabel*>();
  for (const QLabel* label : labels) {
    if (label->buddy() == &widget) return true;
  }
  return false;
}

/// Gives an accessible name to every widget below `root` that takes the keyboard and has none: the text of
/// the label beside it, else its tooltip. Skips widgets that name themselves, such as a button with a text.
void nameFields(QWidget& root) {
  const QList<QWidget*> widgets = root.findChildren<QWidget*>();
  for (QWidget* widget : widgets) {
    if (widget->focusPolicy() == Qt::NoFocus || hasAccessibleName(*widget)) continue;
    QString name = nameByBuddy(*widget);
    if (name.isEmpty()) name = nameByRow(*widget);
    if (name.isEmpty()) name = plain(widget->toolTip());
    widget->setAccessibleName(name);
  }
}

}  // namespace

WindowShell::WindowShell(QMainWindow* window, FileCommands& files, QMenu* view, QMenu* help)
    : QObject(window),
      window_(window),
      files_(files),
      shortcuts_(new ShortcutsDialog(window)),
      tour_(new Tour(window)) {
  addThemes(view);
  QAction* reset =
      addAction(view, "resetLayout", tr("Reset la&yout"), tr("Put all panels back in their original places"));
  connect(reset, &QAction::triggered, this, [this] { layout_->reset(); });
  addHelp(help);
}

void WindowShell::addHelp(QMenu* help) {
  QAction* about = makeAction(this, "about", tr("&About Nearfit"), QStringLiteral("about"), {},
                              tr("Version, method and licence"));
  connect(about, &QAction::triggered, this,
          [this] { QMessageBox::about(window_, tr("About Nearfit"), aboutText_); });
  help->addAction(about);
  guideAction_ = addAction(help, "guide", tr("User &guide"), tr("Read what each command does, task by task"));
  connect(guideAction_, &QAction::triggered, this, &WindowShell::showGuide);
  setGuide({});
  tourAction_ =
      addAction(help, "tour", tr("Short &tour"), tr("Explain the panels of this window, one by one"));
  tourAction_->setIcon(icon(QStringLiteral("about")));
  connect(tourAction_, &QAction::triggered, this, &WindowShell::beginTour);
  QAction* keys = addAction(help, "shortcuts", tr("&Keyboard shortcuts"),
                            tr("List and search all commands and their keys"));
  keys->setShortcuts({QKeySequence(Qt::Key_F1), QKeySequence(QStringLiteral("Ctrl+/"))});
  connect(keys, &QAction::triggered, shortcuts_, &ShortcutsDialog::open);
}

void WindowShell::setGuide(const QString& file) {
  guideFile_ = file;
  guideAction_->setEnabled(!file.isEmpty());
}

void WindowShell::showGuide() {
  if (guide_ == nullptr) guide_ = new GuideDialog(guideFile_, window_);
  guide_->show();
  guide_->raise();
  guide_->activateWindow();
}

void WindowShell::settle() {
  // Menus hide the tooltips of their actions unless told otherwise.
  for (QMenu* menu : window_->findChildren<QMenu*>())
    menu->setToolTipsVisible(areExplained(menu->actions()));
  layout_ = new WindowLayout(window_);
  layout_->restore();
  nameFields(*window_);
}

void WindowShell::addThemes(QMenu* view) {
  QMenu* menu = view->addMenu(tr("&Theme"));
  auto* group = new QActionGroup(this);
  const std::pair<ColourScheme, QAction*> schemes[] = {
      {ColourScheme::System,
       addAction(menu, "themeSystem", tr("&Same as desktop"), tr("Light or dark, following the desktop"))},
      {ColourScheme::Light, addAction(menu, "themeLight", tr("&Light"), tr("Dark text on light panels"))},
      {ColourScheme::Dark, addAction(menu, "themeDark", tr("&Dark"), tr("Light text on dark panels"))}};
  for (const auto& [scheme, action] : schemes) {
    action->setCheckable(true);
    action->setChecked(scheme == colourScheme());
    group->addAction(action);
    connect(action, &QAction::triggered, this, [scheme = scheme] { setColourScheme(scheme); });
  }
}

void WindowShell::beginTour() {
  // An empty window has little to explain.
  files_.withParts([this] { showTour(); });
}

void WindowShell::endTour() {
  tour_->end();
}

void WindowShell::showTour() {
  const auto find = [this](const char* name) { return window_->findChild<QWidget*>(QLatin1String(name)); };
  tour_->begin({
      {find("partsDock"), tr("Parts"),
       tr("All parts of the scene. The eye hides a part, the lock keeps it in place, and the hand makes it "
          "the moving part: the one that you feel.")},
      {window_->centralWidget(), tr("The view"),
       tr("A left drag orbits, the wheel zooms, a click selects. Arrow keys move the selected part. While "
          "you feel, coloured lines show the local minimum distances, and arrows show force and torque.")},
      {find("poseDock"), tr("Pose and mass"),
       tr("The position, rotation, density and mass of the selected part. You can edit the numbers.")},
      {find("feelDock"), tr("Feel"),
       tr("Choose what moves the part: a device, a recording, a script or the manual hand. Press Feel "
          "(F5). With the manual hand, hold Shift and drag in the view: the part stops at contact.")},
      {find("toolBar"), tr("Tools"),
       tr("All these commands are in the menus too. F1 lists all keys; History, beside the parts, takes you "
          "back to any step.")},
  });
}

}  // namespace nearfit::ui
