// Orthographic projection and the scale bar in the window: switched, kept between runs, and worked with.
#include <QImage>
#include <QTreeWidget>
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <vtkCamera.h>

#include "tests/app/desktop/view_pointer.h"
#include "ui/model/selection.h"
#include "ui/view3d/scale_bar.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The two cubes from the front, in orthographic projection, the moving one selected.
struct Flat : ViewPointer {
  explicit Flat(DesktopDriver& d) : ViewPointer(d) {
    d.addCubes();
    d.window().selection().select(d.partId("moving"));
    look("viewFront");
    const int before = view().pictureCount();
    pressShortcut(d, Qt::Key_5);
    // The gizmo follows with the picture.
    QTRY_VERIFY(view().pictureCount() > before);
    QTRY_VERIFY(overlay().picture().has_value());
  }
  double pixel() { return view().projection().metresPerPixel({0.0, 0.0, 0.0}); }
};

ui::ScaleBar& scaleBar(DesktopDriver& d) {
  return *d.window().findChild<ui::ScaleBar*>();
}

}  // namespace

class DesktopOrthographicTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void aKeySwitchesItAndItIsRemembered();
  void theKeyIsListed();
  void anArrowMovesThePartWithThePointer();
  void thePartItselfMovesInTheScreensPlane();
  void aBoxAndAClickSelectWhatIsSeen();
  void standardViewsStayOrthographicAndFit();
  void theScaleBarIsRememberedToo();
  void theScaleBarFollowsTheUnitOfLength();
  void theScaleBarFollowsTheTheme();
  void anEmptySceneHasNoScaleBar();
};

void DesktopOrthographicTest::aKeySwitchesItAndItIsRemembered() {
  {
    DesktopDriver d;
    d.addCubes();
    QVERIFY(!d.window().viewport().projection().isParallel());
    pressShortcut(d, Qt::Key_5);
    QVERIFY(d.action("orthographic")->isChecked());
    QVERIFY(d.window().viewport().projection().isParallel());
  }
  DesktopDriver d;
  QVERIFY(d.action("orthographic")->isChecked());
  QVERIFY(d.window().viewport().projection().isParallel());
  d.addCubes();
  // The scene that opens is fitted.
  const ViewProjection view = d.window().viewport().projection();
  const glm::dvec2 top = view.pixelOf({0.0, 0.0, 0.045}).value(),
                   low = view.pixelOf({0.0, 0.0, -0.02}).value();
  const double share = glm::distance(top, low) / d.window().viewport().height();
  QVERIFY2(share > 0.3 && share < 1.0, qPrintable(QString::number(share)));
  d.choose("orthographic");
  QVERIFY(!d.window().viewport().projection().isParallel());
  DesktopDriver again;
  QVERIFY(!again.action("orthographic")->isChecked());
}

void DesktopOrthographicTest::theKeyIsListed() {
  DesktopDriver d;
  pressShortcut(d, Qt::Key_F1);
  QTRY_VERIFY(d.widget<QDialog>("shortcutsDialog")->isVisible());
  QTest::keyClicks(d.widget<QLineEdit>("shortcutSearch"), QStringLiteral("orthographic"));
  QStringList shown;
  for (QTreeWidgetItemIterator it(d.widget<QTreeWidget>("shortcutList"), QTreeWidgetItemIterator::NotHidden);
       *it != nullptr; ++it) {
    if ((*it)->childCount() == 0) shown << (*it)->text(0) + '|' + (*it)->text(1);
  }
  QCOMPARE(shown, QStringList{QStringLiteral("Orthographic|5")});
  QTest::keyClick(d.widget<QDialog>("shortcutsDialog"), Qt::Key_Escape);
}

void DesktopOrthographicTest::anArrowMovesThePartWithThePointer() {
  DesktopDriver d;
  Flat flat(d);
  const glm::dvec3 before = d.part("moving").worldFromPart.translation;
  flat.drag(flat.handle(GizmoGrip::MoveX), {60, -25});
  const glm::dvec3 way = d.part("moving").worldFromPart.translation - before;
  QVERIFY2(std::abs(way.x - 60.0 * flat.pixel()) < 1e-9, qPrintable(QString::number(way.x / flat.pixel())));
  QCOMPARE(way.y, 0.0);
  QCOMPARE(way.z, 0.0);
}

void DesktopOrthographicTest::thePartItselfMovesInTheScreensPlane() {
  DesktopDriver d;
  Flat flat(d);
  const glm::dvec3 before = d.part("moving").worldFromPart.translation;
  // A place of its face that no handle covers.
  flat.drag(flat.seen({-0.008, -0.01, 0.027}), {-70, 44});
  const glm::dvec3 way = d.part("moving").worldFromPart.translation - before;
  QVERIFY2(std::abs(way.x + 70.0 * flat.pixel()) < 1e-9, qPrintable(QString::number(way.x / flat.pixel())));
  QVERIFY2(std::abs(way.z + 44.0 * flat.pixel()) < 1e-9, qPrintable(QString::number(way.z / flat.pixel())));
  QVERIFY(std::abs(way.y) < 1e-12);
}

void DesktopOrthographicTest::aBoxAndAClickSelectWhatIsSeen() {
  DesktopDriver d;
  Flat flat(d);
  const ui::Selection& selection = d.window().selection();
  flat.click({-0.015, -0.02, -0.015});
  QVERIFY(selection.parts() == std::vector{d.partId("fixed")});
  pressInView(d, Qt::Key_B);
  const QPoint upper = flat.seen({-0.01, -0.01, 0.045}), lower = flat.seen({0.01, -0.01, 0.025});
  flat.drag(upper - QPoint(6, 6), lower + QPoint(6, 2) - (upper - QPoint(6, 6)));
  QVERIFY(selection.parts() == std::vector{d.partId("moving")});
}

void DesktopOrthographicTest::standardViewsStayOrthographicAndFit() {
  DesktopDriver d;
  Flat flat(d);
  for (const char* name : {"viewIso", "viewRight", "viewTop", "viewFront", "fit"}) {
    flat.view().camera()->SetParallelScale(0.5);
    flat.look(name);
    QVERIFY(flat.view().projection().isParallel());
    double most = 0.0;
    for (const double x : {-0.02, 0.02}) {
      for (const double y : {-0.02, 0.02}) {
        for (const double z : {-0.02, 0.045}) {
          const glm::dvec2 pixel = flat.view().projection().pixelOf({x, y, z}).value();
          const glm::dvec2 middle = flat.view().projection().middle();
          most = std::max({most, std::abs(pixel.x / middle.x - 1.0), std::abs(pixel.y / middle.y - 1.0)});
        }
      }
    }
    QVERIFY2(most > 0.9 && most <= 1.0, name);
  }
}

void DesktopOrthographicTest::theScaleBarIsRememberedToo() {
  {
    DesktopDriver d;
    d.addCubes();
    QTRY_VERIFY(scaleBar(d).isVisible());
    d.choose("scaleBar");
    QVERIFY(!scaleBar(d).isVisible());
  }
  DesktopDriver d;
  d.addCubes();
  const int before = d.window().viewport().pictureCount();
  QTRY_VERIFY(d.window().viewport().pictureCount() > before);
  QVERIFY(!d.action("scaleBar")->isChecked());
  QVERIFY(!scaleBar(d).isVisible());
  d.choose("scaleBar");
  QTRY_VERIFY(scaleBar(d).isVisible());
}

void DesktopOrthographicTest::theScaleBarFollowsTheUnitOfLength() {
  DesktopDriver d;
  d.addCubes();
  QTRY_VERIFY(scaleBar(d).isVisible());
  QVERIFY(scaleBar(d).text().endsWith(QStringLiteral(" mm")));
  d.choose("unit-in");
  QVERIFY(scaleBar(d).text().endsWith(QStringLiteral(" in")));
  d.choose("unit-mm");
}

void DesktopOrthographicTest::theScaleBarFollowsTheTheme() {
  DesktopDriver d;
  d.addCubes();
  QTRY_VERIFY(scaleBar(d).isVisible());
  d.choose("themeLight");
  const QImage light = scaleBar(d).grab().toImage();
  d.choose("themeDark");
  const QImage dark = scaleBar(d).grab().toImage();
  QVERIFY(light != dark);
  keepPictures(d.window(), QStringLiteral("scale-bar"));
  d.choose("themeLight");
  QVERIFY(scaleBar(d).grab().toImage() == light);
}

void DesktopOrthographicTest::anEmptySceneHasNoScaleBar() {
  DesktopDriver d;
  QVERIFY(!scaleBar(d).isVisible());
  d.addCubes();
  QTRY_VERIFY(scaleBar(d).isVisible());
  d.session().reset();
  QTRY_VERIFY(!scaleBar(d).isVisible());
}

NEARFIT_QT_SUITE(DesktopOrthographicTest, runDesktopTest<DesktopOrthographicTest>)
#include "desktop_orthographic_test.moc"
