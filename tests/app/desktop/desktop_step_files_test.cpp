// STEP files in the window by the programs that read and write them: opened, felt, saved and opened again, exported, and
// what is left when the reader is killed. Those beside the repository where they are, else the tests' own.
#include <QProgressBar>
#include <QStatusBar>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "tests/app/desktop/export_driver.h"
#include "tests/app/desktop/file_drop.h"
#include "tests/support/places.h"
#include "tests/support/scoped_variable.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

const std::filesystem::path kImportTests = test::sourceFolder() / "tests/app/import";

QString ownModel(const char* name) {
  return nameOf(kImportTests / "models" / name);
}

/// A file, and the part of it that is taken in hand: nothing is above it.
struct StepFile {
  QString file, part;
};

/// The file beside the repository, or one of the tests where it is not there.
StepFile sharedOr(const char* shared, const char* part, const StepFile& own) {
  const std::filesystem::path file = test::sharedFolder() / "models/public" / shared;
  return std::filesystem::exists(file) ? StepFile{nameOf(file), QLatin1String(part)} : own;
}

/// Content of a file as another reader finds it; see make_models.py.
const nlohmann::json& instancesOf(const QString& file) {
  static const nlohmann::json oracle = [] {
    std::ifstream stream(kImportTests / "oracle.json");
    return nlohmann::json::parse(stream);
  }();
  return oracle.at(QFileInfo(file).fileName().toStdString());
}

/// The name that a label and its product give: made-up names of instances do not count.
std::string nameIn(const nlohmann::json& names) {
  const auto own = names[0].get<std::string>();
  return own.starts_with("NAUO") ? names[1].get<std::string>() : own;
}

/// True for the name, and for one with a number behind it, as a scene gives them to names that are taken.
bool isNamed(const std::string& name, const std::string& expected) {
  if (name == expected) return true;
  return name.starts_with(expected + " ") &&
         name.find_first_not_of("0123456789", expected.size() + 1) == std::string::npos;
}

/// Names of the groups around a part, the outermost first.
std::vector<std::string> groupsAround(const Scene& scene, const Part& part) {
  std::vector<std::string> names;
  for (std::optional<GroupId> at = part.group; at; at = scene.findGroup(*at)->parent)
    names.insert(names.begin(), scene.findGroup(*at)->name);
  return names;
}

Aabb boxInWorld(const Part& part) {
  Aabb box;
  for (const glm::dvec3& vertex : part.geometry->mesh.vertices())
    box.add(part.worldFromPart.applyToPoint(vertex));
  return box;
}

/// The name that a part gets: that of the file for the only part if its own says nothing, as in the models at hand.
std::string partNameOf(const std::string& name, const QString& file, bool isAlone) {
  const bool saysNothing = name == "1" || name == "Document";
  return isAlone && saysNothing ? QFileInfo(file).completeBaseName().toStdString() : name;
}

/// Parts, tree, places and surfaces of a scene against what the other reader says of its one file.
void compareWithFile(const Scene& scene, const QString& file) {
  const nlohmann::json& instances = instancesOf(file);
  std::map<std::string, std::size_t> solidsOfProduct;
  std::set<const PartGeometry*> geometries;
  std::size_t next = 0;
  for (const nlohmann::json& instance : instances) {
    const auto solids = instance["solids"].get<std::size_t>();
    solidsOfProduct[instance["product"]] = solids;
    std::vector<std::string> path;
    for (const nlohmann::json& names : instance["path"])
      path.push_back(nameIn(names));
    const std::string name = partNameOf(path.back(), file, instances.size() == 1 && solids == 1);
    // Solids of one product are in a group of its name.
    if (solids == 1) path.pop_back();
    Aabb box;
    double chord = 0.0;
    std::size_t faces = 0;
    for (std::size_t i = 0; i < solids; ++i, ++next) {
      QVERIFY(next < scene.parts().size());
      const Part& part = *scene.parts()[next];
      QVERIFY2(isNamed(part.name, name), part.name.c_str());
      QCOMPARE(groupsAround(scene, part), path);
      const Aabb own = boxInWorld(part);
      box.add(own.lower);
      box.add(own.upper);
      chord = std::max(chord, part.geometry->effectiveTessellation.chord);
      QVERIFY(part.geometry->surfaces != nullptr);
      faces += part.geometry->surfaces->faces.size();
      geometries.insert(part.geometry.get());
    }
    QCOMPARE(faces, instance["faces"].get<std::size_t>());
    // Millimetres; triangles lie off the surface by the chord.
    for (int k = 0; k < 3; ++k) {
      QVERIFY(isNear(box.lower[k], 1e-3 * instance["low"][static_cast<std::size_t>(k)].get<double>(),
                     chord + 1e-9));
      QVERIFY(isNear(box.upper[k], 1e-3 * instance["high"][static_cast<std::size_t>(k)].get<double>(),
                     chord + 1e-9));
    }
  }
  QCOMPARE(scene.parts().size(), next);
  std::size_t shapes = 0;
  for (const auto& product : solidsOfProduct)
    shapes += product.second;
  QCOMPARE(geometries.size(), shapes);
}

/// Everything of a scene that its file is to bring back. Numbers in the file read back as they were, but rotations are
/// made unit again.
void compareScenes(const Scene& before, const Scene& after) {
  QCOMPARE(after.parts().size(), before.parts().size());
  QCOMPARE(after.groups().size(), before.groups().size());
  for (std::size_t i = 0; i < before.parts().size(); ++i) {
    const Part &was = *before.parts()[i], &is = *after.parts()[i];
    QCOMPARE(is.name, was.name);
    QCOMPARE(groupsAround(after, is), groupsAround(before, was));
    QCOMPARE(is.worldFromPart.translation, was.worldFromPart.translation);
    QVERIFY(std::abs(glm::dot(is.worldFromPart.rotation, was.worldFromPart.rotation)) > 1.0 - 1e-14);
    QVERIFY(is.colour == was.colour);
    const PartGeometry &a = *was.geometry, &b = *is.geometry;
    QCOMPARE(b.shapeKey, a.shapeKey);
    QVERIFY(std::ranges::equal(b.mesh.vertices(), a.mesh.vertices()));
    QVERIFY(std::ranges::equal(b.mesh.triangles(), a.mesh.triangles()));
    QVERIFY(std::ranges::equal(b.surfaces->faces, a.surfaces->faces));
    QVERIFY(std::ranges::equal(b.surfaces->faceOfTriangle, a.surfaces->faceOfTriangle));
    QVERIFY(b.faceColours == a.faceColours);
  }
}

/// The window, its failures noted.
class StepDesk : public DesktopDriver {
 public:
  StepDesk() {
    window().setFailureSink(
        [this](const ui::Failure& failure) { told << failure.summary + ' ' + failure.details; });
    QObject::connect(&application.servo(), &desktop::ServoController::snapshotArrived, &application,
                     [this](const ServoSnapshot& snapshot) { tick = snapshot.tick; });
  }
  /// Drops the file and waits until its parts are there. A question, which nobody would answer, holds it up.
  void dropAndWait(const QString& file) {
    const std::size_t before = session().scene().parts().size();
    drop(window(), {file});
    QTRY_VERIFY(session().scene().parts().size() > before && !window().document().isBusy());
    QVERIFY(QApplication::activeModalWidget() == nullptr);
  }
  void verifyNothingIsTold() { QVERIFY2(told.isEmpty(), qPrintable(told.join('\n'))); }

  QStringList told;
  std::uint64_t tick = 0;
};

/// The cubes in the window, and an import of a large file that is held while it reads.
class HeldImport : public StepDesk {
 public:
  HeldImport() {
    addCubes();
    writeLargeFile();
    before_ = session().historyIndex();
    // It becomes the importer, under a number that is known then.
    const std::filesystem::path script =
        folder.write("importer", fmt::format("#!/bin/sh\necho $$ > '{}'\nexec '{}' \"$@\"\n",
                                             pidFile_.string(), test::builtPath("nearfit-import")));
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    const ScopedVariable chosen("NEARFIT_IMPORT", script.string());
    drop(window(), {nameOf(large_)});
    [this] { QTRY_VERIFY(isReading()); }();
    // It reads for seconds, so that it is held long before it ends.
    ::kill(process, SIGSTOP);
    [this] {
      QTRY_VERIFY(widget<QDialog>("progressDialog") != nullptr);
      QTRY_VERIFY(widget<QDialog>("progressDialog")->isVisible());
    }();
  }
  ~HeldImport() {
    if (process > 0) ::kill(process, SIGKILL);
  }
  HeldImport(const HeldImport&) = delete;
  HeldImport& operator=(const HeldImport&) = delete;

  /// The importer has left: nothing has its number, since the window waits for it.
  bool isGone() {
    // Zero is the group of this process.
    if (process > 0 && ::kill(process, 0) != 0) process = 0;
    return process == 0;
  }
  void verifySceneIsAsItWas() {
    QCOMPARE(session().scene().parts().size(), std::size_t{2});
    QVERIFY(session().scene().groups().empty());
    QCOMPARE(session().historyIndex(), before_);
    QVERIFY(session().scene().movingPart() == partId("moving"));
    QVERIFY(QApplication::activeModalWidget() == nullptr);
  }

  ::pid_t process = 0;

 private:
  /// The bracket, with a million points besides that nothing refers to: some 50 MB.
  void writeLargeFile() {
    std::string text = readBytes(kImportTests / "models" / "bracket.step");
    std::string points;
    for (int i = 0; i < 1'000'000; ++i)
      points += fmt::format("#{}=CARTESIAN_POINT('',({}.,0.25,0.5));\n", 1'000'000 + i, i);
    text.insert(text.find("ENDSEC;\nEND-ISO"), points);
    large_ = folder.write("large.step", text);
  }
  bool isReading() {
    std::ifstream(pidFile_) >> process;
    if (process <= 0) return false;
    std::error_code error;
    const auto program = std::filesystem::read_symlink(fmt::format("/proc/{}/exe", process), error);
    return !error && program.filename() == "nearfit-import";
  }

  std::filesystem::path pidFile_ = folder.path() / "pid", large_;
  std::size_t before_ = 0;
};

}  // namespace

class DesktopStepFilesTest : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    qputenv("NEARFIT_IMPORT", QByteArray::fromStdString(test::builtPath("nearfit-import")));
    qputenv("NEARFIT_EXPORT", QByteArray::fromStdString(test::builtPath("nearfit-export")));
  }
  void init() { QSettings().clear(); }
  void anAssemblyIsFeltSavedAndOpenedAgainAsItIs_data();
  void anAssemblyIsFeltSavedAndOpenedAgainAsItIs();
  void aKilledImporterLeavesAMessageAndTheSceneAsItWas();
  void anImporterThatHangsEndsAtOnceWithCancel();
  void aStepFileHasTheChosenSchema();
};

void DesktopStepFilesTest::anAssemblyIsFeltSavedAndOpenedAgainAsItIs_data() {
  QTest::addColumn<QString>("file");
  QTest::addColumn<QString>("inHand");
  const StepFile assembly{ownModel("assembly_ap242.step"), QStringLiteral("bolt right 2")};
  const StepFile solids{ownModel("two_solids.step"), QStringLiteral("pair 2")};
  const StepFile box = sharedOr("trimesh_box_assembly.STEP", "box_top",
                                {ownModel("assembly_inch.step"), QStringLiteral("bolt right 2")});
  const StepFile vise =
      sharedOr("steptools_vise.stp", "steptools_vise", {ownModel("bracket.step"), QStringLiteral("bracket")});
  for (const auto& [name, step] : {std::pair("assembly", assembly), std::pair("solids", solids),
                                   std::pair("box", box), std::pair("vise", vise)})
    QTest::newRow(name) << step.file << step.part;
}

void DesktopStepFilesTest::anAssemblyIsFeltSavedAndOpenedAgainAsItIs() {
  QFETCH(QString, file);
  QFETCH(QString, inHand);
  const QString picture = QStringLiteral("step-") + QLatin1String(QTest::currentDataTag());
  StepDesk d;
  d.dropAndWait(file);
  compareWithFile(d.session().scene(), file);
  QCOMPARE(d.session().historyIndex(), std::size_t{1});
  d.choose("fit");
  keepPictures(d.window(), picture);

  const Part* part = d.session().scene().findByName(inHand.toStdString());
  QVERIFY(part != nullptr);
  const PartId id = part->id;
  // Lifted off what it stands on; a part alone is felt against another file's, well above that.
  RigidTransform pose = part->worldFromPart;
  const bool isAlone = d.session().scene().parts().size() == 1;
  if (isAlone) d.dropAndWait(ownModel("bracket.step"));
  pose.translation.z += isAlone ? 1.0 : 5e-3;
  d.session().movePart(id, pose);
  d.window().selection().select(id);
  pressShortcut(d, Qt::Key_H, Qt::ControlModifier);
  QVERIFY(d.session().scene().movingPart() == id);
  d.startWith(ui::Hand::Manual);
  pose.translation.z += 2e-3;
  d.application.servo().moveHand(pose);
  QTRY_VERIFY(d.felt && isNear(d.felt->translation.z, pose.translation.z, 1e-9));
  const std::uint64_t then = d.tick;
  QTRY_VERIFY(d.tick > then + 100);
  keepPictures(d.window(), picture + QStringLiteral("-felt"));
  d.choose("stop");
  QTRY_VERIFY(!d.application.servo().status().isTaken());
  QVERIFY(isNear(d.session().scene().get(id).worldFromPart.translation.z, pose.translation.z, 1e-9));

  const std::filesystem::path saved = d.folder.path() / "fit.nearfit";
  d.session().save(saved);
  const Scene before = d.session().scene();
  d.session().reset();
  d.dropAndWait(nameOf(saved));
  compareScenes(before, d.session().scene());
  QVERIFY(!d.session().isModified());
  d.verifyNothingIsTold();
}

void DesktopStepFilesTest::aKilledImporterLeavesAMessageAndTheSceneAsItWas() {
  HeldImport d;
  d.verifyNothingIsTold();
  keepPictures(d.window(), QStringLiteral("step-reading"));
  ::kill(d.process, SIGKILL);
  QTRY_COMPARE(d.told.size(), 1);
  QVERIFY2(d.told[0].contains(QStringLiteral("large.step")) && d.told[0].contains(QStringLiteral("killed")),
           qPrintable(d.told[0]));
  QTRY_VERIFY(!d.window().document().isBusy());
  QVERIFY(d.isGone());
  d.verifySceneIsAsItWas();
  // The next file comes as ever.
  drop(d.window(), {ownModel("bracket.step")});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QCOMPARE(d.told.size(), 1);
}

void DesktopStepFilesTest::anImporterThatHangsEndsAtOnceWithCancel() {
  HeldImport d;
  auto* dialog = d.widget<QDialog>("progressDialog");
  QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Cancel), Qt::LeftButton);
  QTRY_VERIFY(!d.window().document().isBusy());
  QTRY_VERIFY(d.isGone());
  d.verifyNothingIsTold();
  d.verifySceneIsAsItWas();
}

void DesktopStepFilesTest::aStepFileHasTheChosenSchema() {
  constexpr int kStlRow = 2, kStepRow = 10;
  StepDesk d;
  d.addCubes();
  const std::filesystem::path file = d.folder.path() / "fit.step";
  bool isOfferedForMeshes = true;
  // Left alone the second time: what was chosen is proposed again.
  for (const bool isChosen : {true, false}) {
    whenModal<ui::ExportDialog>([&, isChosen](ui::ExportDialog* dialog) {
      const auto choose = [dialog](const char* box, int row) {
        auto* field = dialog->findChild<QComboBox*>(QLatin1String(box));
        field->setFocus();
        QTest::keyClick(field, Qt::Key_Home);
        for (int i = 0; i < row; ++i)
          QTest::keyClick(field, Qt::Key_Down);
        return field->isEnabled();
      };
      choose("exportKind", kStlRow);
      isOfferedForMeshes = dialog->findChild<QComboBox*>(QStringLiteral("exportSchema"))->isEnabled();
      choose("exportKind", kStepRow);
      if (isChosen) choose("exportSchema", 1);
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save),
                        Qt::LeftButton);
    });
    whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, nameOf(file)); });
    pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
    QTRY_COMPARE(d.window().statusBar()->currentMessage(), QStringLiteral("Exported fit.step"));
    QVERIFY(!isOfferedForMeshes);
    // The name of the schema, by ISO 10303-242; that of AP214 is AUTOMOTIVE_DESIGN.
    const std::string text = readBytes(file);
    QVERIFY(text.find("AP242_MANAGED_MODEL_BASED_3D_ENGINEERING") != text.npos);
    QVERIFY(text.find("AUTOMOTIVE_DESIGN") == text.npos);
    QVERIFY(std::filesystem::remove(file));
    d.window().statusBar()->clearMessage();
  }
  d.verifyNothingIsTold();
}

NEARFIT_QT_SUITE(DesktopStepFilesTest, runDesktopTest<DesktopStepFilesTest>)
#include "desktop_step_files_test.moc"
