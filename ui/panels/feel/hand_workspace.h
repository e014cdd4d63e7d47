#pragma once

#include "ui/model/servo_status.h"
#include "ui/panels/feel/feel_page.h"

class QAction;
class QLabel;
class QToolButton;

namespace nearfit::ui {

class LocksPage;

/// Settings of the hand's workspace, within reach while it feels: scale and clutch of a device, and which
/// motions count. A scripted hand has nothing to set.
class HandWorkspace : public FeelPage {
  Q_OBJECT

 public:
  /// @param clutch  Holds the part while it is on.
  explicit HandWorkspace(QAction* clutch, QWidget* parent = nullptr);

  /// Shows what this hand can set.
  /// @param isRecorded  True for a recording, which contains scale and locks already: a note says so.
  void showHand(Hand hand, bool isRecorded = false);
  /// Shows whether the part stays, by the clutch here or by the device's own.
  void showClutched(bool isClutched);
  /// Says that the part stays until the device is calibrated, whatever the clutch does.
  void showUncalibrated(bool isUncalibrated);

 protected:
  void refresh() override;

 private:
  QWidget* scaleRow_;
  QToolButton* clutch_;
  QLabel *note_, *recorded_;
  LocksPage* locks_;
};

}  // namespace nearfit::ui
