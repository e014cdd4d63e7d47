#pragma once

#include <QMainWindow>
#include <filesystem>
#include <functional>
#include <memory>

#include "core/session/session.h"

class QDockWidget;
class QMenu;

namespace nearfit::ui {

class ClearanceMapPanel;
class CommandRecordAction;
class Document;
class FeelControl;
class FileCommands;
class HandControl;
class HandState;
class HistoryPanel;
class MoveGuard;
class NoteBar;
class PartChecks;
class PartCommands;
class PathCommands;
class PathSuggestion;
class PlacingTools;
class PlotPanel;
class PosePanel;
class RecordAction;
class Replay;
class SceneCheckPanel;
class SelectedPose;
class Selection;
class ShownPoses;
class UndoActions;
class UnitMenu;
class ViewActions;
class Viewport;
class WindowShell;
struct Failure;

/// The main window of the desktop application: makes the model, the view, panels, tools and commands, lays
/// them out, and shows their failures and notes. Each wires itself to the model and to its own actions; only
/// what those of different folders have to do with each other is connected here.
///
/// Does not own the servo: hand() takes in what it reports, and feel(), handControl(), recording() and
/// suggestion() request what it is to do.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// @param session  Outlives the window.
  explicit MainWindow(Session& session, QWidget* parent = nullptr);
  ~MainWindow() override;

  ClearanceMapPanel& clearanceMap() noexcept { return *clearanceMap_; }
  Document& document() noexcept { return *document_; }
  FeelControl& feel() noexcept { return *feel_; }
  HandControl& handControl() noexcept { return *handControl_; }
  HandState& hand() noexcept { return *hand_; }
  PlacingTools& placing() noexcept { return *placing_; }
  PlotPanel& plots() noexcept { return *plots_; }
  RecordAction& recording() noexcept { return *recording_; }
  PathSuggestion& suggestion() noexcept { return *suggestion_; }
  Selection& selection() noexcept { return *selection_; }
  Viewport& viewport() noexcept { return *viewport_; }

  /// Sends failures to `sink` instead of a message box, for unattended runs.
  void setFailureSink(std::function<void(const Failure&)> sink);
  /// Sets the scene that *Open demo* opens; empty disables the action.
  void setDemoScene(const QString& file);
  /// Sets the first page of the user's guide; empty disables the action.
  void setGuide(const QString& file);
  /// Opens the demo as an unnamed scene. False if there is none, the user cancels, or something is loading.
  bool openDemo();
  /// Starts the tour of the window; with an empty scene it opens the demo first.
  void beginTour();
  /// Keeps journals of unsaved work in that folder, and offers to restore what earlier runs left there.
  void protectWork(const std::filesystem::path& recoveryFolder);
  /// Sets the text of the About box.
  void setAboutText(const QString& text);

 public slots:
  /// Shows a failure without blocking, or passes it to the failure sink.
  void showFailure(const nearfit::ui::Failure& failure);
  /// Shows a note in the status bar, as NoteBar does.
  void showNote(const QString& text);

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void makePanels();
  void makeReviewPanels();
  /// Makes the panel of what is wrong with meshes, in a tab beside `neighbour`.
  void makeCheckPanel(QDockWidget& neighbour);
  /// Makes the panel of the check of all pairs of parts, in a tab beside `neighbour`.
  void makeSceneCheckPanel(QDockWidget& neighbour);
  /// Adds a button to the status bar that shows and hides a dock, or brings it before the other tabs of its place.
  void addDockButton(QDockWidget& dock, const QString& help);
  void makeToolsAndMenus();
  void connectCommands();
  void connectReplay(QDockWidget& timelineDock);
  QDockWidget* addDock(const char* name, const QString& title, QWidget* content, Qt::DockWidgetArea area);
  /// Shows the failures and notes of panels, tools and commands.
  template <class... Sources>
  void listenTo(const Sources&... sources);

  Session& session_;
  Selection* selection_;
  ShownPoses* poses_;
  HandState* hand_;
  MoveGuard* guard_;
  NoteBar* notes_;
  Viewport* viewport_;
  std::unique_ptr<Document> document_;

  FileCommands* files_;
  PartCommands* parts_ = nullptr;
  PartChecks* checks_ = nullptr;
  PosePanel* posePanel_ = nullptr;
  SelectedPose* selectedPose_ = nullptr;
  FeelControl* feel_ = nullptr;
  HistoryPanel* history_ = nullptr;
  UndoActions* undo_ = nullptr;
  CommandRecordAction* commandRecord_ = nullptr;
  ViewActions* viewActions_ = nullptr;
  ClearanceMapPanel* clearanceMap_ = nullptr;
  PlotPanel* plots_ = nullptr;
  Replay* replay_ = nullptr;
  SceneCheckPanel* sceneCheck_ = nullptr;
  PathCommands* paths_ = nullptr;
  RecordAction* recording_ = nullptr;
  PathSuggestion* suggestion_ = nullptr;
  PlacingTools* placing_ = nullptr;
  HandControl* handControl_ = nullptr;

  QMenu* panelsMenu_;
  UnitMenu* units_;
  WindowShell* shell_ = nullptr;
  std::function<void(const Failure&)> failureSink_;
  Subscription changes_;
};

}  // namespace nearfit::ui
