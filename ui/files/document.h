#pragma once

#include <QStringList>
#include <QTimer>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/session/session.h"
#include "ui/model/scene_work.h"
#include "ui/view3d/parts/part_shape.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QWidget;

namespace nearfit::ui {

struct DroppedFiles;

/// Opens, saves and extends the session's scene, with the dialogs for that. Loads in another thread; the open
/// scene stays until the new one is completely loaded. Failures go to failed(). Use from the GUI thread.
class Document : public SceneWork {
  Q_OBJECT

 public:
  /// @param session, window  Outlive this.
  Document(Session& session, std::shared_ptr<PartShapeCache> shapes, QWidget* window);
  ~Document() override;

  /// The shapes that loading prepares for drawing.
  const std::shared_ptr<PartShapeCache>& shapes() const noexcept { return shapes_; }
  /// True while a job of load() runs.
  bool isBusy() const noexcept override { return task_.isRunning(); }
  /// Asks whether to save unsaved changes. False if the user cancels, or saving fails.
  bool mayLeaveScene();

  /// Starts an empty scene after asking about unsaved changes.
  void newScene();
  /// Lets the user choose a scene, meshes or CAD documents, then calls openInPlace().
  void askAndOpen();
  /// Opens a scene after asking about unsaved changes. Does nothing while busy.
  void openScene(const QString& file);
  /// Opens a scene that must not be overwritten: it becomes an unnamed scene, so that saving asks for a file.
  /// Asks about unsaved changes. False if the user cancels, or while busy.
  bool openExample(const QString& file);
  /// Opens a scene that was lost before it was saved, after asking about unsaved changes.
  /// Does nothing while busy.
  /// @param journal    The scene file to read.
  /// @param sceneFile  The file that the scene belongs to; empty if none.
  /// @param restored   Called once the scene is open; not if that fails.
  void openRecovered(const QString& journal, const std::filesystem::path& sceneFile,
                     std::function<void()> restored);
  /// Lets the user choose mesh files and CAD documents, and the unit of those that store none, then calls addParts().
  void askAndAddParts();
  /// Loads mesh files as new parts, and CAD documents as parts and groups, in one step of undo. Does nothing while busy.
  /// @param metresPerUnit  Metres per unit of the numbers in files that store no unit.
  /// @param tessellation   Of documents; std::nullopt: as the user chose it last (importTessellation()).
  void addParts(const QStringList& files, double metresPerUnit,
                const std::optional<Tessellation>& tessellation = std::nullopt);
  /// Opens any mix of meshes, CAD documents, folders of these and at most one scene. The scene is opened first.
  /// @param metresPerUnit  Of all files that store no unit; std::nullopt: asks once, if there are any.
  /// @param tessellation   As for addParts(). A scene keeps that of its shapes.
  void openFiles(const QStringList& filesAndFolders, std::optional<double> metresPerUnit = std::nullopt,
                 const std::optional<Tessellation>& tessellation = std::nullopt);
  /// The same in place of the open scene, after asking about unsaved changes: without a scene among the files, those that
  /// can be read make up a new scene without a file. The open scene stays if none can, or if loading is cancelled. Does
  /// nothing while busy.
  void openInPlace(const QStringList& filesAndFolders);
  /// As openFiles(), for what is dropped on the window. While busy it only emits noted().
  void dropFiles(const QStringList& filesAndFolders);
  /// Runs a job in another thread behind a progress dialog. Must not be called while busy.
  /// @param title, text  Of the dialog: "Loading", "Loading bracket.stl".
  /// @param done  Called on the GUI thread with what the job threw, Cancelled included, or null.
  void load(const QString& title, const QString& text, BackgroundTask::Job job,
            std::function<void(std::exception_ptr)> done);
  void prepareHierarchies(std::function<void(bool isReady)> done) override;
  /// False as long as boxes are shown for parts whose shapes are still to be made.
  bool hasAllShapes() const { return !shapes_->hasPostponed(); }
  /// Saves to the session's file, or asks for one if it has none. False if nothing was written.
  bool save();
  /// Asks for a file and saves to it. False if nothing was written.
  bool askAndSaveAs();

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted while shapes are made of parts for which boxes are shown.
  void shapesMade();
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);
  /// Emitted with parts that were added in one step.
  void partsAdded(const std::vector<nearfit::PartId>& parts);
  /// Emitted when a scene is open and parts given with it are still to be loaded.
  void sceneOpened();
  /// Emitted after opening a scene some of whose mesh files have changed since it was saved.
  void meshesHaveChanged(const QStringList& files);
  /// Emitted when opening or adding ends; `isComplete` is false if anything failed or was cancelled, or there
  /// was nothing to open.
  void loaded(bool isComplete);

 private:
  /// Makes in another thread the shapes that loading has left out, if there are any.
  void makePostponedShapes();
  /// Serves the calls that wait for hierarchies, unless busy.
  void prepareNext();
  /// How the files of parts are read.
  struct PartReading {
    double metresPerUnit;       ///< Of those that store no unit.
    Tessellation tessellation;  ///< Of documents.
  };
  /// @param partsAfter  Added once the scene is open.
  void loadScene(const QString& file, const QStringList& partsAfter, const PartReading& reading);
  /// Reads a scene and prepares its shapes.
  /// @param opened   Puts the scene into the session; gets the mesh files that have
  ///                 changed since it was saved.
  void readScene(const QString& file, const QString& name,
                 const std::function<void(Scene, const QStringList& changed)>& opened);
  void open(const DroppedFiles& files, const PartReading& reading);
  bool saveTo(const QString& file);
  struct LoadedFiles;
  enum class Target { OpenScene, NewScene };
  /// Unit for the files that store none, which the user is asked for if there are any; std::nullopt: cancelled. Offers
  /// the one that was chosen last for their folder or else for their type, if there is any.
  std::optional<double> unitOf(const QStringList& files, Target target);
  void loadParts(const QStringList& files, const PartReading& reading, Target target);
  static LoadedFiles loadFiles(const QStringList& files, const PartReading& reading,
                               const ProgressCallback& progress);
  void tellWarnings(const LoadedFiles& files);
  void finishParts(const QStringList& files, const LoadedFiles& loadedFiles, Target target);
  /// Adds the nodes to the open scene, or puts a new scene of them in its place. Returns all parts of them.
  std::vector<PartId> place(const NewNodes& nodes, Target target);

  Session& session_;
  std::shared_ptr<PartShapeCache> shapes_;
  QWidget* window_;
  BackgroundTask task_, shaping_;
  QTimer shaped_, shapesWait_;
  std::map<QString, double> chosenUnits_;                   ///< In this run, by folder and by ".type" [m].
  std::vector<std::function<void(bool isReady)>> waiting_;  ///< Unanswered prepareHierarchies() calls.
};

/// Map the progress of reading, and of building shapes, to shares of `whole`. Reading takes most of the time: shapes of more
/// than a tenth of a second are built later.
ProgressCallback progressOfReading(const ProgressCallback& whole);
ProgressCallback progressOfShapes(const ProgressCallback& whole);

}  // namespace nearfit::ui
