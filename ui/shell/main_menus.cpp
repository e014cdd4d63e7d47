#include "ui/shell/main_menus.h"

#include <QAction>
#include <QActionGroup>
#include <QMainWindow>
#include <QMenuBar>
#include <QToolBar>
#include <QToolButton>

#include "ui/files/export/exporter.h"
#include "ui/files/export/picture_taker.h"
#include "ui/files/file_commands.h"
#include "ui/panels/clearance/map_panel.h"
#include "ui/panels/feel/feel_control.h"
#include "ui/panels/history/command_record_action.h"
#include "ui/panels/history/undo_actions.h"
#include "ui/panels/parts/joint_actions.h"
#include "ui/panels/parts/part_commands.h"
#include "ui/panels/parts/tree_actions.h"
#include "ui/panels/replay/path_commands.h"
#include "ui/panels/replay/record_action.h"
#include "ui/panels/replay/replay.h"
#include "ui/panels/suggest/path_suggestion.h"
#include "ui/panels/verdict/scene_check_panel.h"
#include "ui/panels/view/feeling_view.h"
#include "ui/panels/view/view_actions.h"
#include "ui/tools/measure/measure_tool.h"
#include "ui/tools/placing/align_tool.h"
#include "ui/tools/placing/drop_tool.h"
#include "ui/tools/placing/hand_control.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/tools/section/section_tool.h"
#include "ui/tools/selecting/box_select.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/split_button.h"

namespace nearfit::ui {

UnitMenu::UnitMenu(QWidget* window)
    : QMenu(tr("&Unit of length"), window), window_(window), group_(new QActionGroup(this)) {
  setObjectName(QStringLiteral("unitMenu"));
  setShownLengthUnit(Preferences::lengthUnit());
  for (const LengthUnit unit : kLengthUnits) {
    QAction* action = addAction(tr("%1 (%2)").arg(nameOf(unit), symbolOf(unit)));
    action->setObjectName(QStringLiteral("unit-") + symbolOf(unit));
    action->setCheckable(true);
    action->setChecked(unit == Preferences::lengthUnit());
    group_->addAction(action);
    connect(action, &QAction::triggered, this, [this, unit] { choose(unit); });
  }
}

void UnitMenu::choose(LengthUnit unit) {
  Preferences::setLengthUnit(unit);
  setShownLengthUnit(unit);
  for (NumberField* field : window_->findChildren<NumberField*>())
    field->setLengthUnit(unit);
  // Painted lengths are formatted while painting.
  for (QWidget* widget : window_->findChildren<QWidget*>())
    widget->update();
  emit unitChanged(unit);
}

MainMenus::MainMenus(QMainWindow* window, const Commands& commands, QMenu* panels, QMenu* units)
    : QObject(window), window_(window), commands_(commands) {
  setUpToolBar();
  setUpFileMenu();
  setUpEditMenu();
  setUpViewMenu(panels, units);
  setUpPlacing();
  setUpFeelMenu();
  help_ = window_->menuBar()->addMenu(tr("&Help"));
  // The window's own context menu would offer to hide the tool bars.
  window_->setContextMenuPolicy(Qt::NoContextMenu);
}

void MainMenus::setUpFileMenu() {
  const FileCommands& files = commands_.files;
  QMenu* menu = window_->menuBar()->addMenu(tr("&File"));
  menu->addActions({files.newScene, files.open});
  menu->addMenu(files.recentMenu);
  menu->addActions({files.openDemo, menu->addSeparator(), files.addParts, files.importTriangles});
  menu->addMenu(files.reloadMenu);
  menu->addActions({menu->addSeparator(), files.save, files.saveAs, commands_.exporter.exportAction(),
                    commands_.exporter.reportAction(), commands_.exporter.copyAction(),
                    commands_.pictures.save(), commands_.pictures.copy(), menu->addSeparator(), files.quit});
}

void MainMenus::setUpEditMenu() {
  const PartCommands& parts = commands_.parts;
  QMenu* menu = window_->menuBar()->addMenu(tr("&Edit"));
  menu->setObjectName(QStringLiteral("editMenu"));
  menu->addActions({commands_.undo.undo, commands_.undo.redo, menu->addSeparator(), parts.takeInHand,
                    parts.duplicate, parts.rename, parts.recolour, parts.changeUnit, parts.refine,
                    parts.check, commands_.suggestion.action(), parts.remove, menu->addSeparator(),
                    parts.selectAll, commands_.boxSelect.action(), parts.selectNone});
  parts.tree().addTo(*menu);
  menu->addMenu(&parts.joints().menu());
  menu->addActions({menu->addSeparator(), &commands_.recordCommands});
}

void MainMenus::setUpViewMenu(QMenu* panels, QMenu* units) {
  const ViewActions& view = commands_.view;
  view_ = window_->menuBar()->addMenu(tr("&View"));
  view_->addActions({view.fit, view.fitSelection});
  view_->addActions(view.views());
  view_->addActions({view.orthographic, view_->addSeparator()});
  view_->addActions(view.switches());
  view_->addActions({commands_.clearanceMap.colour(), view.feeling().legend(), view.scaleBar,
                     view_->addSeparator(), commands_.measure.action(), commands_.section.action(),
                     commands_.sceneCheck.action(), view_->addSeparator()});
  for (QMenu* menu : {panels, view.minimaMenu(), view.feeling().qualityMenu(), units})
    view_->addMenu(menu);
}

void MainMenus::setUpPlacing() {
  QMenu* menu = window_->menuBar()->addMenu(tr("&Place"));
  QToolBar* bar = commands_.placing.addTo(*window_, *menu);
  menu->addSeparator();
  menu->addActions(commands_.align.actions());
  commands_.drop.addTo(*menu);
  QAction* first = bar->actions().constFirst();
  bar->insertAction(first, commands_.boxSelect.action());
  bar->insertSeparator(first);
  // The rest of them, which keep parts, are in the menu.
  bar->addActions(commands_.align.actions().mid(0, 2));
  bar->addSeparator();
  bar->addActions({commands_.measure.action(), commands_.section.action()});
}

void MainMenus::setUpFeelMenu() {
  const FeelControl& feel = commands_.feel;
  QMenu* menu = window_->menuBar()->addMenu(tr("Fee&l"));
  menu->addActions({feel.start, feel.stop, commands_.hand.letGoAction(), feel.clutch, menu->addSeparator(),
                    feel.settings, menu->addSeparator(), &commands_.record, commands_.replay.openAction()});
  menu->addMenu(&commands_.paths.menu());
}

void MainMenus::setUpToolBar() {
  const FileCommands& files = commands_.files;
  const PartCommands& parts = commands_.parts;
  const FeelControl& feel = commands_.feel;
  QToolBar* bar = window_->addToolBar(tr("Tools"));
  bar->setObjectName(QStringLiteral("toolBar"));
  bar->setMovable(false);
  bar->setIconSize(QSize(24, 24));
  const auto addGroup = [bar](const QList<QAction*>& group) {
    if (!bar->actions().isEmpty()) bar->addSeparator();
    bar->addActions(group);
  };
  addGroup({files.newScene, files.open, files.save});
  addGroup({files.addParts, parts.duplicate, parts.remove});
  addGroup({commands_.undo.undo, commands_.undo.redo});
  addGroup({parts.takeInHand, feel.start, feel.stop, feel.settings});
  addGroup({commands_.view.fit});
  addViews(*bar);
  addGroup(commands_.view.switches());
  addGroup({&commands_.record, commands_.exporter.exportAction()});
  for (QAction* action : {files.addParts, feel.start}) {
    auto* button = qobject_cast<QToolButton*>(bar->widgetForAction(action));
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  }
}

/// Adds one button for all views that shows the last one chosen; it saves room in narrow windows.
void MainMenus::addViews(QToolBar& bar) {
  const QList<QAction*>& views = commands_.view.views();
  auto* button = new QToolButton(&bar);
  button->setObjectName(QStringLiteral("viewsButton"));
  auto* menu = new QMenu(button);
  menu->addActions(views);
  button->setMenu(menu);
  button->setPopupMode(QToolButton::MenuButtonPopup);
  button->setDefaultAction(views.constFirst());
  button->setStyleSheet(QString::fromLatin1(kSplitButton));
  for (QAction* view : views)
    connect(view, &QAction::triggered, button, [button, view] { button->setDefaultAction(view); });
  bar.addWidget(button);
}

}  // namespace nearfit::ui
