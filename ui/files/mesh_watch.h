#pragma once

#include <QFileSystemWatcher>
#include <QMap>
#include <QObject>
#include <QSet>
#include <QStringList>
#include <QTimer>

#include "core/session.h"
#include "ui/background_task.h"

namespace nearfit::ui {

/// Tells when a file that a part of the scene was read from holds something else. Also sees files that are
/// replaced as a whole, as most programs save: their folders are watched too. A file is looked at once it has
/// stayed the same for a moment, and its content is compared in another thread.
class MeshWatch : public QObject {
  Q_OBJECT

 public:
  /// How long a file must have stayed the same [ms].
  static constexpr int kSettle = 400;

  /// @param session  Outlives this.
  explicit MeshWatch(Session& session, QObject* parent = nullptr);

 signals:
  void changed(const QStringList& files);

 private:
  /// What a file looks like from outside.
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
  QMap<QString, Stamp> known_;    ///< As it was when it was last compared.
  QMap<QString, Stamp> pending_;  ///< As it was when it was last seen to change.
  QTimer timer_;
  BackgroundTask task_;
};

}  // namespace nearfit::ui
