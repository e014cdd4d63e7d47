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

/// Every action of the main window, its menus and its toolbar. Knows what the actions look like, not what
/// they do.
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
        *helpMenu = nullptr;       ///< Once setUpMenus has made them.
  QMenu *recentMenu, *reloadMenu;  ///< Filled by those who know what belongs there.
  QMenu* editMenu;                 ///< For what else is done with parts.
  QMenu* panelsMenu;               ///< For the docks' own switches.
  QMenu* placeMenu;                ///< For what places parts.

  void setUpMenus(QMainWindow& window);
  void setUpToolBar(QMainWindow& window);

  /// What can be done now.
  struct Availability {
    bool isBusy = false;  ///< Something is being loaded.
    bool hasSelection = false;
    bool isSelectionLocked = false;
    bool canStart = false;
    bool isServoRunning = false;
    bool isHandManual = false;  ///< While the servo runs.
    bool isHandDevice = false;  ///< So too.
  };
  void update(const Session& session, const Availability& availability);

 private:
  QAction* make(const char* name, const QString& text, const QString& iconName,
                const QKeySequence& keys = {});
  void addViews(QToolBar& bar);
  /// What each does, with its keys, under the mouse.
  void explain();
  QAction* makeSwitch(const char* name, const QString& text, const QString& iconName, bool isOn);
};

}  // namespace nearfit::ui
