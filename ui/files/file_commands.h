#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <vector>

#include "core/scene/part.h"
#include "core/session/scene_events.h"
#include "ui/widgets/error_box.h"

class QAction;
class QMenu;
class QWidget;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class Document;
class HandState;
class PartFiles;
class RecentFiles;
class Selection;
class Viewport;

/// Commands on scene files and on the files of parts. Shows all parts once some are loaded, and selects those that
/// were added.
class FileCommands : public QObject {
  Q_OBJECT

 public:
  /// What the commands act on; all outlive this.
  struct Context {
    Session& session;
    Selection& selection;
    const HandState& hand;
    Document& document;
    Viewport& view;
  };
  /// @param window  The parent; *Quit* closes it.
  FileCommands(const Context& context, QWidget* window);

  QAction *newScene, *open, *openDemo, *addParts, *importTriangles, *save, *saveAs, *quit;
  QMenu* recentMenu;  ///< Scenes opened or saved last.
  QMenu* reloadMenu;  ///< Reads the files of parts again.

  /// Opens a scene of RecentFiles::list(); no-op while something is loading.
  void openRecent(const QString& file);
  /// Sets the scene that *Open demo* opens; empty disables the action.
  void setDemoScene(const QString& file);
  /// Opens the demo as an unnamed scene. False if there is none, the user cancels, or something is loading.
  bool showDemo();
  /// Calls `then` once there are parts to show: if the scene is empty and there is a demo, opens that first.
  /// If the user cancels that, or it fails, `then` is not called.
  void withParts(std::function<void()> then);

 public slots:
  /// Asks for another unit of parts and reads their files in it.
  void changeUnit(const std::vector<nearfit::PartId>& parts);
  /// Repairs the meshes of parts, as one undo step.
  void repair(const std::vector<nearfit::PartId>& parts, const nearfit::MeshRepairs& repairs);
  /// Asks for another tessellation of parts and reads their shapes in it.
  void refine(const std::vector<nearfit::PartId>& parts);

 signals:
  /// Emitted with what repairs did.
  void repaired(const nearfit::GeometryRepair& repair);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  void makeActions();
  void connectActions();
  void connectDocument();
  void setUpRecentFiles();
  void setUpPartFiles();
  /// Asks for the tessellation of documents that are added from now on.
  void chooseTriangles();
  void showWhole();
  void showAdded(const std::vector<PartId>& parts);
  void update();

  const Context context_;
  QWidget* window_;
  PartFiles* parts_ = nullptr;
  RecentFiles* recent_ = nullptr;
  QString demoScene_;
  Subscription changes_;
};

}  // namespace nearfit::ui
