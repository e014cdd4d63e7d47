#include "tests/makers/maker_bench.h"

#include <chrono>
#include <fstream>
#include <stdexcept>

#include <dlfcn.h>

#include "device/thread/monotonic_clock.h"
#include "tests/support/eventually.h"
#include "tests/support/places.h"

namespace nearfit::test {
namespace {

/// As the servo's loop has it at 1 kHz.
constexpr Nanoseconds kServoPatience = 2'000'000;

/// Loads a library that stands in for a maker's. The loader knows it by the maker's name from then on, which is what the
/// plug-in asks for. It stays, as such libraries do.
Standin& loaded(const std::string& file) {
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(::dlerror());
  using Entry = Standin*();
  auto* const entry = reinterpret_cast<Entry*>(::dlsym(library, "nearfit_standin"));
  if (entry == nullptr) throw std::runtime_error(file + " stands in for nothing");
  return *entry();
}

}  // namespace

SafetyLimits patientSafety() {
  const double silence = 2.0 * std::chrono::duration<double>(kPatience).count();
  SafetyLimits safety;
  safety.patience = {silence, silence};
  return safety;
}

MakerBench::MakerBench(const MakerModel& model) {
  std::string plugin = builtPath("plugins");
  switch (model.maker) {
    case Maker::OpenHaptics:
      plugin += "/openhaptics.so";
      std::filesystem::create_directory(folder_.path() / "config");
      for (const char* each : {"Default Device", "Left Device"})
        std::ofstream(folder_.path() / "config" / (std::string(each) + ".config")) << "[DEVICE]\n";
      setup_.emplace("GTDD_HOME", folder_.path().string());
      standin_ = &loaded(builtPath("standins/whole/libHD.so"));
      break;
    case Maker::ForceDimension:
      plugin += "/forcedimension.so";
      standin_ = &loaded(builtPath("standins/whole/libdrd.so"));
      break;
    case Maker::Haply:
      plugin += "/haply.so";
      service_ = std::make_unique<HaplyStandin>();
      setup_.emplace("NEARFIT_HAPLY_PORT", std::to_string(service_->port()));
      standin_ = &service_->devices();
      break;
  }
  standin_->restart();
  standin_->model = model.model;
  plugin_ = DevicePlugin::load(plugin);
}

MakerBench::~MakerBench() = default;

std::unique_ptr<HapticDevice> MakerBench::make(int index, const SafetyLimits& safety) {
  return makePluginDevice(plugin_, index, plugin_->devices().at(static_cast<std::size_t>(index)), safety);
}

MakerServo::MakerServo(HapticDevice& device)
    : thread_([this, &device] {
        while (!isStopping_) {
          device.waitForHandle(monotonicNow() + kServoPatience);
          HandleInput handle;
          if (!device.readHandle(handle)) break;
          Wrench wrench;
          {
            const std::lock_guard lock(mutex_);
            last_ = handle;
            wrench = wrench_;
          }
          device.sendWrench(wrench);
        }
        hasEnded_ = true;
      }) {}

void MakerServo::send(const Wrench& wrench) {
  const std::lock_guard lock(mutex_);
  wrench_ = wrench;
}

HandleInput MakerServo::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

void MakerServo::stop() {
  isStopping_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace nearfit::test
