#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "device/common/passive_device.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit {

/// A pose of a hand, and its time.
struct TimedPose {
  double time = 0.0;  ///< Since the start of the recording [s]; never falls.
  RigidTransform worldFromHandle;
};

/// Reads the hand's motion from a recording (MotionWriter): the columns t_s and handle_tx ... handle_qz,
/// found by name in the first row; others are ignored. Times begin at 0. A last row that was cut off is
/// dropped. Throws FileError with file, line and remedy; Cancelled.
std::vector<TimedPose> readHandMotion(const std::filesystem::path& file,
                                      const ProgressCallback& progress = {});

/// A recorded hand as a device: its reports come at their recorded times. The whole path is moved so that it
/// begins at the part. Ends with the recording; takes any wrench, feels none.
class ReplayDevice final : public PassiveDevice {
 public:
  /// Opens nothing yet; start() reads the file.
  explicit ReplayDevice(std::filesystem::path file);

  /// Prefix of the file name by which a user asks for this device.
  static constexpr std::string_view kPrefix = "replay:";

  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return state_.load(std::memory_order_acquire); }
  std::string stateNote() const override { return {}; }
  ReportCounters counters() const noexcept override { return {poses_.load(std::memory_order_relaxed), 0, 0}; }
  void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) override;
  void stop() noexcept override;
  bool waitForHandle(Nanoseconds deadline) noexcept override;
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench&) noexcept override {}

 private:
  Nanoseconds dueTime(std::size_t pose) const noexcept;
  double reportPeriod() const noexcept;

  const std::filesystem::path file_;
  std::vector<TimedPose> motion_;
  PoseFade patience_;
  std::atomic<DeviceState> state_{DeviceState::Present};
  std::atomic<std::uint64_t> poses_{0};
  // Used by the servo thread while it runs.
  Nanoseconds begin_ = 0;  ///< When the first pose was given; 0 before.
  std::size_t next_ = 0;   ///< Next pose to give.
};

}  // namespace nearfit
