#include "app/cli/ticked_device.h"

#include "app/cli/interrupt.h"

namespace nearfit::cli {
namespace {

/// Silent periods after which a device with a report rate is answered anyway, since some
/// devices wait for that.
constexpr double kReportPatience = 2.0;

}  // namespace

void ReportMeter::see(std::uint64_t poses, Nanoseconds arrived) noexcept {
  if (poses == poses_) return;
  if (lastArrived_ != 0 && arrived > lastArrived_ && arrived - lastArrived_ < kPause)
    intervals_.record(toSeconds(arrived - lastArrived_));
  poses_ = poses;
  lastArrived_ = arrived;
}

double ReportMeter::takeRate(Nanoseconds now) noexcept {
  const double seconds = taken_ == 0 ? 0.0 : toSeconds(now - taken_);
  const double rate = seconds > 0.0 ? static_cast<double>(poses_ - posesTaken_) / seconds : 0.0;
  taken_ = now;
  posesTaken_ = poses_;
  return rate;
}

TickedDevice::TickedDevice(HapticDevice& device, bool isCalibrating) : device_(device) {
  device_.start({}, [](double) { return !InterruptGuard::isInterrupted(); });
  try {
    if (isCalibrating) device_.calibrate();
  } catch (...) {
    device_.stop();
    throw;
  }
  // Its pace is known only now that it is open.
  const double period = device_.info().reportPeriod;
  if (period > 0.0) patience_ = static_cast<Nanoseconds>(kReportPatience * period * 1e9);
  requestRealtimeScheduling(grant_);
  meter_.takeRate(monotonicNow());
}

TickedDevice::~TickedDevice() {
  device_.sendWrench({});
  device_.disarm();
  device_.stop();
}

bool TickedDevice::tick(const Wrench& wrench) noexcept {
  const bool hasReport = device_.waitForHandle(monotonicNow() + patience_);
  if (!device_.readHandle(handle_)) return false;
  const Nanoseconds age = hasReport ? static_cast<Nanoseconds>(handle_.age * 1e9) : 0;
  meter_.see(device_.counters().poses, monotonicNow() - age);
  device_.sendWrench(wrench);
  return true;
}

}  // namespace nearfit::cli
