#include <QComboBox>
#include <cmath>

#include "tests/app/desktop/section_driver.h"
#include "ui/model/parts_model.h"
#include "ui/view3d/view_detail.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopSectionTest : public QObject {
  Q_OBJECT

 private slots:
  void cleanup() { QSettings().clear(); }
  void whatLiesBeforeThePlaneIsCutAwayAndTheCutIsClosed();
  void onePartOfTwoAlikeMayBeWhole();
  void whatIsKeptOfAPictureIsCutToo();
  void picksGoThroughWhatIsCutAway();
  void theEdgeOfTheCutIsMeasured();
  void theMovingPartMayStayWhole();
  void theCutFollowsPartsThatMove();
  void openMeshesAreCutWithoutACapAndNamed();
  void switchedOffNothingIsLeftOfIt();
  void closedByItsButtonItGivesTheKeysToTheView();
};

void DesktopSectionTest::whatLiesBeforeThePlaneIsCutAwayAndTheCutIsClosed() {
  SectionDriver cut("viewIso");
  cut.begin("sectionY");
  QCOMPARE(cut.position(), 0.0);
  // In the plane y = 0, through both cubes.
  QTRY_VERIFY(cut.isRedAt({0.01, 0.0, 0.003}));
  QTRY_VERIFY(cut.isBlueAt({0.002, 0.0, 0.038}));
  const auto onFixed = cut.picked({0.01, 0.0, 0.003});
  QVERIFY(onFixed && onFixed->cut != nullptr && onFixed->part == cut.d.partId("fixed"));
  QVERIFY(std::abs(onFixed->point.y) < 1e-6);
  // The face in front of it is gone.
  QVERIFY(!cut.picked({0.01, -0.02, 0.003}) || cut.picked({0.01, -0.02, 0.003})->point.y > -1e-6);
  keepPictures(cut.d.window(), QStringLiteral("section"));
}

void DesktopSectionTest::onePartOfTwoAlikeMayBeWhole() {
  SectionDriver cut;
  // A copy of the moving part beside it, of the same file.
  cut.d.add({cut.d.movingFile});
  QTRY_COMPARE(cut.d.session().scene().parts().size(), std::size_t{3});
  PartId copy{};
  for (const Scene::PartPtr& part : cut.d.session().scene().parts()) {
    if (part->id != cut.d.partId("fixed") && part->id != cut.d.partId("moving")) copy = part->id;
  }
  cut.d.session().movePart(copy, {{1, 0, 0, 0}, {0.03, 0.0, 0.0}});
  cut.d.choose("viewFront");
  cut.begin("sectionY");
  cut.press("sectionSpare");
  QVERIFY(cut.d.widget<QCheckBox>("sectionSpare")->isChecked());
  QVERIFY(std::abs(cut.picked({0.0, -0.01, 0.035})->point.y + 0.01) < 1e-6);
  const auto onCopy = cut.picked({0.03, 0.0, 0.035});
  QVERIFY(onCopy && onCopy->part == copy && onCopy->cut != nullptr && std::abs(onCopy->point.y) < 1e-6);
  QTRY_VERIFY(cut.isBlueAt({0.0, -0.01, 0.035}));
}

void DesktopSectionTest::whatIsKeptOfAPictureIsCutToo() {
  SectionDriver cut("viewTop");
  // Nothing may be drawn at once: all is kept, or drawn coarsely.
  cut.view().detail().setBudget(1);
  QTRY_VERIFY(cut.isBlueAt({0.0, 0.0, 0.045}));
  cut.begin("sectionZ");
  cut.goTo("30");
  if (cut.picked({0.0, 0.0, 0.03}) && cut.picked({0.0, 0.0, 0.03})->cut == nullptr) cut.press("sectionFlip");
  cut.goTo("10");
  // From above into what is left of the fixed part: its cut face where the moving part was.
  QTRY_VERIFY(cut.isRedAt({0.0, 0.0, 0.01}));
  QVERIFY(cut.isRedAt({0.012, 0.0, 0.01}));
  cut.press("sectionClose");
  QTRY_VERIFY(cut.isBlueAt({0.0, 0.0, 0.045}));
}

void DesktopSectionTest::picksGoThroughWhatIsCutAway() {
  SectionDriver cut;
  cut.begin("sectionZ");
  // Seen from the front, only what lies below 10 mm is left.
  cut.goTo("10");
  // Flipped or not, by where the viewer stands: what is left is below.
  if (cut.picked({0.0, -0.01, 0.035})) cut.press("sectionFlip");
  QVERIFY(!cut.picked({0.0, -0.01, 0.035}));
  QVERIFY(!cut.picked({0.0, -0.02, 0.015}));
  QVERIFY(cut.picked({0.0, -0.02, 0.005}));
  // A click selects by that.
  cut.pointer.click({0.0, -0.01, 0.035});
  QVERIFY(cut.d.window().selection().isEmpty());
  cut.pointer.click({0.0, -0.02, 0.005});
  QCOMPARE(*cut.d.window().selection().current(), cut.d.partId("fixed"));
}

void DesktopSectionTest::theEdgeOfTheCutIsMeasured() {
  SectionDriver cut;
  cut.begin("sectionY");
  cut.goTo("5");
  pressShortcut(cut.d, Qt::Key_M);
  constexpr double kInside = 3e-4;
  cut.pointer.click({0.004, 0.005, 0.025 + kInside});
  cut.pointer.click({0.006, 0.005, 0.02 - kInside});
  // Between the two cut faces' edges: the gap of 5 mm.
  QCOMPARE(cut.d.text("measureDistance"), QStringLiteral("5.0000 mm"));
  QCOMPARE(cut.d.text("measureZ"), QStringLiteral("-5.0000 mm"));
  QCOMPARE(cut.d.text("measureY"), QStringLiteral("0.0000 mm"));
}

void DesktopSectionTest::theMovingPartMayStayWhole() {
  SectionDriver cut;
  cut.begin("sectionY");
  QVERIFY(std::abs(cut.picked({0.0, 0.0, 0.035})->point.y) < 1e-6);
  cut.press("sectionSpare");
  QVERIFY(cut.d.widget<QCheckBox>("sectionSpare")->isChecked());
  QVERIFY(std::abs(cut.picked({0.0, 0.0, 0.035})->point.y + 0.01) < 1e-6);
  QVERIFY(std::abs(cut.picked({0.01, 0.0, 0.003})->point.y) < 1e-6);
}

void DesktopSectionTest::theCutFollowsPartsThatMove() {
  SectionDriver cut;
  cut.begin("sectionY");
  QTRY_VERIFY(cut.isBlueAt({0.0, 0.0, 0.035}));
  cut.d.clickPart(1, ui::PartsModel::Name);
  cut.d.type<QDoubleSpinBox>("positionX", "25");
  cut.d.window().selection().select({});
  QTRY_VERIFY(cut.isBlueAt({0.025, 0.0, 0.035}));
  const auto onCap = cut.picked({0.025, 0.0, 0.035});
  QVERIFY(onCap->cut != nullptr && std::abs(onCap->point.y) < 1e-6);
  // In hand, where the servo has it: half a cube to the front and the plane misses it.
  cut.d.session().movePart(cut.d.partId("moving"), {{1, 0, 0, 0}, {0.025, 0.011, 0.0}});
  QTRY_VERIFY(cut.picked({0.025, 0.001, 0.035})->cut == nullptr);
  cut.d.choose("undo");
  QTRY_VERIFY(cut.picked({0.025, 0.0, 0.035})->cut != nullptr);
  auto* hands = cut.d.widget<QComboBox>("hand");
  hands->setFocus();
  for (int i = 0; i < hands->count() && hands->currentData().value<ui::Hand>() != ui::Hand::Manual; ++i)
    QTest::keyClick(hands, Qt::Key_Down);
  QTest::mouseClick(cut.d.widget<QPushButton>("startStop"), Qt::LeftButton);
  QTRY_VERIFY(cut.d.application.servo().isRunning());
  QTRY_COMPARE(cut.d.text("statusMinima"), QStringLiteral("Minima 1"));
  for (int i = 0; i < 12; ++i)
    QTest::keyClick(&cut.view(), Qt::Key_Right);
  QTRY_VERIFY(cut.d.felt && cut.d.felt->translation.x > 0.026);
  QTRY_VERIFY([&] {
    const double x = cut.d.felt->translation.x;
    const auto seen = cut.picked({x + 0.009, 0.0, 0.035});
    return seen && seen->cut != nullptr && seen->part == cut.d.partId("moving");
  }());
  cut.d.choose("stop");
  QTRY_VERIFY(!cut.d.application.servo().isRunning());
}

void DesktopSectionTest::openMeshesAreCutWithoutACapAndNamed() {
  SectionDriver cut;
  const QString open = writeOff(cut.d.folder.path() / "sail.off", squareMesh(0.03, 3));
  cut.d.add({open});
  QTRY_COMPARE(cut.d.session().scene().parts().size(), std::size_t{3});
  auto* note = cut.d.widget<QLabel>("sectionNote");
  cut.begin("sectionX");
  QTRY_VERIFY(note->isVisible());
  QVERIFY2(note->text().contains(QStringLiteral("sail")) && !note->text().contains(QStringLiteral("fixed")),
           qPrintable(note->text()));
  // Where the plane misses it there is nothing to say.
  cut.goTo("17");
  QTRY_VERIFY(!note->isVisible());
}

void DesktopSectionTest::switchedOffNothingIsLeftOfIt() {
  SectionDriver cut("viewIso");
  cut.begin("sectionY");
  QTRY_VERIFY(cut.handle().isVisible());
  cut.press("sectionClose");
  QVERIFY(!cut.d.action("section")->isChecked());
  QVERIFY(!cut.d.widget<QWidget>("sectionBar")->isVisible());
  QVERIFY(!cut.handle().isVisible());
  QVERIFY(std::abs(cut.picked({0.01, -0.02, 0.003})->point.y + 0.02) < 1e-6);
  QVERIFY(cut.picked({0.01, -0.02, 0.003})->cut == nullptr);
  QVERIFY(cut.d.comesToRest());
}

/// The bar gave the keys to the status bar, as the measuring bar did.
void DesktopSectionTest::closedByItsButtonItGivesTheKeysToTheView() {
  SectionDriver cut;
  cut.begin("sectionY");
  auto* close = cut.d.widget<QWidget>("sectionClose");
  close->setFocus();
  QVERIFY(close->hasFocus());
  cut.press("sectionClose");
  QVERIFY(!cut.d.widget<QWidget>("sectionBar")->isVisible());
  QVERIFY(cut.view().hasFocus());
}

NEARFIT_QT_SUITE(DesktopSectionTest, runDesktopTest<DesktopSectionTest>)
#include "desktop_section_test.moc"
