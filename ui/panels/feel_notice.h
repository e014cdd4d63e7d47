#pragma once

#include <QFrame>

#include "core/haptics/servo_snapshot.h"

class QLabel;
class QPushButton;

namespace nearfit::ui {

/// What a user must know about why contact is not felt: a fault, with a way to start anew, or parts that
/// overlap. Takes no room while there is nothing.
class FeelNotice : public QFrame {
  Q_OBJECT

 public:
  explicit FeelNotice(QWidget* parent = nullptr);

  /// @param scene  For the names of the parts.
  void showSnapshot(const ServoSnapshot& snapshot, const Scene& scene);
  void clear();

 signals:
  void restartRequested();

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  /// A panel that is short of room would cut lines that wrap.
  void keepTextWhole();
  QString textFor(const ServoSnapshot& snapshot, const Scene& scene) const;
  /// Whether the proxy has waited for long enough to say so; a few ticks pass unnoticed.
  bool hasWaitedLong(const ServoSnapshot& snapshot);

  QLabel* text_;
  QPushButton* restart_;
  double waitingSince_ = -1.0;  ///< By the servo's clock [s]; negative while it does not wait.
};

}  // namespace nearfit::ui
