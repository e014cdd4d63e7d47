#pragma once

#include <QByteArray>
#include <QObject>

class QMainWindow;

namespace nearfit::ui {

/// A window's place, size and docks, kept from run to run. Made once all docks are there.
class WindowLayout : public QObject {
  Q_OBJECT

 public:
  explicit WindowLayout(QMainWindow* window);

  /// As it was when the program was closed last.
  void restore();
  void remember() const;
  /// As it is in a fresh start.
  void reset();

 private:
  QMainWindow* window_;
  QByteArray fresh_;
};

}  // namespace nearfit::ui
