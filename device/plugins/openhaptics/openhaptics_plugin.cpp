#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "device/plugins/kit/device_frame.h"
#include "device/plugins/kit/plugin_table.h"
#include "device/plugins/openhaptics/device_names.h"
#include "device/plugins/openhaptics/hd_api.h"

namespace nearfit::openhaptics {
namespace {

using plugin::PluginError;

/// OpenHaptics: x to the right, y up, z towards the user.
const plugin::DeviceFrame kHdFrame(glm::dmat3({1, 0, 0}, {0, 0, 1}, {0, -1, 0}));
constexpr double kMetre = 1e-3;  ///< HDAPI's lengths are in millimetres.

/// Of a Touch, as its maker publishes them; used until the device is open, and where it says nothing.
constexpr double kTouchForce = 3.3, kTouchMass = 0.045;  // [N], [kg]
/// The softest wall that its maker rates a device of this family for: a Touch's 1 to 2.3 N/mm are stiffer [N/m].
constexpr double kTouchStiffness = 1000.0;
constexpr double kUsualRate = 1000.0;        // [Hz]
constexpr double kRotationalDamping = 1e-3;  // [N m s/rad]; an estimate on the low side.
/// The guide gives torques in mN m. No device of this maker turns with more than 10 N m or less than 10 mN m, so the
/// max that it names tells the unit, whatever a driver's version takes it for.
constexpr double kLargestTorque = 10.0;

/// The servo answers in some 50 us. The scheduler gives a callback most of a millisecond, which all devices share.
constexpr Nanoseconds kHdAnswer = 200'000;
/// Errors that one frame may leave; more are of the same cause.
constexpr int kMaxErrorsInFrame = 8;
/// Until the scheduler has run a callback once more, at most; one that stalls does not.
constexpr std::chrono::milliseconds kLastTick{200};

/// The library and the scheduler, which all open devices share.
class HdDriver {
 public:
  static HdDriver& instance() {
    // Throws while the driver is missing, and tries again at the next call.
    static HdDriver driver;
    return driver;
  }

  const HdApi api;
  /// Held while devices are opened and closed: the scheduler has to stand still for that.
  std::mutex openMutex;
  int openDevices = 0;
};

/// Takes all errors off the stack of HDAPI. Returns the first.
std::uint32_t takeErrors(const HdApi& api) noexcept {
  std::uint32_t first = hd::kSuccess;
  for (int i = 0; i < kMaxErrorsInFrame; ++i) {
    const std::uint32_t code = api.getError().code;
    if (code == hd::kSuccess) break;
    if (first == hd::kSuccess) first = code;
  }
  return first;
}

std::uint32_t faultOf(std::uint32_t error) noexcept {
  switch (error) {
    case hd::kWarmMotors:
      return NEARFIT_FAULT_HOT;
    case hd::kExceededMaxForce:
    case hd::kExceededMaxForceImpulse:
    case hd::kForceError:
      return NEARFIT_FAULT_OVERLOAD;
    case hd::kExceededMaxVelocity:
      return NEARFIT_FAULT_SPEED;
    default:
      return NEARFIT_FAULT_OTHER;
  }
}

NearfitDeviceDescription usualDescription(const std::string& name) {
  NearfitDeviceDescription out{};
  plugin::copyText("Touch or PHANTOM, " + name, out.name, sizeof out.name);
  out.sensed_axes = 6;
  out.force_axes = 3;
  out.rate = kUsualRate;
  out.max_force = kTouchForce;
  out.damping = plugin::dampingFromStiffness(kTouchStiffness, kUsualRate);
  out.rotational_damping = kRotationalDamping;
  out.mass = kTouchMass;
  return out;
}

/// A device of 3D Systems. The scheduler's thread runs tick() once a period.
class HdDevice final : public NearfitDevice {
 public:
  HdDevice(HdDriver& driver, const std::string& name)
      : driver_(driver), api_(driver.api), description_(usualDescription(name)) {
    const std::lock_guard lock(driver_.openMutex);
    if (driver_.openDevices > 0) api_.stopScheduler();
    takeErrors(api_);
    handle_ = api_.initDevice(name.c_str());
    const std::uint32_t error = takeErrors(api_);
    if (handle_ == kHdInvalidHandle || error != hd::kSuccess) {
      if (handle_ != kHdInvalidHandle) api_.disableDevice(handle_);
      if (driver_.openDevices > 0) api_.startScheduler();
      throw PluginError(wordsOf(error) + "; run Touch_Setup and Touch_Diagnostic");
    }
    api_.makeCurrentDevice(handle_);
    readDescription();
    calibrateCurrent(/*isAsked=*/false);
    // Motors are told nothing before Nearfit arms the device, but the frame's forces count only while this is on.
    api_.enable(hd::kForceOutput);
    task_ = api_.scheduleAsynchronous([](void* self) { return static_cast<HdDevice*>(self)->tick(); }, this,
                                      kHdDefaultPriority);
    std::uint32_t late = takeErrors(api_);
    if (late == hd::kSuccess) {
      api_.startScheduler();
      late = takeErrors(api_);
    }
    // Without a callback it would be open and silent.
    if (late != hd::kSuccess) {
      closeLocked();
      if (driver_.openDevices > 0) api_.startScheduler();
      throw PluginError(wordsOf(late) + "; plug it in again");
    }
    ++driver_.openDevices;
  }
  ~HdDevice() override {
    exchange().setForces(false);
    const std::lock_guard lock(driver_.openMutex);
    --driver_.openDevices;
    closeLocked();
    if (driver_.openDevices > 0) api_.startScheduler();
  }

  NearfitDeviceDescription details() const override { return description_; }
  void setForces(bool areOn) override { exchange().setForces(areOn); }
  void calibrate() override {
    const std::lock_guard lock(driver_.openMutex);
    // Calls of the current device must not meet those of a frame.
    api_.stopScheduler();
    api_.makeCurrentDevice(handle_);
    const bool isDone = calibrateCurrent(/*isAsked=*/true);
    api_.startScheduler();
    if (!isDone) throw PluginError(std::string(uncalibrated()) + ", and try again");
  }
  void reset() override {
    error_.store(hd::kSuccess, std::memory_order_release);
    exchange().clearFault();
  }
  std::string note() const override {
    if (const std::uint32_t error = error_.load(std::memory_order_acquire); error != hd::kSuccess)
      return wordsOf(error);
    return isCalibrated_.load(std::memory_order_acquire) ? std::string() : uncalibrated();
  }

 private:
  std::string wordsOf(std::uint32_t error) const {
    const char* const words = error == hd::kSuccess ? nullptr : api_.getErrorString(error);
    return words != nullptr && *words != '\0' ? words : "its driver gives no reason";
  }
  const char* uncalibrated() const noexcept {
    if ((style_ & hd::kCalibrationInkwell) != 0) return "put its stylus into the inkwell";
    if ((style_ & hd::kCalibrationEncoderReset) != 0)
      return "hold its handle in the rest position of its manual";
    return "move its handle through its whole workspace";
  }

  void readDescription() {
    int number = 0;
    const auto integerOr = [&](HdEnum what, int usual) {
      number = usual;
      api_.getIntegerv(what, &number);
      return takeErrors(api_) == hd::kSuccess && number > 0 ? number : usual;
    };
    const auto realOr = [&](HdEnum what, double usual) {
      double value = usual;
      api_.getDoublev(what, &value);
      return takeErrors(api_) == hd::kSuccess && std::isfinite(value) && value > 0.0 ? value : usual;
    };
    const auto textOf = [&](HdEnum what) {
      const char* const text = api_.getString(what);
      return takeErrors(api_) == hd::kSuccess && text != nullptr ? std::string(text) : std::string();
    };
    std::string name = description_.name;
    if (const std::string model = textOf(hd::kDeviceModelType); !model.empty()) name = model;
    // Reports of devices have nowhere else to say them.
    if (const std::string version = textOf(hd::kVersion); !version.empty())
      name += ", OpenHaptics " + version;
    if (const std::string version = textOf(hd::kDeviceDriverVersion); !version.empty())
      name += ", driver " + version;
    plugin::copyText(name, description_.name, sizeof description_.name);
    plugin::copyText(textOf(hd::kDeviceSerialNumber), description_.serial, sizeof description_.serial);
    description_.sensed_axes = integerOr(hd::kInputDof, 6) >= 6 ? 6 : 3;
    description_.force_axes = integerOr(hd::kOutputDof, 3) >= 6 ? 6 : 3;
    description_.rate = integerOr(hd::kUpdateRate, static_cast<int>(kUsualRate));
    description_.max_force = realOr(hd::kNominalMaxForce, kTouchForce);
    // Above it the driver turns forces off; 0 lets Nearfit's own limit stand.
    description_.max_speed = kMetre * realOr(hd::kSoftwareVelocityLimit, 0.0);
    const double stiffness = realOr(hd::kNominalMaxStiffness, kTouchStiffness * kMetre) / kMetre;
    description_.damping = plugin::dampingFromStiffness(stiffness, description_.rate);
    style_ = static_cast<HdEnum>(integerOr(hd::kCalibrationStyle, static_cast<int>(hd::kCalibrationAuto)));
    if (description_.force_axes != 6) return;
    const double torque = realOr(hd::kNominalMaxTorque, 0.0);
    torqueUnit_ = torque > kLargestTorque ? 1e-3 : 1.0;
    description_.max_torque = torque * torqueUnit_;
    // Without a max nobody knows how much it may be asked for.
    if (!(torque > 0.0)) description_.force_axes = 3;
  }

  /// Of the current device, while no frame runs. Returns true if it is calibrated.
  bool calibrateCurrent(bool isAsked) {
    HdEnum state = api_.checkCalibration();
    const bool isByItself = (style_ & hd::kCalibrationAuto) != 0;
    if (state == hd::kCalibrationNeedsUpdate || (isAsked && state != hd::kCalibrationOk)) {
      if (isByItself || isAsked) {
        api_.updateCalibration(isByItself                                ? hd::kCalibrationAuto
                               : (style_ & hd::kCalibrationInkwell) != 0 ? hd::kCalibrationInkwell
                                                                         : hd::kCalibrationEncoderReset);
        state = api_.checkCalibration();
      }
    }
    takeErrors(api_);
    isCalibrated_.store(state == hd::kCalibrationOk, std::memory_order_release);
    return state == hd::kCalibrationOk;
  }

  /// Scheduler's thread.
  HdCallbackCode tick() noexcept {
    const bool isLast = isEnding_.load(std::memory_order_acquire);
    std::array<double, 16> matrix{};  // Column by column, as OpenGL has it.
    std::array<double, 3> velocity{};
    int buttons = 0;
    api_.beginFrame(handle_);
    api_.getDoublev(hd::kCurrentTransform, matrix.data());
    api_.getDoublev(hd::kCurrentVelocity, velocity.data());
    api_.getIntegerv(hd::kCurrentButtons, &buttons);
    if (!isLast) {
      publish(matrix, velocity, buttons);
      // The force belongs to this pose: in the next frame it would be a millisecond late.
      exchange().waitForWrench(monotonicNow() + kHdAnswer);
    }
    send(isLast ? plugin::PluginWrench{} : exchange().wrenchNow());
    api_.endFrame(handle_);
    const std::uint32_t error = takeErrors(api_);
    if (isLast) {
      hasEnded_.store(true, std::memory_order_release);
      return kHdDone;
    }
    if (error != hd::kSuccess) take(error);
    hasFailed_ = error != hd::kSuccess;
    return kHdContinue;
  }
  void publish(const std::array<double, 16>& matrix, const std::array<double, 3>& velocity,
               int buttons) noexcept {
    // While frames fail nothing in them need be true.
    if (hasFailed_) return;
    NearfitDevicePose pose{};
    const glm::dmat3 turn({matrix[0], matrix[1], matrix[2]}, {matrix[4], matrix[5], matrix[6]},
                          {matrix[8], matrix[9], matrix[10]});
    plugin::put(kMetre * kHdFrame.fromMaker(glm::dvec3(matrix[12], matrix[13], matrix[14])), pose.position);
    plugin::put(kHdFrame.fromMaker(turn), pose.rotation);
    plugin::put(kMetre * kHdFrame.fromMaker(glm::dvec3(velocity[0], velocity[1], velocity[2])),
                pose.velocity);
    pose.buttons = static_cast<std::uint32_t>(buttons);
    if (isCalibrated_.load(std::memory_order_acquire)) pose.flags = NEARFIT_DEVICE_CALIBRATED;
    exchange().publish(pose, monotonicNow());
  }
  void send(const plugin::PluginWrench& wrench) noexcept {
    const glm::dvec3 force = kHdFrame.toMaker(wrench.force);
    api_.setDoublev(hd::kCurrentForce, &force.x);
    if (description_.force_axes != 6) return;
    const glm::dvec3 torque = kHdFrame.toMaker(wrench.torque) / torqueUnit_;
    api_.setDoublev(hd::kCurrentTorque, &torque.x);
  }
  void take(std::uint32_t error) noexcept {
    std::uint32_t none = hd::kSuccess;
    error_.compare_exchange_strong(none, error, std::memory_order_acq_rel);
    if (error == hd::kCommError) {
      exchange().lose();
    } else {
      exchange().stop(faultOf(error));
    }
  }

  /// Under openMutex: afterwards nothing calls tick(), and the scheduler stands still.
  void closeLocked() noexcept {
    isEnding_.store(true, std::memory_order_release);
    const auto end = std::chrono::steady_clock::now() + kLastTick;
    while (!hasEnded_.load(std::memory_order_acquire) && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    api_.stopScheduler();
    if (!hasEnded_.load(std::memory_order_acquire)) api_.unschedule(task_);
    api_.disableDevice(handle_);
    takeErrors(api_);
  }

  HdDriver& driver_;
  const HdApi& api_;
  HdHandle handle_ = kHdInvalidHandle;
  HdSchedulerHandle task_ = 0;
  NearfitDeviceDescription description_;
  HdEnum style_ = hd::kCalibrationAuto;
  bool hasFailed_ = false;    ///< Scheduler's: the last frame ended with an error.
  double torqueUnit_ = 1e-3;  ///< Of what the driver calls 1, in N m.
  std::atomic<bool> isCalibrated_{false}, isEnding_{false}, hasEnded_{false};
  std::atomic<std::uint32_t> error_{hd::kSuccess};  ///< The first since the last reset.
};

struct OpenHaptics {
  static constexpr const char* kName = "OpenHaptics";

  static std::int32_t count() {
    HdDriver::instance();
    std::vector<std::string> found = deviceNames();
    const std::lock_guard lock(namesMutex());
    names() = std::move(found);
    return static_cast<std::int32_t>(names().size());
  }
  static NearfitDeviceDescription describe(std::int32_t index) { return usualDescription(nameAt(index)); }
  static std::unique_ptr<NearfitDevice> open(std::int32_t index) {
    return std::make_unique<HdDevice>(HdDriver::instance(), nameAt(index));
  }

 private:
  // Written where devices are listed, read where they are opened.
  static std::vector<std::string>& names() {
    static std::vector<std::string> names;
    return names;
  }
  static std::mutex& namesMutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::string nameAt(std::int32_t index) {
    const std::lock_guard lock(namesMutex());
    if (index < 0 || static_cast<std::size_t>(index) >= names().size())
      throw PluginError("it is no longer set up: run Touch_Setup");
    return names()[static_cast<std::size_t>(index)];
  }
};

}  // namespace
}  // namespace nearfit::openhaptics

extern "C" __attribute__((visibility("default"))) const NearfitDevicePlugin* nearfit_device_plugin(void) {
  return nearfit::plugin::tableOf<nearfit::openhaptics::OpenHaptics>();
}
