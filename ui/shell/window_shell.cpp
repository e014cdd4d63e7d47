#include "ui/shell/window_shell.h"

#include <QAction>
#include <QActionGroup>
#include <QDockWidget>
#include <QMainWindow>
#include <QMenu>
#include <QMessageBox>
#include <QToolBar>
#include <algorithm>
#include <utility>

#include "ui/files/file_commands.h"
#include "ui/shell/shortcuts_dialog.h"
#include "ui/shell/tour.h"
#include "ui/shell/window_layout.h"
#include "ui/widgets/field_names.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

QAction* addAction(QMenu* menu, const char* name, const QString& text, const QString& toolTip) {
  QAction* action = menu->addAction(text);
  action->setObjectName(QLatin1String(name));
  action->setToolTip(toolTip);
  return action;
}

/// True if each action's tooltip says more than its text.
bool areExplained(const QList<QAction*>& actions) {
  return std::ranges::all_of(actions, [](const QAction* action) {
    return action->isSeparator() || action->menu() != nullptr ||
           action->toolTip() != QAction(action->text()).toolTip();
  });
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
  tourAction_ =
      addAction(help, "tour", tr("Short &tour"), tr("Explain the panels of this window, one by one"));
  tourAction_->setIcon(icon(QStringLiteral("about")));
  connect(tourAction_, &QAction::triggered, this, &WindowShell::beginTour);
  QAction* keys = addAction(help, "shortcuts", tr("&Keyboard shortcuts"),
                            tr("List and search all commands and their keys"));
  keys->setShortcuts({QKeySequence(Qt::Key_F1), QKeySequence(QStringLiteral("Ctrl+/"))});
  connect(keys, &QAction::triggered, shortcuts_, &ShortcutsDialog::open);
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
  QMenu* menu = view->addMenu(tr("T&heme"));
  auto* group = new QActionGroup(this);
  const std::pair<ColourScheme, QAction*> schemes[] = {
      {ColourScheme::System,
       addAction(menu, "themeSystem", tr("Same as &desktop"), tr("Light or dark, following the desktop"))},
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
       tr("Choose what leads the part: a device, a recording, or the mouse. Press Feel (F5), then push the "
          "part against the others: it stops at contact.")},
      {find("toolBar"), tr("Tools"),
       tr("All these commands are in the menus too. F1 lists all keys; History, beside the parts, takes you "
          "back to any step.")},
  });
}

}  // namespace nearfit::ui
