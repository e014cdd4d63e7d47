#pragma once

#include <QDialog>

class QLabel;
class QProgressBar;

namespace nearfit::ui {

/// Shows what is being done, how far it is, and a button to cancel. Appears only if the work takes a while.
class ProgressDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param title  Names the kind of work: "Loading".
  ProgressDialog(const QString& title, const QString& text, QWidget* parent);

 public slots:
  /// Shows the fraction done, 0 to 1.
  void setFraction(double fraction);

 signals:
  /// Emitted when the user cancels.
  void cancelled();

 protected:
  void reject() override;

 private:
  QProgressBar* bar_;
};

}  // namespace nearfit::ui
