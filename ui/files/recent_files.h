#pragma once

#include <QObject>
#include <QStringList>

class QMenu;

namespace nearfit::ui {

/// The scenes opened and saved last, kept from run to run, and the menu that opens them again.
class RecentFiles : public QObject {
  Q_OBJECT

 public:
  static constexpr int kMost = 10;

  /// @param menu  Filled each time that it opens; outlives this.
  explicit RecentFiles(QMenu* menu, QObject* parent = nullptr);

  /// Newest first; also those that are not there any more.
  static QStringList list();
  /// Puts a file first.
  static void remember(const QString& file);
  static void forget(const QString& file);

 signals:
  void openRequested(const QString& file);
  /// It is not there any more, and is no longer in the list.
  void missing(const QString& file);

 private:
  void fill();
  void open(const QString& file);

  QMenu* menu_;
};

}  // namespace nearfit::ui
