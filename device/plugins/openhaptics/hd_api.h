#pragma once

#include <cstdint>

#include "device/plugins/kit/maker_library.h"

/// The part of OpenHaptics' HDAPI that the plug-in uses, declared from its public documentation.
///
/// Functions, their meaning, units and errors: OpenHaptics Toolkit, API Reference Guide (device, calibration and scheduler
/// routines). Values of the constants: ManagedPhantom, an open binding for C# (MIT, Kirurobo 2013), whose names are those
/// of the guide. HD_CURRENT_TORQUE is not in it; two open bindings differ, and 0x2701, which nothing else has, is taken.
/// OpenHaptics 3.0 deprecates it in favour of torques of joints and gimbal.
namespace nearfit::openhaptics {

using HdHandle = std::uint32_t;           // HHD
using HdEnum = std::uint32_t;             // HDenum
using HdCallbackCode = std::uint32_t;     // HDCallbackCode
using HdSchedulerHandle = unsigned long;  // HDSchedulerHandle
using HdCallback = HdCallbackCode (*)(void*);

/// HDErrorInfo, as hdGetError() returns it by value.
struct HdError {
  std::uint32_t code;
  std::int32_t internalCode;
  HdHandle device;
};

constexpr HdHandle kHdInvalidHandle = 0xFFFFFFFF;
constexpr HdCallbackCode kHdDone = 0, kHdContinue = 1;
/// Between the lowest, 0, and the highest, 0xffff: HD_DEFAULT_SCHEDULER_PRIORITY.
constexpr std::uint16_t kHdDefaultPriority = 0x7fff;

namespace hd {
constexpr HdEnum kCurrentButtons = 0x2000, kCurrentVelocity = 0x2051, kCurrentTransform = 0x2052;
constexpr HdEnum kVersion = 0x2500, kDeviceModelType = 0x2501, kDeviceDriverVersion = 0x2502,
                 kDeviceSerialNumber = 0x2504;
constexpr HdEnum kInputDof = 0x2553, kOutputDof = 0x2554, kCalibrationStyle = 0x2555;
constexpr HdEnum kUpdateRate = 0x2600, kNominalMaxStiffness = 0x2602, kNominalMaxForce = 0x2603,
                 kSoftwareVelocityLimit = 0x2606;
constexpr HdEnum kNominalMaxTorque = 0x2622;  // HD_NOMINAL_MAX_TORQUE_FORCE
constexpr HdEnum kCurrentForce = 0x2700, kCurrentTorque = 0x2701;
constexpr HdEnum kForceOutput = 0x4000;
constexpr HdEnum kCalibrationOk = 0x5000, kCalibrationNeedsUpdate = 0x5001,
                 kCalibrationNeedsManualInput = 0x5002;
/// Bits of kCalibrationStyle.
constexpr HdEnum kCalibrationEncoderReset = 1, kCalibrationAuto = 2, kCalibrationInkwell = 4;
/// Errors.
constexpr std::uint32_t kSuccess = 0, kWarmMotors = 0x0200, kExceededMaxForce = 0x0201,
                        kExceededMaxForceImpulse = 0x0202, kExceededMaxVelocity = 0x0203,
                        kForceError = 0x0204, kDeviceFault = 0x0300, kCommError = 0x0302;
}  // namespace hd

/// The functions, found in libHD.so at run time.
struct HdApi {
  /// Throws DriverMissing that says what to install.
  HdApi();

  HdHandle (*initDevice)(const char*) = nullptr;
  void (*disableDevice)(HdHandle) = nullptr;
  void (*makeCurrentDevice)(HdHandle) = nullptr;
  void (*beginFrame)(HdHandle) = nullptr;
  void (*endFrame)(HdHandle) = nullptr;
  void (*enable)(HdEnum) = nullptr;
  void (*disable)(HdEnum) = nullptr;
  HdError (*getError)() = nullptr;
  const char* (*getErrorString)(std::uint32_t) = nullptr;
  void (*getIntegerv)(HdEnum, int*) = nullptr;
  void (*getDoublev)(HdEnum, double*) = nullptr;
  const char* (*getString)(HdEnum) = nullptr;
  void (*setDoublev)(HdEnum, const double*) = nullptr;
  HdEnum (*checkCalibration)() = nullptr;
  void (*updateCalibration)(HdEnum) = nullptr;
  void (*startScheduler)() = nullptr;
  void (*stopScheduler)() = nullptr;
  HdSchedulerHandle (*scheduleAsynchronous)(HdCallback, void*, std::uint16_t) = nullptr;
  void (*unschedule)(HdSchedulerHandle) = nullptr;

 private:
  plugin::MakerLibrary library_;
};

}  // namespace nearfit::openhaptics
