#include "app/desktop/device_watcher.h"

#include <algorithm>

#include "core/base/error.h"
#include "device/registry/device_registry.h"

namespace nearfit::desktop {
namespace {

/// False for a notice of a plug-in.
bool isDevice(const ui::DeviceChoice& choice) {
  return !choice.id.isEmpty();
}

ui::DeviceChoice noDevice() {
  QStringList kinds;
  for (const std::string& kind : drivenKinds())
    kinds << QString::fromStdString(kind);
  ui::DeviceChoice notice;
  notice.name = QObject::tr("No device is plugged in.");
  notice.note = QObject::tr(
                    "Supported devices: %1; others need a plug-in. See resources/docs/devices.md for what "
                    "each needs. A device appears here as soon as you plug it in.")
                    .arg(kinds.join(QStringLiteral(", ")));
  return notice;
}

constexpr int kDevicePollMs = 500;  ///< At once for a user; a poll costs nothing while nothing changes.

}  // namespace

DeviceWatcher::DeviceWatcher(DeviceSource& source) : source_(source) {
  timer_.setInterval(kDevicePollMs);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (source_.hasChanged()) poll();
  });
}

void DeviceWatcher::start() {
  poll();
  timer_.start();
}

void DeviceWatcher::setInHand(const QString& id) {
  if (inHand_ == id) return;
  inHand_ = id;
  // The system's answer on who can use it changed too.
  poll();
}

void DeviceWatcher::letGo(const QString& id) {
  if (inHand_ == id) inHand_.clear();
  poll();
}

void DeviceWatcher::poll() {
  try {
    listed_ = source_.list();
  } catch (const Error&) {
    // Listing may fail while something is unplugged: the next poll will do.
    return;
  }
  publish();
}

void DeviceWatcher::publish() {
  QVector<ui::DeviceChoice> devices = listed_;
  for (ui::DeviceChoice& each : devices) {
    if (each.id.isEmpty() || each.id != inHand_) continue;
    each.isUsable = true;
    each.isMendable = false;
    each.note.clear();
  }
  if (std::none_of(devices.begin(), devices.end(), isDevice)) devices << noDevice();
  if (devices == shown_) return;
  shown_ = devices;
  emit devicesChanged(devices);
}

}  // namespace nearfit::desktop
