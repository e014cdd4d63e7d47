#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

#include "core/realtime/triple_buffer.h"
#include "device/passive_device.h"
#include "device/servo/monotonic_clock.h"

namespace nearfit {

/// Follows a list of poses, one a tick, then ends. Deterministic: no clock in it. Takes any wrench, feels
/// none.
class PathDevice final : public PassiveDevice {
 public:
  /// @param path     worldFromPart for each tick, whatever pose start() is given.
  /// @param repeats  Begins again after the last pose instead of ending.
  /// Throws UsageError when the path is empty.
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

  /// What was sent last; to be read while no servo runs.
  const Wrench& lastWrench() const noexcept { return lastWrench_; }

 private:
  std::vector<RigidTransform> path_;
  bool repeats_;
  std::size_t next_ = 0;
  Wrench lastWrench_;
  std::atomic<DeviceState> state_{DeviceState::Ready};
};

/// A pose that the controlling thread (the window: numbers, dragging) sets; the part follows at once. There
/// is no hand to push: wrenches are for the picture alone.
class ManualDevice final : public PassiveDevice {
 public:
  /// From the thread that calls start(), and from no other. The pose must be finite.
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

/// Of a scripted hand that has no reason for another: three degrees [rad].
constexpr double kScriptedWobble = 0.052359877559829887;

/// Radius of its circle, as a part of the reach.
constexpr double kScriptedSlide = 0.15;

/// A scripted hand: one smooth sweep of approach (by `reach` along `approach`), slide (a circle across it),
/// wobble (turning about the part's origin to and fro) and retreat to where it began. At rest at both
/// ends, so that it can be repeated without a jolt. The same arguments give the same path.
///
/// @param worldFromPart  Where the part is: the first pose and the last.
/// @param approach       Direction of the approach in the world; any length but zero.
/// @param reach          How far the approach goes [m]; > 0.
/// @param seconds        Duration of the whole sweep [s].
/// @param period         Of a tick [s]; one pose for each.
/// @param wobbleAngle    Amplitude of the wobble [rad].
/// @param slideShare     Radius of the circle, as a part of the reach; >= 0.
/// Throws UsageError for arguments that are not finite or out of range.
std::vector<RigidTransform> scriptedHandPath(const RigidTransform& worldFromPart, const glm::dvec3& approach,
                                             double reach, double seconds, double period,
                                             double wobbleAngle = kScriptedWobble,
                                             double slideShare = kScriptedSlide);

/// Reads poses from CSV: `tx,ty,tz,qw,qx,qy,qz` a row (metres, then a unit quaternion), `#` starts a comment
/// line, blank lines are skipped, one header line is allowed. Quaternions are normalised; one that is off
/// unit by more than kQuaternionSlack is refused, and so is a position beyond kMaxPosition. Throws FileError
/// with file, line and remedy; memory is that of the poses.
std::vector<RigidTransform> readPosePath(const std::filesystem::path& file);

}  // namespace nearfit
