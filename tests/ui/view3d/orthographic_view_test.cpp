// The view in orthographic projection: what is drawn, picked and fitted, and the way there and back.
#include <QImage>
#include <QWheelEvent>
#include <QtTest>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>

#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/viewport.h"

using namespace nearfit;

namespace {

/// Half the extents of a bar, and how far its middle is beside the origin [m].
const glm::dvec3 kHalf(0.01, 0.1, 0.01);
constexpr double kBeside = 0.04;
/// Pixels by which smoothed lines at the edges of both bars may go beyond them.
constexpr double kLines = 10.0;

/// Two long bars side by side, along the sight of the front view.
struct Bars {
  Bars() {
    const PartGeometryPtr bar = test::freshGeometryOf(test::boxMesh(2.0 * kHalf));
    Scene scene;
    left = scene.add(test::partOf(bar, "left", {{1, 0, 0, 0}, {-kBeside, 0, 0}}));
    right = scene.add(test::partOf(bar, "right", {{1, 0, 0, 0}, {kBeside, 0, 0}}));
    session.reset(scene);
    view.resize(640, 400);
    view.setScene(session.scene());
    view.show();
    QVERIFY(QTest::qWaitForWindowExposed(&view));
    QTRY_VERIFY(view.pictureCount() > 0);
  }

  QImage picture() {
    view.completePicture();
    return view.grabFramebuffer().convertToFormat(QImage::Format_RGB32);
  }
  /// Number of pixels of the view's middle row that the bars cover.
  int covered() {
    const QImage with = picture();
    show(false);
    const QImage without = picture();
    show(true);
    int count = 0;
    for (int x = 0; x < with.width(); ++x)
      count += with.pixel(x, with.height() / 2) != without.pixel(x, with.height() / 2) ? 1 : 0;
    return count;
  }
  void show(bool isVisible) {
    session.setVisible({left, right}, isVisible);
    view.setScene(session.scene());
  }
  /// Where VTK draws a point [pixels from the lower left].
  glm::dvec2 drawn(const glm::dvec3& point) {
    vtkRenderer* renderer = view.renderWindow()->GetRenderers()->GetFirstRenderer();
    renderer->SetWorldPoint(point.x, point.y, point.z, 1.0);
    renderer->WorldToDisplay();
    const double* p = renderer->GetDisplayPoint();
    return {p[0], p[1]};
  }
  glm::dvec3 focus() {
    const double* p = view.camera()->GetFocalPoint();
    return {p[0], p[1], p[2]};
  }
  double pixelAtFocus() { return view.projection().metresPerPixel(focus()); }
  /// Corners of the right bar at either end of an edge along its length.
  std::vector<std::pair<glm::dvec3, glm::dvec3>> longEdges() const {
    std::vector<std::pair<glm::dvec3, glm::dvec3>> edges;
    for (const double x : {-kHalf.x, kHalf.x}) {
      for (const double z : {-kHalf.z, kHalf.z})
        edges.push_back({{kBeside + x, -kHalf.y, z}, {kBeside + x, kHalf.y, z}});
    }
    return edges;
  }
  std::vector<glm::dvec3> corners() const {
    std::vector<glm::dvec3> all;
    for (const double x : {-kBeside - kHalf.x, kBeside + kHalf.x}) {
      for (const double y : {-kHalf.y, kHalf.y}) {
        for (const double z : {-kHalf.z, kHalf.z})
          all.emplace_back(x, y, z);
      }
    }
    return all;
  }
  void wheel(int notches) {
    const QPoint at = view.rect().center();
    for (int i = 0; i < std::abs(notches); ++i) {
      QWheelEvent event(at, view.mapToGlobal(at), {}, {0, notches > 0 ? 120 : -120}, Qt::NoButton, {},
                        Qt::NoScrollPhase, false);
      QApplication::sendEvent(&view, &event);
    }
  }

  Session session;
  ui::Selection selection{session};
  ui::ShownPoses poses{session};
  ui::Viewport view{std::make_shared<ui::PartShapeCache>(), selection, poses};
  PartId left{}, right{};
};

}  // namespace

class OrthographicViewTest : public QObject {
  Q_OBJECT

 private slots:
  void edgesAlongTheSightAreDrawnAsPoints();
  void parallelEdgesAreDrawnParallel();
  void theFrontViewShowsFrontFacesAlone();
  void theWayThereAndBackKeepsTheSizeInTheMiddle();
  void theWheelZooms();
  void fitShowsAllAndFillsTheView();
  void nothingIsHiddenBehindTheEye();
  void clicksAndBoxesPickWhatIsSeen();
  void aPartThatMovesTowardsTheEyeStaysWhole();
};

void OrthographicViewTest::edgesAlongTheSightAreDrawnAsPoints() {
  Bars b;
  for (const bool isOrthographic : {false, true}) {
    b.view.setOrthographic(isOrthographic);
    b.view.setView(ui::StandardView::Front);
    b.picture();
    for (const auto& [near, far] : b.longEdges()) {
      const double length = glm::distance(b.drawn(near), b.drawn(far));
      QVERIFY2(isOrthographic ? length < 1e-6 : length > 10.0, qPrintable(QString::number(length)));
    }
  }
}

void OrthographicViewTest::parallelEdgesAreDrawnParallel() {
  Bars b;
  for (const bool isOrthographic : {false, true}) {
    b.view.setOrthographic(isOrthographic);
    b.view.setView(ui::StandardView::Isometric);
    b.picture();
    std::vector<glm::dvec2> ways;
    for (const auto& [near, far] : b.longEdges())
      ways.push_back(b.drawn(far) - b.drawn(near));
    double most = 0.0;
    for (const glm::dvec2& way : ways)
      most = std::max(most, glm::distance(way, ways.front()));
    QVERIFY2(isOrthographic ? most < 1e-6 : most > 1.0, qPrintable(QString::number(most)));
  }
}

/// "Front" showed the inner sides of both bars.
void OrthographicViewTest::theFrontViewShowsFrontFacesAlone() {
  Bars b;
  for (const bool isOrthographic : {false, true}) {
    b.view.setOrthographic(isOrthographic);
    b.view.setView(ui::StandardView::Front);
    const int covered = b.covered();
    const double faces = 4.0 * kHalf.x / b.view.projection().metresPerPixel({0.0, -kHalf.y, 0.0});
    QVERIFY2((std::abs(covered - faces) <= kLines) == isOrthographic,
             qPrintable(QStringLiteral("%1, faces %2").arg(covered).arg(faces)));
  }
}

void OrthographicViewTest::theWayThereAndBackKeepsTheSizeInTheMiddle() {
  Bars b;
  b.view.setView(ui::StandardView::Isometric);
  const glm::dvec3 eye = b.view.projection().rayThrough(b.view.projection().middle()).origin;
  const double before = b.pixelAtFocus();
  b.view.setOrthographic(true);
  QVERIFY(b.view.projection().isParallel());
  QVERIFY(std::abs(b.pixelAtFocus() / before - 1.0) < 1e-9);
  b.picture();
  QVERIFY(std::abs(b.pixelAtFocus() / before - 1.0) < 1e-9);
  b.view.setOrthographic(false);
  QVERIFY(!b.view.projection().isParallel());
  QVERIFY(std::abs(b.pixelAtFocus() / before - 1.0) < 1e-9);
  QVERIFY(glm::distance(b.view.projection().rayThrough(b.view.projection().middle()).origin, eye) < 1e-9);
  // Zoomed in between, it stays zoomed.
  b.view.setOrthographic(true);
  b.wheel(3);
  const double zoomed = b.pixelAtFocus();
  QVERIFY(zoomed < 0.9 * before);
  b.picture();
  b.view.setOrthographic(false);
  QVERIFY(std::abs(b.pixelAtFocus() / zoomed - 1.0) < 1e-9);
}

void OrthographicViewTest::theWheelZooms() {
  Bars b;
  b.view.setOrthographic(true);
  b.view.setView(ui::StandardView::Top);
  b.picture();
  const double before = b.pixelAtFocus();
  const int pictures = b.view.pictureCount();
  b.wheel(2);
  QVERIFY(b.pixelAtFocus() < 0.9 * before);
  QTRY_VERIFY(b.view.pictureCount() > pictures);
  b.wheel(-2);
  QVERIFY(std::abs(b.pixelAtFocus() / before - 1.0) < 1e-9);
}

void OrthographicViewTest::fitShowsAllAndFillsTheView() {
  Bars b;
  b.view.setOrthographic(true);
  for (const auto view : {ui::StandardView::Isometric, ui::StandardView::Front, ui::StandardView::Right,
                          ui::StandardView::Top}) {
    b.view.setView(view);
    b.wheel(4);
    b.view.fit();
    double most = 0.0;
    for (const glm::dvec3& corner : b.corners()) {
      const glm::dvec2 pixel = b.view.projection().pixelOf(corner).value();
      most = std::max({most, std::abs(pixel.x / 320.0 - 1.0), std::abs(pixel.y / 200.0 - 1.0)});
    }
    QVERIFY2(most > 0.95 && most <= 1.0, qPrintable(QString::number(most)));
  }
}

/// VTK draws nothing that is behind the eye, wherever that stands in orthographic projection.
void OrthographicViewTest::nothingIsHiddenBehindTheEye() {
  Bars b;
  b.view.setOrthographic(true);
  b.view.setView(ui::StandardView::Front);
  const int covered = b.covered();
  // Half of the bars is behind it.
  const glm::dvec3 focus = b.focus();
  b.view.camera()->SetPosition(focus.x, focus.y - 1e-3, focus.z);
  QVERIFY2(std::abs(b.covered() - covered) <= 2, qPrintable(QString::number(covered)));
  const glm::dvec2 pixel = b.view.projection().pixelOf({kBeside, -kHalf.y, 0.0}).value();
  const auto picked = b.view.pointAt({qRound(pixel.x), qRound(pixel.y)});
  QVERIFY(picked && picked->part == b.right);
  QVERIFY(std::abs(picked->point.y + kHalf.y) < 1e-6);
}

void OrthographicViewTest::clicksAndBoxesPickWhatIsSeen() {
  Bars b;
  b.view.setOrthographic(true);
  b.view.setView(ui::StandardView::Isometric);
  b.picture();
  const double pixelSize = b.pixelAtFocus();
  // Places on the upper faces of both.
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 place(side * kBeside + 0.002, -0.03, kHalf.z);
    const glm::dvec2 pixel = b.view.projection().pixelOf(place).value();
    const QPoint at(qRound(pixel.x), qRound(pixel.y));
    const auto picked = b.view.pointAt(at);
    QVERIFY(picked && picked->part == (side < 0.0 ? b.left : b.right));
    QVERIFY2(glm::distance(picked->point, place) < 4.0 * pixelSize,
             qPrintable(QString::number(glm::distance(picked->point, place) / pixelSize)));
    const std::vector<PartId> seen = b.view.partsIn({at - QPoint(2, 2), at + QPoint(2, 2)});
    QVERIFY(seen == std::vector{picked->part});
  }
  QVERIFY(!b.view.pointAt({2, 2}));
  QCOMPARE(b.view.partsIn(b.view.rect()).size(), std::size_t{2});
}

void OrthographicViewTest::aPartThatMovesTowardsTheEyeStaysWhole() {
  Bars b;
  b.view.setOrthographic(true);
  b.view.setView(ui::StandardView::Front);
  const int covered = b.covered();
  // Orthographic projection shows it the same wherever it is along the sight.
  b.poses.show(ui::ShownPoses::Source::Drag, {{b.right, {{1, 0, 0, 0}, {kBeside, -5.0, 0.0}}}});
  QVERIFY2(std::abs(b.covered() - covered) <= 2, qPrintable(QString::number(covered)));
  const glm::dvec2 pixel = b.view.projection().pixelOf({kBeside, -5.0, 0.0}).value();
  const auto picked = b.view.pointAt({qRound(pixel.x), qRound(pixel.y)});
  QVERIFY(picked && picked->part == b.right);
  QVERIFY(std::abs(picked->point.y + 5.0 + kHalf.y) < 1e-6);
}

NEARFIT_QT_SUITE(OrthographicViewTest, [](int argc, char** argv) {
  ui::Viewport::setDefaultSurfaceFormat();
  return test::runQtTest<OrthographicViewTest>(argc, argv);
})
#include "orthographic_view_test.moc"
