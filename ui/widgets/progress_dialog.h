#pragma once

#include <QDialog>
#include <exception>
#include <functional>

#include "ui/widgets/background_task.h"

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

/// Starts a job whose progress a dialog over `window` shows, and which its user can cancel there. The dialog is gone
/// when `done` is called.
/// @param task       None of its jobs may be running.
/// @param title      As of ProgressDialog.
/// @param job, done  As of BackgroundTask::run().
void runWithDialog(BackgroundTask& task, const QString& title, const QString& text, QWidget* window,
                   BackgroundTask::Job job, std::function<void(std::exception_ptr)> done);

}  // namespace nearfit::ui
