#pragma once

#include <QObject>
#include <QStringList>

class QMenu;

namespace nearfit::ui {

/// The scenes opened or saved last, kept between runs, and the menu that opens them again.
class RecentFiles : public QObject {
  Q_OBJECT

 public:
  static constexpr int kMax = 10;

  /// @param menu  Filled each time that it opens; must outlive this.
  explicit RecentFiles(QMenu* menu, QObject* parent = nullptr);

  /// Returns the files, newest first, including missing ones.
  static QStringList list();
  /// Puts a file first; drops the oldest beyond kMax.
  static void remember(const QString& file);
  /// Removes a file from the list.
  static void forget(const QString& file);
  /// Opens a file of the list: emits openRequested(), or missing().
  void open(const QString& file);

 signals:
  /// Emitted when the user chooses a file that exists.
  void openRequested(const QString& file);
  /// Emitted when the user chooses a file that is missing; it was removed from the list.
  void missing(const QString& file);

 private:
  void fill();

  QMenu* menu_;
};

}  // namespace nearfit::ui
