// A peg is put into its hole by hand in the window: flats cut into thousands of triangles neither hold it nor let it in.
#include <QComboBox>
#include <QDoubleSpinBox>

#include <glm/gtc/quaternion.hpp>

#include "tests/app/desktop/view_driver.h"
#include "ui/model/hand_state.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

constexpr double kPegMargin = 1e-4;  ///< Of a new scene [m].
/// Between the peg and each wall of its hole [m].
constexpr double kPegPlay = 0.3e-3;
/// How far beside the hole the peg is at first: it stands on the tray [m].
constexpr double kPegAside = 12e-3;
/// Upper face of the tray, below the peg's lower end [m].
constexpr double kTrayTop = -1e-3;
/// With the peg put in, its middle, where the hand pulls, is within the hole: it leans flat on the wall [m].
constexpr double kTrayHeight = 30e-3;

TriangleMesh cutIntoThousands(const TriangleMesh& mesh) {
  return cutUnevenly(subdivided(mesh, 5), 200, 7);
}

/// A square peg of 16 mm above a tray with a hole for it.
struct Peg {
  Peg() : mouse(d) {
    const double hole = std::numbers::sqrt2 * (8e-3 + kPegPlay);
    const RigidTransform turned{glm::angleAxis(0.25 * std::numbers::pi, glm::dvec3(0, 0, 1)),
                                {0.0, 0.0, kTrayTop - 0.5 * kTrayHeight}};
    d.add({writeOff(d.folder.path() / "tray.off",
                    cutIntoThousands(transformed(tubeMesh(hole, 42e-3, kTrayHeight, 4), 1.0, turned))),
           writeOff(d.folder.path() / "peg.off",
                    cutIntoThousands(boxMesh({16e-3, 16e-3, 40e-3}, {kPegAside, 0.0, 20e-3})))});
    const auto areBoth = [this] { return d.session().scene().parts().size() == 2; };
    if (!QTest::qWaitFor(areBoth, 30'000)) throw Error("peg", "the parts are not there");
    d.session().setMovingPart(d.partId("peg"));
    QObject::connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, &d.window(),
                     [this](const ServoSnapshot& snapshot) { newest = snapshot; });
    mouse.look("viewFront");
    d.startWith(ui::Hand::Manual);
  }
  void step(const char* millimetres, Qt::Key key, int times) {
    d.type<QDoubleSpinBox>("nudgeStep", millimetres);
    mouse.view().setFocus();
    for (int i = 0; i < times; ++i)
      pressInView(d, key);
  }
  bool isAt(double height) const { return isNear(newest.proxy.translation.z, height, 0.3 * kPegMargin); }

  DesktopDriver d;
  ViewDriver mouse;
  ServoSnapshot newest;
};

}  // namespace

class DesktopPegTest : public QObject {
  Q_OBJECT

 private slots:
  void thePegGoesIntoItsHoleByKeysAndMouse();
};

void DesktopPegTest::thePegGoesIntoItsHoleByKeysAndMouse() {
  Peg p;
  p.step("1", Qt::Key_PageDown, 3);
  QTRY_VERIFY(p.isAt(kTrayTop + kPegMargin));
  QVERIFY(p.newest.contactCount > 0);
  QVERIFY2(!p.newest.isTruncated, "flats say no more than their corners");
  keepPictures(p.d.window(), QStringLiteral("peg-on-rim"));
  // Led along the tray under that pressure it does not stick.
  p.step("1", Qt::Key_Left, 2);
  QTRY_VERIFY(isNear(p.newest.handle.translation.x, -2e-3, 1e-9));
  QTRY_VERIFY(isNear(p.newest.proxy.translation.x, -2e-3, 1e-5));
  QVERIFY(p.isAt(kTrayTop + kPegMargin));
  p.step("1", Qt::Key_PageUp, 4);
  QTRY_VERIFY(p.isAt(1e-3));
  p.step("1", Qt::Key_Left, 10);
  QTRY_VERIFY(isNear(p.newest.proxy.translation.x, -kPegAside, 1e-5));
  p.step("1", Qt::Key_PageDown, 27);
  QTRY_VERIFY(p.isAt(-26e-3));
  QVERIFY(isNear(p.newest.proxy.translation.x, -kPegAside, kPegPlay));
  keepPictures(p.d.window(), QStringLiteral("peg-in-hole"));
  // The mouse presses it against the wall and lifts: it leans there, and comes along the wall with the hand.
  const QPoint middle = p.mouse.view().rect().center();
  p.mouse.drag(middle, {30, -20}, Qt::ShiftModifier);
  const auto handle = [&] { return p.newest.handle.translation; };
  const auto part = [&] { return p.newest.proxy.translation; };
  QTRY_VERIFY(handle().x > -kPegAside + 1e-3 && handle().z > -25.9e-3);
  QTRY_VERIFY(p.newest.contactCount > 0 && isNear(part().z, handle().z, 0.1 * kPegMargin));
  QVERIFY(isNear(part().x, -kPegAside, kPegPlay));
  QVERIFY(p.newest.distance > 0.5 * kPegMargin);
  keepPictures(p.d.window(), QStringLiteral("peg-pressed-aside"));
}

NEARFIT_QT_SUITE(DesktopPegTest, runDesktopTest<DesktopPegTest>)
#include "desktop_peg_test.moc"
