// Parts that are inserted, and kept on others by joints: made by clicks, held in drags and by numbers, shown, removed.
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QStatusBar>
#include <QToolButton>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "tests/app/desktop/view_pointer.h"
#include "ui/model/parts_model.h"
#include "ui/tools/placing/align_bar.h"
#include "ui/tools/placing/shown_joints.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The pointer stands on pixels, and edges are picked from a few away.
constexpr double kInside = 3e-4;
constexpr double kShank = 0.004, kBore = 0.0042, kPlateTop = 0.005;  ///< Radii and height [m].

/// A plate with a bore along z, and a bolt beside it that stands on its head, a little askew.
struct BoltBench {
  /// @param chamfer  Of the shank's end [m]; 0: none.
  explicit BoltBench(double chamfer = 0.0) {
    std::vector<glm::dvec2> profile{{kShank - chamfer, -0.03}};
    if (chamfer > 0.0) profile.emplace_back(kShank, -0.03 + chamfer);
    for (const glm::dvec2& corner :
         {glm::dvec2(kShank, 0.0), glm::dvec2(0.007, 0.0), glm::dvec2(0.007, 0.005)})
      profile.push_back(corner);
    d.add({writeOff(d.folder.path() / "plate.off", tubeMesh(kBore, 0.02, 2.0 * kPlateTop, 48)),
           writeOff(d.folder.path() / "bolt.off", turnedMesh(profile, 48))});
    [this] { QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2}); }();
    d.session().movePart(d.partId("bolt"), aside);
    mouse.look("viewIso");
    QTest::qWait(50);
  }
  /// Where the viewer sees the shank.
  glm::dvec3 onShank(double along) {
    glm::dvec3 towards = aside.inverse().applyToVector(-d.window().viewport().projection().away());
    towards.z = 0.0;
    return aside.applyToPoint(kShank * glm::normalize(towards) + glm::dvec3(0.0, 0.0, along));
  }
  glm::dvec3 underHead() { return onShank(-kInside); }
  glm::dvec3 besideBore() { return {0.0, kBore + kInside, kPlateTop}; }
  RigidTransform bolt() { return d.part("bolt").worldFromPart; }
  const std::vector<Joint>& joints() { return d.session().scene().joints(); }
  std::string undoText() { return d.session().undoText(); }
  const std::vector<ui::JointMark>& marks() { return d.window().findChild<ui::ShownJoints*>()->marks(); }
  void select(const char* name) { d.window().selection().select(d.partId(name)); }
  /// Keeps the shank on the axis of the bore by clicks.
  void keepOnAxis() {
    pressShortcut(d, Qt::Key_K);
    mouse.click(onShank(-0.02));
    mouse.click(besideBore());
    pressInView(d, Qt::Key_Return);
  }
  /// How far the bolt's axis is from that of the plate, which is not moved.
  double offAxis() {
    double most = 0.0;
    for (const double along : {-0.03, 0.01}) {
      const glm::dvec3 point = bolt().applyToPoint({0.0, 0.0, along});
      most = std::max(most, std::hypot(point.x, point.y));
    }
    return most;
  }
  QString note() { return d.window().statusBar()->currentMessage(); }

  DesktopDriver d;
  ViewPointer mouse{d};
  const RigidTransform aside{glm::angleAxis(std::numbers::pi - 0.2, glm::dvec3(1, 0, 0)), {0.05, 0.0, 0.0}};
};

/// How many pixels have about this colour.
int pixelsLike(const QColor& colour, const QImage& picture) {
  constexpr int kAway = 30;  // Shaded brass comes no nearer to olive.
  int count = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const QColor pixel = picture.pixelColor(x, y);
      if (std::abs(pixel.red() - colour.red()) < kAway && std::abs(pixel.green() - colour.green()) < kAway &&
          std::abs(pixel.blue() - colour.blue()) < kAway)
        ++count;
    }
  }
  return count;
}

}  // namespace

class DesktopJointsTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void insertsABoltInItsBoreByTwoClicksAsOneStepOfUndo();
  void anInsertedBoltIsKeptOnTheAxisIfThatIsChosen();
  void insertSaysThatAChamferHasNoFace();
  void escapeInsertsNothing();
  void eachJointHasItsOwnIconAndAPointIsNotFlipped();
  void aDragAcrossTheAxisMovesNothingAndOneAlongItDoes();
  void undoTakesJointAndMoveBackTogether();
  void aNumberThatTheJointDoesNotAllowIsSaidAndTakenBack();
  void withoutItsBaseThereIsNoJoint();
  void aJointIsShownAndInTheColourOfWarningsOnceItsPartHasLeftIt();
  void savedAndOpenedTheJointIsThere();
  void jointsAreTurnedOffAndOnAndRemoved();
  void theTreeTurnsJointsOffByTheirIcon();
  void thePosePanelNamesTheJointAndRemovesIt();
  void lockedPartsAndPartsWithThreeJointsAreRefused();
  void jointsThatContradictEachOtherAreNotMade();
  void aPartInHandIsKeptWhileItIsFelt();
  void thePanelSaysThatJointsContradictEachOther();
  void whatWasSaidOfAJointEndsWhenTheNextToolStarts();
};

void DesktopJointsTest::insertsABoltInItsBoreByTwoClicksAsOneStepOfUndo() {
  BoltBench b;
  const std::size_t steps = b.d.session().historyIndex();
  pressShortcut(b.d, Qt::Key_A, Qt::ShiftModifier);
  QVERIFY(b.d.action("insert")->isChecked());
  QVERIFY(!b.d.widget<QWidget>("alignFilter")->isVisible());
  b.mouse.hover(b.underHead());
  QTRY_VERIFY2(b.d.text("alignHint").startsWith(QStringLiteral("Circle ⌀ 8.0")) &&
                   b.d.text("alignHint").endsWith(QStringLiteral(" of bolt")),
               qPrintable(b.d.text("alignHint")));
  b.mouse.click(b.underHead());
  QVERIFY(b.d.text("alignPrompt").contains(QStringLiteral("round edge or bore")));
  b.mouse.click(b.besideBore());
  keepPictures(b.d.window(), QStringLiteral("insert"));
  // A preview is no change.
  QCOMPARE(b.d.session().historyIndex(), steps);
  pressInView(b.d, Qt::Key_Return);
  QCOMPARE(b.undoText(), std::string("Insert bolt"));
  QCOMPARE(b.d.session().historyIndex(), steps + 1);
  QVERIFY(glm::distance(b.bolt().translation, glm::dvec3(0.0, 0.0, kPlateTop)) < 1e-9);
  QVERIFY(glm::distance(b.bolt().applyToVector({0, 0, 1}), glm::dvec3(0, 0, 1)) < 1e-9);
  QVERIFY(b.joints().empty());
  b.d.choose("undo");
  QCOMPARE(b.bolt().translation, b.aside.translation);
}

void DesktopJointsTest::anInsertedBoltIsKeptOnTheAxisIfThatIsChosen() {
  BoltBench b;
  pressShortcut(b.d, Qt::Key_A, Qt::ShiftModifier);
  b.mouse.click(b.underHead());
  b.mouse.click(b.besideBore());
  QTest::mouseClick(b.d.widget<QCheckBox>("alignKeep"), Qt::LeftButton, {}, QPoint(8, 8));
  QVERIFY(b.d.widget<QCheckBox>("alignKeep")->isChecked());
  b.d.type<QDoubleSpinBox>("alignOffset", "2 mm");
  QTest::mouseClick(b.d.widget<QPushButton>("alignApply"), Qt::LeftButton);
  QCOMPARE(b.undoText(), std::string("Keep bolt on axis"));
  QCOMPARE(b.joints().size(), std::size_t{1});
  QVERIFY(glm::distance(b.bolt().translation, glm::dvec3(0.0, 0.0, kPlateTop + 0.002)) < 1e-9);
  // The choice is for one time.
  pressShortcut(b.d, Qt::Key_A, Qt::ShiftModifier);
  QVERIFY(!b.d.widget<QCheckBox>("alignKeep")->isChecked());
}

void DesktopJointsTest::insertSaysThatAChamferHasNoFace() {
  BoltBench b(0.001);
  pressShortcut(b.d, Qt::Key_A, Qt::ShiftModifier);
  // The edge between chamfer and shank.
  b.mouse.click(b.onShank(-0.029 + kInside));
  QVERIFY2(b.d.text("alignHint").startsWith(QStringLiteral("No flat face at this edge of bolt")),
           qPrintable(b.d.text("alignHint")));
  b.mouse.click(b.besideBore());
  QVERIFY2(b.d.text("alignHint").startsWith(QStringLiteral("No flat face at this edge: only the axes")),
           qPrintable(b.d.text("alignHint")));
  pressInView(b.d, Qt::Key_Escape);
  pressShortcut(b.d, Qt::Key_A, Qt::ShiftModifier);
  b.mouse.click(b.underHead());
  b.mouse.click(b.besideBore());
  QVERIFY2(!b.d.text("alignHint").contains(QStringLiteral("No flat face")),
           qPrintable(b.d.text("alignHint")));
}

void DesktopJointsTest::escapeInsertsNothing() {
  BoltBench b;
  const std::size_t steps = b.d.session().historyIndex();
  pressShortcut(b.d, Qt::Key_A, Qt::ShiftModifier);
  b.mouse.click(b.underHead());
  b.mouse.click(b.besideBore());
  pressInView(b.d, Qt::Key_Escape);
  QVERIFY(!b.d.action("insert")->isChecked());
  QCOMPARE(b.d.session().historyIndex(), steps);
  QCOMPARE(b.bolt().translation, b.aside.translation);
}

void DesktopJointsTest::eachJointHasItsOwnIconAndAPointIsNotFlipped() {
  DesktopDriver d;
  d.addCubes();
  const auto pictureOf = [&](const char* name) { return d.action(name)->icon().pixmap(24).toImage(); };
  const QImage axis = pictureOf("keepOnAxis"), plane = pictureOf("keepInPlane"),
               point = pictureOf("keepToPoint");
  QVERIFY(axis != plane && plane != point && point != axis);
  for (const QImage& picture : {axis, plane, point})
    QVERIFY(!picture.isNull());
  ui::AlignBar bar(&d.window().viewport());
  bar.show();
  const auto* flip = bar.findChild<QCheckBox*>(QStringLiteral("alignFlip"));
  bar.showPair(ui::AlignBar::Options{false, false, false});
  QVERIFY(flip->isHidden());
  bar.showPair(ui::AlignBar::Options{true, false, false});
  QVERIFY(!flip->isHidden());
}

void DesktopJointsTest::aDragAcrossTheAxisMovesNothingAndOneAlongItDoes() {
  BoltBench b;
  b.keepOnAxis();
  QCOMPARE(b.undoText(), std::string("Keep bolt on axis"));
  QCOMPARE(b.joints().size(), std::size_t{1});
  QVERIFY2(b.offAxis() < 1e-9, qPrintable(QString::number(b.offAxis())));
  QTRY_VERIFY(b.mouse.overlay().isVisible() && b.mouse.overlay().picture());
  const std::size_t steps = b.d.session().historyIndex();
  const RigidTransform before = b.bolt();
  const QPoint from = b.mouse.handle(GizmoGrip::MoveX);
  b.mouse.press(from);
  b.mouse.moveTo(from + QPoint(30, 10));
  b.mouse.moveTo(from + QPoint(60, 20));
  QVERIFY2(b.d.widget<QWidget>("dragReadout")->isVisible(), "the drag is under way");
  b.mouse.release(from + QPoint(60, 20));
  QCOMPARE(b.bolt().translation, before.translation);
  QCOMPARE(b.d.session().historyIndex(), steps);
  b.mouse.drag(b.mouse.handle(GizmoGrip::MoveZ), {0, -60});
  QVERIFY(b.bolt().translation.z - before.translation.z > 1e-3);
  QVERIFY(b.offAxis() < 1e-9);
  QCOMPARE(b.d.session().historyIndex(), steps + 1);
}

void DesktopJointsTest::undoTakesJointAndMoveBackTogether() {
  BoltBench b;
  b.keepOnAxis();
  QCOMPARE(b.joints().size(), std::size_t{1});
  b.d.choose("undo");
  QVERIFY(b.joints().empty());
  QCOMPARE(b.bolt().translation, b.aside.translation);
  b.d.choose("redo");
  QCOMPARE(b.joints().size(), std::size_t{1});
  QVERIFY(b.offAxis() < 1e-9);
}

void DesktopJointsTest::aNumberThatTheJointDoesNotAllowIsSaidAndTakenBack() {
  BoltBench b;
  b.keepOnAxis();
  b.select("bolt");
  const std::size_t steps = b.d.session().historyIndex();
  const RigidTransform before = b.bolt();
  b.d.type<QDoubleSpinBox>("positionX", "7 mm");
  QVERIFY2(b.note().contains(QStringLiteral("bolt is kept on axis of plate")), qPrintable(b.note()));
  QCOMPARE(b.d.session().historyIndex(), steps);
  QVERIFY(std::abs(b.d.widget<QDoubleSpinBox>("positionX")->value()) < 1e-4);
  b.d.type<QDoubleSpinBox>("positionZ", "7 mm");
  QVERIFY(std::abs(b.bolt().translation.z - 0.007) < 1e-9);
  QVERIFY(b.bolt().translation.z != before.translation.z && b.offAxis() < 1e-9);
  // An arrow key steps to the right, which is across.
  const glm::dvec3 there = b.bolt().translation;
  b.d.window().viewport().setFocus();
  pressInView(b.d, Qt::Key_Right);
  QVERIFY(glm::distance(b.bolt().translation, there) < 1e-9);
}

void DesktopJointsTest::withoutItsBaseThereIsNoJoint() {
  BoltBench b;
  b.keepOnAxis();
  b.select("plate");
  b.d.choose("remove");
  QCOMPARE(b.d.session().scene().parts().size(), std::size_t{1});
  QVERIFY(b.joints().empty());
  QVERIFY(b.marks().empty());
  b.d.choose("undo");
  QCOMPARE(b.joints().size(), std::size_t{1});
}

void DesktopJointsTest::aJointIsShownAndInTheColourOfWarningsOnceItsPartHasLeftIt() {
  BoltBench b;
  const QColor kept = ui::themed(ui::colours::kJoint), left = ui::themed(ui::colours::kWarning);
  constexpr int kMin = 40;  ///< Pixels of a line.
  b.select("bolt");
  b.keepOnAxis();
  b.d.window().selection().select(std::nullopt);
  QVERIFY(b.marks().empty());
  const QImage without = b.d.picture();
  b.select("bolt");
  QCOMPARE(b.marks().size(), std::size_t{1});
  QVERIFY(!b.marks().front().strayed);
  QVERIFY(std::abs(std::abs(b.marks().front().direction.z) - 1.0) < 1e-9);
  keepPictures(b.d.window(), QStringLiteral("joint"));
  QVERIFY(pixelsLike(kept, b.d.picture()) > pixelsLike(kept, without) + kMin);
  // The plate goes, and takes along nothing.
  b.d.session().movePart(b.d.partId("plate"), {{1, 0, 0, 0}, {0.0, 0.01, 0.0}});
  QVERIFY(b.marks().size() == 1 && b.marks().front().strayed);
  QVERIFY(pixelsLike(left, b.d.picture()) > pixelsLike(left, without) + kMin);
  keepPictures(b.d.window(), QStringLiteral("joint-left"));
}

void DesktopJointsTest::savedAndOpenedTheJointIsThere() {
  BoltBench b;
  b.keepOnAxis();
  const Joint before = b.joints().front();
  const std::filesystem::path file = b.d.folder.path() / "kept.nearfit";
  b.d.session().save(file);
  b.d.session().reset();
  b.d.window().document().openScene(QString::fromStdString(file.string()));
  QTRY_COMPARE(b.joints().size(), std::size_t{1});
  const Joint after = b.joints().front();
  QVERIFY(after.kind == JointKind::OnAxis && after.isOn);
  QVERIFY(glm::distance(after.onPart.point, before.onPart.point) < 1e-12);
  QVERIFY(glm::distance(after.onBase.direction, before.onBase.direction) < 1e-12);
  QVERIFY(after.part == b.d.partId("bolt") && after.base == b.d.partId("plate"));
  b.select("bolt");
  QVERIFY(b.marks().size() == 1 && !b.marks().front().strayed);
}

void DesktopJointsTest::jointsAreTurnedOffAndOnAndRemoved() {
  BoltBench b;
  b.select("bolt");
  QVERIFY(!b.d.action("removeJoint")->isEnabled() && !b.d.action("turnJoint")->isEnabled());
  b.keepOnAxis();
  b.select("bolt");
  QCOMPARE(b.d.action("turnJoint")->text(), QStringLiteral("&Turn off joint"));
  b.d.choose("turnJoint");
  QVERIFY(!b.joints().front().isOn);
  QCOMPARE(b.undoText(), std::string("Turn off joint of bolt"));
  QVERIFY(b.marks().empty());
  // It holds no more.
  b.d.type<QDoubleSpinBox>("positionX", "7 mm");
  QVERIFY(std::abs(b.bolt().translation.x - 0.007) < 1e-12);
  QCOMPARE(b.d.action("turnJoint")->text(), QStringLiteral("&Turn on joint"));
  b.d.choose("turnJoint");
  // The part stays where it is, off the joint.
  QVERIFY(b.joints().front().isOn && b.marks().front().strayed);
  pressShortcut(b.d, Qt::Key_Delete, Qt::ShiftModifier);
  QVERIFY(b.joints().empty());
  QCOMPARE(b.undoText(), std::string("Remove joint of bolt"));
  QCOMPARE(b.d.session().scene().parts().size(), std::size_t{2});
}

void DesktopJointsTest::theTreeTurnsJointsOffByTheirIcon() {
  BoltBench b;
  QVERIFY(b.d.partsView()->isColumnHidden(ui::PartsModel::Joints));
  b.keepOnAxis();
  QVERIFY(!b.d.partsView()->isColumnHidden(ui::PartsModel::Joints));
  b.d.clickPart(1, ui::PartsModel::Joints);
  QVERIFY(!b.joints().front().isOn);
  b.d.clickPart(1, ui::PartsModel::Joints);
  QVERIFY(b.joints().front().isOn);
  // The plate has none.
  b.d.clickPart(0, ui::PartsModel::Joints);
  QCOMPARE(b.undoText(), std::string("Turn on joint of bolt"));
}

void DesktopJointsTest::thePosePanelNamesTheJointAndRemovesIt() {
  BoltBench b;
  b.select("bolt");
  QVERIFY(!b.d.widget<QLabel>("joints")->isVisible());
  b.keepOnAxis();
  b.select("bolt");
  QVERIFY(b.d.widget<QLabel>("joints")->isVisible());
  QCOMPARE(b.d.text("joints"), QStringLiteral("Kept on axis of plate"));
  QTest::mouseClick(b.d.widget<QToolButton>("removeJoints"), Qt::LeftButton);
  QVERIFY(b.joints().empty());
  QVERIFY(!b.d.widget<QLabel>("joints")->isVisible());
}

void DesktopJointsTest::lockedPartsAndPartsWithThreeJointsAreRefused() {
  BoltBench b;
  b.d.session().setLocked(b.d.partId("bolt"), true);
  pressShortcut(b.d, Qt::Key_K);
  b.mouse.hover(b.onShank(-0.02));
  QTRY_VERIFY2(b.d.text("alignHint").contains(QStringLiteral("bolt is locked")),
               qPrintable(b.d.text("alignHint")));
  pressInView(b.d, Qt::Key_Escape);
  b.d.session().setLocked(b.d.partId("bolt"), false);
  Joint joint;
  joint.part = b.d.partId("bolt");
  joint.base = b.d.partId("plate");
  for (int i = 0; i < 3; ++i)
    b.d.session().addJoint(joint, b.aside);
  pressShortcut(b.d, Qt::Key_K);
  b.mouse.hover(b.onShank(-0.02));
  QTRY_VERIFY2(b.d.text("alignHint").contains(QStringLiteral("bolt has 3 joints already")),
               qPrintable(b.d.text("alignHint")));
  b.mouse.click(b.onShank(-0.02));
  QVERIFY(b.d.text("alignPrompt").contains(QStringLiteral("of the part to keep")));
}

void DesktopJointsTest::jointsThatContradictEachOtherAreNotMade() {
  DesktopDriver d;
  d.addCubes();
  ViewPointer mouse(d);
  mouse.look("viewFront");
  // Held at a point, its front can lie in no plane that is farther from the point than any of its own.
  Joint held;
  held.kind = JointKind::ToPoint;
  held.part = d.partId("moving");
  held.base = d.partId("fixed");
  held.onPart.point = held.onBase.point = {0.0, 0.5, 0.0};
  d.session().addJoint(held, d.part("moving").worldFromPart);
  const std::size_t steps = d.session().historyIndex();
  pressShortcut(d, Qt::Key_K, Qt::ShiftModifier);
  // 0.51 m from that point; the other is 0.52 m away.
  mouse.click({0.003, -0.01, 0.036});
  mouse.click({-0.01, -0.02, 0.005});
  QVERIFY(d.widget<QLabel>("alignHint")->styleSheet().contains(ui::colours::kWarning.name()));
  QVERIFY2(d.text("alignHint").contains(QStringLiteral("Contradicts other joints of moving")),
           qPrintable(d.text("alignHint")));
  QVERIFY(!d.widget<QPushButton>("alignApply")->isEnabled());
  pressInView(d, Qt::Key_Return);
  QCOMPARE(d.session().historyIndex(), steps);
  QVERIFY(d.action("keepInPlane")->isChecked());
}

void DesktopJointsTest::aPartInHandIsKeptWhileItIsFelt() {
  DesktopDriver d;
  d.addCubes();
  ViewPointer mouse(d);
  mouse.look("viewFront");
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(d.felt.has_value());
  QTRY_VERIFY(!d.action("align")->isEnabled() && d.action("keepInPlane")->isEnabled());
  pressShortcut(d, Qt::Key_K, Qt::ShiftModifier);
  mouse.click({0.003, -0.01, 0.036});
  mouse.click({-0.01, -0.02, 0.005});
  // Both fronts look at the viewer.
  QTest::mouseClick(d.widget<QCheckBox>("alignFlip"), Qt::LeftButton, {}, QPoint(8, 8));
  QTest::mouseClick(d.widget<QPushButton>("alignApply"), Qt::LeftButton);
  QCOMPARE(d.session().scene().joints().size(), std::size_t{1});
  QVERIFY(d.application.servo().isRunning());
  // 10 mm towards the viewer, where the hand is not.
  QTRY_VERIFY2(std::abs(d.felt->translation.y + 0.01) < 1e-5,
               qPrintable(QString::number(d.felt->translation.y)));
  d.choose("stop");
  QTRY_VERIFY(std::abs(d.part("moving").worldFromPart.translation.y + 0.01) < 1e-5);
}

/// A base that is moved can pull two joints apart; nothing said that none holds any more.
void DesktopJointsTest::thePanelSaysThatJointsContradictEachOther() {
  DesktopDriver d;
  d.addCubes();
  Joint toFixed;
  toFixed.kind = JointKind::ToPoint;
  toFixed.part = d.partId("moving");
  toFixed.base = d.partId("fixed");
  toFixed.onBase.point = d.part("fixed").worldFromPart.inverse().applyToPoint({0.0, 0.0, 0.0});
  Joint toWorld = toFixed;
  toWorld.base = std::nullopt;
  toWorld.onBase.point = {0.0, 0.0, 0.0};
  toFixed.onPart.point = toWorld.onPart.point =
      d.part("moving").worldFromPart.inverse().applyToPoint({0.0, 0.0, 0.0});
  d.session().addJoint(toFixed, d.part("moving").worldFromPart);
  d.session().addJoint(toWorld, d.part("moving").worldFromPart);
  const RigidTransform before = d.part("fixed").worldFromPart;
  RigidTransform away = before;
  away.translation.x += 0.02;
  d.session().movePart(d.partId("fixed"), away);
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY2(d.text("noticeText").contains(QStringLiteral("contradict each other")),
               qPrintable(d.text("noticeText")));
  d.session().movePart(d.partId("fixed"), before);
  QTRY_VERIFY2(!d.text("noticeText").contains(QStringLiteral("contradict")),
               qPrintable(d.text("noticeText")));
}

/// It stayed while the next tool ran, which changes nothing of the scene until it is done.
void DesktopJointsTest::whatWasSaidOfAJointEndsWhenTheNextToolStarts() {
  BoltBench b;
  b.keepOnAxis();
  QTest::qWait(50);
  QVERIFY2(b.note().contains(QStringLiteral("Kept on axis of plate")), qPrintable(b.note()));
  pressShortcut(b.d, Qt::Key_M);
  QVERIFY(b.d.action("measure")->isChecked());
  QCOMPARE(b.note(), QString());
}

NEARFIT_QT_SUITE(DesktopJointsTest, runDesktopTest<DesktopJointsTest>)
#include "desktop_joints_test.moc"
