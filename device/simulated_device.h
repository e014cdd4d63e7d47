#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

#include "core/realtime/triple_buffer.h"
#include "device/haptic_device.h"

namespace nearfit {

/// Follows a list of poses, one a tick, then ends. Deterministic: no clock in it.
class PathDevice final : public HapticDevice {
 public:
  /// @param path  worldFromPart for each tick; not empty.
  explicit PathDevice(std::vector<RigidTransform> path, bool repeats = false);

  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return state_.load(std::memory_order_relaxed); }
  void start(const RigidTransform& worldFromPart) override;
  void stop() noexcept override;
  bool readPose(RigidTransform& pose) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override;

 private:
  std::vector<RigidTransform> path_;
  bool repeats_;
  std::size_t next_ = 0;
  Wrench lastWrench_;
  std::atomic<DeviceState> state_{DeviceState::Ready};
};

/// A pose that another thread (the window: numbers, dragging) sets; the part follows at once.
class ManualDevice final : public HapticDevice {
 public:
  /// From one thread other than the servo's. The pose must be finite.
  void setPose(const RigidTransform& worldFromPart) noexcept { pose_.publish(worldFromPart); }

  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return state_.load(std::memory_order_relaxed); }
  void start(const RigidTransform& worldFromPart) override;
  void stop() noexcept override;
  bool readPose(RigidTransform& pose) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override;

 private:
  TripleBuffer<RigidTransform> pose_;
  std::atomic<DeviceState> state_{DeviceState::Ready};
};

/// A scripted hand: from where the part is, a smooth sweep (approach, slide, wobble, retreat) of the given reach,
/// again and again, the same each time. One pose a tick of `period`.
std::vector<RigidTransform> scriptedHandPath(const RigidTransform& worldFromPart, const glm::dvec3& approach,
                                             double reach, double seconds, double period);

/// Reads poses from CSV: `tx,ty,tz,qw,qx,qy,qz` a row, `#` starts a comment line; a header line is allowed.
/// Quaternions are normalised; one that is off unit by more than 1e-3 is refused. Throws FileError with the line.
std::vector<RigidTransform> readPosePath(const std::filesystem::path& file);

}  // namespace nearfit
