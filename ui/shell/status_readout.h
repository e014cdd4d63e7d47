#pragma once

#include <QObject>

#include "core/servo/servo_tick.h"
#include "ui/model/servo_status.h"

class QLabel;
class QStatusBar;

namespace nearfit::ui {

/// Servo rate, lateness, number of minima and least distance, at the right of the status bar.
class StatusReadout : public QObject {
  Q_OBJECT

 public:
  /// @param bar  Becomes the parent.
  explicit StatusReadout(QStatusBar* bar);

  void showStatus(const ServoStatus& status);
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Shows dashes instead of minima and distance.
  void clearSnapshot();

 private:
  QLabel *rate_, *lateness_, *minima_, *distance_;
};

}  // namespace nearfit::ui
