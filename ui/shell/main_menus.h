#pragma once

#include <QMenu>
#include <QObject>

#include "ui/widgets/length_unit.h"

class QAction;
class QActionGroup;
class QMainWindow;
class QToolBar;

namespace nearfit::ui {

class AlignTool;
class BoxSelect;
class ClearanceMapPanel;
class CommandRecordAction;
class DropTool;
class Exporter;
class FeelControl;
class FileCommands;
class HandControl;
class MeasureTool;
class PartCommands;
class PathCommands;
class PathSuggestion;
class PictureTaker;
class PlacingTools;
class RecordAction;
class Replay;
class SceneCheckPanel;
class SectionTool;
class UndoActions;
class ViewActions;

/// The choice of the length unit, kept between runs and passed to every NumberField of the window.
class UnitMenu : public QMenu {
  Q_OBJECT

 public:
  /// Sets shownLengthUnit() to the stored unit.
  /// @param window  The parent; its number fields follow the choice.
  explicit UnitMenu(QWidget* window);

 signals:
  /// Emitted when the user chose a unit, after fields and shownLengthUnit() have changed.
  void unitChanged(nearfit::ui::LengthUnit unit);

 private:
  void choose(LengthUnit unit);

  QWidget* window_;
  QActionGroup* group_;
};

/// The menu bar and the tool bars: where the actions of panels, tools and files are found. What they do, and
/// when they can be used, is theirs.
class MainMenus : public QObject {
  Q_OBJECT

 public:
  /// Those whose actions are shown.
  struct Commands {
    FileCommands& files;
    Exporter& exporter;
    PictureTaker& pictures;
    UndoActions& undo;
    CommandRecordAction& recordCommands;
    PartCommands& parts;
    BoxSelect& boxSelect;
    ViewActions& view;
    MeasureTool& measure;
    SectionTool& section;
    PlacingTools& placing;
    AlignTool& align;
    DropTool& drop;
    FeelControl& feel;
    HandControl& hand;
    RecordAction& record;
    Replay& replay;
    ClearanceMapPanel& clearanceMap;
    SceneCheckPanel& sceneCheck;
    PathCommands& paths;
    PathSuggestion& suggestion;
  };
  /// @param panels  Menu of the docks, for the view menu.
  /// @param units   Menu of units, for the view menu.
  MainMenus(QMainWindow* window, const Commands& commands, QMenu* panels, QMenu* units);

  /// Menus to which WindowShell adds what it offers.
  QMenu* viewMenu() const noexcept { return view_; }
  QMenu* helpMenu() const noexcept { return help_; }

 private:
  void setUpFileMenu();
  void setUpEditMenu();
  void setUpViewMenu(QMenu* panels, QMenu* units);
  void setUpFeelMenu();
  void setUpToolBar();
  void setUpPlacing();
  void addViews(QToolBar& bar);

  QMainWindow* window_;
  const Commands commands_;
  QMenu *view_ = nullptr, *help_ = nullptr;
};

}  // namespace nearfit::ui
