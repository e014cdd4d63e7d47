#include <QDoubleSpinBox>
#include <QMessageBox>
#include <QProgressBar>
#include <QStatusBar>
#include <QWheelEvent>
#include <algorithm>

#include <vtkCamera.h>

#include "core/files/sha256.h"
#include "core/scene/scene_file.h"
#include "tests/app/desktop/dialog_answers.h"
#include "tests/app/desktop/file_drop.h"
#include "tests/support/mesh_files.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

namespace fs = std::filesystem;

namespace {

/// How the progress dialog is told to stop.
enum class Stop { Button, Escape };

void stopLoading(Stop stop, int& stopped) {
  whenModal<QDialog>(
      [stop, &stopped](QDialog* dialog) {
        ++stopped;
        auto* cancel = dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Cancel);
        stop == Stop::Button ? QTest::mouseClick(cancel, Qt::LeftButton)
                             : QTest::keyClick(dialog, Qt::Key_Escape);
      },
      QStringLiteral("progressDialog"));
}

void zoomIn(ui::Viewport& view) {
  for (int i = 0; i < 5; ++i) {
    const QPoint at = view.rect().center();
    QWheelEvent wheel(at, view.mapToGlobal(at), {}, {0, 120}, Qt::NoButton, {}, Qt::NoScrollPhase, false);
    QApplication::sendEvent(&view, &wheel);
  }
}

void pressOpen(DesktopDriver& d, const fs::path& file) {
  whenModal<QFileDialog>([file](QFileDialog* dialog) { chooseFile(dialog, nameOf(file)); });
  pressShortcut(d, Qt::Key_O, Qt::ControlModifier);
}

void discardChanges(int& asked) {
  whenModal<QMessageBox>(
      [&asked](QMessageBox* box) {
        ++asked;
        QTest::mouseClick(box->button(QMessageBox::Discard), Qt::LeftButton);
      },
      QStringLiteral("unsavedBox"));
}

/// The cubes in a scene with a file; what fails is told to `told`.
struct Pair {
  Pair() {
    d.addCubes();
    d.session().save(file);
    d.window().setFailureSink([this](const ui::Failure& failure) { told << failure.summary; });
    QObject::connect(d.window().statusBar(), &QStatusBar::messageChanged, &d.window(),
                     [this](const QString& text) { shown << text; });
  }
  /// Moves the first cube to 2.5 mm in x.
  void change() {
    d.clickPart(0, ui::PartsModel::Name);
    d.type<QDoubleSpinBox>("positionX", "2.5");
    QVERIFY(d.window().isWindowModified());
  }
  /// The status bar has shown this.
  void verifyWasSaid(const char* text) {
    QVERIFY2(shown.contains(QLatin1String(text)), qPrintable(shown.join('\n')));
  }
  void verifyIsThere(double x) {
    QVERIFY(!d.window().document().isBusy());
    QVERIFY(d.widget<QDialog>("progressDialog") == nullptr);
    QVERIFY(d.session().scene().findByName("fixed") != nullptr);
    QVERIFY(d.session().scene().findByName("moving") != nullptr);
    QCOMPARE(d.part("fixed").worldFromPart.translation.x, x);
    QCOMPARE(d.session().file(), file);
    QVERIFY(d.window().windowTitle().contains(QStringLiteral("pair.nearfit")));
  }

  QStringList told, shown;  ///< Before the window, which fills them.
  DesktopDriver d;
  const fs::path file = d.folder.path() / "pair.nearfit";
};

}  // namespace

class DesktopCancelTest : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase();
  void init() { QSettings().clear(); }
  void cancelWhileASceneOpensKeepsTheOneThatIsThere_data();
  void cancelWhileASceneOpensKeepsTheOneThatIsThere();
  void whatWasToBeDiscardedStaysWhenTheOtherSceneDoesNotCome();
  void cancelWhileAMeshOpensKeepsTheSceneThatIsThere();
  void progressRisesWhileFilesLoad();
  void reloadTakesTheNewShapeAndUndoBringsTheOldOneBack();
  void reloadOfAFileThatIsGoneIsToldAndReloadsTheOthers();
  void cancelOfAReloadKeepsTheOldShape();
  void reloadByKeysWorksOnTheFirstPartsOfAScene();
  void viewStaysWhenNothingCame();
  void aSceneWhoseMeshIsAnotherOpensAndSaysSo();
  void aSceneThatComesWithABrokenMeshIsShownWhole();

 private:
  TemporaryFolder folder_;
  fs::path large_[2];  ///< A million triangles each.
  fs::path scene_;     ///< Of both.
};

void DesktopCancelTest::initTestCase() {
  large_[0] = folder_.write("large0.stl", stlBinary(uvSphereMesh(50.0, 1000, 501)));
  large_[1] = folder_.write("large1.stl", stlBinary(uvSphereMesh(60.0, 1000, 501)));
  scene_ = folder_.path() / "large.nearfit";
  Scene scene;
  for (const fs::path& file : large_) {
    // Not read: a scene's file says where its meshes are.
    PartGeometry geometry;
    geometry.file = file;
    geometry.sha256 = sha256OfFile(file);
    geometry.metresPerUnit = 1e-3;
    Part part;
    part.name = file.stem().string();
    part.geometry = std::make_shared<const PartGeometry>(std::move(geometry));
    scene.add(part);
  }
  writeSceneFile(scene, scene_);
}

void DesktopCancelTest::cancelWhileASceneOpensKeepsTheOneThatIsThere_data() {
  QTest::addColumn<int>("stop");
  QTest::newRow("button") << static_cast<int>(Stop::Button);
  QTest::newRow("escape") << static_cast<int>(Stop::Escape);
}

void DesktopCancelTest::cancelWhileASceneOpensKeepsTheOneThatIsThere() {
  QFETCH(int, stop);
  Pair p;
  int stopped = 0;
  stopLoading(static_cast<Stop>(stop), stopped);
  pressOpen(p.d, scene_);
  QVERIFY(p.d.window().document().isBusy());
  QTRY_VERIFY(!p.d.window().document().isBusy());
  QCOMPARE(stopped, 1);
  p.verifyIsThere(0.0);
  p.verifyWasSaid("Opening of large.nearfit cancelled. The open scene stays.");
  QVERIFY(!p.d.window().isWindowModified());
  // What was begun may end later than it was stopped: it does not come then either.
  p.d.add({nameOf(large_[0])});
  QTRY_VERIFY(!p.d.window().document().isBusy());
  QCOMPARE(p.d.session().scene().parts().size(), std::size_t{3});
  p.verifyIsThere(0.0);
  QVERIFY2(p.told.isEmpty(), qPrintable(p.told.join('\n')));
  // It was not stopped for being broken.
  int asked = 0;
  discardChanges(asked);
  pressOpen(p.d, scene_);
  QTRY_COMPARE(p.d.session().file(), scene_);
  QCOMPARE(p.d.session().scene().parts().size(), std::size_t{2});
  QCOMPARE(asked, 1);
}

void DesktopCancelTest::whatWasToBeDiscardedStaysWhenTheOtherSceneDoesNotCome() {
  Pair p;
  p.change();
  int asked = 0, stopped = 0;
  discardChanges(asked);
  stopLoading(Stop::Button, stopped);
  pressOpen(p.d, scene_);
  QCOMPARE(asked, 1);
  QTRY_VERIFY(!p.d.window().document().isBusy());
  QCOMPARE(stopped, 1);
  p.verifyIsThere(0.0025);
  QVERIFY(p.d.window().isWindowModified());
  QVERIFY(p.told.isEmpty());

  const fs::path broken = p.d.folder.write("broken.nearfit", "{\"nearfit\": ");
  discardChanges(asked);
  pressOpen(p.d, broken);
  QCOMPARE(asked, 2);
  QTRY_COMPARE(p.told, QStringList{QStringLiteral("The scene could not be opened.")});
  p.verifyIsThere(0.0025);
  QVERIFY(p.d.window().isWindowModified());
  pressShortcut(p.d, Qt::Key_Z, Qt::ControlModifier);
  p.verifyIsThere(0.0);
  QVERIFY(!p.d.window().isWindowModified());
}

void DesktopCancelTest::cancelWhileAMeshOpensKeepsTheSceneThatIsThere() {
  Pair p;
  p.change();
  DialogAnswers answers;
  answers.expectFile(nameOf(large_[0]))
      .expectButton(QStringLiteral("unsavedBox"), QDialogButtonBox::Discard)
      .expectButton(QStringLiteral("unitDialog"), QDialogButtonBox::Ok)
      .expectButton(QStringLiteral("progressDialog"), QDialogButtonBox::Cancel);
  pressShortcut(p.d, Qt::Key_O, Qt::ControlModifier);
  QVERIFY(p.d.window().document().isBusy());
  QTRY_VERIFY(!p.d.window().document().isBusy());
  QCOMPARE(answers.faults(), QStringList());
  p.verifyIsThere(0.0025);
  p.verifyWasSaid("Opening of large0.stl cancelled. The open scene stays.");
  QVERIFY(p.d.window().isWindowModified());
  QVERIFY2(p.told.isEmpty(), qPrintable(p.told.join('\n')));
  pressShortcut(p.d, Qt::Key_Z, Qt::ControlModifier);
  p.verifyIsThere(0.0);
}

void DesktopCancelTest::progressRisesWhileFilesLoad() {
  DesktopDriver d;
  const fs::path parts = d.folder.path() / "parts";
  fs::create_directory(parts);
  constexpr int kFiles = 8;
  for (int i = 0; i < kFiles; ++i) {
    std::ofstream out(parts / ("ball" + std::to_string(i) + ".stl"), std::ios::binary);
    out << stlBinary(uvSphereMesh(10.0 + i, 200, 201));
  }
  std::vector<int> values;
  int most = 0;
  const auto watch = [&] {
    const auto* dialog = d.widget<QDialog>("progressDialog");
    if (dialog == nullptr) return;
    const auto* bar = dialog->findChild<QProgressBar*>();
    most = bar->maximum();
    connect(bar, &QProgressBar::valueChanged, bar, [&](int value) { values.push_back(value); });
  };
  connect(&d.window().document(), &ui::Document::busyChanged, this, watch);
  whenModal<QDialog>([](QDialog* dialog) { answerUnit(dialog); }, QStringLiteral("unitDialog"));
  drop(d.window(), {nameOf(parts)});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{kFiles});
  QVERIFY(most > 0);
  QVERIFY2(values.size() >= 4, "it is told on the way");
  QVERIFY(std::ranges::is_sorted(values));
  QVERIFY(values.front() >= 0 && values.front() < values.back());
  QVERIFY(values.back() > most / 2 && values.back() <= most);
}

void DesktopCancelTest::reloadTakesTheNewShapeAndUndoBringsTheOldOneBack() {
  Pair p;
  const RigidTransform pose{{0.5, 0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}};
  p.d.session().movePart(p.d.partId("fixed"), pose);
  writeOff(p.d.fixedFile.toStdString(), boxMesh(glm::dvec3(0.05)));
  const auto isOffered = [&p] {
    const auto* notice = p.d.widget<QWidget>("notice-reload");
    return notice != nullptr && notice->isVisible();
  };
  QTRY_VERIFY(isOffered());
  p.d.choose("reloadParts");
  QVERIFY2(!isOffered(), "what is done need not be offered");
  QTRY_VERIFY(qFuzzyCompare(widthOf(p.d.part("fixed")), 0.05));
  QCOMPARE(p.d.part("fixed").worldFromPart.translation, pose.translation);
  QCOMPARE(p.d.part("fixed").worldFromPart.rotation, pose.rotation);
  QCOMPARE(widthOf(p.d.part("moving")), 0.02);
  QVERIFY(p.d.window().isWindowModified());
  QCOMPARE(p.d.action("undo")->text(), QStringLiteral("&Undo Reload fixed"));
  p.d.choose("undo");
  QCOMPARE(widthOf(p.d.part("fixed")), 0.04);
  QCOMPARE(p.d.part("fixed").worldFromPart.translation, pose.translation);
  p.d.choose("redo");
  QVERIFY(qFuzzyCompare(widthOf(p.d.part("fixed")), 0.05));
  // Nothing has changed since: that is no step to undo.
  const std::size_t steps = p.d.session().history().size();
  p.d.choose("reloadParts");
  QTRY_COMPARE(p.d.window().statusBar()->currentMessage(), QStringLiteral("No file has changed"));
  QCOMPARE(p.d.session().history().size(), steps);
  QVERIFY(p.told.isEmpty());
}

void DesktopCancelTest::reloadOfAFileThatIsGoneIsToldAndReloadsTheOthers() {
  Pair p;
  fs::remove(p.d.fixedFile.toStdString());
  writeOff(p.d.movingFile.toStdString(), boxMesh(glm::dvec3(0.03)));
  p.d.choose("reloadParts");
  QTRY_COMPARE(p.told,
               QStringList{QStringLiteral("Some parts could not be reloaded; they stay as they were.")});
  QCOMPARE(widthOf(p.d.part("fixed")), 0.04);
  QVERIFY(qFuzzyCompare(widthOf(p.d.part("moving")), 0.03));
}

void DesktopCancelTest::cancelOfAReloadKeepsTheOldShape() {
  Pair p;
  const fs::path part = p.d.folder.write("ball.stl", stlBinary(uvSphereMesh(20.0, 20, 21)));
  p.d.add({nameOf(part)});
  QTRY_COMPARE(p.d.session().scene().parts().size(), std::size_t{3});
  const std::size_t steps = p.d.session().history().size();
  const double width = widthOf(p.d.part("ball"));
  fs::copy_file(large_[0], part, fs::copy_options::overwrite_existing);
  int stopped = 0;
  stopLoading(Stop::Button, stopped);
  pressShortcut(p.d, Qt::Key_R, Qt::ControlModifier);
  QVERIFY(p.d.window().document().isBusy());
  QTRY_VERIFY(!p.d.window().document().isBusy());
  QCOMPARE(stopped, 1);
  QCOMPARE(widthOf(p.d.part("ball")), width);
  QCOMPARE(p.d.session().history().size(), steps);
  p.verifyWasSaid("Cancelled. No part was changed.");
  QVERIFY(p.told.isEmpty());
}

/// The command was asked before the first parts were there, and stayed disabled.
void DesktopCancelTest::reloadByKeysWorksOnTheFirstPartsOfAScene() {
  DesktopDriver d;
  d.addCubes();
  writeOff(d.fixedFile.toStdString(), boxMesh(glm::dvec3(0.05)));
  pressShortcut(d, Qt::Key_R, Qt::ControlModifier);
  QVERIFY(d.window().document().isBusy());
  QTRY_VERIFY(qFuzzyCompare(widthOf(d.part("fixed")), 0.05));
}

/// Whatever ended a load, the view was fitted.
void DesktopCancelTest::viewStaysWhenNothingCame() {
  Pair p;
  ui::Viewport& view = p.d.window().viewport();
  const double fitted = view.camera()->GetDistance();
  zoomIn(view);
  const double near = view.camera()->GetDistance();
  QVERIFY(near < 0.8 * fitted);
  int stopped = 0;
  stopLoading(Stop::Button, stopped);
  pressOpen(p.d, scene_);
  QTRY_VERIFY(!p.d.window().document().isBusy());
  QCOMPARE(stopped, 1);
  QCOMPARE(view.camera()->GetDistance(), near);
  pressOpen(p.d, p.d.folder.write("broken.nearfit", "{"));
  QTRY_COMPARE(p.told.size(), 1);
  QCOMPARE(view.camera()->GetDistance(), near);
}

/// A mesh that was exported again meanwhile made all of the scene out of reach.
void DesktopCancelTest::aSceneWhoseMeshIsAnotherOpensAndSaysSo() {
  Pair p;
  const fs::path file = p.d.folder.path() / "own.nearfit";
  p.d.session().save(file);
  const RigidTransform pose = p.d.part("fixed").worldFromPart;
  p.d.choose("newScene");
  writeOff(p.d.fixedFile.toStdString(), boxMesh(glm::dvec3(0.05)));
  pressOpen(p.d, file);
  QTRY_COMPARE(p.d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(p.told.isEmpty());
  QVERIFY(qFuzzyCompare(widthOf(p.d.part("fixed")), 0.05));
  QVERIFY(p.d.part("fixed").worldFromPart.translation == pose.translation);
  QTRY_VERIFY(p.d.widget<QWidget>("notice-others") != nullptr);
  const auto* text = p.d.widget<QWidget>("notice-others")->findChild<QLabel*>(QStringLiteral("noticeText"));
  QVERIFY2(text->text().startsWith(QStringLiteral("fixed.off has changed since")), qPrintable(text->text()));
  // It is not what the file says, until it is saved.
  QVERIFY(p.d.window().isWindowModified());
  pressShortcut(p.d, Qt::Key_S, Qt::ControlModifier);
  QTRY_VERIFY(!p.d.window().isWindowModified());
  QVERIFY(readSceneFile(file).parts().size() == 2);
  QTRY_VERIFY(p.d.widget<QWidget>("notice-others") == nullptr);
}

/// Only what came with it was asked, and the scene stood somewhere.
void DesktopCancelTest::aSceneThatComesWithABrokenMeshIsShownWhole() {
  Pair p;
  ui::Viewport& view = p.d.window().viewport();
  const double fitted = view.camera()->GetDistance();
  zoomIn(view);
  QVERIFY(view.camera()->GetDistance() < 0.8 * fitted);
  const fs::path broken = p.d.folder.write("broken.off", "OFF\n3 1 0\n0 0\n");
  p.d.window().document().openFiles({nameOf(p.file), nameOf(broken)});
  QTRY_COMPARE(p.told.size(), 1);
  QTRY_VERIFY(!p.d.window().document().isBusy());
  QCOMPARE(p.d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(std::abs(view.camera()->GetDistance() - fitted) < 1e-6 * fitted);
  QVERIFY(p.d.window().selection().current() == p.d.session().scene().movingPart());
}

NEARFIT_QT_SUITE(DesktopCancelTest, runDesktopTest<DesktopCancelTest>)
#include "desktop_cancel_test.moc"
