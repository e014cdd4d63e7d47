#include "app/desktop/device_source.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/base/error.h"
#include "core/files/user_folders.h"
#include "device/registry/device_list.h"
#include "device/registry/device_registry.h"

namespace nearfit::desktop {
namespace {

/// Not the place alone: what is plugged in there later is another device.
QString idOf(const DeviceListing& device) {
  const QString plugging = device.plugin ? QString() : QString::fromStdString(device.usb.node());
  return QString::fromStdString(device.driver + ' ' + device.place + ' ' + device.id) + plugging;
}

ui::DeviceChoice choiceOf(const DeviceListing& device) {
  ui::DeviceChoice choice;
  choice.id = idOf(device);
  choice.name = QString::fromStdString(device.name);
  choice.isUsable = device.isUsable();
  choice.isMendable = !device.isUsable() && device.problem != DeviceProblem::Unsupported;
  choice.command = QString::fromStdString(device.command);
  const std::string note =
      device.isUsable() ? device.needs : device.reason + (device.remedy.empty() ? "" : "; " + device.remedy);
  if (!note.empty()) {
    choice.note = QString::fromStdString(device.isUsable() ? "It needs " + note + "." : note + ".");
    choice.note[0] = choice.note[0].toUpper();
  }
  return choice;
}

/// Returns an entry that tells of a problem with plug-ins.
ui::DeviceChoice noticeOf(const std::string& problem) {
  ui::DeviceChoice notice;
  notice.name = QObject::tr("Plug-in");
  notice.note = QString::fromStdString(problem + ".");
  notice.isMendable = true;
  return notice;
}

constexpr const char* kMissingId = "missing ";

/// Returns a grey entry for devices whose maker's driver is not there: their owner looks for them here.
ui::DeviceChoice missingOf(const MissingDriver& missing) {
  ui::DeviceChoice choice;
  choice.id = kMissingId + QString::fromStdString(missing.name);
  choice.name = QObject::tr("%1: driver not installed").arg(QString::fromStdString(missing.name));
  choice.note = QString::fromStdString(missing.remedy + ".");
  choice.note[0] = choice.note[0].toUpper();
  return choice;
}

/// Looks for makers' drivers, which nothing announces, come this many polls apart.
constexpr int kPollsPerDriverLook = 10;

/// Returns the files in ~/.config/nearfit that exist under their usual names.
DeviceFiles userFiles() {
  DeviceFiles files;
  const std::filesystem::path folder = userFolder(UserFiles::Config);
  if (folder.empty()) return files;
  std::error_code ignored;
  const auto existing = [&](const char* name) {
    const std::filesystem::path file = folder / name;
    return std::filesystem::is_regular_file(file, ignored) ? file : std::filesystem::path();
  };
  files.falconFirmware = existing("falcon-firmware.bin");
  files.polhemCalibration = existing("polhem-calibration.json");
  return files;
}

class PluggedIn final : public DeviceSource {
 public:
  PluggedIn() : plugins_(loadPlugins(pluginFolders())) {
    try {
      bus_.emplace();
    } catch (const DeviceError&) {
      // Without USB there are no USB devices; nearfit-cli devices says why.
    }
  }
  bool hasChanged() override {
    // Systems that announce no changes, and plug-ins, have to be polled; those without a driver less often.
    const bool hasDrivers = missing_ < plugins_.plugins.size();
    const bool hasToLook = hasDrivers || isFirst_ || ++polls_ % kPollsPerDriverLook == 0;
    return bus_ ? hasToLook || !bus_->tellsOfChanges() || bus_->changes() != changes_ : hasToLook;
  }
  QVector<ui::DeviceChoice> list() override {
    isFirst_ = false;
    if (bus_) changes_ = bus_->changes();
    std::vector<std::string> problems;
    std::vector<MissingDriver> missing;
    devices_ = bus_ ? listDevices(*bus_, plugins_, problems, &missing)
                    : listPluginDevices(plugins_, problems, &missing);
    QVector<ui::DeviceChoice> choices;
    for (const DeviceListing& each : devices_)
      choices.push_back(choiceOf(each));
    for (const std::string& each : problems)
      choices.push_back(noticeOf(each));
    missing_ = missing.size();
    for (const MissingDriver& each : missing)
      choices.push_back(missingOf(each));
    return choices;
  }
  QString find(const QString& wanted) override {
    list();
    return idOf(chooseDevice(devices_, wanted.toStdString()));
  }
  std::unique_ptr<HapticDevice> make(const QString& id) override {
    const auto found = std::find_if(devices_.begin(), devices_.end(),
                                    [&](const DeviceListing& each) { return idOf(each) == id; });
    if (found == devices_.end()) {
      throw DeviceError(DeviceProblem::Gone, id.toStdString(), "it is no longer plugged in",
                        "plug it in again");
    }
    return makeDevice(*found, userFiles());
  }

 private:
  std::optional<UsbBus> bus_;
  PluginSearch plugins_;
  std::vector<DeviceListing> devices_;
  std::uint64_t changes_ = 0;
  std::size_t missing_ = 0;  ///< Plug-ins whose maker's driver was not there.
  int polls_ = 0;
  bool isFirst_ = true;
};

/// False for a notice of a plug-in, and for a driver that is missing.
bool isDevice(const ui::DeviceChoice& choice) {
  return !choice.id.isEmpty() && !choice.id.startsWith(kMissingId);
}

ui::DeviceChoice noDevice() {
  QStringList kinds;
  for (const std::string& kind : drivenKinds())
    kinds << QString::fromStdString(kind);
  ui::DeviceChoice notice;
  notice.name = QObject::tr("No device is plugged in.");
  notice.note =
      QObject::tr(
          "Supported devices: %1; and with their makers' drivers, those of 3D Systems, Force "
          "Dimension and Haply. See resources/docs/devices.md for what each needs. A device appears "
          "here as soon as you plug it in.")
          .arg(kinds.join(QStringLiteral(", ")));
  return notice;
}

constexpr int kDevicePollMs = 500;  ///< At once for a user; a poll costs nothing while nothing changes.

}  // namespace

std::unique_ptr<DeviceSource> makeDeviceSource() {
  return std::make_unique<PluggedIn>();
}

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
