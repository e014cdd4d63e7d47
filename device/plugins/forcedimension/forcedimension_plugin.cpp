#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "device/plugins/forcedimension/dhd_api.h"
#include "device/plugins/kit/device_frame.h"
#include "device/plugins/kit/plugin_table.h"

namespace nearfit::forcedimension {
namespace {

using plugin::PluginError;

/// Force Dimension: x towards the user, y to the right, z up.
const plugin::DeviceFrame kDhdFrame(glm::dmat3({0, -1, 0}, {1, 0, 0}, {0, 0, 1}));

/// What the SDK does not tell of a device. Forces, torques and stiffnesses are those that CHAI3D, an open toolkit, has
/// for its drivers; those of the sigma.7 are its data sheet's.
struct DhdModel {
  double force, stiffness, torque, turnStiffness;  ///< [N], [N/m], [N m], [N m/rad]
};
constexpr DhdModel kDeltaModel{20.0, 4000.0, 0.2, 1.0};
constexpr DhdModel kOmegaModel{12.0, 4000.0, 0.0, 0.0};
constexpr DhdModel kSigmaModel{20.0, 4000.0, 0.4, 1.0};
/// Of a Falcon, and of a model that is not known: little.
constexpr DhdModel kWeakModel{8.0, 3000.0, 0.2, 0.5};
constexpr double kDhdMass = 0.1;                // [kg]; an estimate on the low side.
constexpr double kDhdRotationalDamping = 1e-3;  // [N m s/rad]; the same, where a wrist has no motors.
/// Its USB transfers come that fast; of a Falcon, once a millisecond [Hz].
constexpr double kDhdRate = 4000.0, kFalconRate = 1000.0;

DhdModel modelOf(int type) noexcept {
  switch (type) {
    case dhd::kDelta3:
    case dhd::kDelta6:
      return kDeltaModel;
    case dhd::kOmega3:
    case dhd::kOmega6:
    case dhd::kOmega6Left:
    case dhd::kOmega7:
    case dhd::kOmega7Left:
      return kOmegaModel;
    case dhd::kSigma7:
    case dhd::kSigma7Left:
      return kSigmaModel;
    default:
      return kWeakModel;
  }
}

/// The servo's answer comes in some 50 us; a force that waits longer goes out with the next pose.
constexpr Nanoseconds kAnswerPatience = 150'000;
/// Poses between two looks at the device's status, which costs a transfer: 20 ms at 4 kHz.
constexpr int kPosesPerStatus = 80;
/// Failures in a row after which a device whose connection is disturbed counts as lost.
constexpr int kMaxFailures = 20;
/// Until the device's thread has done what it was asked for, or has ended; what calibrates takes as long as the
/// handle's way.
constexpr std::chrono::seconds kWorkTime{2}, kCalibrationTime{60};
/// Before a pose is asked for again that was asked for too early: a fifth of the SDK's own guard of 0.25 ms.
constexpr std::chrono::microseconds kEarlyPause{50};

class DhdDriver {
 public:
  static DhdDriver& instance() {
    static DhdDriver driver;
    return driver;
  }
  const DhdApi api;
};

NearfitDeviceDescription usualDescription(std::int32_t index) {
  NearfitDeviceDescription out{};
  plugin::copyText("Force Dimension device " + std::to_string(index + 1), out.name, sizeof out.name);
  out.sensed_axes = 3;
  out.force_axes = 3;
  out.rate = kDhdRate;
  out.max_force = kWeakModel.force;
  out.damping = plugin::dampingFromStiffness(kWeakModel.stiffness, kDhdRate);
  out.rotational_damping = kDhdRotationalDamping;
  out.mass = kDhdMass;
  return out;
}

/// State of a device that its thread uses, alone or with others. The thread shares its ownership: a call of the SDK that
/// hangs may outlive the device.
class DhdSession {
 public:
  DhdSession(const DhdApi& api, std::int32_t index, std::shared_ptr<plugin::PoseExchange> exchange)
      : api_(api), exchange_(std::move(exchange)) {
    // Compared as an int: a char has no sign on ARM.
    const int opened = api_.openId(static_cast<char>(index));
    if (opened < 0) throw PluginError(lastWords() + "; close other programs that use it");
    id_ = static_cast<char>(opened);
    describeOpen(index);
    // A gripper has no button: closing it is one.
    hasGripper_ = api_.hasGripper(id_);
    if (hasGripper_) api_.emulateButton(dhd::kOn, id_);
    api_.enableForce(dhd::kOff, id_);
  }

  // Device's thread.

  /// Exchanges poses and forces until end() is called, then closes the device.
  void run() {
    for (int poses = 0; !isEnding_.load(std::memory_order_acquire); ++poses) {
      work();
      if (exchange_->isLost()) {
        // If it hears again, it must not push on as it was told last.
        api_.setWrench(0, 0, 0, 0, 0, 0, 0, id_);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        continue;
      }
      if (poses % kPosesPerStatus == 0) look();
      exchangeOnce();
    }
    api_.setWrench(0, 0, 0, 0, 0, 0, 0, id_);
    api_.enableForce(dhd::kOff, id_);
    api_.close(id_);
    const std::lock_guard lock(workMutex_);
    hasEnded_ = true;
    workDone_.notify_all();
  }

  // Controlling thread.

  const NearfitDeviceDescription& details() const noexcept { return description_; }
  void setForces(bool areOn) {
    if (!areOn) exchange_->setForces(false);
    const std::string problem = ask([this, areOn] {
      return api_.enableForce(areOn ? dhd::kOn : dhd::kOff, id_) >= 0 ? std::string() : lastWords();
    });
    if (areOn && !problem.empty()) throw PluginError(problem);
    exchange_->setForces(areOn);
  }
  void calibrate() {
    if (api_.autoInit == nullptr) {
      if (!isCalibrated_.load(std::memory_order_acquire)) throw PluginError(kByHand);
      return;
    }
    const std::string problem = ask(
        [this] {
          // The device moves its handle by itself, then lets it go. What failed is asked before later calls succeed.
          const std::string failure = api_.autoInit(id_) >= 0 ? std::string() : lastWords();
          api_.stopRegulation(true, id_);
          api_.enableForce(dhd::kOff, id_);
          return failure;
        },
        kCalibrationTime);
    if (!problem.empty()) throw PluginError(problem);
  }
  void reset() noexcept {
    words_.store(nullptr, std::memory_order_release);
    exchange_->clearFault();
  }
  std::string note() const {
    if (const char* words = words_.load(std::memory_order_acquire)) return words;
    if (isCalibrated_.load(std::memory_order_acquire)) return {};
    return api_.autoInit != nullptr ? "take your hands off it and calibrate it: it moves its handle by itself"
                                    : kByHand;
  }
  /// Ends run(): motors get no force from now on. Returns true once it has ended, false if that takes longer than kWorkTime.
  bool end() {
    exchange_->setForces(false);
    isEnding_.store(true, std::memory_order_release);
    std::unique_lock lock(workMutex_);
    return workDone_.wait_for(lock, kWorkTime, [this] { return hasEnded_; });
  }

 private:
  static constexpr const char* kByHand =
      "put its calibration pole into the pit, or its handle into its end stops, as its manual says";

  /// The SDK's words on the last error, which it keeps for each thread. Never empty.
  std::string lastWords() const {
    const char* const words = api_.errorGetLastStr();
    return words != nullptr && *words != '\0' ? words : "its driver gives no reason";
  }

  void describeOpen(std::int32_t index) {
    description_ = usualDescription(index);
    const int type = api_.getSystemType(id_);
    const DhdModel model = modelOf(type);
    std::string name = description_.name;
    if (const char* its = api_.getSystemName(id_); its != nullptr && *its != '\0') name = its;
    // Reports of devices have nowhere else to say it.
    if (api_.getSdkVersion != nullptr) {
      std::array<int, 4> v{};
      api_.getSdkVersion(&v[0], &v[1], &v[2], &v[3]);
      name += ", SDK " + std::to_string(v[0]) + "." + std::to_string(v[1]) + "." + std::to_string(v[2]);
    }
    plugin::copyText(name, description_.name, sizeof description_.name);
    unsigned short serial = 0;
    if (api_.getSerialNumber(&serial, id_) >= 0)
      plugin::copyText(std::to_string(serial), description_.serial, sizeof description_.serial);
    description_.rate = type == dhd::kFalcon ? kFalconRate : kDhdRate;
    description_.sensed_axes = api_.hasWrist(id_) ? 6 : 3;
    description_.force_axes = api_.hasActiveWrist(id_) && model.torque > 0.0 ? 6 : 3;
    description_.max_force = model.force;
    if (api_.getMaxForce != nullptr) {
      const double limit = api_.getMaxForce(id_);
      if (std::isfinite(limit) && limit > 0.0) description_.max_force = std::fmin(model.force, limit);
    }
    description_.damping = plugin::dampingFromStiffness(model.stiffness, description_.rate);
    if (description_.force_axes != 6) return;
    description_.max_torque = model.torque;
    description_.rotational_damping = plugin::dampingFromStiffness(model.turnStiffness, description_.rate);
  }

  /// Has the device's thread do it between two poses, and forgets it if that has not begun in time.
  /// @param work  Returns why it failed; empty if it did not.
  /// Returns what `work` does, or that the thread is stuck.
  template <class Work>
  std::string ask(Work work, std::chrono::seconds patience = kWorkTime) {
    std::unique_lock lock(workMutex_);
    const std::uint64_t mine = ++asked_;
    work_ = std::move(work);
    hasWork_.store(true, std::memory_order_release);
    if (workDone_.wait_for(lock, patience, [&] { return done_ == mine; })) return workProblem_;
    work_ = nullptr;
    hasWork_.store(false, std::memory_order_release);
    return "its driver does not answer";
  }
  /// Device's thread. Holds no lock while it works, so that whoever asked can give up.
  void work() {
    if (!hasWork_.load(std::memory_order_acquire)) return;
    std::unique_lock lock(workMutex_);
    if (!work_) return;
    const std::uint64_t which = asked_;
    const std::function<std::string()> next = std::exchange(work_, nullptr);
    hasWork_.store(false, std::memory_order_release);
    lock.unlock();
    std::string problem = next();
    lock.lock();
    workProblem_ = std::move(problem);
    done_ = which;
    workDone_.notify_all();
  }

  void exchangeOnce() noexcept {
    glm::dvec3 position(0.0), velocity(0.0);
    std::array<std::array<double, 3>, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const int got = api_.getPoseFrame(&position.x, &position.y, &position.z,
                                      reinterpret_cast<double(*)[3]>(rows.data()), id_);
    if (got < 0) return fail();
    if (got > 0) {
      // DHD_TIMEGUARD: it was too early, and the pose is the one before.
      std::this_thread::sleep_for(kEarlyPause);
      return;
    }
    const Nanoseconds arrived = monotonicNow();
    api_.getLinearVelocity(&velocity.x, &velocity.y, &velocity.z, id_);
    NearfitDevicePose pose{};
    plugin::put(kDhdFrame.fromMaker(position), pose.position);
    plugin::put(kDhdFrame.fromMaker(velocity), pose.velocity);
    const glm::dmat3 turn({rows[0][0], rows[1][0], rows[2][0]}, {rows[0][1], rows[1][1], rows[2][1]},
                          {rows[0][2], rows[1][2], rows[2][2]});
    plugin::put(description_.sensed_axes == 6 ? kDhdFrame.fromMaker(turn) : glm::dquat(1, 0, 0, 0),
                pose.rotation);
    pose.buttons = api_.getButtonMask(id_);
    if (isCalibrated_.load(std::memory_order_acquire)) pose.flags = NEARFIT_DEVICE_CALIBRATED;
    takeGrip(pose);
    exchange_->publish(pose, arrived);
    exchange_->waitForWrench(arrived + kAnswerPatience);
    // A transfer may have hung until after the device was closed.
    if (isEnding_.load(std::memory_order_acquire)) return;
    const plugin::PluginWrench wrench = exchange_->wrenchNow();
    const glm::dvec3 force = kDhdFrame.toMaker(wrench.force), torque = kDhdFrame.toMaker(wrench.torque);
    // A positive result only says that it was too early or that a motor is at its limit.
    if (api_.setWrench(force.x, force.y, force.z, torque.x, torque.y, torque.z, 0.0, id_) < 0) return fail();
    failures_ = 0;
  }

  /// An angle that cannot be read is none in this pose; a device that fails says so by its next call.
  void takeGrip(NearfitDevicePose& pose) noexcept {
    double angle = 0.0;
    if (!hasGripper_ || api_.getGripperAngle == nullptr || api_.getGripperAngle(&angle, id_) < 0) return;
    if (!std::isfinite(angle)) return;
    // The documentation does not say which sign an open gripper has, and it may depend on the hand that the device is for.
    pose.grip = std::abs(angle);
    pose.flags |= NEARFIT_DEVICE_HAS_GRIP;
  }

  void fail() noexcept {
    const int error = api_.errorGetLast();
    if (error == dhd::kErrorNoDevice || error == dhd::kErrorNotReady || error == dhd::kErrorCom)
      return lose("it was unplugged or switched off");
    if (error == dhd::kErrorTimeout || error == dhd::kErrorBusy) {
      stop(NEARFIT_FAULT_LINK, "its answers come too late");
    } else {
      stop(NEARFIT_FAULT_OTHER, "its driver reported an error");
    }
    if (++failures_ >= kMaxFailures) lose("it no longer answers");
    // Whoever fails at once would fail a million times a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  void look() noexcept {
    std::array<int, dhd::kMaxStatus> status{};
    if (api_.getStatus(status.data(), id_) < 0) return fail();
    isCalibrated_.store(
        api_.isInitialized != nullptr ? api_.isInitialized(id_) : status[dhd::kStatusReset] == 0,
        std::memory_order_release);
    if (status[dhd::kStatusConnected] == 0) return lose("it was unplugged or switched off");
    if (status[dhd::kStatusPower] == 0)
      return stop(NEARFIT_FAULT_SWITCHED_OFF, "its power supply is unplugged or off");
    if (status[dhd::kStatusError] != 0) return stop(NEARFIT_FAULT_OTHER, "its controller reported an error");
    if (!exchange_->areForcesOn() || status[dhd::kStatusForce] != 0) return;
    switch (status[dhd::kStatusForceOffCause]) {
      case dhd::kOffByVelocity:
        return stop(NEARFIT_FAULT_SPEED, "its controller turned the motors off");
      case dhd::kOffByWatchdog:
      case dhd::kOffByUsb:
        return stop(NEARFIT_FAULT_LINK, "its controller heard nothing for too long");
      default:
        return stop(NEARFIT_FAULT_SWITCHED_OFF, "by its button or its hand sensor");
    }
  }
  void stop(std::uint32_t fault, const char* words) noexcept {
    say(words);
    exchange_->stop(fault);
  }
  void lose(const char* words) noexcept {
    say(words);
    exchange_->lose();
  }
  /// The first reason is kept until the next reset.
  void say(const char* words) noexcept {
    const char* none = nullptr;
    words_.compare_exchange_strong(none, words, std::memory_order_acq_rel);
  }

  const DhdApi& api_;
  const std::shared_ptr<plugin::PoseExchange> exchange_;
  char id_ = -1;
  NearfitDeviceDescription description_{};
  bool hasGripper_ = false;
  int failures_ = 0;  ///< In a row.
  std::atomic<bool> isCalibrated_{false}, isEnding_{false};
  std::atomic<const char*> words_{nullptr};  ///< Why it is stopped or lost; static text.

  std::mutex workMutex_;
  std::condition_variable workDone_;
  std::function<std::string()> work_;   ///< Empty once it has begun.
  std::uint64_t asked_ = 0, done_ = 0;  ///< Numbers of the last work that was asked for, and done.
  std::string workProblem_;             ///< Of the work that was done last.
  bool hasEnded_ = false;               ///< run() has closed the device.
  std::atomic<bool> hasWork_{false};
};

/// A device of Force Dimension. A thread of its own exchanges poses and forces with it, as fast as its transfers go,
/// and is the only one that calls the SDK for this device while it runs.
class DhdDevice final : public NearfitDevice {
 public:
  DhdDevice(const DhdApi& api, std::int32_t index)
      : session_(std::make_shared<DhdSession>(api, index, sharedExchange())),
        thread_([session = session_] { session->run(); }) {}
  /// Nothing can end a call of the SDK that hangs: it is left behind, and its thread closes the device once it returns.
  ~DhdDevice() override {
    if (session_->end()) {
      thread_.join();
      return;
    }
    plugin::keepLoaded();
    thread_.detach();
  }

  NearfitDeviceDescription details() const override { return session_->details(); }
  void setForces(bool areOn) override { session_->setForces(areOn); }
  void calibrate() override { session_->calibrate(); }
  void reset() override { session_->reset(); }
  std::string note() const override { return session_->note(); }

 private:
  const std::shared_ptr<DhdSession> session_;
  std::thread thread_;
};

struct ForceDimension {
  static constexpr const char* kName = "Force Dimension";

  static std::int32_t count() {
    const DhdApi& api = DhdDriver::instance().api;
    const int count = api.getDeviceCount();
    return count > 0 ? count : 0;
  }
  static NearfitDeviceDescription describe(std::int32_t index) { return usualDescription(index); }
  static std::unique_ptr<NearfitDevice> open(std::int32_t index) {
    return std::make_unique<DhdDevice>(DhdDriver::instance().api, index);
  }
};

}  // namespace
}  // namespace nearfit::forcedimension

extern "C" __attribute__((visibility("default"))) const NearfitDevicePlugin* nearfit_device_plugin(void) {
  return nearfit::plugin::tableOf<nearfit::forcedimension::ForceDimension>();
}
