#pragma once

#include <QFileSystemWatcher>
#include <QMap>
#include <QObject>
#include <QSet>
#include <QStringList>
#include <QTimer>

#include "core/session/session.h"
#include "ui/widgets/background_task.h"

namespace nearfit::ui {

/// Notices when a file that a part was read from, or a companion of its document, gets other content. Also notices
/// files that are replaced as a whole, as most programs save, by watching their folders. A file is examined once it has
/// stayed the same for a moment; its content is compared in another thread.
class MeshWatch : public QObject {
  Q_OBJECT

 public:
  /// Time for which a file must have stayed the same [ms].
  static constexpr int kSettle = 400;

  /// @param session  Must outlive this.
  explicit MeshWatch(Session& session, QObject* parent = nullptr);

 signals:
  /// Emitted with the files whose content, or that of a companion, differs from what the parts were read from.
  void changed(const QStringList& files);

 private:
  /// Time of change and size of a file; -1 if it does not exist.
  struct Stamp {
    qint64 modified = -1, size = -1;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stampOf(const QString& file);
  QSet<QString> filesOfScene() const;
  void watchScene();
  void look(const QString& folder);
  void settle();
  void compare(const QStringList& files);

  Session& session_;
  QFileSystemWatcher watcher_;
  QMap<QString, Stamp> known_;    ///< Stamps at the last comparison.
  QMap<QString, Stamp> pending_;  ///< Stamps when a change was last seen.
  QTimer timer_;
  BackgroundTask task_;
  Subscription changes_;
};

}  // namespace nearfit::ui
