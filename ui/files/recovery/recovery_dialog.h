#pragma once

#include <QDialog>
#include <vector>

#include "core/recovery/recovery_folder.h"

class QVBoxLayout;

namespace nearfit::ui {

/// Offers to restore each piece of lost work, to discard it, or to leave it for later. Closing the dialog
/// leaves the rest for later.
class RecoveryDialog : public QDialog {
  Q_OBJECT

 public:
  RecoveryDialog(const std::vector<LostWork>& lost, QWidget* parent);

 signals:
  /// Emitted when the user restores one; the dialog closes, since only one scene is open at a time.
  void restoreRequested(const nearfit::LostWork& work);
  /// Emitted when the user discards one.
  void discardRequested(const nearfit::LostWork& work);

 private:
  void addRow(const LostWork& work, int number);
  void removeRow(QWidget* row);

  QVBoxLayout* rows_;
  int rowCount_ = 0;
};

}  // namespace nearfit::ui
