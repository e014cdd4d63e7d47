#pragma once

#include <QFrame>

#include "core/servo/servo_snapshot.h"

class QLabel;
class QPushButton;

namespace nearfit::ui {

/// Tells the user why contact is not felt: a fault, with a button to start anew, or overlapping parts. Takes
/// no room if there is nothing to say.
class FeelNotice : public QFrame {
  Q_OBJECT

 public:
  explicit FeelNotice(QWidget* parent = nullptr);

  /// @param scene  Holds the parts' names.
  void showSnapshot(const ServoSnapshot& snapshot, const Scene& scene);
  void clear();

 signals:
  /// Emitted when the user asks to start anew.
  void restartRequested();

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  /// Keeps wrapped lines from being cut off in a panel that is short of room.
  void keepTextWhole();
  QString textFor(const ServoSnapshot& snapshot, const Scene& scene) const;
  static QString overlapText(const ServoSnapshot& snapshot, const Scene& scene);
  /// True if the proxy has waited long enough to say so; a few ticks pass unnoticed.
  bool hasWaitedLong(const ServoSnapshot& snapshot);

  QLabel* text_;
  QPushButton* restart_;
  double waitingSince_ = -1.0;  ///< Servo time [s]; negative while it does not wait.
};

}  // namespace nearfit::ui
