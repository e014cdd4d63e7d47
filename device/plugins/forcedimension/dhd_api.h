#pragma once

#include <cstddef>

#include "device/plugins/kit/maker_library.h"

/// The part of Force Dimension's SDK that the plug-in uses, declared from its public documentation (DHD and DRD
/// reference, SDK 3.7 to 3.17, on forcedimension.com). Values of the constants: forcedimension-python, an open binding
/// (D. Chow), whose error codes from 15 on leave out two; the cause of forces off and the delta.6 are not in it, and are as
/// AMBF, an open simulator, has them.
namespace nearfit::forcedimension {

namespace dhd {
constexpr int kDelta3 = 63, kDelta6 = 64, kOmega3 = 33, kOmega6 = 34, kOmega7 = 35, kOmega6Left = 36,
              kOmega7Left = 37, kFalcon = 60, kSigma7 = 104, kSigma7Left = 105;
/// dhdErrorGetLast().
constexpr int kErrorCom = 2, kErrorBusy = 3, kErrorNoDriver = 4, kErrorNoDevice = 5, kErrorTimeout = 7,
              kErrorNotReady = 12;
/// Fields of dhdGetStatus(), at most. Versions differ (12 to 17), and the SDK writes as many as it has.
constexpr std::size_t kMaxStatus = 64;
constexpr std::size_t kStatusPower = 0, kStatusConnected = 1, kStatusReset = 3, kStatusForce = 5,
                      kStatusError = 9, kStatusForceOffCause = 14;
/// Why forces are off.
constexpr int kOffByVelocity = 2, kOffByWatchdog = 3, kOffByUsb = 5;
constexpr unsigned char kOn = 1, kOff = 0;
}  // namespace dhd

/// The functions, found in libdrd.so or libdhd.so at run time. Each that is for a device takes its ID last.
struct DhdApi {
  /// Throws DriverMissing that says what to install.
  DhdApi();

  int (*getDeviceCount)() = nullptr;
  int (*openId)(char) = nullptr;
  int (*close)(char) = nullptr;
  int (*getSystemType)(char) = nullptr;
  const char* (*getSystemName)(char) = nullptr;
  int (*getSerialNumber)(unsigned short*, char) = nullptr;
  bool (*hasWrist)(char) = nullptr;
  bool (*hasActiveWrist)(char) = nullptr;
  bool (*hasGripper)(char) = nullptr;
  int (*emulateButton)(unsigned char, char) = nullptr;
  int (*getStatus)(int*, char) = nullptr;
  int (*enableForce)(unsigned char, char) = nullptr;
  int (*getPoseFrame)(double*, double*, double*, double (*)[3], char) = nullptr;
  int (*getLinearVelocity)(double*, double*, double*, char) = nullptr;
  unsigned int (*getButtonMask)(char) = nullptr;
  int (*setWrench)(double, double, double, double, double, double, double, char) = nullptr;
  int (*errorGetLast)() = nullptr;
  const char* (*errorGetLastStr)() = nullptr;
  /// Of libdrd.so only; all or none of the first two. Null without it, or before version 3: the user calibrates by hand.
  bool (*isInitialized)(char) = nullptr;
  int (*autoInit)(char) = nullptr;
  int (*stopRegulation)(bool, char) = nullptr;
  /// Null if the library lacks it: then no gripper is read. [rad]
  int (*getGripperAngle)(double*, char) = nullptr;
  /// Of newer versions; null before: the limit set in the device [N], negative if there is none. Only lowers ours.
  double (*getMaxForce)(char) = nullptr;
  /// Null if the library lacks it: then the version is not shown. Major, minor, release and revision.
  void (*getSdkVersion)(int*, int*, int*, int*) = nullptr;

  bool canCalibrate() const noexcept {
    return isInitialized != nullptr && autoInit != nullptr && stopRegulation != nullptr;
  }

 private:
  plugin::MakerLibrary library_;
};

}  // namespace nearfit::forcedimension
