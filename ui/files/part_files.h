#pragma once

#include <QObject>
#include <QStringList>
#include <vector>

#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QMenu;

namespace nearfit::ui {

class Document;
class MeshWatch;
class NoticeBar;

/// Keeps parts and their files in step: offers to reload files that have changed on disk, and to rescale
/// parts whose unit seems wrong.
class PartFiles : public QObject {
  Q_OBJECT

 public:
  /// @param session   Must outlive this.
  /// @param document  Must outlive this.
  /// @param notices   Must outlive this.
  /// @param menu      Receives the actions.
  PartFiles(Session& session, Document& document, NoticeBar& notices, QMenu* menu, QObject* parent);

 signals:
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  struct Wanted {
    PartId part;
    double metresPerUnit;
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
  void judgeSizes(const std::vector<PartId>& added);
  void offerRescale(const std::vector<PartId>& parts, double ratio, double factor);
  void rescale(const std::vector<PartId>& parts, double factor);
  using Command = void (Session::*)(const std::vector<Session::NewGeometry>&);
  /// Reads the files of parts again, and gives the results to the session by a command.
  /// @param text     Shown to the user meanwhile.
  /// @param failure  Shown to the user if it fails.
  void load(const QString& text, const std::vector<Wanted>& wanted, Command command, const QString& failure);

  Session& session_;
  Document& document_;
  NoticeBar& notices_;
  MeshWatch* watch_;
  QAction *reload_ = nullptr, *reloadAlways_ = nullptr;
  QStringList changed_;              ///< Files changed on disk and not reloaded yet.
  std::uint64_t sceneOfOthers_ = 0;  ///< Serial of the scene that was said to have other meshes.
  QStringList waiting_;              ///< Files to reload once nothing else is being loaded.
  Subscription changes_;
};

}  // namespace nearfit::ui
