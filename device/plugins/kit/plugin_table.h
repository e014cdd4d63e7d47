#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>
#include <string>

#include "device/plugin/nearfit_device.h"
#include "device/plugins/kit/maker_library.h"
#include "device/plugins/kit/pose_exchange.h"

/// An open device of a plug-in of this tree; the C interface passes its pointer.
struct NearfitDevice {
 public:
  virtual ~NearfitDevice() = default;
  NearfitDevice(const NearfitDevice&) = delete;
  NearfitDevice& operator=(const NearfitDevice&) = delete;

  // Controlling thread; the last three throw PluginError.
  virtual NearfitDeviceDescription details() const = 0;
  virtual void setForces(bool areOn) = 0;
  virtual void calibrate() = 0;
  virtual void reset() = 0;
  /// Any thread: why it is stopped or what it waits for; may be empty.
  virtual std::string note() const = 0;

  nearfit::plugin::PoseExchange& exchange() noexcept { return *exchange_; }
  const nearfit::plugin::PoseExchange& exchange() const noexcept { return *exchange_; }

 protected:
  NearfitDevice() = default;
  /// For a thread that may outlive the device.
  const std::shared_ptr<nearfit::plugin::PoseExchange>& sharedExchange() const noexcept { return exchange_; }

 private:
  const std::shared_ptr<nearfit::plugin::PoseExchange> exchange_ =
      std::make_shared<nearfit::plugin::PoseExchange>();
};

namespace nearfit::plugin {

inline void copyText(const std::string& from, char* to, std::size_t size) noexcept {
  if (size == 0) return;
  const std::size_t length = std::min(from.size(), size - 1);
  std::copy_n(from.data(), length, to);
  to[length] = '\0';
}

/// Calls `act`. Returns its result, or `failed` with the reason in `error`: no exception may leave a C function.
template <class Result, class Act>
Result answer(char* error, std::size_t size, Result failed, Act&& act) noexcept {
  try {
    return act();
  } catch (const std::exception& e) {
    copyText(e.what(), error, size);
  } catch (...) {
    copyText("it failed for an unknown reason", error, size);
  }
  return failed;
}

/// The functions of a plug-in.
/// @tparam Maker  Has `kName`, `count()`, `describe(index)` and `open(index)`, all static; the last three may throw
///                PluginError, `count` also DriverMissing.
template <class Maker>
const NearfitDevicePlugin* tableOf() noexcept {
  static const NearfitDevicePlugin table = {
      NEARFIT_DEVICE_VERSION,
      sizeof(NearfitDevicePlugin),
      Maker::kName,
      [](char* error, std::size_t size) -> std::int32_t {
        return answer<std::int32_t>(error, size, -1, [&]() -> std::int32_t {
          try {
            return Maker::count();
          } catch (const DriverMissing& missing) {
            copyText(missing.what(), error, size);
            return NEARFIT_DEVICE_NO_DRIVER;
          }
        });
      },
      [](std::int32_t index, NearfitDeviceDescription* out, char* error, std::size_t size) -> std::int32_t {
        return answer<std::int32_t>(error, size, -1, [&] {
          *out = Maker::describe(index);
          return 0;
        });
      },
      [](std::int32_t index, char* error, std::size_t size) -> NearfitDevice* {
        return answer<NearfitDevice*>(error, size, nullptr, [&] { return Maker::open(index).release(); });
      },
      [](NearfitDevice* device) { delete device; },
      [](NearfitDevice* device, NearfitDeviceDescription* out) -> std::int32_t {
        return answer<std::int32_t>(nullptr, 0, -1, [&] {
          *out = device->details();
          return 0;
        });
      },
      [](NearfitDevice* device, std::int32_t areOn, char* error, std::size_t size) -> std::int32_t {
        return answer<std::int32_t>(error, size, -1, [&] {
          device->setForces(areOn != 0);
          return 0;
        });
      },
      [](NearfitDevice* device, char* error, std::size_t size) -> std::int32_t {
        return answer<std::int32_t>(error, size, -1, [&] {
          device->calibrate();
          return 0;
        });
      },
      [](NearfitDevice* device, char* error, std::size_t size) -> std::int32_t {
        return answer<std::int32_t>(error, size, -1, [&] {
          device->reset();
          return 0;
        });
      },
      [](NearfitDevice* device, char* text, std::size_t size) {
        answer<std::int32_t>(text, size, -1, [&] {
          copyText(device->note(), text, size);
          return 0;
        });
      },
      [](NearfitDevice* device, std::int64_t deadline) -> std::int32_t {
        return device->exchange().wait(deadline) ? 1 : 0;
      },
      [](NearfitDevice* device, NearfitDevicePose* out) -> std::int32_t {
        return device->exchange().read(*out);
      },
      [](NearfitDevice* device, const double* force, const double* torque) -> std::int32_t {
        return device->exchange().write(force, torque);
      }};
  return &table;
}

}  // namespace nearfit::plugin
