#pragma once

#include <QObject>
#include <QPointer>
#include <QStringList>
#include <functional>
#include <memory>
#include <vector>

#include "core/session.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"
#include "ui/part_shape.h"

class QWidget;

namespace nearfit::ui {

class ProgressDialog;

/// The session's way to and from files, with the dialogs that go with it. Loads in another thread; what is
/// open stays open until the new is loaded whole.
class Document : public QObject {
  Q_OBJECT

 public:
  /// @param session, window  Outlive this.
  Document(Session& session, std::shared_ptr<PartShapeCache> shapes, QWidget* window);
  ~Document() override;

  bool isBusy() const noexcept { return task_.isRunning(); }
  /// Asks what to do with changes that are not saved. False when the user wants to stay.
  bool mayLeaveScene();

  void newScene();
  void askAndOpen();
  /// Opens a scene after asking about changes.
  void openScene(const QString& file);
  void askAndAddParts();
  /// @param metresPerUnit  Of the numbers in the files.
  void addParts(const QStringList& files, double metresPerUnit);
  /// Any mixture of meshes and at most one scene, which is opened first; meshes in the unit used last.
  void openFiles(const QStringList& files);
  /// Makes the hierarchies of all parts ready in another thread, and calls `done` with whether they are: at
  /// once when nothing is missing, else when it is done or the user has stopped it. Waits for what is being
  /// loaded.
  void prepareHierarchies(std::function<void(bool isReady)> done);
  /// False when nothing was written.
  bool save();
  bool askAndSaveAs();
  /// @param worldFromMoving  Where the moving part is.
  void askAndExport(const RigidTransform& worldFromMoving);

 signals:
  /// The scene is about to be saved or left: whoever holds a part puts its pose into the session now.
  void sceneNeeded();
  void busyChanged();
  void failed(const nearfit::ui::Failure& failure);
  /// A short note for the status bar.
  void noted(const QString& text);
  /// Loading ended, well or not.
  void loaded(bool isComplete);

 private:
  void load(const QString& text, BackgroundTask::Job job, std::function<void(std::exception_ptr)> done);
  void prepareNext();
  void loadScene(const QString& file, const QStringList& partsAfter);
  bool saveTo(const QString& file);
  void finishParts(const std::vector<PartGeometryPtr>& geometries, const QStringList& problems);

  Session& session_;
  std::shared_ptr<PartShapeCache> shapes_;
  QWidget* window_;
  BackgroundTask task_;
  QPointer<ProgressDialog> progress_;
  std::vector<std::function<void(bool isReady)>> waiting_;  ///< For hierarchies.
};

}  // namespace nearfit::ui
