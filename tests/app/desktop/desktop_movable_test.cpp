#include <QSlider>
#include <QStatusBar>
#include <QToolButton>

#include "core/servo/motion_recording.h"
#include "tests/app/desktop/view_driver.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The application with two cubes, the one in hand selected.
struct Bench : DesktopDriver {
  Bench() {
    window().setFailureSink([this](const ui::Failure& failure) { failures << failure.summary; });
    addCubes();
    clickPart(1, ui::PartsModel::Name);
  }
  ui::NumberField* field(const char* name) { return widget<ui::NumberField>(name); }
  bool isNoted(const char* text) {
    return window().statusBar()->currentMessage().contains(QLatin1String(text));
  }
  std::size_t steps() { return session().historyIndex(); }
  double x(const char* name) { return part(name).worldFromPart.translation.x; }

  QStringList failures;
};

/// In which the part goes 20 mm along x in two seconds.
QString writeRecording(const std::filesystem::path& file) {
  constexpr int kRows = 201;
  MotionWriter writer(file);
  for (int i = 0; i < kRows; ++i) {
    MotionRow row;
    row.time = 1e-2 * i;
    row.proxy.translation.x = row.handle.translation.x = 0.02 * i / (kRows - 1);
    writer.write(row);
  }
  writer.finish();
  return QString::fromStdString(file.string());
}

}  // namespace

class DesktopMovableTest : public QObject {
  Q_OBJECT

 private slots:
  void whatARecordingShowsIsMovedByNoTool();
  void whatCouldNotBeReadMakesRoomWhenThePartIsMovedOtherwise();
  void severalShowTheirMassTogetherAndADensityThatTheyShare();
  void aSelectedGroupIsNamedByItsName();
  void withALockedPartAmongThemTheFieldsSayWhyTheyAreDisabled();
  void whatHasBeenDroppedOrPushedIsNoStepTheSecondTime();
  void aPushNamesWhatBarsTheWayFirst();
};

// They moved the hidden pose of the scene, while the part on the screen stayed where the recording had it.
void DesktopMovableTest::whatARecordingShowsIsMovedByNoTool() {
  Bench d;
  ViewDriver view(d);
  view.look("viewFront");
  QTRY_VERIFY(view.overlay().picture().has_value());
  const QPoint arrow = view.handle(GizmoGrip::MoveX);
  const QString file = writeRecording(d.folder.path() / "felt.csv");
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, file); });
  d.choose("openRecording");
  QTRY_COMPARE(d.text("timelineName"), QStringLiteral("felt.csv"));
  const std::size_t before = d.steps();

  QVERIFY(!view.overlay().picture().has_value());
  view.drag(arrow, {40, 0});
  for (const char* name : {"positionX", "rotationZ"}) {
    QVERIFY(!d.field(name)->isEnabled());
    QVERIFY2(d.field(name)->toolTip().contains(QStringLiteral("close the recording")), name);
  }
  for (const char* name : {"dropDown", "pushDown"})
    QVERIFY2(!d.action(name)->isEnabled(), name);
  d.window().viewport().setFocus();
  pressInView(d, Qt::Key_Right);
  QVERIFY(d.isNoted("close the recording"));
  QCOMPARE(d.steps(), before);
  QCOMPARE(d.x("moving"), 0.0);

  // The numbers are those of what is seen.
  auto* scale = d.widget<QSlider>("timelineScale");
  QTRY_VERIFY(scale->width() > 50);
  QTest::mouseClick(scale, Qt::LeftButton, {}, {scale->width() - 3, scale->height() / 2});
  QTRY_VERIFY(std::abs(d.field("positionX")->quantity() - 0.02) < 1e-3);
  // Another part is nobody's.
  d.clickPart(0, ui::PartsModel::Name);
  QVERIFY(d.field("positionX")->isEnabled());
  d.clickPart(1, ui::PartsModel::Name);
  QVERIFY(!d.field("positionX")->isEnabled());

  QTest::mouseClick(d.widget<QToolButton>("timelineClose"), Qt::LeftButton);
  QVERIFY(d.field("positionX")->isEnabled());
  QVERIFY(d.field("positionX")->toolTip().isEmpty());
  QCOMPARE(d.field("positionX")->quantity(), 0.0);
  QTRY_VERIFY(view.overlay().picture().has_value());
  d.type<ui::NumberField>("positionX", "3");
  QCOMPARE(d.x("moving"), 0.003);
  QVERIFY(d.failures.isEmpty());
}

// It stayed, red, and hid the part's true number.
void DesktopMovableTest::whatCouldNotBeReadMakesRoomWhenThePartIsMovedOtherwise() {
  Bench d;
  // Else no focus is lost.
  QApplication::setActiveWindow(&d.window());
  d.type<ui::NumberField>("positionY", "5 kg");
  QVERIFY(d.field("positionY")->isFaulty());
  d.field("positionX")->setFocus();
  QVERIFY(d.isNoted("was taken back"));
  d.type<ui::NumberField>("positionX", "3");
  QCOMPARE(d.x("moving"), 0.003);
  QVERIFY(!d.field("positionY")->isFaulty());
  QCOMPARE(d.field("positionY")->text(), QStringLiteral("0.0000 mm"));
  d.type<ui::NumberField>("positionZ", "5 kg");
  QVERIFY(d.field("positionZ")->isFaulty());
  d.choose("dropDown");
  QTRY_VERIFY(d.part("moving").worldFromPart.translation.z < 0.0);
  QVERIFY(!d.field("positionZ")->isFaulty());
  QVERIFY(std::abs(d.field("positionZ")->quantity() + 0.005) < 2e-6);
}

void DesktopMovableTest::severalShowTheirMassTogetherAndADensityThatTheyShare() {
  Bench d;
  QCOMPARE(d.text("mass"), QStringLiteral("8.00 g"));
  QTest::mouseClick(d.partsView()->viewport(), Qt::LeftButton, Qt::ControlModifier,
                    d.partsView()->visualRect(d.partsView()->model()->index(0, 0)).center());
  QCOMPARE(d.text("mass"), QStringLiteral("72.0 g"));
  QCOMPARE(d.field("density")->quantity(), 1000.0);
  d.session().setDensity(d.partId("moving"), 2700.0);
  QCOMPARE(d.text("mass"), QStringLiteral("85.6 g"));
  QCOMPARE(d.field("density")->text(), QStringLiteral("different"));
  // A word is no number: it can be left, and takes no steps.
  const std::size_t before = d.steps();
  d.field("density")->setFocus();
  QTest::keyClick(d.field("density"), Qt::Key_Up);
  QTest::keyClick(d.field("density"), Qt::Key_Return);
  QVERIFY(!d.field("density")->isFaulty());
  QCOMPARE(d.field("density")->text(), QStringLiteral("different"));
  QCOMPARE(d.steps(), before);
  // One that a part of them has already counts for all of them.
  d.type<ui::NumberField>("density", "1000");
  QCOMPARE(d.part("moving").density, 1000.0);
  QCOMPARE(d.text("mass"), QStringLiteral("72.0 g"));
  QVERIFY(d.field("density")->text().startsWith(QStringLiteral("1000")));
  QCOMPARE(d.steps(), before + 1);
}

void DesktopMovableTest::aSelectedGroupIsNamedByItsName() {
  Bench d;
  const PartId fixed = d.partId("fixed"), moving = d.partId("moving");
  const GroupId group = d.session().group({{fixed, moving}, {}}, "Frame");
  d.window().selection().set({fixed, moving}, {group});
  QCOMPARE(d.text("poseHeading"), QStringLiteral("Frame"));
  QVERIFY(d.widget<QLabel>("poseHeading")->toolTip().contains(QStringLiteral("of fixed")));
  d.window().selection().set({fixed, moving});
  QCOMPARE(d.text("poseHeading"), QStringLiteral("moving and 1 more"));
}

// They looked as if they could be used, and then a number was refused.
void DesktopMovableTest::withALockedPartAmongThemTheFieldsSayWhyTheyAreDisabled() {
  Bench d;
  const PartId fixed = d.partId("fixed"), moving = d.partId("moving");
  const GroupId group = d.session().group({{fixed, moving}, {}}, "Frame");
  d.window().selection().set({fixed, moving}, {group});
  QVERIFY(d.field("positionX")->isEnabled());
  d.session().setLocked(fixed, true);
  for (const char* name : {"positionX", "rotationY"}) {
    QVERIFY(!d.field(name)->isEnabled());
    QVERIFY2(d.field(name)->toolTip().contains(QStringLiteral("fixed is locked")), name);
  }
  QVERIFY(!d.field("density")->isEnabled());
  d.window().viewport().setFocus();
  pressInView(d, Qt::Key_Right);
  QVERIFY(d.isNoted("fixed is locked"));
  QCOMPARE(d.x("moving"), 0.0);
  d.session().setLocked(fixed, false);
  QVERIFY(d.field("positionX")->isEnabled());
  QVERIFY(d.failures.isEmpty());
}

// "moving went 0.00 um and touches fixed", and a second step of undo.
void DesktopMovableTest::whatHasBeenDroppedOrPushedIsNoStepTheSecondTime() {
  Bench d;
  d.choose("dropDown");
  QTRY_VERIFY(d.isNoted("touches fixed"));
  const std::size_t dropped = d.steps();
  const double z = d.part("moving").worldFromPart.translation.z;
  d.choose("dropDown");
  QTRY_VERIFY(d.isNoted("moving already touches fixed"));
  QCOMPARE(d.steps(), dropped);
  QCOMPARE(d.part("moving").worldFromPart.translation.z, z);

  d.choose("pushDown");
  QTRY_VERIFY(d.steps() > dropped || d.isNoted("is already held by fixed"));
  const std::size_t pushed = d.steps();
  d.choose("pushDown");
  QTRY_VERIFY(d.isNoted("is already held by fixed"));
  QCOMPARE(d.steps(), pushed);
}

// It said "touches floor", which only lies beneath.
void DesktopMovableTest::aPushNamesWhatBarsTheWayFirst() {
  DesktopDriver d;
  const auto write = [&](const char* name, const glm::dvec3& size, const glm::dvec3& centre) {
    return writeOff(d.folder.path() / name, boxMesh(size, centre));
  };
  d.add({write("floor.off", {0.4, 0.2, 0.02}, glm::dvec3(0.0)),
         write("wall.off", {0.02, 0.2, 0.1}, {0.15, 0.0, 0.07}),
         write("cube.off", glm::dvec3(0.02), {0.0, 0.0, 0.05})});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  d.clickPart(2, ui::PartsModel::Name);
  d.choose("pushDown");
  QTRY_VERIFY(d.window().statusBar()->currentMessage().endsWith(QStringLiteral("touches floor")));
  d.choose("pushRight");
  QTRY_VERIFY2(d.window().statusBar()->currentMessage().contains(QStringLiteral("touches wall")),
               qPrintable(d.window().statusBar()->currentMessage()));
  QVERIFY(std::abs(d.part("cube").worldFromPart.translation.x - 0.13) < 1e-3);
}

NEARFIT_QT_SUITE(DesktopMovableTest, runDesktopTest<DesktopMovableTest>)
#include "desktop_movable_test.moc"
