#pragma once

#include <QObject>
#include <QStringList>
#include <vector>

#include "core/session.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"

class QAction;
class QMenu;

namespace nearfit::ui {

class Document;
class MeshWatch;
class NoticeBar;

/// Keeps parts and their files in step: offers to reload what has changed on disk, and to rescale parts whose
/// unit seems to be wrong.
class PartFiles : public QObject {
  Q_OBJECT

 public:
  /// @param session, document, notices  Outlive this.
  /// @param menu  Gets the actions.
  PartFiles(Session& session, Document& document, NoticeBar& notices, QMenu* menu, QObject* parent);

 signals:
  void noted(const QString& text);
  void failed(const nearfit::ui::Failure& failure);

 private:
  struct Wanted {
    PartId part;
    double metresPerUnit;
  };
  void addActions(QMenu* menu);
  void seeChange(const QStringList& files);
  /// Meshes of a scene that are not what it was saved with.
  void tellOfOthers(const QStringList& files);
  /// Names all files that have changed and were neither reloaded nor waved away.
  void offerReload();
  /// All files when there are none.
  void reload(QStringList files);
  /// All parts of the scene that are read from these files; of all files when there are none.
  std::vector<Wanted> partsOf(const QStringList& files) const;
  void judgeSizes(const std::vector<PartId>& added);
  void offerRescale(const std::vector<PartId>& parts, double ratio, double factor);
  void rescale(const std::vector<PartId>& parts, double factor);
  using Command = void (Session::*)(const std::vector<Session::NewGeometry>&);
  /// Loads the files of parts anew, and gives them to the session by a command.
  void load(const QString& text, const std::vector<Wanted>& wanted, Command command, const QString& failure);

  Session& session_;
  Document& document_;
  NoticeBar& notices_;
  MeshWatch* watch_;
  QAction *reload_ = nullptr, *reloadAlways_ = nullptr;
  QStringList changed_;              ///< On disk, and not reloaded yet.
  std::uint64_t sceneOfOthers_ = 0;  ///< The scene that was told to have other meshes.
  QStringList waiting_;              ///< Files to reload once nothing else is being loaded.
};

}  // namespace nearfit::ui
