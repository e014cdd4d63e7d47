#include "ui/widgets/progress_dialog.h"

#include <QDialogButtonBox>
#include <QLabel>
#include <QPointer>
#include <QProgressBar>
#include <QPushButton>
#include <QTimer>
#include <QVBoxLayout>
#include <utility>

#include "ui/widgets/font_scale.h"
#include "ui/widgets/names.h"

namespace nearfit::ui {
namespace {

/// Shorter work shows no dialog, which would only flash [ms].
constexpr int kPatience = 300;
constexpr int kSteps = 1000;

}  // namespace

ProgressDialog::ProgressDialog(const QString& title, const QString& text, QWidget* parent)
    : QDialog(parent), bar_(new QProgressBar(this)) {
  setObjectName(QStringLiteral("progressDialog"));
  setWindowTitle(title);
  setWindowModality(Qt::WindowModal);
  setMinimumWidth(forFont(*this, 380));
  bar_->setRange(0, kSteps);
  bar_->setAccessibleName(tr("Progress"));
  auto* label = new QLabel(breakable(text), this);
  label->setWordWrap(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, this);
  connect(buttons, &QDialogButtonBox::rejected, this, &ProgressDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(label);
  layout->addWidget(bar_);
  layout->addWidget(buttons);
  QTimer::singleShot(kPatience, this, &QWidget::show);
}

void ProgressDialog::setFraction(double fraction) {
  bar_->setValue(static_cast<int>(fraction * kSteps));
}

void ProgressDialog::reject() {
  emit cancelled();
}

void runWithDialog(BackgroundTask& task, const QString& title, const QString& text, QWidget* window,
                   BackgroundTask::Job job, std::function<void(std::exception_ptr)> done) {
  // It may go before the job ends: with its window.
  const QPointer<ProgressDialog> dialog = new ProgressDialog(title, text, window);
  QObject::connect(&task, &BackgroundTask::progressed, dialog, &ProgressDialog::setFraction);
  QObject::connect(dialog, &ProgressDialog::cancelled, &task, &BackgroundTask::cancel);
  task.run(std::move(job), [dialog, done = std::move(done)](const std::exception_ptr& error) {
    delete dialog;
    done(error);
  });
}

}  // namespace nearfit::ui
