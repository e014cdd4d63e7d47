#pragma once

#include "ui/dialogs/feel_page.h"
#include "ui/servo_status.h"

class QAction;
class QLabel;
class QToolButton;

namespace nearfit::ui {

class LocksPage;

/// The hand's way into the scene, at hand while it feels: scale and clutch of a device, and which motions
/// count. Of a scripted hand there is nothing to set.
class HandWorkspace : public FeelPage {
  Q_OBJECT

 public:
  /// @param clutch  Holds the part while it is on.
  explicit HandWorkspace(QAction* clutch, QWidget* parent = nullptr);

  /// @param isRecorded  It is a recording, which has been through scale and locks when it was made: instead
  ///                    of them stands why.
  void showHand(Hand hand, bool isRecorded = false);
  /// Whether the part stays though the hand moves, by the clutch here or by one of the device's own.
  void showClutched(bool isClutched);
  /// Then the part stays, whatever the clutch is.
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
