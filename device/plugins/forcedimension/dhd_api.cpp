#include "device/plugins/forcedimension/dhd_api.h"

namespace nearfit::forcedimension {
namespace {

constexpr const char* kDhdRemedy =
    "for a delta, omega or sigma, install Force Dimension's SDK 3.7 or newer (libdrd.so or libdhd.so) where "
    "the system "
    "finds libraries";

}  // namespace

DhdApi::DhdApi() : library_({"libdrd.so", "libdrd.so.3", "libdhd.so", "libdhd.so.3"}, kDhdRemedy) {
  library_.take(getDeviceCount, "dhdGetDeviceCount", kDhdRemedy);
  library_.take(getSystemType, "dhdGetSystemType", kDhdRemedy);
  library_.take(getSystemName, "dhdGetSystemName", kDhdRemedy);
  library_.take(getSerialNumber, "dhdGetSerialNumber", kDhdRemedy);
  library_.take(hasWrist, "dhdHasWrist", kDhdRemedy);
  library_.take(hasActiveWrist, "dhdHasActiveWrist", kDhdRemedy);
  library_.take(hasGripper, "dhdHasGripper", kDhdRemedy);
  library_.take(emulateButton, "dhdEmulateButton", kDhdRemedy);
  library_.take(getStatus, "dhdGetStatus", kDhdRemedy);
  library_.take(enableForce, "dhdEnableForce", kDhdRemedy);
  library_.take(getPoseFrame, "dhdGetPositionAndOrientationFrame", kDhdRemedy);
  library_.take(getLinearVelocity, "dhdGetLinearVelocity", kDhdRemedy);
  library_.take(getButtonMask, "dhdGetButtonMask", kDhdRemedy);
  library_.take(setWrench, "dhdSetForceAndTorqueAndGripperForce", kDhdRemedy);
  library_.take(errorGetLast, "dhdErrorGetLast", kDhdRemedy);
  library_.take(errorGetLastStr, "dhdErrorGetLastStr", kDhdRemedy);
  library_.find(isInitialized, "drdIsInitialized");
  library_.find(autoInit, "drdAutoInit");
  library_.find(stopRegulation, "drdStop");
  library_.find(getGripperAngle, "dhdGetGripperAngleRad");
  library_.find(getMaxForce, "dhdGetMaxForce");
  library_.find(getSdkVersion, "dhdGetSDKVersion");
  // A device that libdrd.so is to calibrate has to be opened by it.
  if (!canCalibrate() || !library_.find(openId, "drdOpenID") || !library_.find(close, "drdClose")) {
    library_.take(openId, "dhdOpenID", kDhdRemedy);
    library_.take(close, "dhdClose", kDhdRemedy);
    // The library that did not open a device does not know it either.
    isInitialized = nullptr;
    autoInit = nullptr;
  }
}

}  // namespace nearfit::forcedimension
