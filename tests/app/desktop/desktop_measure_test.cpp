#include <QClipboard>
#include <QComboBox>
#include <QDoubleSpinBox>

#include "tests/app/desktop/view_pointer.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopMeasureTest : public QObject {
  Q_OBJECT

 private slots:
  void cleanup() { QSettings().clear(); }
  void cornersAreMeasuredWithTheirComponents();
  void parallelFacesSayHowFarTheyAreApart();
  void hoverTellsWhatWouldBeMeasured();
  void aThirdClickBeginsAnew();
  void numbersAreCopied();
  void unitsAreFollowed();
  void theLabelStandsOnTheLine();
  void theMeasureFollowsItsParts();
  void theMeasureFollowsThePartInHand();
  void theMeasureLeavesWithItsPart();
  void dragsStillOrbitAndEscapeLeaves();
  void oneToolAtATimeTakesClicks();
  void whatIsSeenThroughAnotherPartIsMeasured();
  void closedByItsButtonItGivesTheKeysToTheView();

 private:
  /// The two cubes from the front, and the tool on.
  static void begin(DesktopDriver& d) {
    d.addCubes();
    d.choose("viewFront");
    QTest::qWait(50);
    pressShortcut(d, Qt::Key_M);
    QVERIFY(d.action("measure")->isChecked());
    QVERIFY(d.widget<QWidget>("measureBar")->isVisible());
  }
  /// From the moving cube's upper left corner to the fixed one's: 10, 10 and 25 mm.
  static void measureCorners(DesktopDriver& d) {
    begin(d);
    ViewPointer pointer(d);
    pointer.click({-0.01 + kInside, -0.01, 0.045 - kInside});
    pointer.click({-0.02 + kInside, -0.02, 0.02 - kInside});
  }
  /// Kept where NEARFIT_PICTURES says, to be looked at.
  static void keepPicture(DesktopDriver& d, const char* name) {
    const QString folder = qEnvironmentVariable("NEARFIT_PICTURES");
    if (folder.isEmpty()) return;
    QTest::qWait(300);
    d.window().grab().save(folder + QChar('/') + QLatin1String(name));
  }
  static bool isShown(DesktopDriver& d, const char* label) { return d.widget<QLabel>(label)->isVisible(); }
  /// Of what the label says [mm].
  static double number(DesktopDriver& d, const char* label) {
    return d.text(label).section(QChar(' '), 0, 0).toDouble();
  }
  /// The pointer stands on pixels: exactly on an outline it may be beside the part.
  static constexpr double kInside = 3e-4;
};

void DesktopMeasureTest::cornersAreMeasuredWithTheirComponents() {
  DesktopDriver d;
  measureCorners(d);
  // Millimetres: sqrt(100 + 100 + 625).
  QCOMPARE(d.text("measureDistance"), QStringLiteral("28.723 mm"));
  QCOMPARE(d.text("measureX"), QStringLiteral("-10.000 mm"));
  QCOMPARE(d.text("measureY"), QStringLiteral("-10.000 mm"));
  QCOMPARE(d.text("measureZ"), QStringLiteral("-25.000 mm"));
  QVERIFY(!isShown(d, "measureApart"));
  QVERIFY(!isShown(d, "measureAngle"));
  QCOMPARE(d.text("measurePrompt"), QStringLiteral("From point of moving to point of fixed"));
  // It is no change of the scene.
  QVERIFY(!d.action("undo")->text().contains(QStringLiteral("easure")));
}

void DesktopMeasureTest::parallelFacesSayHowFarTheyAreApart() {
  DesktopDriver d;
  begin(d);
  ViewPointer pointer(d);
  pointer.click({0.004, -0.01, 0.038});
  QVERIFY(!isShown(d, "measureDistance"));
  pointer.click({-0.011, -0.02, 0.004});
  QCOMPARE(d.text("measureDistance"), QStringLiteral("10.000 mm"));
  QCOMPARE(d.text("measureLabel"), QStringLiteral("10.000 mm"));
  QVERIFY(!isShown(d, "measureApart"));
  QCOMPARE(d.text("measureAngle"), QStringLiteral("0.000") + QChar(0xB0));
  QVERIFY(number(d, "measurePoints") > 30.0);
  QVERIFY(!isShown(d, "measureFaces"));
  keepPicture(d, "measure-light.png");
  d.choose("themeDark");
  d.choose("viewIso");
  keepPicture(d, "measure-dark.png");
  d.choose("themeLight");
}

void DesktopMeasureTest::hoverTellsWhatWouldBeMeasured() {
  DesktopDriver d;
  begin(d);
  ViewPointer pointer(d);
  pointer.hover({0.003, -0.01, 0.036});
  QTRY_COMPARE(d.text("measureHint"), QStringLiteral("Flat face of moving"));
  pointer.hover({0.0, -0.01, 0.045 - kInside});
  QTRY_COMPARE(d.text("measureHint"), QStringLiteral("Straight edge of moving"));
}

void DesktopMeasureTest::aThirdClickBeginsAnew() {
  DesktopDriver d;
  measureCorners(d);
  ViewPointer pointer(d);
  QTRY_COMPARE(d.text("measureHint"), QStringLiteral("Click to start a new measurement; Esc exits"));
  pointer.click({0.01 - kInside, -0.01, 0.045 - kInside});
  QVERIFY(!isShown(d, "measureDistance"));
  QVERIFY(!d.widget<QLabel>("measureLabel")->isVisible());
  // To the other end of the same edge, of the same part.
  pointer.click({-0.01 + kInside, -0.01, 0.045 - kInside});
  QCOMPARE(d.text("measureDistance"), QStringLiteral("20.000 mm"));
}

void DesktopMeasureTest::numbersAreCopied() {
  DesktopDriver d;
  measureCorners(d);
  QApplication::clipboard()->clear();
  QTest::mouseClick(d.widget<QPushButton>("measureCopy"), Qt::LeftButton);
  QCOMPARE(QApplication::clipboard()->text(),
           QStringLiteral("Distance: 28.723 mm\nX: -10.000 mm\nY: -10.000 mm\nZ: -25.000 mm"));
}

void DesktopMeasureTest::unitsAreFollowed() {
  DesktopDriver d;
  measureCorners(d);
  d.choose("unit-in");
  QCOMPARE(d.text("measureZ"), QStringLiteral("-0.9843 in"));
  QCOMPARE(d.text("measureLabel"), d.text("measureDistance"));
  d.choose("unit-mm");
  QCOMPARE(d.text("measureZ"), QStringLiteral("-25.000 mm"));
}

void DesktopMeasureTest::theLabelStandsOnTheLine() {
  DesktopDriver d;
  measureCorners(d);
  const auto* label = d.widget<QLabel>("measureLabel");
  ViewPointer pointer(d);
  const glm::dvec3 middle(-0.015, -0.015, 0.0325);
  const auto isThere = [&] {
    return (label->geometry().center() - pointer.seen(middle)).manhattanLength() <= 3;
  };
  QTRY_VERIFY(label->isVisible() && isThere());
  QCOMPARE(label->text(), QStringLiteral("28.723 mm"));
  // The camera goes elsewhere, and the label with it.
  d.choose("viewIso");
  QTRY_VERIFY(label->isVisible() && isThere());
}

void DesktopMeasureTest::theMeasureFollowsItsParts() {
  DesktopDriver d;
  measureCorners(d);
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionZ", "15");
  QTRY_COMPARE(d.text("measureZ"), QStringLiteral("-40.000 mm"));
  d.choose("undo");
  QTRY_COMPARE(d.text("measureZ"), QStringLiteral("-25.000 mm"));
}

void DesktopMeasureTest::theMeasureFollowsThePartInHand() {
  DesktopDriver d;
  measureCorners(d);
  auto* hands = d.widget<QComboBox>("hand");
  hands->setFocus();
  for (int i = 0; i < hands->count() && hands->currentData().value<ui::Hand>() != ui::Hand::Manual; ++i)
    QTest::keyClick(hands, Qt::Key_Down);
  QTest::mouseClick(d.widget<QPushButton>("startStop"), Qt::LeftButton);
  QTRY_VERIFY(d.application.servo().isRunning());
  QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 1"));
  QVERIFY(d.action("measure")->isChecked());
  for (int i = 0; i < 3; ++i)
    pressInView(d, Qt::Key_PageUp);
  // Wherever the servo has it.
  QTRY_VERIFY(d.felt && d.felt->translation.z > 2e-4);
  QTRY_VERIFY(std::abs(number(d, "measureZ") + 25.0 + 1e3 * d.felt->translation.z) < 2e-3);
  d.choose("stop");
  QTRY_VERIFY(!d.application.servo().isRunning());
  QTRY_VERIFY(std::abs(number(d, "measureZ") + 25.0 + 1e3 * d.part("moving").worldFromPart.translation.z) <
              2e-3);
}

void DesktopMeasureTest::theMeasureLeavesWithItsPart() {
  DesktopDriver d;
  measureCorners(d);
  d.clickPart(1, ui::PartsModel::Name);
  d.choose("remove");
  QCOMPARE(d.session().scene().parts().size(), std::size_t{1});
  QVERIFY(!isShown(d, "measureDistance"));
  QVERIFY(!d.widget<QLabel>("measureLabel")->isVisible());
  QVERIFY(d.text("measurePrompt").contains(QStringLiteral("to measure from")));
  QVERIFY(!d.widget<QPushButton>("measureCopy")->isEnabled());
}

void DesktopMeasureTest::dragsStillOrbitAndEscapeLeaves() {
  DesktopDriver d;
  measureCorners(d);
  const std::string undo = d.session().undoText();
  const glm::dvec3 before = d.window().viewport().projection().away();
  ViewPointer pointer(d);
  pointer.drag(pointer.seen({0.003, -0.02, 0.01}), QPoint(80, 0));
  QVERIFY(glm::distance(d.window().viewport().projection().away(), before) > 0.05);
  QCOMPARE(d.text("measureDistance"), QStringLiteral("28.723 mm"));
  pressInView(d, Qt::Key_Escape);
  QVERIFY(!d.action("measure")->isChecked());
  QVERIFY(!d.widget<QWidget>("measureBar")->isVisible());
  QVERIFY(!d.widget<QLabel>("measureLabel")->isVisible());
  QCOMPARE(d.session().undoText(), undo);
}

void DesktopMeasureTest::oneToolAtATimeTakesClicks() {
  DesktopDriver d;
  begin(d);
  d.choose("align");
  QVERIFY(d.action("align")->isChecked());
  QVERIFY(!d.action("measure")->isChecked());
  QVERIFY(!d.widget<QWidget>("measureBar")->isVisible());
  d.choose("measure");
  QVERIFY(!d.action("align")->isChecked());
  pressInView(d, Qt::Key_Escape);
  QVERIFY(!d.action("measure")->isChecked());
}

/// The see-through part in front was picked, though the solid one behind it is what one looks at.
void DesktopMeasureTest::whatIsSeenThroughAnotherPartIsMeasured() {
  DesktopDriver d;
  begin(d);
  // Behind the fixed cube, which the part in hand makes see-through.
  d.session().movePart(d.partId("moving"), {{1, 0, 0, 0}, {0.0, 0.06, -0.035}});
  ViewPointer pointer(d);
  const glm::dvec3 onMoving{0.003, 0.05, 0.001}, besideIt{0.016, -0.02, 0.001};
  pointer.hover(onMoving);
  QTRY_COMPARE(d.text("measureHint"), QStringLiteral("Flat face of moving"));
  pointer.hover(besideIt);
  QTRY_COMPARE(d.text("measureHint"), QStringLiteral("Flat face of fixed"));
  d.action("seeThrough")->setChecked(false);
  pointer.hover(onMoving);
  QTRY_COMPARE(d.text("measureHint"), QStringLiteral("Flat face of fixed"));
}

/// The next widget by Tab is a button of the status bar: the arrow keys went along those, and Space opened a panel.
void DesktopMeasureTest::closedByItsButtonItGivesTheKeysToTheView() {
  DesktopDriver d;
  begin(d);
  auto* close = d.widget<QPushButton>("measureClose");
  close->setFocus();
  QVERIFY(close->hasFocus());
  QTest::mouseClick(close, Qt::LeftButton);
  QVERIFY(!d.widget<QWidget>("measureBar")->isVisible());
  QVERIFY(d.window().viewport().hasFocus());
}

NEARFIT_QT_SUITE(DesktopMeasureTest, runDesktopTest<DesktopMeasureTest>)
#include "desktop_measure_test.moc"
