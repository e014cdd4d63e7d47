#pragma once

#include <QObject>
#include <QPointer>
#include <QStringList>
#include <filesystem>
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
struct DroppedFiles;

/// The session's way to and from files, with the dialogs that go with it. Loads in another thread; what is
/// open stays open until the new is loaded whole.
class Document : public QObject {
  Q_OBJECT

 public:
  /// @param session, window  Outlive this.
  Document(Session& session, std::shared_ptr<PartShapeCache> shapes, QWidget* window);
  ~Document() override;

  const std::shared_ptr<PartShapeCache>& shapes() const noexcept { return shapes_; }
  bool isBusy() const noexcept { return task_.isRunning(); }
  /// Asks what to do with changes that are not saved. False when the user wants to stay.
  bool mayLeaveScene();

  void newScene();
  void askAndOpen();
  /// Opens a scene after asking about changes.
  void openScene(const QString& file);
  /// As openScene, of one that others need as it is: it becomes an unnamed scene, so that saving asks where.
  /// False when the user stays with what is open, or something is being loaded.
  bool openExample(const QString& file);
  /// Opens a scene that was lost before it was saved, after asking about changes.
  /// @param journal    A scene file that it is read from.
  /// @param sceneFile  That the scene has as its own; empty for none.
  /// @param restored   Called once it is open.
  void openLost(const QString& journal, const std::filesystem::path& sceneFile,
                std::function<void()> restored);
  void askAndAddParts();
  /// @param metresPerUnit  Of the numbers in the files.
  void addParts(const QStringList& files, double metresPerUnit);
  /// Any mixture of meshes and at most one scene, which is opened first; meshes in the unit used last.
  void openFiles(const QStringList& files);
  /// As openFiles, for what was dropped: folders are taken apart, and the unit of all meshes is asked once.
  void dropFiles(const QStringList& filesAndFolders);
  /// Runs a job in another thread, showing progress; `done` gets what it threw, or null. Nothing may be
  /// running.
  void load(const QString& text, BackgroundTask::Job job, std::function<void(std::exception_ptr)> done);
  /// Makes the hierarchies of all parts ready in another thread, and calls `done` with whether they are: at
  /// once when nothing is missing, else when it is done or the user has stopped it. Waits for what is being
  /// loaded.
  void prepareHierarchies(std::function<void(bool isReady)> done);
  /// False when nothing was written.
  bool save();
  bool askAndSaveAs();

 signals:
  /// The scene is about to be saved or left: whoever holds a part puts its pose into the session now.
  void sceneNeeded();
  void busyChanged();
  void failed(const nearfit::ui::Failure& failure);
  /// A short note for the status bar.
  void noted(const QString& text);
  /// These came together.
  void partsAdded(const std::vector<nearfit::PartId>& parts);
  /// A scene is in the session; parts that were named with it are still to come.
  void sceneOpened();
  /// These meshes of the scene that has been opened are no longer what it was saved with.
  void meshesHaveChanged(const QStringList& files);
  /// Loading ended, well or not.
  void loaded(bool isComplete);

 private:
  void prepareNext();
  /// @param metresPerUnit  Of the parts that are added after.
  void loadScene(const QString& file, const QStringList& partsAfter, double metresPerUnit);
  /// @param opened  Puts the scene into the session.
  /// @param changed  Meshes that are other files than those that it was saved with.
  void readScene(const QString& file, const QString& name,
                 const std::function<void(Scene, const QStringList& changed)>& opened);
  void open(const DroppedFiles& files, double metresPerUnit);
  bool saveTo(const QString& file);
  void finishParts(const QStringList& files, const std::vector<PartGeometryPtr>& geometries,
                   const QVector<FailedItem>& problems);

  Session& session_;
  std::shared_ptr<PartShapeCache> shapes_;
  QWidget* window_;
  BackgroundTask task_;
  QPointer<ProgressDialog> progress_;
  std::vector<std::function<void(bool isReady)>> waiting_;  ///< For hierarchies.
};

/// The progress of reading, and of making what is drawn of it, as parts of the whole: that of either is about
/// half of the time.
ProgressCallback progressOfReading(const ProgressCallback& whole);
ProgressCallback progressOfShapes(const ProgressCallback& whole);

/// Whether that is what a job throws that the user has stopped.
bool isCancelled(const std::exception_ptr& error);

}  // namespace nearfit::ui
