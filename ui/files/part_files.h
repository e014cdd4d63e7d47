#pragma once

#include <QObject>
#include <QStringList>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QMenu;
class QWidget;

namespace nearfit::ui {

class Document;
class HandState;
class MeshWatch;
class NoticeBar;

/// Keeps parts and their files in step: offers to reload files that have changed on disk, and to rescale
/// parts whose unit seems wrong; changes units.
class PartFiles : public QObject {
  Q_OBJECT

 public:
  /// What this acts on; all outlive it.
  struct Context {
    Session& session;
    const HandState& hand;
    Document& document;
    NoticeBar& notices;
  };
  /// @param menu    Receives the actions.
  /// @param window  The parent of dialogs.
  PartFiles(const Context& context, QMenu* menu, QWidget* window, QObject* parent);

  /// Asks for another unit of parts, then reads their files in it, as one undo step; poses stay. All parts of
  /// a glTF, URDF or 3MF document change together, their positions too. Refuses parts whose file stores its unit, and while a
  /// part is being felt: what is felt must not change its size. Does nothing while the document is busy.
  void changeUnit(const std::vector<PartId>& parts);
  /// Repairs the meshes of parts in another thread, as one undo step; their files stay. Refuses while a part is being
  /// felt. Does nothing while the document is busy.
  void repair(const std::vector<PartId>& parts, const MeshRepairs& repairs);
  /// Asks for another tessellation of parts, then reads their shapes in it, as one undo step; all instances follow, and
  /// poses stay. Refuses while a part is being felt. Does nothing while the document is busy.
  void refine(const std::vector<PartId>& parts);

 signals:
  /// Emitted with what repairs did, of several meshes with the first.
  void repaired(const nearfit::GeometryRepair& repair);
  /// Emitted when parts have changed their unit, by undo and redo too.
  void rescaled();
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  struct Wanted {
    PartId part;
    double metresPerUnit;
    std::string sha256 = {};  ///< Required content of its file; empty: any.
    Tessellation tessellation = {};
    MeshRepairs repairs = {};
  };
  void addActions(QMenu* menu);
  void seeChange(const QStringList& files);
  /// Tells that these meshes differ from those that the scene was saved with.
  void tellOfOthers(const QStringList& files);
  /// Offers to reload all changed files that were neither reloaded nor dismissed.
  void offerReload();
  /// Reloads the parts of these files; of all files if the list is empty.
  void reload(QStringList files);
  /// Returns the parts that were read from these files; from any file if the list is empty.
  std::vector<Wanted> partsOf(const QStringList& files) const;
  /// Judges the sizes of doubted parts anew when a geometry is another, and ends the doubt with their scene.
  void followGeometries();
  void judgeSizes(const std::vector<PartId>& added);
  /// Offers to rescale those of these parts whose size is odd; ignores parts that are not in the scene. False if
  /// none is.
  bool offerRescaleOf(std::vector<PartId> parts);
  void offerRescale(const std::vector<PartId>& parts, double ratio, double factor);
  /// Doubts the unit of a document, in metres by its format, whose parts together are too large for one.
  bool offerRescaleOfHuge(const std::vector<PartId>& parts);
  void rescale(const std::vector<PartId>& parts, double factor);
  /// These parts, and all others of their documents that change their unit as a whole.
  std::vector<PartId> withWholeDocuments(const std::vector<PartId>& parts) const;
  using Repaired = std::vector<std::pair<PartGeometryPtr, GeometryRepair>>;
  /// Puts repaired geometries, each with the one that it replaces, into the scene.
  void takeRepaired(const std::vector<PartId>& parts, const Repaired& repaired);
  /// The same part in another unit, from the content that its file had when it was read.
  static Wanted inUnit(const Part& part, double metresPerUnit);
  /// Title and text of the progress dialog.
  struct ProgressText {
    QString title, text;
  };
  /// A sentence with %1 for the names of parts.
  ProgressText textAbout(const std::vector<Wanted>& parts, const QString& title, const QString& text) const;
  /// Reads the files of parts in other units, as one undo step.
  void loadInUnits(const ProgressText& text, const std::vector<Wanted>& wanted, const QString& failure);
  using Command = std::function<void(const std::vector<Session::NewGeometry>&)>;
  using Result = std::function<QString(const std::vector<Session::NewGeometry>&)>;
  /// Reads the files of parts again, and gives what is new to a command.
  /// @param text     Shown to the user meanwhile.
  /// @param failure  Shown to the user if it fails.
  /// @param result   Says what the command did with what was new, if anything; empty: its name.
  void load(const ProgressText& text, const std::vector<Wanted>& wanted, const Command& command,
            const QString& failure, const Result& result = {});

  Session& session_;
  const HandState& hand_;
  Document& document_;
  NoticeBar& notices_;
  QWidget* window_;
  MeshWatch* watch_;
  QAction *reload_ = nullptr, *reloadAlways_ = nullptr;
  QStringList changed_;              ///< Files changed on disk and not reloaded yet.
  std::uint64_t sceneOfOthers_ = 0;  ///< Serial of the scene that was said to have other meshes.
  std::vector<PartId> doubted_;      ///< Parts added with a unit that seemed wrong; empty once dismissed.
  std::map<PartId, PartGeometryPtr> geometries_;  ///< Of all parts, as last judged.
  std::uint64_t sceneFollowed_ = 0;               ///< Serial of their scene.
  QStringList waiting_;                           ///< Files to reload once nothing else is being loaded.
  Subscription changes_;
};

}  // namespace nearfit::ui
