#pragma once

#include <QObject>

#include "core/servo/servo_tick.h"
#include "ui/model/servo_status.h"

class QLabel;
class QStatusBar;

namespace nearfit::ui {

class HandState;

/// Servo rate, lateness, number of minima and least distance, at the right of the status bar.
class StatusReadout : public QObject {
  Q_OBJECT

 public:
  /// @param hand  What it shows.
  /// @param bar   Becomes the parent.
  StatusReadout(const HandState& hand, QStatusBar* bar);

 private:
  void showStatus(const ServoStatus& status);
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Shows dashes instead of minima and distance.
  void clearSnapshot();

  QLabel *rate_, *lateness_, *minima_, *distance_;
};

}  // namespace nearfit::ui
