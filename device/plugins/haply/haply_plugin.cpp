#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "device/plugins/haply/inverse_state.h"
#include "device/plugins/haply/service_link.h"
#include "device/plugins/kit/plugin_table.h"

namespace nearfit::haply {
namespace {

using plugin::PluginError;

/// The service names no limits. An Inverse3 can do more for a moment; this is ours until its owner's report says what it
/// holds [N].
constexpr double kInverseForce = 3.0;
/// Estimates on the low side.
constexpr double kInverseDamping = 0.5, kInverseRotationalDamping = 1e-3;  // [N s/m], [N m s/rad]
constexpr double kInverseMass = 0.1;                                       // [kg]
/// The service answers as often as it is asked [Hz].
constexpr double kInverseRate = 1000.0;
constexpr Nanoseconds kInversePeriod = 1'000'000;
/// The servo's answer to a pose goes out by itself if it comes within this time, else with the next question.
constexpr Nanoseconds kInverseAnswer = 500'000;
/// The service answers within a millisecond; without an answer for so long, Nearfit has stopped the device long before.
constexpr std::chrono::milliseconds kDevicePatience{500};
/// Devices are listed twice a second on the window's thread, which a service that hangs must not hold up.
constexpr std::chrono::milliseconds kInventoryPatience{50};
/// Messages without a place of the device after which it is gone: half a second.
constexpr int kMaxAbsent = 500;

/// @param withFirmware  Its version stands behind the name, as other makers' do once a device is open.
NearfitDeviceDescription descriptionOf(const InverseListing& listing, bool withFirmware) {
  NearfitDeviceDescription out{};
  std::string name = listing.hasGrip ? "Haply Inverse3 with VerseGrip" : "Haply Inverse3";
  if (withFirmware && !listing.firmware.empty()) name += ", firmware " + listing.firmware;
  plugin::copyText(name, out.name, sizeof out.name);
  plugin::copyText(listing.id, out.serial, sizeof out.serial);
  out.sensed_axes = listing.hasGrip ? 6 : 3;
  out.force_axes = 3;
  out.rate = kInverseRate;
  out.max_force = kInverseForce;
  out.damping = kInverseDamping;
  out.rotational_damping = kInverseRotationalDamping;
  out.mass = kInverseMass;
  return out;
}

/// An Inverse3 with a connection and a thread of its own. Its axes are taken for Nearfit's (x to the right, y away from the
/// user, z up), as the service's examples suggest; its documents do not say so in words.
class InverseDevice final : public NearfitDevice {
 public:
  explicit InverseDevice(InverseListing listing)
      : listing_(std::move(listing)), description_(descriptionOf(listing_, /*withFirmware=*/true)) {
    link_.emplace(servicePort(), servicePatience(kDevicePatience));
    take(link_->receive());
    exchangeOnce(/*isLast=*/false);
    thread_ = std::thread([this] { run(); });
  }
  ~InverseDevice() override {
    isEnding_.store(true, std::memory_order_release);
    thread_.join();
  }

  NearfitDeviceDescription details() const override { return description_; }
  void setForces(bool areOn) override { exchange().setForces(areOn); }
  /// The service finds the place by itself; this says what it waits for.
  void calibrate() override {
    if (!isCalibrated_.load(std::memory_order_acquire)) throw PluginError(kUncalibrated);
  }
  void reset() override {
    words_.store(nullptr, std::memory_order_release);
    exchange().clearFault();
  }
  std::string note() const override {
    if (const char* words = words_.load(std::memory_order_acquire)) return words;
    return isCalibrated_.load(std::memory_order_acquire) ? std::string() : kUncalibrated;
  }

 private:
  static constexpr const char* kUncalibrated =
      "put its handle into its dock, as Haply Hub shows, until its light says that it is calibrated";

  void run() noexcept {
    Nanoseconds next = monotonicNow();
    try {
      while (!isEnding_.load(std::memory_order_acquire)) {
        exchangeOnce(false);
        if (exchange().waitForWrench(monotonicNow() + kInverseAnswer)) {
          // What comes back is older than the next pose: its only use is that the service waits for nothing.
          send(exchange().wrenchNow());
          link_->receive();
        }
        next = std::max(next + kInversePeriod, monotonicNow());
        waitUntil(next);
      }
      exchangeOnce(true);
    } catch (const std::exception&) {
      say("the Haply Inverse Service ended, or the device was unplugged");
      // The service lets a device rest once nobody commands it.
      link_.reset();
      exchange().lose();
    }
  }
  void exchangeOnce(bool isLast) {
    send(isLast ? plugin::PluginWrench{} : exchange().wrenchNow());
    take(link_->receive());
  }
  void send(const plugin::PluginWrench& wrench) { link_->send(forceCommand(listing_, wrench.force)); }

  void take(const std::string& message) {
    const Nanoseconds arrived = monotonicNow();
    takeMessage(message, listing_.id, state_);
    absent_ = state_.isThere ? 0 : absent_ + 1;
    if (absent_ >= kMaxAbsent) throw PluginError("it is gone");
    isCalibrated_.store(state_.isCalibrated, std::memory_order_release);
    if (!state_.hasPower) {
      say("its power supply is unplugged");
      exchange().stop(NEARFIT_FAULT_SWITCHED_OFF);
    }
    if (wasReady_ && !state_.isReady) {
      say("the service says that it is no longer ready");
      exchange().stop(NEARFIT_FAULT_OTHER);
    }
    wasReady_ = wasReady_ || state_.isReady;
    // A message without a place is no pose: in time its silence tells.
    if (!state_.isThere) return;
    NearfitDevicePose pose{};
    std::copy_n(state_.position.data(), 3, pose.position);
    std::copy_n(state_.velocity.data(), 3, pose.velocity);
    const std::array<double, 4> none{1, 0, 0, 0};
    std::copy_n(description_.sensed_axes == 6 ? state_.rotation.data() : none.data(), 4, pose.rotation);
    pose.buttons = state_.buttons;
    if (state_.isCalibrated) pose.flags = NEARFIT_DEVICE_CALIBRATED;
    exchange().publish(pose, arrived);
  }
  void say(const char* words) noexcept {
    const char* none = nullptr;
    words_.compare_exchange_strong(none, words, std::memory_order_acq_rel);
  }

  const InverseListing listing_;
  const NearfitDeviceDescription description_;
  std::optional<ServiceLink> link_;  ///< Empty once it is broken.
  InverseState state_;
  int absent_ = 0;         ///< Messages in a row.
  bool wasReady_ = false;  ///< Some services name no readiness, and others before it is there.
  std::atomic<bool> isCalibrated_{false}, isEnding_{false};
  std::atomic<const char*> words_{nullptr};  ///< Why it is stopped or lost; static text.
  std::thread thread_;
};

/// The devices as the service last listed them, over a connection that is kept.
class Inventory {
 public:
  static Inventory& instance() {
    static Inventory inventory;
    return inventory;
  }
  std::int32_t look() {
    const std::lock_guard lock(mutex_);
    listed_.clear();
    try {
      listed_ = readInventory(nextMessage());
    } catch (const PluginError&) {
      // The service may have been started anew: once more, over a new connection.
      const bool hadLink = link_.has_value();
      link_.reset();
      if (!hadLink) throw;
      listed_ = readInventory(nextMessage());
    }
    return static_cast<std::int32_t>(listed_.size());
  }
  InverseListing at(std::int32_t index) {
    const std::lock_guard lock(mutex_);
    if (index < 0 || static_cast<std::size_t>(index) >= listed_.size())
      throw PluginError("it is no longer plugged in");
    return listed_[static_cast<std::size_t>(index)];
  }

 private:
  const std::string& nextMessage() {
    if (!link_) {
      link_.emplace(servicePort(), servicePatience(kInventoryPatience));
      return link_->receive();
    }
    link_->send(inventoryCommand());
    return link_->receive();
  }

  std::mutex mutex_;
  std::optional<ServiceLink> link_;
  std::vector<InverseListing> listed_;
};

struct Haply {
  static constexpr const char* kName = "Haply";

  static std::int32_t count() { return Inventory::instance().look(); }
  static NearfitDeviceDescription describe(std::int32_t index) {
    return descriptionOf(Inventory::instance().at(index), /*withFirmware=*/false);
  }
  static std::unique_ptr<NearfitDevice> open(std::int32_t index) {
    return std::make_unique<InverseDevice>(Inventory::instance().at(index));
  }
};

}  // namespace
}  // namespace nearfit::haply

extern "C" __attribute__((visibility("default"))) const NearfitDevicePlugin* nearfit_device_plugin(void) {
  return nearfit::plugin::tableOf<nearfit::haply::Haply>();
}
