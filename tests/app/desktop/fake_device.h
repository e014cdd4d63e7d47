#pragma once

#include <QThread>
#include <atomic>
#include <memory>
#include <mutex>
#include <utility>

#include "app/desktop/device_source.h"
#include "core/base/error.h"
#include "device/interface/device_supervisor.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit::test {

/// What a fake device and its test share.
struct Handle {
  void moveTo(const glm::dvec3& place) {
    const std::lock_guard lock(mutex);
    position = place;
  }
  glm::dvec3 place() {
    const std::lock_guard lock(mutex);
    return position;
  }
  std::atomic<bool> isUnplugged{false};
  std::atomic<int> starts{0}, arms{0}, disarms{0}, stops{0}, calibrations{0}, resets{0};
  std::atomic<bool> needsCalibration{false}, isFaulty{false};
  /// Opening, or arming, waits for this to be lowered, and takes no notice of anything else.
  std::atomic<bool> opensSlowly{false}, armsSlowly{false};
  std::atomic<double> fraction{0.0};  ///< That it says meanwhile.
  std::mutex mutex;
  glm::dvec3 position{0.0};
};

/// Six axes, at the servo's pace.
class FakeDevice final : public HapticDevice {
 public:
  explicit FakeDevice(std::shared_ptr<Handle> handle) : handle_(std::move(handle)) {}

  DeviceInfo info() const override { return {"Fake arm", 6, DeviceLimits{}}; }
  DeviceState state() const noexcept override { return supervisor_.state(); }
  std::string stateNote() const override {
    return state() == DeviceState::Lost ? "it was unplugged" : faultReason(supervisor_.fault());
  }
  ReportCounters counters() const noexcept override { return {}; }
  void start(const RigidTransform&, const ProgressCallback& progress = {}) override {
    ++handle_->starts;
    supervisor_.beginOpening();
    while (handle_->opensSlowly) {
      if (progress) progress(handle_->fraction);
      QThread::msleep(1);
    }
    supervisor_.opened({}, !handle_->needsCalibration);
  }
  void stop() noexcept override { ++handle_->stops; }
  void arm() override {
    while (handle_->armsSlowly)
      QThread::msleep(1);
    supervisor_.arm("Fake arm");
    ++handle_->arms;
  }
  void disarm() noexcept override {
    supervisor_.disarm();
    ++handle_->disarms;
  }
  void calibrate() override {
    ++handle_->calibrations;
    supervisor_.calibrated();
  }
  void reset() override {
    ++handle_->resets;
    supervisor_.reset();
  }
  bool waitForHandle(Nanoseconds deadline) noexcept override {
    waitUntil(deadline);
    return false;
  }
  bool readHandle(HandleInput& input) noexcept override {
    if (handle_->isUnplugged) supervisor_.lost();
    if (state() == DeviceState::Lost) return false;
    if (handle_->isFaulty) supervisor_.stop(DeviceFault::Reported);
    input = {};
    input.pose.translation = handle_->place();
    input.hasOwnFrame = true;
    // As arms have it, whose pose is none till then.
    input.isClutched = state() == DeviceState::Uncalibrated;
    input.isArmed = supervisor_.check({});
    return true;
  }
  void sendWrench(const Wrench&) noexcept override {}

 private:
  std::shared_ptr<Handle> handle_;
  DeviceSupervisor supervisor_;
};

class FakeSource final : public desktop::DeviceSource {
 public:
  /// Tests say themselves when it is to be looked.
  bool hasChanged() override { return false; }
  QVector<ui::DeviceChoice> list() override { return devices; }
  QString find(const QString& wanted) override { return wanted; }
  std::unique_ptr<HapticDevice> make(const QString& id) override {
    for (const ui::DeviceChoice& each : devices) {
      if (each.id == id) return std::make_unique<FakeDevice>(handle);
    }
    throw Error("fake", "it is not plugged in", "plug it in");
  }

  QVector<ui::DeviceChoice> devices;
  std::shared_ptr<Handle> handle = std::make_shared<Handle>();
};

}  // namespace nearfit::test
