#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "device/plugin/device_plugin.h"
#include "tests/makers/standin_haply.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test {

enum class Maker { OpenHaptics, ForceDimension, Haply };

/// A model of a maker, and what its device is to be.
struct MakerModel {
  const char* name;
  Maker maker;
  int model;  ///< Standin::model.
  int sensedAxes, forceAxes;
  double rate;      ///< [Hz]
  double maxForce;  ///< As its driver or its maker names it [N].
};

inline constexpr std::array kMakerModels = {
    MakerModel{"Touch", Maker::OpenHaptics, 0, 6, 3, 1000.0, 3.3},
    MakerModel{"Phantom", Maker::OpenHaptics, 6, 6, 6, 1000.0, 8.5},
    MakerModel{"Omega3", Maker::ForceDimension, 33, 3, 3, 4000.0, 12.0},
    MakerModel{"Omega6", Maker::ForceDimension, 34, 6, 3, 4000.0, 12.0},
    MakerModel{"Sigma7", Maker::ForceDimension, 104, 6, 6, 4000.0, 20.0},
    MakerModel{"Inverse3", Maker::Haply, 3, 3, 3, 1000.0, 3.0},
    MakerModel{"Inverse3WithGrip", Maker::Haply, 0, 6, 3, 1000.0, 3.0},
    MakerModel{"Inverse3Format31", Maker::Haply, 31, 6, 3, 1000.0, 3.0}};

inline std::ostream& operator<<(std::ostream& out, const MakerModel& model) {
  return out << model.name;
}

/// Limits of a device that no stall of a loaded machine stops: it may be silent for longer than any test waits. Those that
/// ship are SafetyLimits{}; only tests of silence itself, and those for machines that do nothing else, have them.
SafetyLimits patientSafety();

/// A maker's plug-in, as it is built, over what stands in for the maker's driver.
class MakerBench {
 public:
  /// Within which Haply's service has to answer, for NEARFIT_HAPLY_PATIENCE [ms]: as long as any test waits.
  static constexpr const char* kServicePatience = "60000";

  explicit MakerBench(const MakerModel& model);
  ~MakerBench();
  MakerBench(const MakerBench&) = delete;
  MakerBench& operator=(const MakerBench&) = delete;

  Standin& standin() noexcept { return *standin_; }
  StandinDevice& device(std::size_t index = 0) noexcept { return standin_->devices.at(index); }
  const std::shared_ptr<const DevicePlugin>& plugin() const noexcept { return plugin_; }
  /// Creates the driver of a device that the plug-in lists now.
  std::unique_ptr<HapticDevice> make(int index = 0, const SafetyLimits& safety = patientSafety());
  /// Only of Haply.
  HaplyStandin& service() noexcept { return *service_; }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<HaplyStandin> service_;
  std::optional<ScopedVariable> setup_;  ///< Where the plug-in looks.
  const ScopedVariable patience_{"NEARFIT_HAPLY_PATIENCE", kServicePatience};
  Standin* standin_ = nullptr;
  std::shared_ptr<const DevicePlugin> plugin_;
};

/// Plays the servo on a thread of its own: answers each pose, and silence, with one wrench.
class MakerServo {
 public:
  explicit MakerServo(HapticDevice& device);
  ~MakerServo() { stop(); }
  MakerServo(const MakerServo&) = delete;
  MakerServo& operator=(const MakerServo&) = delete;

  void send(const Wrench& wrench);
  HandleInput last() const;
  bool hasEnded() const { return hasEnded_; }
  void stop();

 private:
  static HandleInput unread() {
    HandleInput none;
    none.isArmed = false;
    return none;
  }

  mutable std::mutex mutex_;
  Wrench wrench_;
  HandleInput last_ = unread();
  std::atomic<bool> isStopping_{false}, hasEnded_{false};
  std::thread thread_;
};

}  // namespace nearfit::test
