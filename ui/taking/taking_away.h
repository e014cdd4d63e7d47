#pragma once

#include <QObject>
#include <functional>
#include <vector>

#include "core/scene/motion_recording.h"
#include "core/session.h"
#include "ui/dialogs/error_box.h"
#include "ui/pair_segment.h"

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

/// What a user takes away and looks back at, in docks that are hidden at first: exports, the clearance table,
/// plots, recordings and the timeline on which they are played. Puts these together; each knows nothing of
/// the others.
class TakingAway : public QObject {
  Q_OBJECT

 public:
  struct Menus {
    QMenu *file, *feel, *panels;
    QToolBar* toolBar;
    QAction* exportAction;  ///< That others stand beside.
  };
  /// All outlive this.
  struct Window {
    QMainWindow& window;
    Session& session;
    Selection& selection;
    Viewport& viewport;
    std::function<RigidTransform()> poseOfMoving;  ///< Where the moving part is now.
  };
  explicit TakingAway(const Window& window);
  ~TakingAway() override;

  void addTo(const Menus& menus);

 public slots:
  void exportScene();
  void openRecording(const QString& file);
  /// A part is in hand, or no more.
  void showTaken(bool isTaken);
  void showSnapshot(const nearfit::ServoSnapshot& snapshot);
  /// @param lost  Ticks after these that are missing.
  void showTicks(const std::vector<nearfit::MotionRow>& rows, quint64 lost);
  /// What is recorded or will be; empty: nothing.
  void showRecording(const QString& file, double seconds);
  void showRecorded(const QString& file, double seconds, quint64 lost);
  /// The failure itself is told elsewhere.
  void showRecordingFailed();

 signals:
  /// Record to that file; empty: no more.
  void recordRequested(const QString& file);
  /// Numbers that are still being typed count now.
  void sceneNeeded();
  /// Whether a recording moves the part in hand in the view.
  void replayingChanged(bool isReplaying);
  void failed(const nearfit::ui::Failure& failure);
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
