#pragma once

#include <QDialog>
#include <vector>

#include "core/recovery/recovery_folder.h"

class QVBoxLayout;

namespace nearfit::ui {

/// Offers each piece of lost work to be restored, discarded, or left for later. Closing it leaves the rest
/// for later.
class RecoveryDialog : public QDialog {
  Q_OBJECT

 public:
  RecoveryDialog(const std::vector<LostWork>& lost, QWidget* parent);

 signals:
  /// The dialog then closes: one scene is open at a time.
  void restoreRequested(const nearfit::LostWork& work);
  void discardRequested(const nearfit::LostWork& work);

 private:
  void addRow(const LostWork& work, int number);
  void removeRow(QWidget* row);

  QVBoxLayout* rows_;
  int rowCount_ = 0;
};

}  // namespace nearfit::ui
