#pragma once

#include <QObject>

#include "core/haptics/servo_tick.h"
#include "ui/servo_status.h"

class QLabel;
class QStatusBar;

namespace nearfit::ui {

/// The figures at the right of the status bar: servo rate, lateness, minima, least distance.
class StatusReadout : public QObject {
  Q_OBJECT

 public:
  explicit StatusReadout(QStatusBar* bar);

  void showStatus(const ServoStatus& status);
  void showSnapshot(const ServoSnapshot& snapshot);
  void clearSnapshot();

 private:
  QLabel *rate_, *lateness_, *minima_, *distance_;
};

}  // namespace nearfit::ui
