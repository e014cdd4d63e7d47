#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "device/interface/device_error.h"
#include "device/interface/device_supervisor.h"
#include "device/registry/device_registry.h"
#include "tests/usb/emulated_device.h"
#include "tests/usb/hand_servo.h"

namespace nearfit::test {

/// A report that is not as it should be.
struct BadReport {
  std::string name;
  std::function<void(Bytes&)> damage;  ///< Of a good one's bytes.
  /// Longer than its endpoint may send: it is thrown away before the driver sees it.
  bool isOversized = false;
};

/// A driver and the emulated device that it drives: what the tests of all drivers (driver_*_test.cpp) have to
/// know of each. The test's thread plays hand and servo, and in a round() the device too, so that it is known
/// what is on its way: nothing, before and after. Only stream() has the device speak from another thread.
class DriverBench {
 public:
  struct Traits {
    DeviceDriver driver = DeviceDriver::None;
    double rate = 1000.0;                     ///< Of its reports [Hz].
    bool pushes = true;                       ///< It has forces, and so is armed and told what to push with.
    DeviceState opened = DeviceState::Ready;  ///< When it is open and nobody has seen to it yet.
    std::optional<DeviceProblem> whenSilent;  ///< Opening it fails so when it answers nothing.
    std::optional<DeviceProblem> whenRefusing;  ///< And when it refuses its driver's requests.
    bool isStoppedByGarbage = true;             ///< By kMaxRejectedInRow bad reports in a row.
    std::uint8_t in = 0x81, out = 0x01;         ///< Endpoints; of `out`, 0 for none.
  };

  virtual ~DriverBench() = default;
  virtual Traits traits() const = 0;
  virtual const std::shared_ptr<EmulatedDevice>& emulated() const = 0;
  /// Its driver, for the device as it is plugged in; opens nothing yet.
  virtual std::unique_ptr<HapticDevice> make(const UsbDescription& seen, const SafetyLimits& safety) = 0;

  /// Opens it.
  virtual void start(HapticDevice& device) = 0;
  /// Brings one that is open to where it can be armed, as its user does.
  virtual void makeWell(HapticDevice&) {}
  /// The hand holds the handle at another place for each `i`, near to that for i - 1.
  virtual void hold(int i) = 0;
  /// Expects the handle where hold(i) has it.
  virtual void expectHeld(HapticDevice& device, const HandleInput& handle, int i) = 0;
  /// One report, read by the driver, and one wrench that answers it, or asks for the report where the device
  /// answers commands. False when either does not come.
  virtual bool round(HapticDevice& device, const Wrench& wrench, HandleInput& handle) = 0;

  /// Reports without end, each as soon as the device has it, from now on.
  virtual void stream() = 0;
  virtual void stopStreaming() = 0;
  /// Without power: after it was unplugged.
  virtual void powerOff() = 0;

  /// What is bad, and of what sort: each is counted once as rejected, unless it is oversized.
  virtual std::vector<BadReport> badReports() const = 0;
  /// Sends one; of a device that answers commands, as the answer to one.
  virtual void sendBad(HapticDevice& device, const BadReport& bad) = 0;

  // Of devices that push.
  virtual std::uint64_t commands() { return 0; }  ///< That it has taken.
  virtual bool isPushing() { return false; }      ///< As it was last told.
  /// The hand holds the handle so far from some place in the middle of the workspace, in the device's frame
  /// [m]; of those that sense places.
  virtual void holdAt(const glm::dvec3&) {}
  /// What its motors push with as they were last told [N]: the handle is where holdAt() has it.
  virtual glm::dvec3 force() { return glm::dvec3(0.0); }
  /// Expects that it was last told to push so.
  virtual void expectTold(const Wrench&, const HandleInput&) {}
};

std::unique_ptr<DriverBench> openHapBench();
std::unique_ptr<DriverBench> spaceMouseBench();
std::unique_ptr<DriverBench> polhemBench();
std::unique_ptr<DriverBench> falconBench();

struct DriverKind {
  const char* name;
  std::unique_ptr<DriverBench> (*make)();
};
inline constexpr std::array kDriverKinds = {
    DriverKind{"OpenHap", &openHapBench}, DriverKind{"SpaceMouse", &spaceMouseBench},
    DriverKind{"Polhem", &polhemBench}, DriverKind{"Falcon", &falconBench}};
inline std::ostream& operator<<(std::ostream& to, const DriverKind& kind) {
  return to << kind.name;
}

/// A driver that stops its device after so long without a report [s]. On a loaded machine a thread may not
/// run for a while: usually for nothing like that.
SafetyLimits safetyWith(double silence);
SafetyLimits lenientSafety();

/// The force that makes motors, whose numbers are `told`, do what `tell` of a force has them do: linear.
glm::dvec3 forceFor(const glm::dvec3& told, const std::function<glm::dvec3(const glm::dvec3&)>& tell);

/// As eventually(), looking all the time: for what comes within microseconds and thousands of times.
bool promptly(const std::function<bool()>& isTrue);

/// 0, 1, 2, ... `most`, ..., 1, 0, -1, ... -most, ..., -1, 0 and so on.
int toAndFro(int i, int most);

}  // namespace nearfit::test
