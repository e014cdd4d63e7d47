#include "app/desktop/device_watcher.h"

#include "core/error.h"

namespace nearfit::desktop {
namespace {

constexpr int kLookMs = 500;  ///< A user sees it at once; a look costs nothing while nothing changes.

}  // namespace

DeviceWatcher::DeviceWatcher(DeviceSource& source) : source_(source) {
  timer_.setInterval(kLookMs);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (source_.hasChanged()) look();
  });
}

void DeviceWatcher::start() {
  look();
  timer_.start();
}

void DeviceWatcher::setInHand(const QString& id) {
  if (inHand_ == id) return;
  inHand_ = id;
  // Whether others can have it has changed too.
  look();
}

void DeviceWatcher::letGo(const QString& id) {
  if (inHand_ == id) inHand_.clear();
  look();
}

void DeviceWatcher::look() {
  try {
    listed_ = source_.list();
  } catch (const Error&) {
    // Listing fails now and then while something is unplugged: the next look will do.
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
  if (devices == shown_) return;
  shown_ = devices;
  emit devicesChanged(devices);
}

}  // namespace nearfit::desktop
