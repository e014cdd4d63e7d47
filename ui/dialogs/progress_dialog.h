#pragma once

#include <QDialog>

class QLabel;
class QProgressBar;

namespace nearfit::ui {

/// What is being loaded, how far it is, and a button to stop it. Appears only when the work takes a while.
class ProgressDialog : public QDialog {
  Q_OBJECT

 public:
  explicit ProgressDialog(const QString& text, QWidget* parent);

 public slots:
  /// 0 to 1.
  void setFraction(double fraction);

 signals:
  void cancelled();

 protected:
  void reject() override;

 private:
  QProgressBar* bar_;
};

}  // namespace nearfit::ui
