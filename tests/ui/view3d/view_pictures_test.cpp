// What the view shows, compared with pictures in tests/ui/baseline. How to renew them: README.md there.
#include <QDir>
#include <QtTest>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include <vtkVersion.h>

#include "core/report/clearance_colours.h"
#include "core/report/clearance_map.h"
#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/places.h"
#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/ui/view3d/picture_comparison.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/gizmo_overlay.h"
#include "ui/view3d/glyphs/colour_legend.h"
#include "ui/view3d/parts/coloured_surface.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/theme.h"

using namespace nearfit;
using test::PictureDifference;

namespace {

/// Each version of VTK shades and draws lines a little differently.
const QString kBaseline =
    QString::fromStdString((test::sourceFolder() / "tests/ui/baseline/vtk-%1.%2/").string())
        .arg(vtkVersion::GetVTKMajorVersion())
        .arg(vtkVersion::GetVTKMinorVersion());

SnapshotLmd minimum(const glm::dvec3& scenePoint, const glm::dvec3& partPoint, bool isBlocked = false) {
  SnapshotLmd minimum;
  minimum.lmd.scenePoint = scenePoint;
  minimum.lmd.partPoint = partPoint;
  minimum.lmd.distance = glm::distance(scenePoint, partPoint);
  minimum.lmd.direction = (partPoint - scenePoint) / minimum.lmd.distance;
  minimum.lmd.isBlocked = isBlocked;
  return minimum;
}

/// A view of a peg over a plate with a hole, beside a ball.
struct Bench {
  Bench() {
    Scene scene;
    const auto add = [&scene](TriangleMesh mesh, const char* name, const glm::dvec3& place) {
      Part part = test::partOf(test::geometryOf(std::move(mesh)), name, {{1, 0, 0, 0}, place});
      part.colour = scene.nextColour();
      return scene.add(part);
    };
    plate = add(test::tubeMesh(0.009, 0.03, 0.01, 32), "plate", {});
    peg = add(test::cylinderMesh(0.008, 0.04, 32), "peg", {0.004, 0.0, 0.032});
    ball = add(test::icosphereMesh(0.012, 3), "ball", {-0.035, 0.012, 0.02});
    scene.setMovingPart(peg);
    session.reset(scene);
    view.resize(640, 400);
    view.setScene(session.scene());
    view.show();
    QVERIFY(QTest::qWaitForWindowExposed(&view));
    QTRY_VERIFY(view.pictureCount() > 0);
    view.fit();
  }
  /// As the baseline has them.
  void setColourRange() {
    ui::MinimaChoice choice;
    choice.colourRange = 0.01;
    view.setMinimaChoice(choice);
  }
  QImage picture() {
    QCoreApplication::processEvents();
    view.renderWindow()->Render();
    return view.grab().toImage();
  }
  /// The hand is lower than the peg, which stands on the plate's rim.
  std::unique_ptr<ServoSnapshot> felt() const {
    auto snapshot = std::make_unique<ServoSnapshot>();
    snapshot->moving = peg;
    snapshot->proxy = snapshot->handle = session.scene().find(peg)->worldFromPart;
    snapshot->centre = snapshot->proxy.translation;
    return snapshot;
  }
  std::unique_ptr<ServoSnapshot> withMinima() const {
    auto snapshot = felt();
    snapshot->lmds[0] = minimum({0.011, 0.004, 0.005}, {0.011, 0.004, 0.012});
    snapshot->lmds[1] = minimum({-0.004, -0.008, 0.005}, {-0.003, -0.004, 0.0085});
    snapshot->lmds[2] = minimum({-0.024, 0.009, 0.022}, {-0.004, 0.002, 0.022});
    snapshot->lmds[3] = minimum({-0.025, 0.012, 0.03}, {-0.004, 0.0, 0.045}, true);
    snapshot->lmdCount = snapshot->storedLmds = 4;
    return snapshot;
  }
  std::vector<QRect> texts() {
    const auto* legend = view.findChild<ui::ColourLegend*>();
    return legend->isVisible() ? std::vector{legend->geometry()} : std::vector<QRect>{};
  }

  Session session;
  ui::Selection selection{session};
  ui::ShownPoses poses{session};
  ui::Viewport view{std::make_shared<ui::PartShapeCache>(), selection, poses};
  PartId plate{}, peg{}, ball{};
};

QImage baseline(const char* name) {
  return QImage(kBaseline + QLatin1String(name) + QStringLiteral(".png"));
}

/// Fails where the picture is another than that of the name; leaves both and their difference then.
void check(const QImage& seen, const char* name, const std::vector<QRect>& texts = {}) {
  if (qEnvironmentVariableIsSet("NEARFIT_RENEW_PICTURES")) {
    QVERIFY(seen.save(kBaseline + QLatin1String(name) + QStringLiteral(".png")));
    return;
  }
  const PictureDifference difference = test::compare(seen, baseline(name), texts);
  if (!difference.isSeen()) return;
  const QString left = QDir::current().absoluteFilePath(QLatin1String(name));
  seen.save(left + QStringLiteral("-seen.png"));
  difference.picture.save(left + QStringLiteral("-difference.png"));
  QFAIL(qPrintable(QStringLiteral("%1.png is another: mean %2, share %3; see %4-seen.png and "
                                  "-difference.png, and tests/ui/baseline/README.md")
                       .arg(QLatin1String(name))
                       .arg(difference.mean)
                       .arg(difference.share)
                       .arg(left)));
}

}  // namespace

class ViewPicturesTest : public QObject {
  Q_OBJECT

 private slots:
  void cleanup();
  void partsAreShaded();
  void theDarkViewIsDark();
  void whatIsSelectedShowsThroughOthers();
  void theGizmoStandsAtItsPart();
  void minimaAreColouredByDistance();
  void forceTorqueContactsAndTheHandAreShown();
  void overlapsAreMarked();
  void cutFacesAreClosedAndHatched();
  void whatIsBehindATransparentPartIsSeen();
  void aTransparentPartLeavesTheColoursOfAMapAsTheyAre();
  void theColoursOfABoreAreSeenThroughItsOwnOuterWall();
  void aGlyphThatIsMissingIsSeen();
  void anArrowThatIsMissingIsSeen();
  void smoothedEdgesAndLettersAreNotSeen();
};

void ViewPicturesTest::cleanup() {
  ui::setColourScheme(ui::ColourScheme::Light);
}

void ViewPicturesTest::partsAreShaded() {
  Bench b;
  check(b.picture(), "parts");
}

void ViewPicturesTest::theDarkViewIsDark() {
  ui::setColourScheme(ui::ColourScheme::Dark);
  Bench b;
  check(b.picture(), "dark");
}

void ViewPicturesTest::whatIsSelectedShowsThroughOthers() {
  Bench b;
  b.view.setView(ui::StandardView::Front);
  b.selection.set({b.ball, b.plate});
  check(b.picture(), "selection");
}

void ViewPicturesTest::theGizmoStandsAtItsPart() {
  Bench b;
  b.selection.select(b.peg);
  ui::GizmoOverlay overlay(&b.view);
  GizmoFrame frame;
  frame.pivot = b.session.scene().find(b.peg)->worldFromPart.translation;
  overlay.showPicture({GizmoLayout(b.view.projection(), frame, GizmoMode::MoveAndTurn), GizmoGrip::MoveZ,
                       false, std::nullopt});
  check(b.picture(), "gizmo");
}

void ViewPicturesTest::minimaAreColouredByDistance() {
  Bench b;
  b.setColourRange();
  b.view.showSnapshot(*b.withMinima());
  check(b.picture(), "minima", b.texts());
}

void ViewPicturesTest::forceTorqueContactsAndTheHandAreShown() {
  Bench b;
  const auto snapshot = b.felt();
  snapshot->handle.translation += glm::dvec3(0.004, 0.0, -0.012);
  snapshot->wrench.force = {-1.0, 0.5, 4.0};
  snapshot->wrench.torque = {0.0, 0.05, 0.02};
  snapshot->contacts[0] = {{0.01, 0.003, 0.012}, {0.0, 0.0, 1.0}, 3.0, b.plate};
  snapshot->storedContacts = snapshot->contactCount = 1;
  b.view.showSnapshot(*snapshot);
  check(b.picture(), "felt", b.texts());
}

void ViewPicturesTest::overlapsAreMarked() {
  Bench b;
  const auto snapshot = b.felt();
  snapshot->proxy.translation = snapshot->handle.translation = {-0.025, 0.01, 0.02};
  snapshot->overlapping[0] = b.ball;
  snapshot->overlappingCount = 1;
  b.poses.show(ui::ShownPoses::Source::Hand, {{b.peg, snapshot->proxy}});
  b.view.showSnapshot(*snapshot);
  check(b.picture(), "overlap", b.texts());
}

void ViewPicturesTest::cutFacesAreClosedAndHatched() {
  Bench b;
  b.view.setCut(ui::ViewCut{{{0.0, -1.0, 0.0}, 0.0}, false});
  check(b.picture(), "cut");
}

void ViewPicturesTest::whatIsBehindATransparentPartIsSeen() {
  Bench b;
  // The moving part is seen through the others anyway.
  b.session.setMovingPart(std::nullopt);
  b.session.setOpacity({b.peg}, 0.4);
  b.view.setScene(b.session.scene());
  b.view.setView(ui::StandardView::Top);
  check(b.picture(), "transparent");
}

/// The colours of a bore were mixed with those of the part before it, and could not be read.
void ViewPicturesTest::aTransparentPartLeavesTheColoursOfAMapAsTheyAre() {
  constexpr int kFewPercent = 15;  // 255 is white.
  Bench b;
  b.session.movePart(b.peg, {{1, 0, 0, 0}, {0.004, 0.0, -0.032}});
  b.view.setScene(b.session.scene());
  b.view.setSeeThrough(true);
  b.view.setOrthographic(true);
  b.view.setView(ui::StandardView::Top);
  // On the peg's upper face, beyond the rim of the plate's hole: 7 mm under the plate.
  const glm::dvec2 pixel = b.view.projection().pixelOf({0.0105, 0.0, -0.012}).value();
  const QPoint at(static_cast<int>(std::lround(pixel.x)), static_cast<int>(std::lround(pixel.y)));
  const auto differenceWithPlate = [&] {
    QColor colours[2];
    for (const bool isThere : {false, true}) {
      b.session.setVisible(b.plate, isThere);
      b.view.setScene(b.session.scene());
      colours[isThere ? 1 : 0] = b.picture().pixelColor(at);
    }
    return std::max({std::abs(colours[0].red() - colours[1].red()),
                     std::abs(colours[0].green() - colours[1].green()),
                     std::abs(colours[0].blue() - colours[1].blue())});
  };
  const int tint = differenceWithPlate();
  QVERIFY2(tint > kFewPercent, qPrintable(QString::number(tint)));
  const ClearanceMap map = ClearanceMapper().map(clearanceMapRequest(b.session.scene(), b.peg, 0.01, false));
  const auto coloured = ui::colouredSurface(map.surfaces.front(), map.range);
  const QColor own = b.picture().pixelColor(at);
  b.view.setColours({{b.peg, coloured}}, false);
  QVERIFY2(b.picture().pixelColor(at) != own, "it is coloured there");
  const int mapped = differenceWithPlate();
  QVERIFY2(mapped <= kFewPercent, qPrintable(QString::number(mapped)));
  // Its outline stays, without which it would be lost, until there are no colours.
  b.view.setEdgesVisible(false);
  const auto hasOutline = [&] {
    const ui::PartActor* plate = b.view.parts().find(b.plate);
    std::vector<vtkProp*> drawn;
    plate->addTo(drawn);
    return drawn.size() > plate->pieces().size();
  };
  QVERIFY(hasOutline());
  b.view.setColours({}, false);
  QVERIFY(!hasOutline());
  QVERIFY(differenceWithPlate() > kFewPercent);
}

/// The outer wall hid them, and the pointer found it.
void ViewPicturesTest::theColoursOfABoreAreSeenThroughItsOwnOuterWall() {
  constexpr double kRange = 0.005, kGap = 0.001;
  constexpr int kSameHue = 15;  // Of 360.
  Bench b;
  b.session.movePart(b.peg, {{1, 0, 0, 0}, {0.0, 0.0, 0.0}});
  b.session.setVisible(b.ball, false);
  b.session.setOpacity({b.plate}, 0.4);
  b.view.setScene(b.session.scene());
  b.view.setOrthographic(true);
  b.view.setView(ui::StandardView::Front);
  b.picture();
  const glm::dvec2 pixel = b.view.projection().pixelOf({0.0003, -0.03, 0.0}).value();
  const QPoint at(static_cast<int>(std::lround(pixel.x)), static_cast<int>(std::lround(pixel.y)));
  const ClearanceMap map =
      ClearanceMapper().map(clearanceMapRequest(b.session.scene(), b.plate, kRange, false));
  const MappedSurface& mapped = map.surfaces.front();
  b.view.setColours({{b.plate, ui::colouredSurface(mapped, map.range)}}, false);
  const Colour colour = clearanceColour(kGap, kRange);
  const QColor expected = QColor::fromRgbF(static_cast<double>(colour.r), static_cast<double>(colour.g),
                                           static_cast<double>(colour.b));
  const QColor seen = b.picture().pixelColor(at);
  const int turn = std::abs(seen.hue() - expected.hue());
  QVERIFY2(seen.saturation() > 60 && std::min(turn, 360 - turn) <= kSameHue,
           qPrintable(seen.name() + QStringLiteral(" instead of ") + expected.name()));

  const auto isNearAt = [&](PartId, std::uint32_t triangle, const glm::dvec3& point) {
    return clearanceAt(mapped, triangle, point).has_value();
  };
  const auto nearest = b.view.pointAt(at, ui::SeenThrough::Never, isNearAt);
  QVERIFY(nearest && nearest->part == b.plate);
  QVERIFY2(std::abs(nearest->point.y + 0.009) < 1e-4, qPrintable(QString::number(nearest->point.y)));
  // A click takes the part as ever.
  const auto outer = b.view.pointAt(at);
  QVERIFY(outer && outer->part == b.plate && outer->point.y < -0.029);
}

void ViewPicturesTest::aGlyphThatIsMissingIsSeen() {
  Bench b;
  b.setColourRange();
  const auto snapshot = b.withMinima();
  // The shortest of them.
  snapshot->lmds[1] = snapshot->lmds[3];
  snapshot->lmdCount = snapshot->storedLmds = 3;
  b.view.showSnapshot(*snapshot);
  const PictureDifference difference = test::compare(b.picture(), baseline("minima"), b.texts());
  QVERIFY2(difference.isSeen(), qPrintable(QString::number(difference.share)));
}

void ViewPicturesTest::anArrowThatIsMissingIsSeen() {
  Bench b;
  b.selection.select(b.peg);
  ui::GizmoOverlay overlay(&b.view);
  GizmoFrame frame;
  frame.pivot = b.session.scene().find(b.peg)->worldFromPart.translation;
  overlay.showPicture(
      {GizmoLayout(b.view.projection(), frame, GizmoMode::Turn), GizmoGrip::None, false, std::nullopt});
  QVERIFY(test::compare(b.picture(), baseline("gizmo")).isSeen());
}

void ViewPicturesTest::smoothedEdgesAndLettersAreNotSeen() {
  QImage seen = baseline("minima");
  QVERIFY(!seen.isNull());
  const QImage expected = seen;
  // As another driver smooths: every pixel a little of its neighbour.
  for (int y = 1; y + 1 < seen.height(); ++y) {
    for (int x = 1; x + 1 < seen.width(); ++x) {
      const QRgb here = expected.pixel(x, y), beside = expected.pixel(x + 1, y);
      seen.setPixel(x, y,
                    qRgb((7 * qRed(here) + qRed(beside)) / 8, (7 * qGreen(here) + qGreen(beside)) / 8,
                         (7 * qBlue(here) + qBlue(beside)) / 8));
    }
  }
  const PictureDifference smoothed = test::compare(seen, expected);
  QVERIFY2(!smoothed.isSeen(), qPrintable(QStringLiteral("%1, %2").arg(smoothed.mean).arg(smoothed.share)));
  // Letters of another font; and a picture of another size is another.
  QImage lettered = expected;
  {
    QPainter painter(&lettered);
    painter.setPen(Qt::black);
    painter.drawText(20, 40, QStringLiteral("Local minimum distance"));
  }
  QVERIFY(test::compare(lettered, expected).isSeen());
  QVERIFY(!test::compare(lettered, expected, {QRect(10, 20, 200, 60)}).isSeen());
  QVERIFY(test::compare(expected.copy(0, 0, 100, 100), expected).isSeen());
}

NEARFIT_QT_SUITE(ViewPicturesTest, [](int argc, char** argv) {
  ui::Viewport::setDefaultSurfaceFormat();
  QCoreApplication::setOrganizationName(QStringLiteral("Nearfit"));
  QApplication qt(argc, argv);
  QTemporaryDir settings;
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
  ui::applyTheme(qt);
  ui::setColourScheme(ui::ColourScheme::Light);
  ViewPicturesTest test;
  return QTest::qExec(&test, argc, argv);
})
#include "view_pictures_test.moc"
