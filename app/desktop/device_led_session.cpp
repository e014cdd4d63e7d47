#include "app/desktop/device_led_session.h"

#include <QCoreApplication>
#include <QTimer>
#include <cstdio>
#include <utility>

#include "app/desktop/hands.h"
#include "core/base/error.h"
#include "ui/files/document.h"
#include "ui/panels/feel/feel_control.h"

namespace nearfit::desktop {
namespace {

void printTimes(const char* name, const LatencyHistogram& times) {
  if (times.count() == 0) return;
  constexpr double kMicro = 1e6;
  std::printf("%-12sp50 %.1f, p99 %.1f, p99.9 %.1f, max %.1f us\n", name, kMicro * times.percentile(0.5),
              kMicro * times.percentile(0.99), kMicro * times.percentile(0.999), kMicro * times.max());
}

}  // namespace

DeviceLedSession::DeviceLedSession(Application& application, LedOptions options)
    : application_(application), options_(std::move(options)) {
  if (options_.seconds) {
    application_.window().setFailureSink(
        [this](const ui::Failure& failure) { fail(failure.summary + QChar('\n') + failure.details); });
  }
  connect(&application_.window().document(), &ui::Document::loaded, this, &DeviceLedSession::take);
  connect(&application_.servo(), &ServoController::statusChanged, this, &DeviceLedSession::follow);
}

void DeviceLedSession::begin(const QStringList& files, std::optional<double> metresPerUnit,
                             const std::optional<Tessellation>& tessellation) {
  application_.window().show();
  QTimer::singleShot(
      0, this, [=, this] { application_.window().document().openFiles(files, metresPerUnit, tessellation); });
}

void DeviceLedSession::take(bool isComplete) {
  disconnect(&application_.window().document(), &ui::Document::loaded, this, nullptr);
  if (!isComplete) return fail(tr("the files could not be opened"));
  if (!application_.session().scene().movingPart())
    return fail(tr("no part of the scene is in hand; take one in hand and save the scene"));
  try {
    const bool isRecording = recordingOf(options_.device).has_value();
    application_.window().feel().feelWith(isRecording ? options_.device
                                                      : application_.devices().find(options_.device));
  } catch (...) {
    application_.window().showFailure(
        ui::describe(tr("The part could not be taken in hand."), std::current_exception()));
  }
}

void DeviceLedSession::follow(const ui::ServoStatus& status) {
  if (status.isRunning && !std::exchange(hasBegun_, true) && options_.seconds)
    QTimer::singleShot(static_cast<int>(1e3 * *options_.seconds), this, &DeviceLedSession::finish);
  const bool isReady = status.isRunning && status.isArmable && !status.isArmed && !status.isUncalibrated &&
                       !status.isFaulted && !status.isBusy;
  if (options_.isArming && isReady && !std::exchange(hasArmed_, true)) application_.servo().setArmed(true);
  // The servo ended by itself: a recording is over. Failures are reported elsewhere.
  if (hasBegun_ && !status.isTaken() && options_.seconds)
    QTimer::singleShot(0, this, &DeviceLedSession::finish);
}

void DeviceLedSession::finish() {
  if (hasEnded_) return;
  const ui::ServoStatus status = application_.servo().status();
  application_.servo().stop();
  // Stopping may have failed and said so, for a recording for example.
  if (hasEnded_) return;
  // The device's state tells if all was well to the end.
  if (status.isFaulted) return fail(status.deviceState);
  hasEnded_ = true;
  const ServoStatistics statistics = application_.servo().statistics();
  std::printf("%-12s%llu\n", "ticks", static_cast<unsigned long long>(statistics.ticks));
  std::printf("%-12s%s\n", "armed", hasArmed_ ? "yes" : "no");
  printTimes("round trip", statistics.roundTrip);
  printTimes("tick", statistics.tickTime);
  std::fflush(stdout);
  QCoreApplication::exit(0);
}

void DeviceLedSession::fail(const QString& message) {
  if (std::exchange(hasEnded_, true)) return;
  std::fprintf(stderr, "nearfit: %s\n", message.simplified().toLocal8Bit().constData());
  if (options_.seconds) QCoreApplication::exit(1);
}

}  // namespace nearfit::desktop
