// Stands in for libHD.so: the functions of HDAPI that the plug-in uses, as the OpenHaptics API Reference Guide describes
// them. Models: 0, a Touch (force along 3 axes); 6, a PHANTOM with torque. StandinDevice::error is an HD_... code that each
// frame ends with; 0x501 (its scheduler is full) and 0x304 (it has no timer) also keep it from being scheduled and from
// starting. With STANDIN_OLD it is a version that lacks a function.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/makers/standin.h"

namespace {

using nearfit::test::StandinDevice;
using nearfit::test::Triple;

using Handle = std::uint32_t;
using Callback = std::uint32_t (*)(void*);
constexpr Handle kInvalid = 0xFFFFFFFF;
constexpr double kMillimetre = 1e-3;
constexpr int kCommError = 0x302, kDeviceFault = 0x300, kAlreadyInitiated = 0x301, kInvalidEnum = 0x100,
              kTimerError = 0x304, kSchedulerFull = 0x501;

struct Task {
  unsigned long id;
  Callback callback;
  void* data;
};

struct Hd {
  nearfit::test::Standin devices;
  std::mutex mutex;  // Of everything below.
  std::deque<int> errors;
  std::map<std::string, Handle> names;
  std::vector<Task> tasks;
  unsigned long lastTask = 0;
  Handle current = kInvalid;
  std::thread scheduler;
  std::atomic<bool> isRunning{false};

  ~Hd() { stop(); }
  StandinDevice& device(Handle handle) { return devices.devices.at(handle); }
  void fail(int code) {
    const std::lock_guard lock(mutex);
    errors.push_back(code);
  }
  void stop() {
    isRunning = false;
    if (scheduler.joinable()) scheduler.join();
  }
  bool isStalled() {
    for (StandinDevice& each : devices.devices)
      if (each.isOpen && each.isStalled) return true;
    return false;
  }
  void runOnce() {
    std::vector<Task> now;
    {
      const std::lock_guard lock(mutex);
      now = tasks;
    }
    for (const Task& each : now) {
      if (each.callback(each.data) == 1) continue;
      const std::lock_guard lock(mutex);
      std::erase_if(tasks, [&](const Task& task) { return task.id == each.id; });
    }
  }
  // Its rate, 1 kHz, by the clock.
  void run() {
    auto next = std::chrono::steady_clock::now();
    while (isRunning) {
      if (!isStalled()) runOnce();
      next = std::max(next + std::chrono::milliseconds(1), std::chrono::steady_clock::now());
      std::this_thread::sleep_until(next);
    }
  }
};

Hd& hd() {
  static Hd hd;
  return hd;
}

bool hasTorque() {
  return hd().devices.model == 6;
}

// OpenHaptics: x to the right, y up, z towards the user.
Triple toHd(const Triple& v) {
  return {v[0], v[2], -v[1]};
}
Triple fromHd(const double* v) {
  return {v[0], -v[2], v[1]};
}

}  // namespace

extern "C" {

nearfit::test::Standin* nearfit_standin() {
  return &hd().devices;
}

Handle hdInitDevice(const char* name) {
  const std::string key = name != nullptr ? name : "Default Device";
  Handle handle;
  {
    const std::lock_guard lock(hd().mutex);
    handle = hd().names.try_emplace(key, static_cast<Handle>(hd().names.size())).first->second;
  }
  if (handle >= static_cast<Handle>(hd().devices.count) || !hd().device(handle).isPlugged) {
    hd().fail(kDeviceFault);
    return kInvalid;
  }
  if (hd().device(handle).isOpen.exchange(true)) hd().fail(kAlreadyInitiated);
  hd().current = handle;
  return handle;
}
void hdDisableDevice(Handle handle) {
  if (handle == kInvalid) return;
  hd().device(handle).push({}, {});
  hd().device(handle).isOpen = false;
}
void hdMakeCurrentDevice(Handle handle) {
  hd().current = handle;
}
void hdBeginFrame(Handle handle) {
  hd().current = handle;
  if (hd().device(handle).isPlugged) hd().device(handle).advance(1e-3);
}
void hdEndFrame(Handle handle) {
  const StandinDevice& device = hd().device(handle);
  if (!device.isPlugged)
    hd().fail(kCommError);
  else if (device.error != 0)
    hd().fail(device.error);
}
void hdEnable(std::uint32_t) {}
void hdDisable(std::uint32_t) {}

struct ErrorInfo {
  std::uint32_t code;
  int internalCode;
  Handle device;
};
ErrorInfo hdGetError() {
  const std::lock_guard lock(hd().mutex);
  if (hd().errors.empty()) return {0, 0, kInvalid};
  const int code = hd().errors.front();
  hd().errors.pop_front();
  return {static_cast<std::uint32_t>(code), -1, hd().current};
}
const char* hdGetErrorString(std::uint32_t code) {
  switch (code) {
    case kCommError:
      return "Communication error";
    case kDeviceFault:
      return "Device fault";
    case 0x200:
      return "Motors are too warm";
    default:
      return "Some error";
  }
}

void hdGetIntegerv(std::uint32_t what, int* out) {
  const StandinDevice& device = hd().device(hd().current);
  switch (what) {
    case 0x2000:
      *out = device.buttons;
      return;
    case 0x2553:
      *out = 6;
      return;
    case 0x2554:
      *out = hasTorque() ? 6 : 3;
      return;
    case 0x2555:
      *out = device.status != 0 ? device.status.load() : 2;
      return;
    case 0x2600:
      *out = 1000;
      return;
    default:
      hd().fail(kInvalidEnum);
  }
}
void hdGetDoublev(std::uint32_t what, double* out) {
  const StandinDevice& device = hd().device(hd().current);
  switch (what) {
    case 0x2051: {
      const Triple v = toHd(device.velocity.get());
      for (int i = 0; i < 3; ++i)
        out[i] = v[static_cast<std::size_t>(i)] / kMillimetre;
      return;
    }
    case 0x2052: {
      // A turn about Nearfit's y, which is -z here: about z by the opposite angle.
      const double c = std::cos(-device.turn), s = std::sin(-device.turn);
      const double turned[16] = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      std::memcpy(out, turned, sizeof turned);
      const Triple at = toHd(device.position.get());
      for (int i = 0; i < 3; ++i)
        out[12 + i] = at[static_cast<std::size_t>(i)] / kMillimetre;
      return;
    }
    case 0x2602:
      *out = 1.0;  // N/mm
      return;
    case 0x2603:
      *out = hasTorque() ? 8.5 : 3.3;
      return;
    case 0x2606:
      if (!(device.maxSpeed > 0.0)) return hd().fail(kInvalidEnum);
      *out = device.maxSpeed / kMillimetre;
      return;
    case 0x2622:
      *out = 188.0;  // mN m
      return;
    default:
      hd().fail(kInvalidEnum);
  }
}
const char* hdGetString(std::uint32_t what) {
  switch (what) {
    case 0x2500:
      return "3.50.0";
    case 0x2501:
      return hasTorque() ? "PHANTOM Premium 6DOF" : "Touch";
    case 0x2502:
      return "2.7";
    case 0x2504:
      return "31415";
    default:
      return "";
  }
}
void hdSetDoublev(std::uint32_t what, const double* in) {
  StandinDevice& device = hd().device(hd().current);
  if (what == 0x2700) {
    device.push(fromHd(in), device.torque.get());
  } else if (what == 0x2701 && hasTorque()) {
    const double newtonMetres[3] = {1e-3 * in[0], 1e-3 * in[1], 1e-3 * in[2]};
    device.push(device.force.get(), fromHd(newtonMetres));
  } else {
    hd().fail(kInvalidEnum);
  }
}
std::uint32_t hdCheckCalibration() {
  const StandinDevice& device = hd().device(hd().current);
  if (device.isCalibrated) return 0x5000;
  return device.status == 4 ? 0x5002 : 0x5001;
}
void hdUpdateCalibration(std::uint32_t) {
  hd().device(hd().current).isCalibrated = true;
}

void hdStartScheduler() {
  if (hd().device(hd().current).error == kTimerError) return hd().fail(kTimerError);
  if (hd().isRunning.exchange(true)) return;
  hd().scheduler = std::thread([] { hd().run(); });
}
void hdStopScheduler() {
  hd().stop();
}
unsigned long hdScheduleAsynchronous(Callback callback, void* data, std::uint16_t) {
  if (hd().device(hd().current).error == kSchedulerFull) {
    hd().fail(kSchedulerFull);
    return 0;
  }
  const std::lock_guard lock(hd().mutex);
  hd().tasks.push_back({++hd().lastTask, callback, data});
  return hd().lastTask;
}
#ifndef STANDIN_OLD
void hdUnschedule(unsigned long id) {
  const std::lock_guard lock(hd().mutex);
  std::erase_if(hd().tasks, [&](const Task& task) { return task.id == id; });
}
#endif
}
