#include "ui/panels/device_notices.h"

#include <QApplication>
#include <QClipboard>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/theme.h"

namespace nearfit::ui {

DeviceNotices::DeviceNotices(QWidget* parent)
    : QWidget(parent), text_(new QLabel(this)), copy_(new QPushButton(tr("Copy the command"), this)) {
  text_->setObjectName(QStringLiteral("deviceNotices"));
  text_->setWordWrap(true);
  // A path may be long and has no spaces: the panel must not grow with it.
  text_->setTextFormat(Qt::PlainText);
  text_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  text_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kWarning.name()));
  copy_->setObjectName(QStringLiteral("copyCommand"));
  copy_->setToolTip(tr("To paste it into a terminal; then plug the device in again"));
  connect(copy_, &QPushButton::clicked, this, [this] { QApplication::clipboard()->setText(command_); });
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(text_);
  layout->addWidget(copy_);
  showDevices({});
}

void DeviceNotices::showDevices(const QVector<DeviceChoice>& devices) {
  QStringList notices;
  command_.clear();
  for (const DeviceChoice& each : devices) {
    if (!each.isMendable) continue;
    notices << each.name + QStringLiteral(": ") + each.note;
    if (command_.isEmpty()) command_ = each.command;
  }
  text_->setText(notices.join(QChar('\n')));
  copy_->setVisible(!command_.isEmpty());
  setVisible(!notices.isEmpty());
}

}  // namespace nearfit::ui
