#pragma once

#include <QWidget>

#include "core/haptics/servo_tick.h"
#include "ui/servo_status.h"

class QComboBox;
class QLabel;
class QPushButton;
class QVBoxLayout;

namespace nearfit::ui {

/// Start and stop of the servo, whose hand it is, and what is felt: wrench, minima and timing in numbers.
class FeelPanel : public QWidget {
  Q_OBJECT

 public:
  /// @param springsButton  Opens the springs; becomes part of this panel.
  explicit FeelPanel(QWidget* springsButton, QWidget* parent = nullptr);

  Hand hand() const;
  void setStartable(bool isStartable);
  void showStatus(const ServoStatus& status);
  void showSnapshot(const ServoSnapshot& snapshot);
  void clearSnapshot();

 signals:
  void startRequested();
  void stopRequested();
  void handChanged();

 private:
  QLabel* addReadout(QVBoxLayout& layout, const QString& name, const QString& objectName);
  void addHeading(QVBoxLayout& layout, const QString& text);

  QComboBox* hand_;
  QPushButton* startStop_;
  QLabel *force_, *torque_, *distance_, *minima_, *clamped_;
  QLabel *rate_, *lateness_, *tick_, *overruns_, *scheduling_;
  bool isRunning_ = false, isStartable_ = false;
};

}  // namespace nearfit::ui
