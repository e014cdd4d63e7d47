#include "app/desktop/application.h"

#include <QApplication>
#include <QSettings>
#include <QTimer>

#include "app/desktop/resource_files.h"
#include "ui/files/document.h"
#include "ui/shell/taking_away.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::desktop {

void Application::prepare() {
  ui::Viewport::setDefaultSurfaceFormat();
  QCoreApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
  QCoreApplication::setOrganizationName(QStringLiteral("Nearfit"));
  QCoreApplication::setApplicationName(QStringLiteral("nearfit"));
  QCoreApplication::setApplicationVersion(QStringLiteral(NEARFIT_VERSION));
  QSettings::setDefaultFormat(QSettings::IniFormat);
}

void Application::configure() {
  ui::applyTheme(*qApp);
}

Application::Application(std::unique_ptr<DeviceSource> devices)
    : devices_(devices ? std::move(devices) : makeDeviceSource()),
      servo_(session_, *devices_),
      watcher_(*devices_),
      window_(session_) {
  wire();
  watcher_.start();
  window_.setDemoScene(resourceFile(QStringLiteral("demo/piston.nearfit")));
  window_.setAboutText(
      tr("<h3>Nearfit %1</h3><p>Virtual prototyping by touch: feel one part against the others "
         "before any of them exists.</p><p>Method: Johnson and Willemsen, <i>Six degree-of-freedom "
         "haptic rendering of complex polygonal models</i>, 2003.</p><p>GNU General Public License, "
         "version 3 or later.</p>")
          .arg(QCoreApplication::applicationVersion()));
}

Application::~Application() = default;

void Application::show(const QStringList& files, bool isDemo) {
  window_.show();
  const bool isFirst = ui::Preferences::takeFirstRun();
  QTimer::singleShot(0, this, [=, this] {
    if (!files.isEmpty()) return window_.document().openFiles(files);
    // A question about lost work comes first.
    if (isFirst && QApplication::activeModalWidget() == nullptr) return window_.beginTour();
    if (isDemo) window_.openDemo();
  });
}

void Application::wire() {
  connect(&window_, &ui::MainWindow::servoStartRequested, &servo_, &ServoController::start);
  connect(&window_, &ui::MainWindow::armRequested, &servo_, &ServoController::setArmed);
  connect(&window_, &ui::MainWindow::calibrateRequested, &servo_, &ServoController::calibrate);
  connect(&window_, &ui::MainWindow::resetRequested, &servo_, &ServoController::reset);
  connect(&window_, &ui::MainWindow::clutchRequested, &servo_, &ServoController::setClutched);
  connect(&window_, &ui::MainWindow::servoStopRequested, &servo_, &ServoController::stop);
  connect(&window_, &ui::MainWindow::poseInHandRequested, &servo_, &ServoController::commitPose);
  servo_.setRate(ui::Preferences::rate());
  connect(&window_, &ui::MainWindow::rateChanged, &servo_, &ServoController::setRate);
  connect(&window_, &ui::MainWindow::handMoved, &servo_, &ServoController::moveHand);
  connect(&watcher_, &DeviceWatcher::devicesChanged, &window_, &ui::MainWindow::showDevices);
  connect(&servo_, &ServoController::statusChanged, &watcher_, [this](const ui::ServoStatus& status) {
    if (!status.deviceId.isEmpty()) watcher_.setInHand(status.deviceId);
  });
  connect(&servo_, &ServoController::deviceReleased, &watcher_, &DeviceWatcher::letGo);
  connect(&servo_, &ServoController::statusChanged, &window_, &ui::MainWindow::showServoStatus);
  connect(&servo_, &ServoController::snapshotArrived, &window_, &ui::MainWindow::showSnapshot);
  connect(&servo_, &ServoController::hierarchiesNeeded, &window_, &ui::MainWindow::prepareHierarchies);
  connect(&window_, &ui::MainWindow::hierarchiesReady, &servo_, &ServoController::followSession);
  connect(&servo_, &ServoController::failed, &window_, &ui::MainWindow::showFailure);
  ui::TakingAway& takingAway = window_.takingAway();
  connect(&takingAway, &ui::TakingAway::recordRequested, &servo_, &ServoController::recordTo);
  connect(&servo_.rows(), &ServoRows::ticked, &takingAway, &ui::TakingAway::showTicks);
  connect(&servo_.rows(), &ServoRows::recordingChanged, &takingAway, &ui::TakingAway::showRecording);
  connect(&servo_.rows(), &ServoRows::recorded, &takingAway, &ui::TakingAway::showRecorded);
  connect(&servo_.rows(), &ServoRows::failed, &takingAway, &ui::TakingAway::showRecordingFailed);
}

}  // namespace nearfit::desktop
