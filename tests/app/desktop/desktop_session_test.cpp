// A day's work from end to end: real parts are opened and placed by gizmo, by numbers and by a device,
// against contact; the process is killed; another one recovers what was not saved and exports it.
//
// The one that works is this program again, under nearfit-emulate, which plugs an emulated OpenHap device
// into it.
#include <QComboBox>
#include <QProcess>
#include <QStatusBar>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <signal.h>

#include "app/desktop/device_source.h"
#include "tests/app/desktop/export_driver.h"
#include "tests/app/desktop/recovery_driver.h"
#include "tests/app/desktop/view_driver.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/places.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace fs = std::filesystem;

namespace {

/// A round peg in its hole and a square one, the key, in its slot, all on the z axis; files in metres.
struct WorkPlace {
  WorkPlace() {
    const fs::path models = test::sharedFolder() / "models/public/peghole";
    const std::pair<const char*, const char*> real[] = {
        {"hole.obj", "factory_round_hole_16mm_subdiv_3x.obj"},
        {"peg.obj", "factory_round_peg_16mm_loose.obj"},
        {"slot.obj", "factory_rectangular_hole_12mm_subdiv_3x.obj"},
        {"key.obj", "factory_rectangular_peg_12mm_loose_subdiv_3x.obj"}};
    const bool isThere = fs::is_directory(models);
    if (!isThere) writeLike();
    for (const auto& [name, model] : real) {
      if (isThere) fs::copy_file(models / model, folder.path() / name);
    }
  }
  /// Where there are no models: of the same sizes.
  void writeLike() const {
    const auto write = [&](const char* name, const TriangleMesh& mesh, double up) {
      // writeOff has millimetres.
      writeOff(folder.path() / name, transformed(mesh, 1e-3, {{1, 0, 0, 0}, {0.0, 0.0, up * 1e-3}}));
    };
    write("hole.off", tubeMesh(0.00825, 0.0125, 0.009, 24), 0.0045);
    write("peg.off", cylinderMesh(0.008, 0.05, 24), 0.025);
    write("slot.off", tubeMesh(0.00825, 0.0125, 0.009, 4), 0.0045);
    write("key.off", cylinderMesh(0.008, 0.05, 4), 0.025);
  }
  QStringList files() const {
    QStringList all;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path())) {
      const std::string kind = entry.path().extension().string();
      if (kind == ".obj" || kind == ".off") all << QString::fromStdString(entry.path().string());
    }
    all.sort();
    return all;
  }

  TemporaryFolder folder;
};

/// Ends the process that works: its test tells then where it came to.
void require(bool isTrue, const char* what) {
  if (isTrue) return;
  std::fprintf(stderr, "the one that works came no farther: %s\n", what);
  std::exit(3);
}
#define REQUIRE(condition) require((condition), #condition)
#define REQUIRE_SOON(condition) \
  require(QTest::qWaitFor([&] { return (condition); }, kQtPatienceMs), #condition)

/// Works on the scene by the window's own widgets.
class Worker {
 public:
  explicit Worker(fs::path folder) : folder_(std::move(folder)) {
    d_.window().setFailureSink([](const ui::Failure& failure) {
      // Where a part rests in contact a device that was not armed is told of nothing.
      require(false, qPrintable(failure.summary + QChar(' ') + failure.details));
    });
    d_.window().protectWork(state());
  }

  void openParts(const QStringList& files);
  void setApart();
  void pressPegOntoHoleByGizmo();
  void putPegIntoHoleByNumbers();
  void undoAndRedo();
  void leadPegByDevice();
  void save();
  void changeSomethingMore();
  void waitUntilItIsKept() {
    const std::string expected = poses(d_.session().scene());
    REQUIRE(isJournalKept(state(), expected));
    std::ofstream(folder_ / "expected") << expected;
  }

 private:
  fs::path state() const { return folder_ / "state"; }
  RigidTransform pose(const char* name) { return d_.part(name).worldFromPart; }
  void select(const char* name) {
    const auto& parts = d_.session().scene().parts();
    for (std::size_t row = 0; row < parts.size(); ++row) {
      if (parts[row]->name == name) d_.clickPart(static_cast<int>(row), ui::PartsModel::Name);
    }
    REQUIRE(d_.window().selection().current() == d_.partId(name));
  }
  /// Types into a field of the pose and waits for the one step that it is.
  void type(const char* field, const char* text) {
    const std::size_t steps = d_.session().historyIndex();
    d_.type<ui::NumberField>(field, text);
    REQUIRE_SOON(d_.session().historyIndex() == steps + 1);
  }
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    // There is no window manager that gives the window the focus back after a dialog.
    QApplication::setActiveWindow(&d_.window());
    pressShortcut(d_, key, modifiers);
  }
  void click(const char* button) { QTest::mouseClick(d_.widget<QPushButton>(button), Qt::LeftButton); }

  const fs::path folder_;
  DesktopDriver d_{desktop::makeDeviceSource()};
  ViewDriver view_{d_};
};

void Worker::openParts(const QStringList& files) {
  QStringList quoted;
  for (const QString& file : files)
    quoted << QChar('"') + file + QChar('"');
  whenModal<QFileDialog>([&](QFileDialog* dialog) {
    whenModal<QDialog>([](QDialog* question) { answerUnit(question, "m"); }, QStringLiteral("unitDialog"));
    chooseFile(dialog, quoted.join(QChar(' ')));
  });
  d_.choose("addParts");
  REQUIRE_SOON(d_.session().scene().parts().size() == 4);
  REQUIRE_SOON(!d_.window().document().isBusy());
}

void Worker::setApart() {
  REQUIRE(!d_.action("solid")->isChecked());
  for (const char* name : {"slot", "key"}) {
    select(name);
    type("positionX", "6 cm");
  }
  select("peg");
  type("positionZ", "2 cm");
  type("positionX", "1/2 in");
  REQUIRE(qFuzzyCompare(pose("peg").translation.x, 0.0127));
}

void Worker::pressPegOntoHoleByGizmo() {
  press(Qt::Key_S, Qt::ShiftModifier);
  REQUIRE(d_.action("solid")->isChecked());
  REQUIRE_SOON(!d_.window().document().isBusy());
  view_.look("viewFront");
  REQUIRE_SOON(view_.overlay().picture().has_value());
  const QPoint from = view_.handle(GizmoGrip::MoveZ);
  const std::size_t steps = d_.session().historyIndex();
  view_.press(from);
  for (int i = 1; i <= 30; ++i)
    view_.moveTo(from + QPoint(0, 10 * i));
  REQUIRE_SOON(view_.readout().contains(QStringLiteral("hole")));
  view_.release(from + QPoint(0, 300));
  REQUIRE_SOON(d_.session().historyIndex() == steps + 1);
  // On the plate, whose top is at 9 mm.
  REQUIRE(std::abs(pose("peg").translation.z - 0.009) < 0.5e-3);
  REQUIRE(pose("peg").translation.z > 0.00899);
}

void Worker::putPegIntoHoleByNumbers() {
  type("positionX", "0");
  type("positionZ", "1/2 cm");
  REQUIRE(qFuzzyCompare(pose("peg").translation.z, 0.005));
  // As far as there is room between them.
  type("positionX", "3 mm");
  REQUIRE(pose("peg").translation.x > 0.0 && pose("peg").translation.x < 0.3e-3);
}

void Worker::undoAndRedo() {
  const std::string after = poses(d_.session().scene());
  const std::size_t here = d_.session().historyIndex();
  for (int i = 0; i < 4; ++i)
    press(Qt::Key_Z, Qt::ControlModifier);
  REQUIRE(d_.session().historyIndex() == here - 4);
  REQUIRE(qFuzzyCompare(pose("peg").translation.z, 0.02));
  for (int i = 0; i < 4; ++i)
    press(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  REQUIRE(d_.session().historyIndex() == here);
  REQUIRE(poses(d_.session().scene()) == after);
}

void Worker::leadPegByDevice() {
  select("peg");
  press(Qt::Key_H, Qt::ControlModifier);
  auto* hand = d_.widget<QComboBox>("hand");
  int wanted = -1;
  REQUIRE_SOON((wanted = hand->findText(QStringLiteral("OpenHap"), Qt::MatchContains)) >= 0);
  hand->setFocus();
  for (int keys = 0; keys < 10 && hand->currentIndex() != wanted; ++keys)
    QTest::keyClick(hand, Qt::Key_Down);
  REQUIRE(hand->currentIndex() == wanted);
  const glm::dvec3 before = pose("peg").translation;
  click("startStop");
  // The hand goes round; the hole lets the peg go up and down alone.
  REQUIRE_SOON(d_.felt && std::abs(d_.felt->translation.z - before.z) > 2e-3);
  // On a busy machine the window may hear of a pose late: the peg may be out of the hole, above it or below it. Wherever
  // it is, it meets nothing.
  const Part &peg = d_.part("peg"), &hole = d_.part("hole");
  const PoseCertifier certifier(hole.geometry->mesh, peg.geometry->mesh);
  const RigidTransform inHole = (hole.worldFromPart.inverse() * *d_.felt).normalized();
  REQUIRE(!certifier.doMeet(inHole));
  click("startStop");
  REQUIRE_SOON(!d_.application.servo().status().isTaken());
  REQUIRE(d_.session().undoText() == "Feel peg");
  const glm::dvec3 after = pose("peg").translation;
  REQUIRE(glm::distance(after, before) > 1e-4);
  press(Qt::Key_Z, Qt::ControlModifier);
  REQUIRE(pose("peg").translation == before);
  press(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  REQUIRE(pose("peg").translation == after);
}

void Worker::save() {
  const QString file = QString::fromStdString((folder_ / "work.nearfit").string());
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, file); });
  press(Qt::Key_S, Qt::ControlModifier);
  REQUIRE_SOON(!d_.window().isWindowModified());
  REQUIRE(fs::exists(folder_ / "work.nearfit"));
}

void Worker::changeSomethingMore() {
  select("key");
  type("positionZ", "+= 12.345 mm");
  REQUIRE(d_.window().isWindowModified());
}

/// The other end of the test: works, and dies without a word.
int work(int argc, char** argv) {
  desktop::Application::prepare();
  const fs::path folder = argv[2];
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, QString::fromStdString(folder.string()));
  QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  QApplication qt(argc, argv);
  desktop::Application::configure();
  QStringList files;
  for (int i = 3; i < argc; ++i)
    files << QString::fromLocal8Bit(argv[i]);
  Worker worker(folder);
  worker.openParts(files);
  worker.setApart();
  worker.pressPegOntoHoleByGizmo();
  worker.putPegIntoHoleByNumbers();
  worker.undoAndRedo();
  worker.leadPegByDevice();
  worker.save();
  worker.changeSomethingMore();
  worker.waitUntilItIsKept();
  return ::raise(SIGKILL);
}

/// What an export says of a part.
struct Exported {
  PartGeometryPtr geometry;
  RigidTransform worldFromPart;
};

std::map<std::string, Exported> readExport(const fs::path& file) {
  std::map<std::string, Exported> parts;
  const nlohmann::json placement = nlohmann::json::parse(readBytes(file));
  for (const nlohmann::json& part : placement["parts"]) {
    const auto& p = part["position"];
    const auto& q = part["quaternion"];
    Exported& each = parts[part["name"]];
    each.geometry = loadPartGeometry(part["mesh"].get<std::string>(), part["metresPerUnit"]);
    each.worldFromPart = {{q[0], q[1], q[2], q[3]}, {p[0], p[1], p[2]}};
  }
  return parts;
}

}  // namespace

class DesktopSessionTest : public QObject {
  Q_OBJECT

 private slots:
  void aDaysWorkSurvivesTheEndOfItsProcess();

 private:
  void work(const WorkPlace& place);
  void exportScene(DesktopDriver& d, const fs::path& file);
};

void DesktopSessionTest::work(const WorkPlace& place) {
  QProcess process;
  process.setProcessChannelMode(QProcess::ForwardedChannels);
  process.start(QString::fromStdString(test::builtPath("nearfit-emulate")),
                QStringList{QStringLiteral("openhap"), QStringLiteral("--"),
                            QCoreApplication::applicationFilePath(), QStringLiteral("desktop_session_test"),
                            QStringLiteral("--work"), QString::fromStdString(place.folder.path().string())} +
                    place.files());
  QVERIFY(process.waitForFinished(250'000));
  QCOMPARE(process.exitStatus(), QProcess::CrashExit);
}

void DesktopSessionTest::exportScene(DesktopDriver& d, const fs::path& file) {
  chooseExport(0, false);
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
  QApplication::setActiveWindow(&d.window());
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QTRY_VERIFY(fs::exists(file));
}

void DesktopSessionTest::aDaysWorkSurvivesTheEndOfItsProcess() {
  const WorkPlace place;
  work(place);
  QVERIFY(!QTest::currentTestFailed());
  const fs::path folder = place.folder.path();
  const std::string expected = readBytes(folder / "expected");

  DesktopDriver d;
  d.window().protectWork(folder / "state");
  ui::RecoveryDialog* dialog = dialogOf(d);
  QVERIFY(dialog != nullptr);
  QString texts;
  for (const QLabel* label : dialog->findChildren<QLabel*>())
    texts += label->text() + QChar('\n');
  // What was saved is not offered, nor counted.
  QVERIFY2(texts.contains(QStringLiteral("work.nearfit")), qPrintable(texts));
  QVERIFY2(texts.contains(QStringLiteral("1 unsaved change")), qPrintable(texts));
  QVERIFY(dialog->findChild<QPushButton*>(QStringLiteral("restore2")) == nullptr);
  clickIn(dialog, "restore1");
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  QCOMPARE(poses(d.session().scene()), expected);
  QVERIFY(d.window().isWindowModified());
  QVERIFY(poses(readSceneFile(folder / "work.nearfit")) != expected);
  QTRY_VERIFY(!d.window().document().isBusy());

  exportScene(d, folder / "placement.json");
  const std::map<std::string, Exported> parts = readExport(folder / "placement.json");
  QCOMPARE(parts.size(), std::size_t{4});
  for (const Scene::PartPtr& part : d.session().scene().parts()) {
    const Exported& exported = parts.at(part->name);
    QCOMPARE(exported.worldFromPart.translation, part->worldFromPart.translation);
    QCOMPARE(exported.worldFromPart.rotation, part->worldFromPart.rotation);
    for (const auto& [name, other] : parts) {
      if (name == part->name) continue;
      const PoseCertifier certifier(exported.geometry->mesh, other.geometry->mesh);
      QVERIFY2(!certifier.doMeet(exported.worldFromPart.inverse() * other.worldFromPart),
               qPrintable(QString::fromStdString(part->name + " meets " + name)));
    }
  }
}

NEARFIT_QT_SUITE(DesktopSessionTest, [](int argc, char** argv) {
  if (argc > 3 && QLatin1String(argv[1]) == QLatin1String("--work")) return work(argc, argv);
  return runDesktopTest<DesktopSessionTest>(argc, argv);
})
#include "desktop_session_test.moc"
