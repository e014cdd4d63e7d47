// Stands in for Force Dimension's libdhd.so and, with STANDIN_DRD, libdrd.so: the functions that the plug-in uses, as the
// reference of the SDK describes them. Each exchange takes a quarter of a millisecond, as over USB. Models are DHD_DEVICE_...
// numbers: 33, an omega.3; 34 (or 0), an omega.6; 104, a sigma.7. StandinDevice::error is a DHD_ERROR_... code that each
// call fails with; StandinDevice::status a cause of forces off, whose forces are off then; -1, its power is off; -2, each
// pose is asked for too early, and is the one before. With STANDIN_OLD it is a version that lacks a function that the plug-in
// needs, with STANDIN_SPARE one that lacks those that it does without.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "tests/makers/standin.h"

namespace {

using nearfit::test::StandinDevice;
using nearfit::test::Triple;
using Clock = std::chrono::steady_clock;

constexpr int kNoDevice = 5, kInUse = 20;
constexpr int kPowerOff = -1, kTooEarly = -2;  // Of StandinDevice::status.
/// As a new version has it.
constexpr int kStatusFields = 17;
constexpr std::chrono::microseconds kTransfer{250};

struct Dhd {
  nearfit::test::Standin devices;
  std::atomic<int> lastError{0};
  std::array<Clock::time_point, 2> next{};
  std::array<std::atomic<bool>, 2> areForcesOn{};

  StandinDevice& device(char id) { return devices.devices.at(static_cast<std::size_t>(id)); }
  int fail(int code) {
    lastError = code;
    return -1;
  }
  /// Fails as the device does now; 0 if it does not.
  int trouble(char id) {
    if (!device(id).isPlugged) return fail(kNoDevice);
    return device(id).failsNow() ? fail(device(id).error) : 0;
  }
};

Dhd& dhd() {
  static Dhd dhd;
  return dhd;
}
int modelNow() {
  const int model = dhd().devices.model;
  return model == 0 ? 34 : model;
}
// Force Dimension: x towards the user, y to the right, z up.
Triple toDhd(const Triple& v) {
  return {-v[1], v[0], v[2]};
}
Triple fromDhd(const Triple& v) {
  return {v[1], -v[0], v[2]};
}

int openDevice(char id) {
  if (id < 0 || id >= dhd().devices.count || !dhd().device(id).isPlugged) return dhd().fail(kNoDevice);
  if (dhd().device(id).isOpen.exchange(true)) return dhd().fail(kInUse);
  dhd().next[static_cast<std::size_t>(id)] = Clock::now();
  return id;
}
int closeDevice(char id) {
  dhd().device(id).push({}, {});
  dhd().device(id).isOpen = false;
  return 0;
}

}  // namespace

extern "C" {

nearfit::test::Standin* nearfit_standin() {
  return &dhd().devices;
}

int dhdGetDeviceCount() {
  int there = 0;
  for (int i = 0; i < dhd().devices.count; ++i)
    there += dhd().device(static_cast<char>(i)).isPlugged ? 1 : 0;
  return there;
}
int dhdOpenID(char id) {
  return openDevice(id);
}
int dhdClose(char id) {
  return closeDevice(id);
}
#ifndef STANDIN_SPARE
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
  *minor = 17;
  *release = 1;
  *revision = 2;
}
double dhdGetMaxForce(char id) {
  return dhd().device(id).maxForce;
}
#endif
int dhdGetSystemType(char) {
  return modelNow();
}
const char* dhdGetSystemName(char) {
  return modelNow() == 33 ? "omega.3" : modelNow() == 104 ? "sigma.7" : "omega.6";
}
int dhdGetSerialNumber(unsigned short* serial, char id) {
  *serial = static_cast<unsigned short>(54321 + id);
  return 0;
}
bool dhdHasWrist(char) {
  return modelNow() != 33;
}
bool dhdHasActiveWrist(char) {
  return modelNow() == 104;
}
bool dhdHasGripper(char) {
  return modelNow() == 104;
}
int dhdEmulateButton(unsigned char, char) {
  return 0;
}
int dhdGetStatus(int* status, char id) {
  if (dhd().trouble(id) < 0) return -1;
  const int cause = dhd().device(id).status;
  std::fill(status, status + kStatusFields, 0);
  status[0] = cause == kPowerOff ? 0 : 1;
  status[1] = status[2] = 1;
  status[3] = dhd().device(id).isCalibrated ? 0 : 1;
  status[5] = dhd().areForcesOn[static_cast<std::size_t>(id)] && (cause == 0 || cause == kTooEarly) ? 1 : 0;
  status[14] = std::max(cause, 0);
  return 0;
}
int dhdEnableForce(unsigned char isOn, char id) {
  if (dhd().trouble(id) < 0) return -1;
  dhd().areForcesOn[static_cast<std::size_t>(id)] = isOn != 0;
  return 0;
}
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double matrix[3][3], char id) {
  while (dhd().device(id).isStalled)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (dhd().trouble(id) < 0) return -1;
  const Triple at = toDhd(dhd().device(id).position.get());
  *x = at[0];
  *y = at[1];
  *z = at[2];
  // A turn about Nearfit's y, which is -x here.
  const double c = std::cos(-dhd().device(id).turn), s = std::sin(-dhd().device(id).turn);
  const double turned[3][3] = {{1, 0, 0}, {0, c, -s}, {0, s, c}};
  std::copy(&turned[0][0], &turned[0][0] + 9, &matrix[0][0]);
  return dhd().device(id).status == kTooEarly ? 1 : 0;
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
  const Triple v = toDhd(dhd().device(id).velocity.get());
  *x = v[0];
  *y = v[1];
  *z = v[2];
  return 0;
}
#ifndef STANDIN_OLD
unsigned int dhdGetButtonMask(char id) {
  return static_cast<unsigned int>(dhd().device(id).buttons);
}
#endif
#ifndef STANDIN_SPARE
// Of a device for the right hand.
int dhdGetGripperAngleRad(double* angle, char id) {
  if (!dhdHasGripper(id)) return -1;
  *angle = -dhd().device(id).grip;
  return 0;
}
#endif
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz,
                                        double, char id) {
  if (dhd().trouble(id) < 0) return -1;
  StandinDevice& device = dhd().device(id);
  const bool isOn = dhd().areForcesOn[static_cast<std::size_t>(id)];
  device.push(isOn ? fromDhd({fx, fy, fz}) : Triple{},
              isOn && dhdHasActiveWrist(id) ? fromDhd({tx, ty, tz}) : Triple{});
  // The transfer takes until the controller's next sample.
  Clock::time_point& next = dhd().next[static_cast<std::size_t>(id)];
  const Clock::time_point before = next;
  next = std::max(next + kTransfer, Clock::now());
  std::this_thread::sleep_until(next);
  device.advance(std::chrono::duration<double>(next - before).count());
  return 0;
}
int dhdErrorGetLast() {
  return dhd().lastError;
}
const char* dhdErrorGetLastStr() {
  return dhd().lastError == kNoDevice ? "no device found"
         : dhd().lastError == kInUse  ? "device already in use"
                                      : "some error";
}

#ifdef STANDIN_DRD
int drdOpenID(char id) {
  return openDevice(id);
}
int drdClose(char id) {
  return closeDevice(id);
}
bool drdIsInitialized(char id) {
  return dhd().device(id).isCalibrated;
}
int drdAutoInit(char id) {
  if (dhd().trouble(id) < 0) return -1;
  dhd().device(id).isCalibrated = true;
  return 0;
}
int drdStop(bool, char) {
  return 0;
}
#endif
}
