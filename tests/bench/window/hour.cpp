#include "tests/bench/window/hour.h"

#include <QObject>
#include <algorithm>
#include <cstdint>
#include <fstream>

#include <unistd.h>

#include "core/base/error.h"
#include "tests/bench/window/bench_window.h"
#include "ui/files/document.h"

namespace nearfit::bench {
namespace {

constexpr double kMsOfMinute = 60'000.0;

/// Without giving back to the system what is free: a user's program does not either.
std::uint64_t residentAsItIs() {
  std::uint64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void openDemo(BenchWindow& window) {
  ui::MainWindow& shell = window.application().window();
  if (!shell.openDemo()) {
    throw Error("demo", "it cannot be opened",
                "start the program where it was built, beside the sources, or installed");
  }
  waitUntil("the demo", [&] {
    return !shell.document().isBusy() && window.application().session().scene().movingPart().has_value();
  });
  window.settle();
}

/// Snapshots that the window was shown.
struct ShownSnapshots {
  std::uint64_t all = 0, inContact = 0;

  double share() const { return all == 0 ? 0.0 : static_cast<double>(inContact) / static_cast<double>(all); }
};

}  // namespace

void keepWindowOpen(const HourOptions& options, const std::function<void(const HourRow&)>& tell) {
  ShownSnapshots shown;  // Outlives the servo that tells of them.
  BenchWindow window;
  openDemo(window);
  desktop::ServoController& servo = window.application().servo();
  QObject::connect(&servo, &desktop::ServoController::snapshotArrived, &servo,
                   [&shown](const ServoSnapshot& s) {
                     ++shown.all;
                     shown.inContact += s.contactCount > 0 ? 1U : 0U;
                   });
  window.startServo();
  ServoStatistics before;
  int picturesBefore = window.view().pictureCount();
  bool isTouching = false;
  const double start = milliseconds(), end = start + static_cast<double>(options.time.count());
  // Stretches end where the clock says, so that what a row costs does not add up.
  for (double next = start; next < end;) {
    next = std::min(end, next + static_cast<double>(options.every.count()));
    BenchWindow::run(std::chrono::milliseconds(static_cast<int>(std::max(1.0, next - milliseconds()))));
    const ServoStatistics now = servo.statistics();
    tell({(milliseconds() - start) / kMsOfMinute, residentAsItIs(), now.ticks - before.ticks,
          now.overruns - before.overruns, now.lateness.since(before.lateness),
          now.tickTime.since(before.tickTime), shown.share(), window.view().pictureCount() - picturesBefore});
    isTouching = isTouching || shown.inContact > 0;
    before = now;
    picturesBefore = window.view().pictureCount();
    shown = {};
  }
  window.stopServo();
  if (!isTouching) throw Error("hour", "the scripted hand touched nothing", "run it for longer than a sweep");
}

}  // namespace nearfit::bench
