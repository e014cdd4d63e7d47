#include "app/desktop/application.h"

#include <QApplication>
#include <QDir>
#include <QFileInfo>
#include <QOpenGLContext>
#include <QSettings>
#include <QTimer>
#include <QtGlobal>
#include <exception>
#include <filesystem>
#include <vector>

#include "core/base/error.h"
#include "core/session/session_script.h"
#include "ui/files/document.h"
#include "ui/model/hand_state.h"
#include "ui/panels/feel/feel_control.h"
#include "ui/panels/plots/plot_panel.h"
#include "ui/panels/replay/record_action.h"
#include "ui/panels/suggest/path_suggestion.h"
#include "ui/tools/placing/hand_control.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/names.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::desktop {
namespace {

/// Returns the path of a file that comes with the program, named by its path below resources/
/// ("demo/piston.nearfit"): beside the installed program, or in the source tree that it was built from. Empty
/// if it is in neither. Needs the QCoreApplication.
QString resourceFile(const QString& name) {
  const QString installed = QCoreApplication::applicationDirPath() + QStringLiteral("/../share/nearfit");
  for (const QString& folder : {installed, QStringLiteral(NEARFIT_RESOURCE_DIR)}) {
    const QString file = QDir::cleanPath(QDir(folder).filePath(name));
    if (QFileInfo(file).isFile()) return file;
  }
  return {};
}

}  // namespace

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
  window_.setGuide(resourceFile(QStringLiteral("docs/guide.md")));
  window_.setAboutText(
      tr("<h3>Nearfit %1</h3><p>Virtual prototyping by touch: feel one part against the others "
         "before any of them exists.</p><p>Method: Johnson and Willemsen, <i>Six degree-of-freedom "
         "haptic rendering of complex polygonal models</i>, 2003.</p><p>GNU General Public License, "
         "version 3 or later.</p>")
          .arg(QCoreApplication::applicationVersion()));
}

Application::~Application() = default;

void Application::show(const QStringList& files, bool isDemo, std::optional<double> metresPerUnit,
                       const std::optional<Tessellation>& tessellation) {
  window_.show();
  const bool isFirst = ui::Preferences::takeFirstRun();
  QTimer::singleShot(0, this, [=, this] {
    if (!files.isEmpty()) return window_.document().openFiles(files, metresPerUnit, tessellation);
    // A question about lost work comes first.
    if (isFirst && QApplication::activeModalWidget() == nullptr) return window_.beginTour();
    if (isDemo) window_.openDemo();
  });
}

void Application::replayScript(const QString& file) {
  window_.show();
  QTimer::singleShot(0, this, [this, file] {
    try {
      const SessionScript script = readScript(ui::toPath(file));
      std::vector<std::filesystem::path> changed;
      // It is in no file as it is: saving must not replace the scene that the script starts from.
      if (script.scene) session_.restore(startOf(script, {}, &changed), {});
      QStringList meshes;
      for (const std::filesystem::path& mesh : changed)
        meshes << ui::fromPath(mesh);
      if (!meshes.isEmpty()) emit window_.document().meshesHaveChanged(meshes);
      replay(script, session_);
      window_.showNote(tr("Replayed %1").arg(ui::shortName(QFileInfo(file).fileName())));
    } catch (const std::exception&) {
      window_.showFailure(ui::describe(tr("The script could not be replayed."), std::current_exception()));
    }
  });
}

void Application::wire() {
  wireRequests();
  wireReports();
}

void Application::wireRequests() {
  using ui::FeelControl;
  const FeelControl& feel = window_.feel();
  connect(&feel, &FeelControl::servoStartRequested, &servo_, &ServoController::start);
  connect(&feel, &FeelControl::servoStopRequested, &servo_, &ServoController::stop);
  connect(&feel, &FeelControl::armRequested, &servo_, &ServoController::setArmed);
  connect(&feel, &FeelControl::calibrateRequested, &servo_, &ServoController::calibrate);
  connect(&feel, &FeelControl::resetRequested, &servo_, &ServoController::reset);
  connect(&feel, &FeelControl::clutchRequested, &servo_, &ServoController::setClutched);
  connect(&feel, &FeelControl::hierarchiesReady, &servo_, &ServoController::followSession);
  servo_.setRate(ui::Preferences::rate());
  connect(&feel, &FeelControl::rateChanged, &servo_, &ServoController::setRate);
  connect(&window_.handControl(), &ui::HandControl::handMoved, &servo_, &ServoController::moveHand);
  connect(&window_.document(), &ui::Document::sceneNeeded, &servo_, &ServoController::commitPose);
  connect(&window_.suggestion(), &ui::PathSuggestion::guidanceChanged, &servo_,
          &ServoController::setGuidance);
  connect(&window_.recording(), &ui::RecordAction::recordRequested, &servo_, &ServoController::recordTo);
}

void Application::wireReports() {
  connect(&watcher_, &DeviceWatcher::devicesChanged, &window_.feel(), &ui::FeelControl::showDevices);
  connect(&servo_, &ServoController::statusChanged, &watcher_, [this](const ui::ServoStatus& status) {
    if (!status.deviceId.isEmpty()) watcher_.setInHand(status.deviceId);
  });
  connect(&servo_, &ServoController::deviceReleased, &watcher_, &DeviceWatcher::letGo);
  connect(&servo_, &ServoController::statusChanged, &window_.hand(), &ui::HandState::showStatus);
  connect(&servo_, &ServoController::snapshotArrived, &window_.hand(), &ui::HandState::showSnapshot);
  connect(&servo_, &ServoController::handReturned, &window_.hand(), &ui::HandState::setHandPose);
  connect(&servo_, &ServoController::hierarchiesNeeded, &window_.feel(),
          &ui::FeelControl::prepareHierarchies);
  connect(&servo_, &ServoController::failed, &window_, &ui::MainWindow::showFailure);
  using ui::RecordAction;
  const ServoRows& rows = servo_.rows();
  connect(&rows, &ServoRows::ticked, &window_.plots(), &ui::PlotPanel::add);
  connect(&rows, &ServoRows::recordingChanged, &window_.recording(), &RecordAction::showRecording);
  connect(&rows, &ServoRows::recorded, &window_.recording(), &RecordAction::showRecorded);
  connect(&rows, &ServoRows::failed, &window_.recording(), &RecordAction::showFailed);
}

void requireDisplay() {
  if (!qEnvironmentVariableIsEmpty("DISPLAY") || !qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY") ||
      !qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) {
    return;
  }
  throw Error("", "there is no display", "set DISPLAY, or use nearfit-cli, which needs none");
}

void requireOpenGl() {
  QOpenGLContext context;
  const bool isUsable = context.create() && context.format().version() >= qMakePair(3, 2);
  if (!isUsable) {
    throw Error("", "this display does not support OpenGL 3.2",
                "install a graphics driver, or Mesa's software one (libgl1-mesa-dri)");
  }
}

}  // namespace nearfit::desktop
