#pragma once

#include <QKeySequence>
#include <QObject>

class QAction;
class QMainWindow;
class QMenu;
class QToolBar;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

/// The main window's actions, menus and toolbar. Knows how actions look; what they do is connected elsewhere.
class Actions : public QObject {
  Q_OBJECT

 public:
  explicit Actions(QMainWindow* window);

  QAction *newScene, *open, *openDemo, *addParts, *save, *saveAs, *exportPlacement, *quit;
  QAction *undo, *redo, *duplicate, *rename, *recolour, *takeInHand, *remove, *selectAll, *selectNone;
  QAction *start, *stop, *letGo, *clutch, *feelSettings;
  QAction *fit, *fitSelection, *viewIso, *viewFront, *viewRight, *viewTop;
  QAction *seeThrough, *edges, *minima, *contacts, *hand, *wrench;
  QAction* about;
  QMenu *fileMenu = nullptr, *viewMenu = nullptr, *feelMenu = nullptr,
        *helpMenu = nullptr;       ///< Null until setUpMenus().
  QMenu *recentMenu, *reloadMenu;  ///< Created empty; filled by their owners.
  QMenu* editMenu;                 ///< Extended by others, who add more commands on parts.
  QMenu* panelsMenu;               ///< For the docks' toggle actions.
  QMenu* placeMenu;                ///< Created empty; placing commands are added by others.

  /// Builds the menu bar. Call once, before anything uses the menus made here.
  void setUpMenus(QMainWindow& window);
  /// Builds the toolbar and turns off the window's own context menu.
  void setUpToolBar(QMainWindow& window);

  /// State that decides which actions are enabled, beside the session's.
  struct Availability {
    bool isBusy = false;  ///< A file is being loaded or parts prepared.
    bool hasSelection = false;
    bool isSelectionLocked = false;
    bool canStart = false;  ///< There is a moving part and another part.
    bool isServoRunning = false;
    bool isHandManual = false;  ///< The servo runs with the manual hand.
    bool isHandDevice = false;  ///< The servo runs with a device.
  };
  /// Enables and disables actions, and names the next step in the texts of undo and redo.
  void update(const Session& session, const Availability& availability);

 private:
  QAction* make(const char* name, const QString& text, const QString& iconName,
                const QKeySequence& keys = {});
  void addViews(QToolBar& bar);
  /// Sets tool tips: what each action does, and its shortcut.
  void explain();
  QAction* makeSwitch(const char* name, const QString& text, const QString& iconName, bool isOn);
};

}  // namespace nearfit::ui
