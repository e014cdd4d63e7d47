#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

#include "core/realtime/triple_buffer.h"
#include "device/common/passive_device.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit {

/// Follows a list of poses, one per tick, then ends. Deterministic: no pose depends on a clock. Takes any
/// wrench, feels none.
class PathDevice final : public PassiveDevice {
 public:
  /// @param path     worldFromPart for each tick, whatever pose start() is given.
  /// @param repeats  Begins again after the last pose instead of ending.
  /// Throws UsageError if the path is empty.
  explicit PathDevice(std::vector<RigidTransform> path, bool repeats = false);

  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return state_.load(std::memory_order_relaxed); }
  std::string stateNote() const override { return {}; }
  ReportCounters counters() const noexcept override { return {}; }
  void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) override;
  void stop() noexcept override;
  bool waitForHandle(Nanoseconds deadline) noexcept override;
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override;

  /// Returns the wrench sent last; call it only while no servo runs.
  const Wrench& lastWrench() const noexcept { return lastWrench_; }

 private:
  std::vector<RigidTransform> path_;
  bool repeats_;
  std::size_t next_ = 0;
  Wrench lastWrench_;
  std::atomic<DeviceState> state_{DeviceState::Ready};
};

/// A hand whose pose the controlling thread sets (the window: numbers, dragging); the part follows at once.
/// Nobody feels the wrench: it is only shown.
class ManualDevice final : public PassiveDevice {
 public:
  /// Sets the hand's pose; must be finite. Call it only from the thread that calls start().
  void setPose(const RigidTransform& worldFromPart) noexcept { pose_.publish(worldFromPart); }

  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return state_.load(std::memory_order_relaxed); }
  std::string stateNote() const override { return {}; }
  ReportCounters counters() const noexcept override { return {}; }
  void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) override;
  void stop() noexcept override;
  bool waitForHandle(Nanoseconds deadline) noexcept override;
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override;

 private:
  TripleBuffer<RigidTransform> pose_;
  std::atomic<DeviceState> state_{DeviceState::Ready};
};

/// Default wobble of a scripted hand: three degrees [rad].
constexpr double kScriptedWobble = 0.052359877559829887;

/// Default radius of its circle, as a share of the reach.
constexpr double kScriptedSlide = 0.15;

/// Returns the path of a scripted hand, one smooth sweep: approach (by `reach` along `approach`), slide (a
/// circle across it), wobble (to and fro about the part's origin) and retreat to the start. At rest at both
/// ends, so that it repeats without a jolt. The same arguments give the same path.
///
/// @param worldFromPart  First and last pose of the part.
/// @param approach       Direction of the approach in the world; any length but zero.
/// @param reach          Length of the approach [m]; > 0.
/// @param seconds        Duration of the whole sweep [s]; > 0.
/// @param period         Period of a tick [s]; > 0. One pose per tick, and one more.
/// @param wobbleAngle    Amplitude of the wobble [rad].
/// @param slideShare     Radius of the circle, as a share of the reach; >= 0.
/// Throws UsageError for arguments that are not finite or out of range.
std::vector<RigidTransform> scriptedHandPath(const RigidTransform& worldFromPart, const glm::dvec3& approach,
                                             double reach, double seconds, double period,
                                             double wobbleAngle = kScriptedWobble,
                                             double slideShare = kScriptedSlide);

/// Reads poses from CSV, one `tx,ty,tz,qw,qx,qy,qz` per row (metres, unit quaternion). Skips comment lines
/// (`#`), blank lines and one header line. Normalises quaternions; refuses one whose length is off by more
/// than kQuaternionSlack, and a position beyond kMaxPosition. Throws FileError with file, line and remedy.
/// Needs memory for the poses only.
std::vector<RigidTransform> readPosePath(const std::filesystem::path& file);

}  // namespace nearfit
