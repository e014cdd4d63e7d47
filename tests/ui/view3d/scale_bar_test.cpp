#include "ui/view3d/scale_bar.h"

#include <QtTest>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <vtkCamera.h>

#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"

using namespace nearfit;

namespace {

/// A cube in a view with its scale bar.
struct CubeView {
  CubeView() {
    Scene scene;
    cube = scene.add(test::partOf(test::freshGeometryOf(test::boxMesh(glm::dvec3(0.05))), "cube"));
    session.reset(scene);
    view.resize(640, 400);
    view.setScaleBarVisible(true);
    view.setScene(session.scene());
    view.show();
    QVERIFY(QTest::qWaitForWindowExposed(&view));
    draw();
  }
  void draw() {
    view.completePicture();
    QCoreApplication::processEvents();
  }
  ui::ScaleBar& bar() { return *view.findChild<ui::ScaleBar*>(); }
  /// The view shows two points at the depth of the focal point, as far apart as the bar is long, this far
  /// apart [pixels].
  double apart() {
    const ViewProjection projection = view.projection();
    const double* p = view.camera()->GetFocalPoint();
    const glm::dvec3 half = 0.5 * bar().length() * projection.right(), focus(p[0], p[1], p[2]);
    return glm::distance(projection.pixelOf(focus - half).value(), projection.pixelOf(focus + half).value());
  }

  Session session;
  ui::Selection selection{session};
  ui::ShownPoses poses{session};
  ui::Viewport view{std::make_shared<ui::PartShapeCache>(), selection, poses};
  PartId cube{};
};

/// True for 1, 2 and 5 times a power of ten.
bool isRound(double number) {
  const double power = std::pow(10.0, std::floor(std::log10(number) + 1e-9));
  const double first = number / power;
  return std::abs(first - 1.0) < 1e-6 || std::abs(first - 2.0) < 1e-6 || std::abs(first - 5.0) < 1e-6;
}

}  // namespace

class ScaleBarTest : public QObject {
  Q_OBJECT

 private slots:
  void cleanup() { ui::setShownLengthUnit(ui::LengthUnit::Millimetre); }
  void isAsLongAsTheViewShowsItsLength();
  void isRoundInTheUnitThatIsShown();
  void isOffUntilItIsWanted();
  void isHiddenWhereNothingIsToBeSeen();
  void staysInTheCornerOfTheView();
};

void ScaleBarTest::isAsLongAsTheViewShowsItsLength() {
  CubeView b;
  for (const bool isOrthographic : {false, true}) {
    b.view.setOrthographic(isOrthographic);
    for (const auto view : {ui::StandardView::Isometric, ui::StandardView::Front}) {
      b.view.setView(view);
      for (const double zoom : {1.0, 3.7, 41.0}) {
        isOrthographic ? b.view.camera()->SetParallelScale(b.view.camera()->GetParallelScale() / zoom)
                       : b.view.camera()->Dolly(zoom);
        b.draw();
        QVERIFY(b.bar().isVisible());
        QVERIFY(b.bar().pixels() > 30.0);
        QVERIFY2(std::abs(b.apart() - b.bar().pixels()) < 1e-6,
                 qPrintable(QStringLiteral("%1 and %2").arg(b.apart()).arg(b.bar().pixels())));
        QCOMPARE(b.bar().text(), ui::formatRoundLength(b.bar().length()));
      }
    }
  }
}

void ScaleBarTest::isRoundInTheUnitThatIsShown() {
  CubeView b;
  for (const ui::LengthUnit unit : ui::kLengthUnits) {
    ui::setShownLengthUnit(unit);
    QVERIFY2(isRound(b.bar().length() / ui::metresOf(unit)), qPrintable(b.bar().text()));
    QVERIFY2(b.bar().text().endsWith(ui::symbolOf(unit)), qPrintable(b.bar().text()));
    QVERIFY(std::abs(b.apart() - b.bar().pixels()) < 1e-6);
  }
}

void ScaleBarTest::isOffUntilItIsWanted() {
  CubeView b;
  b.view.setScaleBarVisible(false);
  b.draw();
  QVERIFY(!b.bar().isVisible());
  b.view.setScaleBarVisible(true);
  QVERIFY(b.bar().isVisible());
}

void ScaleBarTest::isHiddenWhereNothingIsToBeSeen() {
  CubeView b;
  b.session.setVisible(b.cube, false);
  b.view.setScene(b.session.scene());
  b.draw();
  QVERIFY(!b.bar().isVisible());
  b.session.setVisible(b.cube, true);
  b.view.setScene(b.session.scene());
  b.draw();
  QVERIFY(b.bar().isVisible());
}

void ScaleBarTest::staysInTheCornerOfTheView() {
  CubeView b;
  const auto isInCorner = [&b] {
    const QRect corner = b.bar().geometry();
    return b.view.rect().contains(corner) && corner.right() > b.view.width() - 20 &&
           corner.bottom() > b.view.height() - 20;
  };
  QVERIFY(isInCorner());
  b.view.resize(500, 330);
  QTRY_VERIFY(isInCorner());
}

NEARFIT_QT_SUITE(ScaleBarTest, [](int argc, char** argv) {
  ui::Viewport::setDefaultSurfaceFormat();
  return test::runQtTest<ScaleBarTest>(argc, argv);
})
#include "scale_bar_test.moc"
