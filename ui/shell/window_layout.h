#pragma once

#include <QByteArray>
#include <QObject>

class QMainWindow;

namespace nearfit::ui {

/// A window's position, size and docks, kept between runs. Make it once all docks exist.
class WindowLayout : public QObject {
  Q_OBJECT

 public:
  explicit WindowLayout(QMainWindow* window);

  /// Restores the layout of the last run. A window that is larger than its screen is fitted to it.
  void restore();
  /// Saves the layout for the next run.
  void remember() const;
  /// Restores the docks of a fresh start.
  void reset();

 private:
  void fitToScreen();

  QMainWindow* window_;
  QByteArray fresh_;
};

}  // namespace nearfit::ui
