#include "device/plugins/openhaptics/hd_api.h"

namespace nearfit::openhaptics {
namespace {

constexpr const char* kHdRemedy =
    "for a Touch or PHANTOM, install 3D Systems' Touch Device Driver and OpenHaptics (libHD.so), and run "
    "Touch_Setup";

}  // namespace

HdApi::HdApi() : library_({"libHD.so", "libHD.so.3.4", "libHD.so.3"}, kHdRemedy) {
  library_.take(initDevice, "hdInitDevice", kHdRemedy);
  library_.take(disableDevice, "hdDisableDevice", kHdRemedy);
  library_.take(makeCurrentDevice, "hdMakeCurrentDevice", kHdRemedy);
  library_.take(beginFrame, "hdBeginFrame", kHdRemedy);
  library_.take(endFrame, "hdEndFrame", kHdRemedy);
  library_.take(enable, "hdEnable", kHdRemedy);
  library_.take(disable, "hdDisable", kHdRemedy);
  library_.take(getError, "hdGetError", kHdRemedy);
  library_.take(getErrorString, "hdGetErrorString", kHdRemedy);
  library_.take(getIntegerv, "hdGetIntegerv", kHdRemedy);
  library_.take(getDoublev, "hdGetDoublev", kHdRemedy);
  library_.take(getString, "hdGetString", kHdRemedy);
  library_.take(setDoublev, "hdSetDoublev", kHdRemedy);
  library_.take(checkCalibration, "hdCheckCalibration", kHdRemedy);
  library_.take(updateCalibration, "hdUpdateCalibration", kHdRemedy);
  library_.take(startScheduler, "hdStartScheduler", kHdRemedy);
  library_.take(stopScheduler, "hdStopScheduler", kHdRemedy);
  library_.take(scheduleAsynchronous, "hdScheduleAsynchronous", kHdRemedy);
  library_.take(unschedule, "hdUnschedule", kHdRemedy);
}

}  // namespace nearfit::openhaptics
