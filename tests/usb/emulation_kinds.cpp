#include "tests/usb/emulation_kinds.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "device/simulated/simulated_device.h"
#include "tests/usb/falcon_emulator.h"
#include "tests/usb/openhap_emulator.h"
#include "tests/usb/polhem_emulator.h"
#include "tests/usb/spacemouse_emulator.h"

namespace nearfit::test {
namespace {

constexpr double kRadius = 0.02, kTurnsPerSecond = 0.25;
/// An arm is held still for so many reports, in its rest, then moved [reports].
constexpr std::uint64_t kAtRest = 500;
/// How far arms are moved, in counts of their encoders: some centimetres of the handle.
constexpr double kFalconCounts = 150.0, kPolhemCounts = 600.0;

/// The share of a turn that the hand has made, or of one to and fro, after so many reports.
double turned(std::uint64_t reports, double rate) {
  const std::uint64_t moved = reports - std::min(reports, kAtRest);
  return 2.0 * std::numbers::pi * kTurnsPerSecond * static_cast<double>(moved) / rate;
}

std::string countsText(const ReportStream::Counts& counts) {
  return fmt::format("{} reports sent, {} waited for a transfer", counts.sent, counts.waited);
}

/// The device's handle along a circle, or the poses of a file, one a report, again and again. The circle begins with
/// the first wrench: however long a loaded machine takes to begin, the way that follows is the same.
std::function<void(OpenHapFirmware&, double)> handOf(const EmulationOptions& options, double rate) {
  std::vector<RigidTransform> path;
  if (!options.path.empty()) path = readPosePath(options.path);
  const auto poseAt = [path, rate](double time) -> RigidTransform {
    if (!path.empty()) return path[static_cast<std::size_t>(std::max(time, 0.0) * rate) % path.size()];
    const double angle = 2.0 * std::numbers::pi * kTurnsPerSecond * time;
    return {glm::dquat(1.0, 0.0, 0.0, 0.0), {kRadius * std::cos(angle), 0.0, kRadius * std::sin(angle)}};
  };
  return [poseAt, rate, began = path.empty() ? std::nullopt : std::optional(0.0)](OpenHapFirmware& firmware,
                                                                                  double sinceStart) mutable {
    if (!began && firmware.accepted() > 0) began = sinceStart;
    const double time = began ? sinceStart - *began : 0.0;
    const RigidTransform pose = poseAt(time);
    const glm::dvec3 velocity =
        began ? (pose.translation - poseAt(time - 1.0 / rate).translation) * rate : glm::dvec3(0.0);
    for (int i = 0; i < 3; ++i) {
      firmware.handle.position.at(static_cast<std::size_t>(i)) = static_cast<float>(pose.translation[i]);
      firmware.handle.velocity.at(static_cast<std::size_t>(i)) = static_cast<float>(velocity[i]);
    }
    const glm::dquat& q = pose.rotation;
    firmware.handle.rotation = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                                static_cast<float>(q.z)};
    firmware.isDeadManHeld = true;
  };
}

class OpenHapKind final : public EmulatedKind {
 public:
  explicit OpenHapKind(const EmulationOptions& options)
      : hand_(handOf(options, capabilitiesOf(options).rate)), emulator_(capabilitiesOf(options)) {}
  void start() override { emulator_.stream({.hand = hand_}); }
  const std::shared_ptr<EmulatedDevice>& device() const override { return emulator_.device(); }
  std::uint64_t sent() override { return emulator_.counts().sent; }
  void stop() override { emulator_.stopStreaming(); }
  std::string summary() override {
    const LatencyHistogram times = emulator_.roundTrips();
    return fmt::format(
        "{}\n{} answered; from pose to wrench p50 {:.1f} us, p99 {:.1f} us, p99.9 {:.1f} us, max {:.1f} us",
        countsText(emulator_.counts()), times.count(), 1e6 * times.percentile(0.5),
        1e6 * times.percentile(0.99), 1e6 * times.percentile(0.999), 1e6 * times.max());
  }

 private:
  static openhap::Capabilities capabilitiesOf(const EmulationOptions& options) {
    openhap::Capabilities capabilities = OpenHapEmulator::usualCapabilities();
    if (options.rate > 0.0) capabilities.rate = static_cast<std::uint16_t>(options.rate);
    return capabilities;
  }
  const std::function<void(OpenHapFirmware&, double)> hand_;
  OpenHapEmulator emulator_;
};

class SpaceMouseKind final : public EmulatedKind {
 public:
  explicit SpaceMouseKind(const EmulationOptions& options)
      : rate_(options.rate > 0.0 ? options.rate : 125.0) {}
  void start() override { emulator_.stream(pushEachAxis, rate_); }
  const std::shared_ptr<EmulatedDevice>& device() const override { return emulator_.device(); }
  std::uint64_t sent() override { return emulator_.counts().sent; }
  void stop() override { emulator_.stopStreaming(); }
  std::string summary() override { return countsText(emulator_.counts()); }

 private:
  /// Each axis in turn, to and fro.
  static void pushEachAxis(SpaceMouseFirmware& firmware, double time) {
    firmware.counts = {};
    const auto axis = static_cast<std::size_t>(time / 2.0) % firmware.counts.size();
    firmware.counts.at(axis) =
        static_cast<std::int16_t>(std::lround(200.0 * std::sin(std::numbers::pi * time)));
  }
  const double rate_;
  SpaceMouseEmulator emulator_;
};

/// Held in its rest at first, for whoever calibrates it; then its joints go to and fro.
class PolhemKind final : public EmulatedKind {
 public:
  explicit PolhemKind(const EmulationOptions& options) : rate_(options.rate > 0.0 ? options.rate : 1000.0) {}
  void start() override {
    const auto hand = [rate = rate_](PolhemFirmware& firmware) {
      const double counts = kPolhemCounts * std::sin(turned(firmware.accepted(), rate));
      firmware.counts = {
          static_cast<int>(2.0 * counts), static_cast<int>(-counts), static_cast<int>(counts), 0, 0, 0};
    };
    emulator_.stream({.hand = hand, .rate = rate_});
  }
  const std::shared_ptr<EmulatedDevice>& device() const override { return emulator_.device(); }
  std::uint64_t sent() override { return emulator_.counts().sent; }
  void stop() override { emulator_.stopStreaming(); }
  std::string summary() override { return countsText(emulator_.counts()); }

 private:
  const double rate_;
  PolhemEmulator emulator_;
};

FalconFirmware::Bytes imageOf(const std::string& file) {
  if (file.empty()) return {};
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file + ": it cannot be read; check its name");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::span<const std::byte> bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Its handle is pulled out and pushed in once it has been asked a while, then goes round. Without a firmware
/// file it has its firmware already; with one it runs that and nothing else.
class FalconKind final : public EmulatedKind {
 public:
  explicit FalconKind(const EmulationOptions& options) : emulator_(imageOf(options.firmware)) {
    if (options.firmware.empty()) emulator_.withFirmware([](FalconFirmware& firmware) { firmware.run(); });
    const double rate = options.rate > 0.0 ? options.rate : 1000.0;
    emulator_.paceAt(rate);
    emulator_.moveWith([rate](FalconFirmware& firmware) {
      const double angle = turned(firmware.commands(), rate);
      if (firmware.commands() > kAtRest) firmware.indexesPassed = 7;
      for (std::size_t i = 0; i < firmware.encoders.size(); ++i) {
        const double phase = angle + 2.0 * std::numbers::pi * static_cast<double>(i) / 3.0;
        firmware.encoders.at(i) = static_cast<std::int16_t>(std::lround(kFalconCounts * std::sin(phase)));
      }
    });
  }
  const std::shared_ptr<EmulatedDevice>& device() const override { return emulator_.device(); }
  std::uint64_t sent() override {
    return emulator_.withFirmware([](const FalconFirmware& firmware) { return firmware.commands(); });
  }
  void start() override {}
  void stop() override {}
  std::string summary() override { return fmt::format("{} commands answered", sent()); }

 private:
  FalconEmulator emulator_;
};

}  // namespace

std::unique_ptr<EmulatedKind> makeKind(const EmulationOptions& options) {
  if (options.kind == "openhap") return std::make_unique<OpenHapKind>(options);
  if (options.kind == "spacemouse") return std::make_unique<SpaceMouseKind>(options);
  if (options.kind == "polhem") return std::make_unique<PolhemKind>(options);
  if (options.kind == "falcon") return std::make_unique<FalconKind>(options);
  throw std::runtime_error("\"" + options.kind + "\" is no kind of device that is known");
}

}  // namespace nearfit::test
