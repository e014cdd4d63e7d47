#include "device/spacemouse/spacemouse_device.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "device/hid/report_descriptor.h"
#include "device/interface/device_error.h"
#include "device/interface/device_supervisor.h"

namespace nearfit {
namespace {

/// The device renders no force, so a push of this size on the handle stops it, as a firm hand would be
/// stopped [N], [N m].
constexpr double kLeashForce = 5.0, kLeashTorque = 0.25;
/// A pushed cap sends reports at least every 16 ms; after so long without one, the report that the
/// cap is back was lost.
constexpr Nanoseconds kForgetAfter = kNanosecondsPerSecond / 10;

/// Button bits.
constexpr std::uint64_t kMouseClutchButton = 1, kLetGoButton = 2;

/// HID 1.11, 7.1.1 and 7.2.2.
constexpr std::uint8_t kGetFromInterface = 0x81, kGetDescriptor = 0x06, kSetToInterface = 0x21,
                       kSetReport = 0x09;
constexpr std::uint16_t kReportDescriptor = 0x2200, kOutputReport = 0x0200;
constexpr std::size_t kMaxMouseDescriptor = 4096;
constexpr UsbLink::Timeout kMouseRequestTimeout{500};

constexpr std::uint16_t kLogitech = 0x046d, k3Dconnexion = 0x256f;
// Source of all USB IDs: spacenavd's lists of devices.
constexpr std::array<std::uint16_t, 11> kOfLogitech = {0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625,
                                                       0xc626, 0xc627, 0xc628, 0xc629, 0xc62b};
/// 3Dconnexion's own IDs. Newer models are recognised by their axes.
constexpr std::array<std::uint16_t, 7> kSpaceMice = {0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633, 0xc635, 0xc636};
/// All CadMouse models.
constexpr std::array<std::uint16_t, 7> kOrdinaryMice = {0xc650, 0xc651, 0xc654, 0xc655,
                                                        0xc656, 0xc657, 0xc658};

/// HID 1.11, 4.2 and 4.3: an interface that declares itself a keyboard or a mouse.
constexpr std::uint8_t kMouseHidClass = 3, kBootSubclass = 1;

template <std::size_t Count>
bool contains(const std::array<std::uint16_t, Count>& numbers, std::uint16_t number) noexcept {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

bool isReader(const UsbInterface& face) noexcept {
  return face.classCode == kMouseHidClass && face.streaming(true) != nullptr;
}

bool isOrdinaryMouse(const UsbDescription& device) noexcept {
  return device.vendor == k3Dconnexion && contains(kOrdinaryMice, device.product);
}

enum class Axes : std::uint8_t { Six, Fewer, Unknown };

Axes axesOf(const UsbDescription& device, const UsbInterface& face) {
  if (const auto descriptor = systemReportDescriptor(device, face.number)) {
    if (SpaceMouseReader::fromDescriptor(*descriptor)) return Axes::Six;
    if (parseReportDescriptor(*descriptor)) return Axes::Fewer;
  }
  return face.subclass == kBootSubclass && face.protocol != 0 ? Axes::Fewer : Axes::Unknown;
}

/// True if its USB ID is known to have six axes.
bool isKnownModel(const UsbDescription& device) noexcept {
  return (device.vendor == k3Dconnexion && contains(kSpaceMice, device.product)) ||
         (device.vendor == kLogitech && contains(kOfLogitech, device.product));
}

/// Returns the interfaces that may have the six axes, the likeliest first. Leaves out those that declare
/// themselves a mouse or keyboard, and those that the system knows to lack an axis: opening one takes it from
/// the desktop. Pointers refer into `device`.
std::vector<const UsbInterface*> candidates(const UsbDescription& device) {
  std::vector<const UsbInterface*> sure, possible;
  if (isOrdinaryMouse(device)) return sure;
  for (const UsbInterface& each : device.interfaces) {
    if (!isReader(each)) continue;
    const Axes axes = axesOf(device, each);
    if (axes == Axes::Six) sure.push_back(&each);
    if (axes == Axes::Unknown) possible.push_back(&each);
  }
  sure.insert(sure.end(), possible.begin(), possible.end());
  return sure;
}

/// Returns the refusal for a device that had no six axes when opened.
DeviceRefusal noSixAxes() {
  return {"it lacks the six axes of a space mouse", "choose a space mouse"};
}

}  // namespace

bool SpaceMouseDevice::speaks(const UsbDescription& device) noexcept {
  const bool isTheirs =
      device.vendor == k3Dconnexion || (device.vendor == kLogitech && contains(kOfLogitech, device.product));
  return isTheirs && std::any_of(device.interfaces.begin(), device.interfaces.end(), isReader);
}

std::optional<DeviceRefusal> SpaceMouseDevice::refusal(const UsbDescription& device) {
  if (isOrdinaryMouse(device)) {
    return DeviceRefusal{"it is an ordinary mouse, not a space mouse with six axes", "choose a space mouse"};
  }
  if (candidates(device).empty()) return noSixAxes();
  return std::nullopt;
}

SpaceMouseDevice::SpaceMouseDevice(UsbDescription device)
    : device_(std::move(device)), control_(kLeashForce, kLeashTorque) {}

SpaceMouseDevice::~SpaceMouseDevice() {
  stop();
}

std::string SpaceMouseDevice::name() const {
  return fmt::format("{} ({} at {})", product_.empty() ? "Space mouse" : product_, device_.id(),
                     device_.node());
}

void SpaceMouseDevice::setRate(const RateSettings& settings) {
  checkRateSettings(settings);
  settings_.publish(settings);
}

DeviceInfo SpaceMouseDevice::info() const {
  return {name(), 0, DeviceLimits{}};
}

std::string SpaceMouseDevice::stateNote() const {
  return state() == DeviceState::Lost ? lossReason(loss_.load(std::memory_order_acquire)) : "";
}

void SpaceMouseDevice::start(const RigidTransform&, const ProgressCallback&) {
  stop();
  state_ = DeviceState::Opening;
  try {
    const std::uint8_t endpoint = openAxes();
    product_ = link_->strings().product;
    newest_ = {};
    samples_.publish(Sample{});
    control_.restart({});
    wrench_ = {};
    lastRead_ = 0;
    wasLettingGo_ = false;
    loss_ = UsbLoss::None;
    light(true);
    state_ = DeviceState::Armed;
    link_->stream({endpoint, 0}, *this);
  } catch (...) {
    link_.reset();
    state_ = stateAfterFailure();
    throw;
  }
}

std::uint8_t SpaceMouseDevice::openAxes() {
  const UsbInterface* unreadable = nullptr;
  for (const UsbInterface* face : candidates(device_)) {
    open(*face);
    const std::vector<std::byte> descriptor = readDescriptor();
    reader_ = SpaceMouseReader::fromDescriptor(descriptor);
    if (reader_) return face->streaming(true)->address;
    const bool isReadable = !descriptor.empty() && parseReportDescriptor(descriptor).has_value();
    if (!isReadable && unreadable == nullptr) unreadable = face;
  }
  // Believe a descriptor without the axes; a device without a readable one may still be a known model.
  if (unreadable == nullptr || !isKnownModel(device_)) {
    const DeviceRefusal refusal = noSixAxes();
    throw DeviceError(DeviceProblem::Unsupported, name(), refusal.reason, refusal.remedy);
  }
  open(*unreadable);
  reader_ = SpaceMouseReader::withKnownLayout();
  return unreadable->streaming(true)->address;
}

void SpaceMouseDevice::open(const UsbInterface& face) {
  link_.reset();  // Releases the previous interface.
  interfaceNumber_ = face.number;
  link_.emplace(device_, face.number);
}

std::vector<std::byte> SpaceMouseDevice::readDescriptor() {
  std::vector<std::byte> descriptor(kMaxMouseDescriptor);
  try {
    descriptor.resize(link_->controlIn(kGetFromInterface, kGetDescriptor, kReportDescriptor, interfaceNumber_,
                                       descriptor, kMouseRequestTimeout));
  } catch (const DeviceError& error) {
    if (error.cause() == DeviceProblem::Gone) throw;
    descriptor.clear();
  }
  return descriptor;
}

void SpaceMouseDevice::light(bool isOn) noexcept {
  const std::optional<SpaceMouseReader::LedReport> report = reader_ ? reader_->ledReport(isOn) : std::nullopt;
  if (!report || !link_) return;
  try {
    const auto value =
        static_cast<std::uint16_t>(kOutputReport | std::to_integer<unsigned>(report->bytes[0]));
    link_->controlOut(kSetToInterface, kSetReport, value, interfaceNumber_,
                      std::span(report->bytes).first(report->size), kMouseRequestTimeout);
  } catch (const DeviceError&) {
    // The light does not matter.
  }
}

void SpaceMouseDevice::stop() noexcept {
  if (!link_) return;
  const bool isLost = state() == DeviceState::Lost;
  link_->stop();
  if (!isLost) light(false);
  link_.reset();
  state_ = isLost ? DeviceState::Lost : DeviceState::Present;
}

void SpaceMouseDevice::onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept {
  if (!reader_->read(packet, newest_)) {
    rejected_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  samples_.publish({newest_, arrived});
  shown_.publish(newest_);
  // Counted last, so that whoever sees the count finds the report.
  reports_.fetch_add(1, std::memory_order_release);
}

ReportCounters SpaceMouseDevice::counters() const noexcept {
  return {reports_.load(std::memory_order_acquire), rejected_.load(std::memory_order_relaxed)};
}

void SpaceMouseDevice::onLost(UsbLoss loss) noexcept {
  loss_.store(loss, std::memory_order_release);
  state_.store(DeviceState::Lost, std::memory_order_release);
}

bool SpaceMouseDevice::waitForHandle(Nanoseconds deadline) noexcept {
  waitUntil(deadline);
  return false;
}

bool SpaceMouseDevice::readHandle(HandleInput& handle) noexcept {
  if (state() != DeviceState::Armed) return false;
  samples_.update();
  settings_.update();
  const Sample& sample = samples_.front();
  const Nanoseconds now = monotonicNow();
  const bool isFresh = now - sample.arrived < kForgetAfter;
  const double time = lastRead_ == 0 ? 0.0 : toSeconds(now - lastRead_);
  lastRead_ = now;
  const std::uint64_t buttons = sample.state.buttons;
  handle = {};
  handle.isClutched = (buttons & kMouseClutchButton) != 0;
  const bool isDriven = isFresh && !handle.isClutched;
  handle.pose =
      control_.step(isDriven ? sample.state.axes : std::array<double, 6>{}, settings_.front(), wrench_, time);
  const bool returnsToPart = (buttons & kLetGoButton) != 0;
  handle.returnsToPart = returnsToPart && !wasLettingGo_;
  wasLettingGo_ = returnsToPart;
  handle.hasOwnFrame = true;
  handle.buttons = buttons;
  return true;
}

const SpaceMouseState& SpaceMouseDevice::newest() noexcept {
  shown_.update();
  return shown_.front();
}

}  // namespace nearfit
