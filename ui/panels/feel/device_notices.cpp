#include "ui/panels/feel/device_notices.h"

#include <QApplication>
#include <QClipboard>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/widgets/theme.h"

namespace nearfit::ui {

DeviceNotices::DeviceNotices(QWidget* parent)
    : QWidget(parent),
      none_(new QLabel(this)),
      text_(new QLabel(this)),
      copy_(new QPushButton(tr("Copy the command"), this)) {
  none_->setObjectName(QStringLiteral("noDevice"));
  none_->setWordWrap(true);
  none_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  text_->setObjectName(QStringLiteral("deviceNotices"));
  text_->setWordWrap(true);
  // A long path has no spaces to break at: the panel must not grow with it.
  text_->setTextFormat(Qt::PlainText);
  text_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  text_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kWarning.name()));
  copy_->setObjectName(QStringLiteral("copyCommand"));
  copy_->setToolTip(tr("Copy the command to paste it into a terminal; then plug the device in again"));
  connect(copy_, &QPushButton::clicked, this, [this] { QApplication::clipboard()->setText(command_); });
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(none_);
  layout->addWidget(text_);
  layout->addWidget(copy_);
  showDevices({});
}

void DeviceNotices::showDevices(const QVector<DeviceChoice>& devices) {
  QStringList notices;
  command_.clear();
  none_->clear();
  for (const DeviceChoice& each : devices) {
    if (each.id.isEmpty() && !each.isMendable) {
      none_->setText(each.name);
      none_->setToolTip(each.note);
    }
    if (!each.isMendable) continue;
    notices << each.name + QStringLiteral(": ") + each.note;
    if (command_.isEmpty()) command_ = each.command;
  }
  text_->setText(notices.join(QChar('\n')));
  none_->setVisible(!none_->text().isEmpty());
  text_->setVisible(!notices.isEmpty());
  copy_->setVisible(!command_.isEmpty());
  setVisible(!none_->isHidden() || !notices.isEmpty());
}

}  // namespace nearfit::ui
