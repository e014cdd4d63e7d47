#include "ui/shell/actions.h"

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QToolBar>
#include <QToolButton>
#include <utility>

#include "core/session/session.h"
#include "ui/panels/view/minima_menu.h"
#include "ui/shell/unit_menu.h"
#include "ui/widgets/names.h"
#include "ui/widgets/split_button.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

Actions::Actions(QMainWindow* window) : QObject(window) {
  newScene = make("newScene", tr("&New scene"), "new", QKeySequence::New);
  open = make("open", tr("&Open scene…"), "open", QKeySequence::Open);
  openDemo = make("openDemo", tr("Open &demo"), "demo");
  addParts = make("addParts", tr("&Add parts…"), "add", QKeySequence(QStringLiteral("Ctrl+I")));
  save = make("save", tr("&Save"), "save", QKeySequence::Save);
  saveAs = make("saveAs", tr("Save &as…"), "save-as", QKeySequence(QStringLiteral("Ctrl+Shift+S")));
  exportPlacement = make("exportPlacement", tr("&Export…"), "export", QKeySequence(QStringLiteral("Ctrl+E")));
  quit = make("quit", tr("&Quit"), {}, QKeySequence(QStringLiteral("Ctrl+Q")));

  undo = make("undo", tr("&Undo"), "undo", QKeySequence::Undo);
  redo = make("redo", tr("&Redo"), "redo");
  redo->setShortcuts({QKeySequence(QStringLiteral("Ctrl+Shift+Z")), QKeySequence(QStringLiteral("Ctrl+Y"))});
  duplicate = make("duplicate", tr("&Duplicate"), "duplicate", QKeySequence(QStringLiteral("Ctrl+D")));
  rename = make("rename", tr("Re&name"), "rename", QKeySequence(Qt::Key_F2));
  recolour = make("recolour", tr("&Colour…"), {});
  takeInHand = make("takeInHand", tr("&Take in hand"), "hand", QKeySequence(QStringLiteral("Ctrl+H")));
  takeInHand->setToolTip(tr("Make the selected part the moving part"));
  selectAll = make("selectAll", tr("Select &all"), {}, QKeySequence::SelectAll);
  selectAll->setToolTip(tr("Select all visible parts"));
  selectNone = make("selectNone", tr("Select n&one"), {}, QKeySequence(QStringLiteral("Ctrl+Shift+A")));
  remove = make("remove", tr("De&lete"), "delete", QKeySequence::Delete);

  start = make("start", tr("&Feel"), "start", QKeySequence(Qt::Key_F5));
  start->setToolTip(tr("Start the servo: feel the moving part against the others (F5)"));
  stop = make("stop", tr("S&top"), "stop", QKeySequence(Qt::Key_F6));
  stop->setToolTip(tr("Stop the servo and leave the part where it is (F6)"));
  letGo = make("letGo", tr("&Let go"), "hand-off", QKeySequence(Qt::Key_F7));
  letGo->setToolTip(tr("Move the manual hand back to the part, so that it no longer presses (F7)"));
  clutch = makeSwitch("clutch", tr("&Clutch"), "clutch", false);
  clutch->setShortcut(QKeySequence(Qt::Key_F9));
  clutch->setToolTip(tr("The part stays while you move the device to a comfortable position (F9)"));
  feelSettings = make("feelSettings", tr("Feel s&ettings…"), "springs");
  feelSettings->setToolTip(tr("Mode, cutoff, margin, stiffness, weight and workspace"));

  fit = make("fit", tr("&Fit all"), "fit", QKeySequence(Qt::Key_F));
  fitSelection = make("fitSelection", tr("Fit se&lected"), "fit", QKeySequence(QStringLiteral("Shift+F")));
  viewIso = make("viewIso", tr("&Isometric"), "view-iso", QKeySequence(Qt::Key_0));
  viewFront = make("viewFront", tr("F&ront"), "view-front", QKeySequence(Qt::Key_1));
  viewRight = make("viewRight", tr("Ri&ght"), "view-right", QKeySequence(Qt::Key_2));
  viewTop = make("viewTop", tr("&Top"), "view-top", QKeySequence(Qt::Key_3));
  seeThrough = makeSwitch("seeThrough", tr("&See through fixed parts"), "translucent", true);
  edges = makeSwitch("edges", tr("&Edges"), "edges", true);
  minima = makeSwitch("minima", tr("&Minima"), "minima", true);
  contacts = makeSwitch("contacts", tr("C&ontacts"), "contacts", true);
  hand = makeSwitch("handGhost", tr("&Hand ahead of the part"), "ghost", true);
  wrench = makeSwitch("wrench", tr("Force and torque &arrows"), "wrench-arrows", true);
  about = make("about", tr("&About Nearfit"), "about");
  explain();
  // These must work from the feel dialog too, which stays open beside the window.
  for (QAction* action : {undo, redo, start, stop, letGo, clutch})
    action->setShortcutContext(Qt::ApplicationShortcut);
  recentMenu = new QMenu(tr("Open &recent"), window);
  reloadMenu = new QMenu(tr("Re&load"), window);
  panelsMenu = new QMenu(tr("&Panels"), window);
  placeMenu = new QMenu(tr("&Place"), window);
}

void Actions::explain() {
  const std::pair<QAction*, QString> tips[] = {
      {newScene, tr("Start an empty scene")},
      {open, tr("Open a scene (*.nearfit) in place of this one")},
      {openDemo, tr("Open the demo scene: a piston to fit into its cylinder")},
      {addParts,
       tr("Add meshes (STL, OBJ, PLY, OFF) to the scene; you can also drop files and folders on the window")},
      {save, tr("Save the scene and where its parts are")},
      {saveAs, tr("Save the scene under another name")},
      {exportPlacement, tr("Export the poses of the parts (JSON, CSV) or the parts as one mesh")},
      {quit, tr("Quit Nearfit; asks first if there are unsaved changes")},
      {duplicate, tr("Add a copy of the selected parts and groups; it shares their meshes")},
      {rename, tr("Give the selected part or group another name")},
      {recolour, tr("Choose another colour for the selected parts")},
      {remove, tr("Delete the selected parts and groups from the scene; their files stay")},
      {selectNone, tr("Select nothing")},
      {fit, tr("Zoom the view to all parts")},
      {fitSelection, tr("Zoom the view to the selected parts")},
      {viewIso, tr("Look from the corner between front, right and top")},
      {viewFront, tr("Look from the front, along Y")},
      {viewRight, tr("Look from the right, along X")},
      {viewTop, tr("Look from above, along Z")},
      {seeThrough, tr("Make the other parts translucent, to see the moving part through them")},
      {edges, tr("Draw the sharp edges of parts as lines")},
      {minima, tr("Draw each local minimum distance while a part is in hand")},
      {contacts, tr("Mark where the part in hand touches")},
      {hand, tr("Draw where the hand wants a part that is held by contact")},
      {wrench, tr("Draw the felt force and torque as arrows")},
      {about, tr("Version, method and licence")},
  };
  for (const auto& [action, tip] : tips) {
    const QString keys = action->shortcut().toString(QKeySequence::NativeText);
    action->setToolTip(keys.isEmpty() ? tip : QStringLiteral("%1 (%2)").arg(tip, keys));
  }
}

QAction* Actions::make(const char* name, const QString& text, const QString& iconName,
                       const QKeySequence& keys) {
  auto* action = new QAction(text, this);
  action->setObjectName(QLatin1String(name));
  if (!iconName.isEmpty()) action->setIcon(icon(iconName));
  action->setShortcut(keys);
  return action;
}

QAction* Actions::makeSwitch(const char* name, const QString& text, const QString& iconName, bool isOn) {
  QAction* action = make(name, text, iconName);
  action->setCheckable(true);
  action->setChecked(isOn);
  return action;
}

void Actions::setUpMenus(QMainWindow& window) {
  QMenu* file = fileMenu = window.menuBar()->addMenu(tr("&File"));
  file->addActions({newScene, open});
  file->addMenu(recentMenu);
  file->addActions({openDemo, file->addSeparator(), addParts});
  file->addMenu(reloadMenu);
  file->addActions({file->addSeparator(), save, saveAs, exportPlacement, file->addSeparator(), quit});
  QMenu* edit = editMenu = window.menuBar()->addMenu(tr("&Edit"));
  edit->addActions({undo, redo, edit->addSeparator(), takeInHand, duplicate, rename, recolour, remove,
                    edit->addSeparator(), selectAll, selectNone});
  QMenu* view = window.menuBar()->addMenu(tr("&View"));
  view->addActions({fit, fitSelection, viewIso, viewFront, viewRight, viewTop, view->addSeparator(),
                    seeThrough, edges, minima, contacts, hand, wrench, view->addSeparator()});
  view->addMenu(panelsMenu);
  view->addMenu(new MinimaMenu(&window));
  view->addMenu(new UnitMenu(&window));
  window.menuBar()->addMenu(placeMenu);
  viewMenu = view;
  QMenu* feel = feelMenu = window.menuBar()->addMenu(tr("F&eel"));
  feel->addActions({start, stop, letGo, clutch, feel->addSeparator(), feelSettings});
  helpMenu = window.menuBar()->addMenu(tr("&Help"));
  helpMenu->addAction(about);
}

void Actions::setUpToolBar(QMainWindow& window) {
  QToolBar* bar = window.addToolBar(tr("Tools"));
  bar->setObjectName(QStringLiteral("toolBar"));
  bar->setMovable(false);
  bar->setIconSize(QSize(24, 24));
  const auto addGroup = [bar](const QList<QAction*>& group) {
    if (!bar->actions().isEmpty()) bar->addSeparator();
    bar->addActions(group);
  };
  addGroup({newScene, open, save});
  addGroup({addParts, duplicate, remove});
  addGroup({undo, redo});
  addGroup({takeInHand, start, stop, feelSettings});
  addGroup({fit});
  addViews(*bar);
  addGroup({seeThrough, edges, minima, contacts, hand, wrench});
  addGroup({exportPlacement});
  for (QAction* action : {addParts, start}) {
    auto* button = qobject_cast<QToolButton*>(bar->widgetForAction(action));
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  }
  window.setContextMenuPolicy(Qt::NoContextMenu);
}

/// Adds one button for all views that shows the last one chosen; it saves room in narrow windows.
void Actions::addViews(QToolBar& bar) {
  auto* button = new QToolButton(&bar);
  button->setObjectName(QStringLiteral("viewsButton"));
  auto* menu = new QMenu(button);
  menu->addActions({viewIso, viewFront, viewRight, viewTop});
  button->setMenu(menu);
  button->setPopupMode(QToolButton::MenuButtonPopup);
  button->setDefaultAction(viewIso);
  button->setStyleSheet(QString::fromLatin1(kSplitButton));
  for (QAction* view : menu->actions())
    connect(view, &QAction::triggered, button, [button, view] { button->setDefaultAction(view); });
  bar.addWidget(button);
}

void Actions::update(const Session& session, const Availability& availability) {
  const bool isFree = !availability.isBusy;
  for (QAction* action : {newScene, open, openDemo, addParts})
    action->setEnabled(isFree);
  const bool hasParts = !session.scene().parts().empty();
  save->setEnabled(isFree && (session.isModified() || availability.isServoRunning));
  for (QAction* action : {saveAs, exportPlacement})
    action->setEnabled(isFree && hasParts);
  undo->setEnabled(isFree && session.canUndo());
  redo->setEnabled(isFree && session.canRedo());
  const auto withLabel = [](const QString& verb, const std::string& label) {
    // An ampersand in a part's name must not become a menu mnemonic.
    const QString name = shortName(label).replace(QChar('&'), QStringLiteral("&&"));
    return label.empty() ? verb : verb + QChar(' ') + name;
  };
  const auto show = [&](QAction* action, const QString& verb, const QString& explained,
                        const std::string& label) {
    action->setText(withLabel(verb, label));
    const QString keys = action->shortcut().toString(QKeySequence::NativeText);
    const QString what = label.empty() ? QString() : QStringLiteral(": ") + shortName(label);
    // A part's name must not be read as markup.
    const QString tip = QStringLiteral("%1%2 (%3)").arg(explained, what, keys);
    action->setToolTip(QStringLiteral("<qt>%1</qt>").arg(tip.toHtmlEscaped()));
  };
  show(undo, tr("&Undo"), tr("Undo the last step"), session.undoText());
  show(redo, tr("&Redo"), tr("Redo the last undone step"), session.redoText());

  const bool canChange = isFree && availability.hasSelection && !availability.isSelectionLocked;
  // Locks prevent neither copying a part nor changing its look.
  for (QAction* action : {duplicate, recolour})
    action->setEnabled(isFree && availability.hasSelection);
  for (QAction* action : {rename, remove, takeInHand})
    action->setEnabled(canChange);
  fitSelection->setEnabled(availability.hasSelection);
  start->setEnabled(isFree && availability.canStart && !availability.isServoRunning);
  stop->setEnabled(availability.isServoRunning);
  letGo->setEnabled(availability.isServoRunning && availability.isHandManual);
  clutch->setEnabled(availability.isServoRunning && availability.isHandDevice);
  selectAll->setEnabled(hasParts);
  selectNone->setEnabled(availability.hasSelection);
  for (QAction* action : {fit, viewIso, viewFront, viewRight, viewTop})
    action->setEnabled(hasParts);
}

}  // namespace nearfit::ui
