#include <QSlider>
#include <cmath>

#include <glm/geometric.hpp>

#include "tests/app/desktop/section_driver.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopSectionPlaneTest : public QObject {
  Q_OBJECT

 private slots:
  void cleanup() { QSettings().clear(); }
  void theSideTowardsTheViewerIsCutAndFlipTurnsItRound();
  void sliderNumberAndArrowMoveThePlane();
  void escapeTakesADragOfTheArrowBack();
  void ringsTiltThePlane();
  void aFaceThatIsClickedIsThePlane();
  void escapeClosesWhatIsAskedForAndThenTheSection();
  void thePlaneIsKeptWhileItIsOff();
  void theDirectionOfSightIsTakenAsItIs();
  void itIsNoChangeOfTheSceneAndItsChoicesAreKept();
};

void DesktopSectionPlaneTest::theSideTowardsTheViewerIsCutAndFlipTurnsItRound() {
  SectionDriver cut;
  cut.begin("sectionY");
  QTRY_VERIFY(cut.picked({0.01, 0.0, 0.003}));
  QVERIFY(std::abs(cut.picked({0.01, 0.0, 0.003})->point.y) < 1e-6);
  cut.press("sectionFlip");
  // The near half is there again, whole from outside.
  QTRY_VERIFY(std::abs(cut.picked({0.01, -0.02, 0.003})->point.y + 0.02) < 1e-6);
  QVERIFY(cut.picked({0.01, -0.02, 0.003})->cut == nullptr);
  QCOMPARE(cut.position(), 0.0);
}

void DesktopSectionPlaneTest::sliderNumberAndArrowMoveThePlane() {
  SectionDriver cut;
  cut.begin("sectionX");
  QCOMPARE(cut.position(), 0.0);
  cut.goTo("5 mm + 0.5 cm");
  QCOMPARE(cut.position(), 10.0);
  // From -20 to 20 mm: three quarters.
  auto* slider = cut.d.widget<QSlider>("sectionSlider");
  QCOMPARE(slider->value(), 750);
  slider->setFocus();
  QTest::keyClick(slider, Qt::Key_Home);
  QCOMPARE(cut.position(), -20.0);
  QTest::keyClick(slider, Qt::Key_End);
  QCOMPARE(cut.position(), 20.0);
  cut.goTo("0");
  QTRY_VERIFY(cut.handle().picture());
  cut.pointer.drag(cut.handleAt(GizmoGrip::MoveX), QPoint(60, 0));
  const double pixel = 1e3 * cut.view().projection().metresPerPixel({0.0, 0.0, 0.0125});
  QVERIFY(std::abs(cut.position() - 60.0 * pixel) < 3.0 * pixel);
  // The arrow goes with the plane.
  const double reached = cut.position();
  cut.pointer.drag(cut.handleAt(GizmoGrip::MoveX), QPoint(-60, 0));
  QVERIFY(std::abs(cut.position()) < 3.0 * pixel && reached > 10.0 * pixel);
}

void DesktopSectionPlaneTest::escapeTakesADragOfTheArrowBack() {
  SectionDriver cut;
  cut.begin("sectionX");
  cut.goTo("3");
  QTRY_VERIFY(cut.handle().picture());
  const QPoint from = cut.handleAt(GizmoGrip::MoveX);
  cut.pointer.press(from);
  for (int i = 1; i <= 10; ++i)
    cut.pointer.moveTo(from + QPoint(5 * i, 0));
  QVERIFY(cut.position() > 4.0);
  QTest::keyClick(&cut.view(), Qt::Key_Escape);
  QCOMPARE(cut.position(), 3.0);
  QVERIFY(cut.d.action("section")->isChecked());
  cut.pointer.release(from + QPoint(50, 0));
  QCOMPARE(cut.position(), 3.0);
}

void DesktopSectionPlaneTest::ringsTiltThePlane() {
  SectionDriver cut("viewIso");
  cut.begin("sectionY");
  QTRY_VERIFY(cut.handle().picture());
  const QPoint from = cut.handleAt(GizmoGrip::TurnX);
  cut.pointer.drag(from, QPoint(12, 18));
  // No longer across an axis, and counted from where it is now.
  QVERIFY(!cut.isDown("sectionX") && !cut.isDown("sectionY") && !cut.isDown("sectionZ"));
  QCOMPARE(cut.position(), 0.0);
  // It was turned about the line along X through the middle of both parts: that is still in it, and how far
  // it stands out depends on the height alone.
  const auto near = cut.picked({0.008, 0.0, 0.0125});
  const auto deep = cut.picked({0.008, 0.0, 0.0});
  const auto left = cut.picked({-0.008, 0.0, 0.0});
  QVERIFY(deep && deep->cut != nullptr && std::abs(deep->point.y) > 1e-4);
  QVERIFY(near && near->cut != nullptr && left && left->cut != nullptr);
  const double slope = deep->point.y / (deep->point.z - 0.0125);
  QVERIFY(std::abs(near->point.y - slope * (near->point.z - 0.0125)) < 1e-6);
  QVERIFY(std::abs(left->point.y - slope * (left->point.z - 0.0125)) < 1e-6);
  // Escape in the middle of another turn takes that back alone.
  const glm::dvec3 before = deep->point;
  cut.pointer.press(cut.handleAt(GizmoGrip::TurnX));
  for (int i = 1; i <= 5; ++i)
    cut.pointer.moveTo(cut.handleAt(GizmoGrip::TurnX) + QPoint(-2 * i, -4 * i));
  QTest::keyClick(&cut.view(), Qt::Key_Escape);
  cut.pointer.release(from);
  const auto after = cut.picked({0.008, 0.0, 0.0});
  QVERIFY(after && glm::distance(after->point, before) < 1e-9);
  QVERIFY(cut.d.action("section")->isChecked());
}

void DesktopSectionPlaneTest::aFaceThatIsClickedIsThePlane() {
  SectionDriver cut("viewIso");
  cut.begin("sectionX");
  cut.press("sectionFlip");
  cut.goTo("-100");
  cut.press("sectionFace");
  QVERIFY(cut.isDown("sectionFace") && !cut.isDown("sectionX"));
  QVERIFY(cut.d.widget<QLabel>("sectionNote")->isVisible());
  // The front of the moving part: what lies before it is cut away, half of the fixed one's depth.
  if (!cut.picked({0.0, -0.01, 0.035})) cut.press("sectionFlip");
  cut.pointer.click({0.0, -0.01, 0.035});
  QVERIFY(cut.isDown("sectionFace"));
  QVERIFY(!cut.d.widget<QLabel>("sectionNote")->isVisible());
  QCOMPARE(cut.position(), 0.0);
  QVERIFY(cut.isCapAt({0.005, -0.01, 0.005}, "fixed"));
  QTRY_VERIFY(cut.isRedAt({0.005, -0.01, 0.005}));
  // The face itself is there still, and whole.
  const auto face = cut.picked({0.0, -0.01, 0.035});
  QVERIFY(face && face->part == cut.d.partId("moving") && std::abs(face->point.y + 0.01) < 1e-6);
  for (const double x : {-0.008, -0.003, 0.002, 0.008})
    QVERIFY(cut.isBlueAt({x, -0.01, 0.03 - 0.2 * x}));
  // Along the face's normal, which looks to the front.
  cut.goTo("-4");
  QVERIFY(cut.isCapAt({0.0, -0.006, 0.035}, "moving"));
  QVERIFY(std::abs(cut.picked({0.0, -0.006, 0.035})->point.y + 0.006) < 1e-6);
}

void DesktopSectionPlaneTest::escapeClosesWhatIsAskedForAndThenTheSection() {
  SectionDriver cut;
  cut.begin("sectionY");
  cut.press("sectionFace");
  QTest::keyClick(&cut.view(), Qt::Key_Escape);
  QVERIFY(cut.d.action("section")->isChecked());
  QVERIFY(cut.isDown("sectionY") && !cut.isDown("sectionFace"));
  pressShortcut(cut.d, Qt::Key_M);
  QTest::keyClick(&cut.view(), Qt::Key_Escape);
  QVERIFY(!cut.d.action("measure")->isChecked() && cut.d.action("section")->isChecked());
  QTest::keyClick(&cut.view(), Qt::Key_Escape);
  QVERIFY(!cut.d.action("section")->isChecked());
  QVERIFY(!cut.d.widget<QWidget>("sectionBar")->isVisible());
}

void DesktopSectionPlaneTest::thePlaneIsKeptWhileItIsOff() {
  SectionDriver cut;
  cut.begin("sectionX");
  cut.goTo("7");
  pressShortcut(cut.d, Qt::Key_C);
  QVERIFY(!cut.d.action("section")->isChecked());
  pressShortcut(cut.d, Qt::Key_C);
  QCOMPARE(cut.position(), 7.0);
  QVERIFY(cut.isDown("sectionX"));
  // Chosen again it is in the middle.
  cut.press("sectionX");
  QCOMPARE(cut.position(), 0.0);
}

void DesktopSectionPlaneTest::theDirectionOfSightIsTakenAsItIs() {
  SectionDriver cut("viewIso");
  cut.begin("sectionSight");
  const auto away = cut.view().projection().away();
  const auto seen = cut.picked({0.0, 0.0, 0.005});
  QVERIFY(seen && seen->cut != nullptr);
  // Through the middle of the box around both: from -20 to 20, and from -20 to 45 mm.
  QVERIFY(std::abs(glm::dot(seen->point - glm::dvec3(0.0, 0.0, 0.0125), away)) < 1e-6);
  // The plane stays when the camera goes.
  cut.d.choose("viewFront");
  QTest::qWait(50);
  const auto after = cut.picked({0.0, 0.0, 0.0});
  QVERIFY(after && std::abs(glm::dot(after->point - glm::dvec3(0.0, 0.0, 0.0125), away)) < 1e-6);
}

void DesktopSectionPlaneTest::itIsNoChangeOfTheSceneAndItsChoicesAreKept() {
  {
    SectionDriver cut;
    const std::size_t steps = cut.d.session().historyIndex();
    cut.begin("sectionZ");
    cut.goTo("4");
    cut.press("sectionSpare");
    QCOMPARE(cut.d.session().historyIndex(), steps);
  }
  SectionDriver cut;
  pressShortcut(cut.d, Qt::Key_C);
  QVERIFY(cut.isDown("sectionZ"));
  QVERIFY(cut.d.widget<QCheckBox>("sectionSpare")->isChecked());
}

NEARFIT_QT_SUITE(DesktopSectionPlaneTest, runDesktopTest<DesktopSectionPlaneTest>)
#include "desktop_section_plane_test.moc"
