#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "device/passive_device.h"
#include "device/servo/monotonic_clock.h"

namespace nearfit {

/// Where a hand was, and when.
struct TimedPose {
  double time = 0.0;  ///< Since the beginning [s]; never falling.
  RigidTransform worldFromHandle;
};

/// Reads the hand's way out of a recording (MotionWriter): the columns t_s and handle_tx ... handle_qz, by
/// their names in the first row; others may be there. Throws FileError with file, line and remedy, Cancelled.
std::vector<TimedPose> readHandMotion(const std::filesystem::path& file,
                                      const ProgressCallback& progress = {});

/// A recorded hand, as a device: its reports come when they came then. Where the part was taken elsewhere the
/// whole way is moved with it. It ends with the recording; takes any wrench, feels none.
class ReplayDevice final : public PassiveDevice {
 public:
  /// A file is read by start().
  explicit ReplayDevice(std::filesystem::path file);

  /// What a user writes for such a device, before the file's name.
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
  PosePatience patience_;
  std::atomic<DeviceState> state_{DeviceState::Present};
  std::atomic<std::uint64_t> poses_{0};
  // The servo thread's own while it runs.
  Nanoseconds begin_ = 0;  ///< When the first pose was given; 0 before.
  std::size_t next_ = 0;   ///< Not given yet.
};

}  // namespace nearfit
