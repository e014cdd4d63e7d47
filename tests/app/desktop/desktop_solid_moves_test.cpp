// What is solid stops at contact, whichever way it is moved; with the switch off the same goes through.
#include <QStatusBar>
#include <QWheelEvent>

#include <glm/geometric.hpp>

#include "tests/app/desktop/solid_driver.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

QString shown(const glm::dvec3& v) {
  return QStringLiteral("%1 %2 %3").arg(v.x, 0, 'g', 12).arg(v.y, 0, 'g', 12).arg(v.z, 0, 'g', 12);
}

constexpr double kAngleSlack = 3e-3;  ///< What a tenth of the margin makes of the channel's angle, and more.

}  // namespace

class DesktopSolidMovesTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void aKeyStopsWhereItWouldGoThrough_data();
  void aKeyStopsWhereItWouldGoThrough();
  void aTurnByAKeyStopsBetweenTwoPlates_data();
  void aTurnByAKeyStopsBetweenTwoPlates();
  void stepsOfAPositionStopAtContact_data();
  void stepsOfAPositionStopAtContact();
  void stepsOfARotationStopAtContact_data();
  void stepsOfARotationStopAtContact();
  void aRingStopsBetweenTwoPlates_data() { solidOrNot(); }
  void aRingStopsBetweenTwoPlates();
  void severalTogetherStopWhereOneOfThemDoes_data();
  void severalTogetherStopWhereOneOfThemDoes();
  void aPartThatLeavesWhileItSettlesIsPutNowhere();

 private:
  static void solidOrNot();
};

void DesktopSolidMovesTest::solidOrNot() {
  QTest::addColumn<bool>("isSolid");
  QTest::newRow("solid") << true;
  QTest::newRow("not solid") << false;
}

void DesktopSolidMovesTest::aKeyStopsWhereItWouldGoThrough_data() {
  QTest::addColumn<int>("key");
  QTest::addColumn<int>("axis");
  QTest::addColumn<double>("sense");
  QTest::addColumn<bool>("isSolid");
  struct {
    const char* name;
    int key, axis;
    double sense;
  } const keys[] = {{"right", Qt::Key_Right, 0, 1.0},    {"left", Qt::Key_Left, 0, -1.0},
                    {"up", Qt::Key_Up, 1, 1.0},          {"down", Qt::Key_Down, 1, -1.0},
                    {"page up", Qt::Key_PageUp, 2, 1.0}, {"page down", Qt::Key_PageDown, 2, -1.0}};
  for (const auto& row : keys)
    QTest::addRow("%s, solid", row.name) << row.key << row.axis << row.sense << true;
  QTest::addRow("right, not solid") << int(Qt::Key_Right) << 0 << 1.0 << false;
  QTest::addRow("page down, not solid") << int(Qt::Key_PageDown) << 2 << -1.0 << false;
}

void DesktopSolidMovesTest::aKeyStopsWhereItWouldGoThrough() {
  QFETCH(int, key);
  QFETCH(int, axis);
  QFETCH(double, sense);
  QFETCH(bool, isSolid);
  glm::dvec3 before(0.0);
  before[axis] = -0.035 * sense;
  SolidDriver b({{"block", glm::dvec3(0.04), glm::dvec3(0.0)}, {"cube", glm::dvec3(0.02), before}}, isSolid);
  b.select({"cube"});
  b.type<ui::NumberField>("nudgeStep", "100");
  const std::size_t steps = b.steps();
  b.press(static_cast<Qt::Key>(key));
  b.settle("cube");
  QCOMPARE(b.steps(), steps + 1);
  // 5 mm are between them, and 100 mm lead out on the other side.
  glm::dvec3 wanted(0.0);
  wanted[axis] = sense * (isSolid ? 0.005 - b.margin : 0.1);
  const glm::dvec3 gone = b.pose("cube").translation;
  QVERIFY2(glm::distance(gone, wanted) < (isSolid ? 0.1 * b.margin : 1e-12), qPrintable(shown(gone)));
  QVERIFY(!b.doMeet("block", "cube"));
  QCOMPARE(b.told().contains(QStringLiteral("Stopped by block")), isSolid);
  // Pressed once more, it stays there.
  if (!isSolid) return;
  b.press(static_cast<Qt::Key>(key));
  b.settle("cube");
  QVERIFY(glm::distance(b.pose("cube").translation, wanted) < 0.1 * b.margin);
  QVERIFY(!b.doMeet("block", "cube"));
  // It crept by a hundredth of what was left, in a step of undo each time.
  QCOMPARE(b.steps(), steps + 1);
  QCOMPARE(b.pose("cube").translation, gone);
}

void DesktopSolidMovesTest::aTurnByAKeyStopsBetweenTwoPlates_data() {
  QTest::addColumn<int>("key");
  QTest::addColumn<int>("axis");
  QTest::addColumn<double>("sense");
  QTest::addColumn<bool>("isSolid");
  for (const bool isSolid : {true, false}) {
    const char* word = isSolid ? "solid" : "not solid";
    QTest::addRow("about x, %s", word) << int(Qt::Key_Right) << 0 << 1.0 << isSolid;
    QTest::addRow("back about x, %s", word) << int(Qt::Key_Left) << 0 << -1.0 << isSolid;
    QTest::addRow("about y, %s", word) << int(Qt::Key_Up) << 1 << 1.0 << isSolid;
    QTest::addRow("back about y, %s", word) << int(Qt::Key_Down) << 1 << -1.0 << isSolid;
  }
}

void DesktopSolidMovesTest::aTurnByAKeyStopsBetweenTwoPlates() {
  QFETCH(int, key);
  QFETCH(int, axis);
  QFETCH(double, sense);
  QFETCH(bool, isSolid);
  SolidDriver b(channel(), isSolid);
  b.select({"cube"});
  // After 80 degrees it would stand as free as before, but for the plates on the way: its corners are 11.6 mm
  // up then.
  b.type<ui::NumberField>("turnStep", "80");
  const std::size_t steps = b.steps();
  b.press(static_cast<Qt::Key>(key), Qt::ShiftModifier);
  b.settle("cube");
  QCOMPARE(b.steps(), steps + 1);
  glm::dvec3 wanted(0.0);
  wanted[axis] = sense * (isSolid ? channelAngle(b.margin) : 80.0 * kDegree);
  const glm::dvec3 turn = b.turnOf("cube");
  QVERIFY2(glm::distance(turn, wanted) < (isSolid ? kAngleSlack : 1e-9), qPrintable(shown(turn / kDegree)));
  QVERIFY(!b.doPlatesMeet(b.pose("cube")));
  QCOMPARE(b.told().contains(QStringLiteral("Stopped by")), isSolid);
}

namespace {

/// One step of a spin box at a time, by what a user has for it.
void step(QWidget* field, const QString& how) {
  field->setFocus();
  if (how == QLatin1String("down")) return QTest::keyClick(field, Qt::Key_Down);
  if (how == QLatin1String("up")) return QTest::keyClick(field, Qt::Key_Up);
  if (how == QLatin1String("page down")) return QTest::keyClick(field, Qt::Key_PageDown);
  if (how == QLatin1String("page up")) return QTest::keyClick(field, Qt::Key_PageUp);
  const QPointF middle(field->rect().center());
  QWheelEvent wheel(middle, field->mapToGlobal(middle.toPoint()), {},
                    {0, how == QLatin1String("wheel up") ? 120 : -120}, Qt::NoButton, {}, Qt::NoScrollPhase,
                    false);
  QApplication::sendEvent(field, &wheel);
}

void stepRows(std::initializer_list<std::pair<const char*, int>> ways) {
  QTest::addColumn<QString>("how");
  QTest::addColumn<int>("times");
  QTest::addColumn<bool>("isSolid");
  for (const auto& [how, times] : ways) {
    for (const bool isSolid : {true, false})
      QTest::addRow("%s, %s", how, isSolid ? "solid" : "not solid") << QString(how) << times << isSolid;
  }
}

}  // namespace

void DesktopSolidMovesTest::stepsOfAPositionStopAtContact_data() {
  // A step is 1 mm; one by the page, 10 mm.
  stepRows({{"down", 8}, {"wheel down", 8}, {"page down", 1}});
}

void DesktopSolidMovesTest::stepsOfAPositionStopAtContact() {
  QFETCH(QString, how);
  QFETCH(int, times);
  QFETCH(bool, isSolid);
  SolidDriver b({{"block", glm::dvec3(0.04), glm::dvec3(0.0)}, {"cube", glm::dvec3(0.02), {0, 0, 0.035}}},
                isSolid);
  b.select({"cube"});
  for (int i = 0; i < times; ++i) {
    step(b.widget<ui::NumberField>("positionZ"), how);
    b.settle("cube");
    if (isSolid) QVERIFY(!b.doMeet("block", "cube"));
  }
  const glm::dvec3 gone = b.pose("cube").translation;
  const double wanted = isSolid ? b.margin - 0.005 : -1e-3 * (times == 1 ? 10 : times);
  QVERIFY2(glm::distance(gone, {0, 0, wanted}) < (isSolid ? 0.1 * b.margin : 1e-9), qPrintable(shown(gone)));
  QCOMPARE(b.doMeet("block", "cube"), !isSolid);
  // The field has what came of it.
  QVERIFY(std::abs(b.widget<ui::NumberField>("positionZ")->quantity() - gone.z) < 1e-6);
}

void DesktopSolidMovesTest::stepsOfARotationStopAtContact_data() {
  // A step is 1 degree; one by the page, 10.
  stepRows({{"up", 20}, {"wheel up", 20}, {"page up", 2}});
}

void DesktopSolidMovesTest::stepsOfARotationStopAtContact() {
  QFETCH(QString, how);
  QFETCH(int, times);
  QFETCH(bool, isSolid);
  SolidDriver b(channel(), isSolid);
  b.select({"cube"});
  for (int i = 0; i < times; ++i) {
    step(b.widget<ui::NumberField>("rotationY"), how);
    b.settle("cube");
    if (isSolid) QVERIFY(!b.doPlatesMeet(b.pose("cube")));
  }
  const double wanted = isSolid ? channelAngle(b.margin) : 20.0 * kDegree;
  const glm::dvec3 turn = b.turnOf("cube");
  QVERIFY2(glm::distance(turn, {0, wanted, 0}) < (isSolid ? kAngleSlack : 1e-9),
           qPrintable(shown(turn / kDegree)));
  QCOMPARE(b.doPlatesMeet(b.pose("cube")), !isSolid);
}

void DesktopSolidMovesTest::aRingStopsBetweenTwoPlates() {
  QFETCH(bool, isSolid);
  SolidDriver b(channel(), isSolid);
  b.select({"cube"});
  b.choose("gizmoTurn");
  QTRY_VERIFY(b.overlay().picture().has_value());
  const std::size_t steps = b.steps();
  int dragged = 0, met = 0;
  const ui::ShownPoses& poses = b.view().poses();
  QObject::connect(&poses, &ui::ShownPoses::changed, &b.view(), [&] {
    if (!poses.isDragged(b.partId("cube"))) return;
    ++dragged;
    met += b.doPlatesMeet(poses.poseOf(b.part("cube"))) ? 1 : 0;
  });
  // 70 degrees round the middle; the ring about y is seen as a circle from the front.
  const QPoint middle = b.seen(glm::dvec3(0.0)), from = b.handle(GizmoGrip::TurnY);
  const auto at = [&](double angle) {
    const QPointF arm = from - middle;
    return middle + QPointF(arm.x() * std::cos(angle) - arm.y() * std::sin(angle),
                            arm.x() * std::sin(angle) + arm.y() * std::cos(angle))
                        .toPoint();
  };
  static_cast<ViewDriver&>(b).press(from);
  for (int i = 1; i <= 35; ++i)
    b.moveTo(at(2.0 * i * kDegree));
  b.release(at(70.0 * kDegree));
  b.settle("cube");
  QCOMPARE(b.steps(), steps + 1);
  QVERIFY(dragged > 1);
  const glm::dvec3 turn = b.turnOf("cube");
  // Anticlockwise on paper is one sense, on a picture the other: either is a turn about y.
  const double wanted = isSolid ? channelAngle(b.margin) : 70.0 * kDegree;
  QVERIFY2(std::abs(std::abs(turn.y) - wanted) < (isSolid ? kAngleSlack : kDegree),
           qPrintable(shown(turn / kDegree)));
  QVERIFY(std::hypot(turn.x, turn.z) < 1e-3);
  QCOMPARE(met > 0, !isSolid);
  QVERIFY(isSolid != b.doPlatesMeet(b.pose("cube")));
}

void DesktopSolidMovesTest::severalTogetherStopWhereOneOfThemDoes_data() {
  QTest::addColumn<bool>("isByKey");
  QTest::addColumn<bool>("isFrontLast");
  QTest::addColumn<bool>("isSolid");
  for (const bool isByKey : {true, false}) {
    const char* how = isByKey ? "key" : "arrow";
    QTest::addRow("%s, the one in front leads, solid", how) << isByKey << true << true;
    QTest::addRow("%s, the one behind leads, solid", how) << isByKey << false << true;
    QTest::addRow("%s, not solid", how) << isByKey << true << false;
  }
}

void DesktopSolidMovesTest::severalTogetherStopWhereOneOfThemDoes() {
  QFETCH(bool, isByKey);
  QFETCH(bool, isFrontLast);
  QFETCH(bool, isSolid);
  // 15 mm are between the front one and a wall of 10 mm.
  SolidDriver b({{"wall", {0.01, 0.1, 0.1}, {0.03, 0, 0}},
                 {"front", glm::dvec3(0.02), glm::dvec3(0.0)},
                 {"behind", glm::dvec3(0.02), {-0.04, 0, 0}}},
                isSolid);
  isFrontLast ? b.select({"behind", "front"}) : b.select({"front", "behind"});
  const std::size_t steps = b.steps();
  if (isByKey) {
    b.type<ui::NumberField>("nudgeStep", "60");
    b.press(Qt::Key_Right);
  } else {
    QTRY_VERIFY(b.overlay().picture().has_value());
    const QPoint way = b.seen({0.06, 0, 0}) - b.seen(glm::dvec3(0.0));
    b.drag(b.handle(GizmoGrip::MoveX), {way.x(), 0});
  }
  b.settle("front");
  QCOMPARE(b.steps(), steps + 1);
  const glm::dvec3 front = b.pose("front").translation, behind = b.pose("behind").translation;
  if (isSolid) {
    QVERIFY2(glm::distance(front, {0.015 - b.margin, 0, 0}) < 0.1 * b.margin, qPrintable(shown(front)));
    QVERIFY(!b.doMeet("wall", "front") && !b.doMeet("wall", "behind"));
  } else {
    // Out on the other side, and the one behind nearly so.
    QVERIFY2(front.x > 0.05 && std::abs(front.z) < 1e-12, qPrintable(shown(front)));
  }
  QVERIFY(glm::distance(front, behind) < 1e-12);
  QVERIFY(glm::length(b.turnOf("front")) < 1e-12 && glm::length(b.turnOf("behind")) < 1e-12);
}

/// The selection was the first to tell that the part had left, and the tools put it where it had come to.
void DesktopSolidMovesTest::aPartThatLeavesWhileItSettlesIsPutNowhere() {
  SolidDriver b(channel(), true);
  QStringList failures;
  b.window().setFailureSink([&](const ui::Failure& failure) { failures << failure.summary; });
  b.select({"cube"});
  b.type<ui::NumberField>("nudgeStep", "100");
  b.press(Qt::Key_Up);
  const PartId cube = b.partId("cube");
  b.session().deletePart(cube);
  QCOMPARE(failures, QStringList());
  QVERIFY(!b.view().poses().isDragged(cube));
  QCOMPARE(QString::fromStdString(b.session().undoText()), QStringLiteral("Delete cube"));
}

NEARFIT_QT_SUITE(DesktopSolidMovesTest, runDesktopTest<DesktopSolidMovesTest>)
#include "desktop_solid_moves_test.moc"
