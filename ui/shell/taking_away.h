#pragma once

#include <QObject>
#include <functional>
#include <vector>

#include "core/servo/motion_recording.h"
#include "core/session/session.h"
#include "ui/view3d/glyphs/pair_segment.h"
#include "ui/widgets/error_box.h"

class QAction;
class QDockWidget;
class QMainWindow;
class QMenu;
class QToolBar;
class QWidget;

namespace nearfit::ui {

class ClearancePanel;
class ClearanceSearch;
class Exporter;
class PictureTaker;
class PlotPanel;
class Replay;
class Selection;
class Timeline;
class Viewport;

/// Puts together what a user exports and looks back at: exports, the clearance table, plots, recordings and
/// the timeline that plays them, in docks that are hidden at first. None of these knows the others.
class TakingAway : public QObject {
  Q_OBJECT

 public:
  struct Menus {
    QMenu *file, *feel, *panels;
    QToolBar* toolBar;
    QAction* exportAction;  ///< Others are inserted beside it.
  };
  /// All must outlive this.
  struct Window {
    QMainWindow& window;
    Session& session;
    Selection& selection;
    Viewport& viewport;
    std::function<RigidTransform()> poseOfMoving;  ///< Returns the moving part's worldFromPart now.
  };
  explicit TakingAway(const Window& window);
  ~TakingAway() override;

  /// Adds the actions to menus and tool bar.
  void addTo(const Menus& menus);

 public slots:
  /// Asks what to export and writes it.
  void exportScene();
  /// Opens a recording on the timeline.
  void openRecording(const QString& file);
  /// Tells whether a part is in hand: no recording is played then.
  void showTaken(bool isTaken);
  /// Updates the clearances of the part in hand.
  void showSnapshot(const nearfit::ServoSnapshot& snapshot);
  /// Plots ticks.
  /// @param lost  Ticks missing after these.
  void showTicks(const std::vector<nearfit::MotionRow>& rows, quint64 lost);
  /// Shows what is recorded, or will be; empty: nothing.
  /// @param seconds  Length so far [s].
  void showRecording(const QString& file, double seconds);
  /// Tells that a recording is complete.
  /// @param seconds  Its length [s].
  /// @param lost     Ticks missing in it.
  void showRecorded(const QString& file, double seconds, quint64 lost);
  /// Tells that recording has ended early; the failure itself is shown elsewhere.
  void showRecordingFailed();

 signals:
  /// Emitted with the file to record to; empty: stop recording.
  void recordRequested(const QString& file);
  /// Emitted before an export: numbers that are still being typed count now.
  void sceneNeeded();
  /// Emitted when a recording starts or ceases to move the part in the view.
  void replayingChanged(bool isReplaying);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  QDockWidget* addDock(const char* name, const QString& title, QWidget* content, Qt::DockWidgetArea area);
  void setUpActions();
  void setUpDocks();
  void connectClearance();
  void connectReplay();
  void showPair();
  void toggleRecord(bool isOn);

  Window window_;
  PairSegment segment_;
  Exporter* exporter_;
  PictureTaker* pictures_;
  ClearanceSearch* search_;
  ClearancePanel* clearances_;
  PlotPanel* plots_;
  Timeline* timeline_;
  Replay* replay_;
  QDockWidget *clearanceDock_, *plotsDock_, *timelineDock_;
  QAction *copy_, *record_, *openRecording_;
  bool isTaken_ = false;
};

}  // namespace nearfit::ui
