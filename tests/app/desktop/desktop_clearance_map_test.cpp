#include <QCheckBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QProgressBar>
#include <QStatusBar>
#include <algorithm>
#include <cmath>
#include <limits>

#include <vtkActor.h>
#include <vtkMapper.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include "core/report/clearance_histogram.h"
#include "tests/app/desktop/export_driver.h"
#include "tests/app/desktop/view_driver.h"
#include "tests/support/ply_values.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/clearance/histogram_view.h"
#include "ui/panels/clearance/map_panel.h"
#include "ui/widgets/format.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The two cubes, the upper one 5 mm over the lower, coloured: its range is one and a half times that, rounded up.
struct MapFixture {
  MapFixture() {
    d.addCubes();
    d.choose("colourByClearance");
  }
  const ui::ClearanceMapSearch& search() { return d.window().clearanceMap().search(); }
  /// Least clearance of the map that is shown [m]; infinity without one.
  double least() {
    const auto& shown = search().shown();
    return shown != nullptr ? shown->areas.least().value_or(INFINITY) : INFINITY;
  }
  bool isRange(double metres) {
    return search().shown() != nullptr && std::abs(search().shown()->map.range - metres) < 1e-12;
  }
  bool isLeast(double metres) { return std::abs(least() - metres) < 1e-9; }
  const std::shared_ptr<const ui::ColouredSurface>& colours(const char* part) {
    return d.window().viewport().parts().find(d.partId(part))->colours();
  }

  DesktopDriver d;
};

/// Adds a ball of 327,680 triangles, 4 mm over the lower cube, in hand instead of the small one.
PartId addLargeBall(DesktopDriver& d) {
  const QString file = writeOff(d.folder.path() / "ball.off",
                                transformed(icosphereMesh(0.01, 7), 1.0, {{1, 0, 0, 0}, {0.0, 0.0, 0.034}}));
  d.add({d.fixedFile, file});
  (void)QTest::qWaitFor([&] { return d.session().scene().parts().size() == 2; }, kQtPatienceMs);
  d.session().setMovingPart(d.partId("ball"));
  return d.partId("ball");
}

}  // namespace

class DesktopClearanceMapTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void theSwitchColoursThePartByItsDistance();
  void thePanelHasTheHistogramAndAreas();
  void theMapFollowsMovesAndDrags();
  void theMapFollowsThePartThatIsFelt();
  void theSelectedPartIsMapped();
  void aGroupInHandIsMappedAsOne();
  void nearPartsAreColouredToo();
  void theRangeIsChosen();
  void theValueUnderThePointerIsSaid();
  void theLegendAndTheMapAreOfTheChosenUnit();
  void aLargeMeshDoesNotHoldUpTheWindow();
  void aLargeMapIsCancelledAndComputedAgain();
  void mapAndHistogramAreExported();
  void anotherSceneHasNoMapOfThisOne();
};

void DesktopClearanceMapTest::theSwitchColoursThePartByItsDistance() {
  MapFixture f;
  QTRY_VERIFY(f.colours("moving") != nullptr);
  QVERIFY(f.colours("fixed") == nullptr);
  QCOMPARE(f.search().shown()->map.range, 0.01);
  std::size_t below = 0, beyond = 0;
  for (const auto& piece : f.colours("moving")->pieces) {
    vtkDataArray* scalars = piece->GetPointData()->GetScalars();
    QCOMPARE(scalars->GetNumberOfTuples(), piece->GetNumberOfPoints());
    for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i) {
      const double height = piece->GetPoint(i)[2] - 0.02, shown = scalars->GetTuple1(i);
      // Rounding decides whether what is just at the range is within it.
      if (std::abs(height - 0.01) < 1e-9) continue;
      height > 0.01 ? ++beyond : ++below;
      const double expected = height > 0.01 ? 0.015 : height;
      QVERIFY2(std::abs(shown - expected) < 1e-9, qPrintable(QString::number(shown)));
    }
  }
  QVERIFY(below > 100 && beyond > 100);
  // That surface is the one drawn.
  const auto& pieces = f.d.window().viewport().parts().find(f.d.partId("moving"))->pieces();
  QVERIFY(pieces.front()->GetMapper()->GetScalarVisibility() != 0);
  QCOMPARE(pieces.front()->GetMapper()->GetInputDataObject(0, 0),
           static_cast<vtkDataObject*>(f.colours("moving")->pieces.front().Get()));
  auto* legend = f.d.widget<QWidget>("clearanceLegend");
  QVERIFY(legend->isVisible() && legend->property("inPictures").toBool());
  QVERIFY(f.d.widget<QDockWidget>("clearanceMapDock")->isVisible());
  keepPictures(f.d.window(), QStringLiteral("clearance-map"));
  const QImage coloured = f.d.picture();
  f.d.choose("colourByClearance");
  QVERIFY(f.colours("moving") == nullptr);
  QVERIFY(!legend->isVisible());
  QVERIFY(f.d.picture() != coloured);
}

void DesktopClearanceMapTest::thePanelHasTheHistogramAndAreas() {
  MapFixture f;
  QTRY_VERIFY(f.isLeast(0.005));
  const std::vector<ClearanceBin>& bins = f.d.widget<ui::HistogramView>("clearanceHistogram")->bins();
  QCOMPARE(bins.size(), std::size_t{40});
  for (std::size_t i = 0; i < 19; ++i)
    QCOMPARE(bins[i].area, 0.0);
  // The lower face; rounding decides on which side of 5 mm it is.
  const double face = bins[19].area + bins[20].area;
  QVERIFY2(face >= 4e-4 - 1e-12 && face < 5e-4, qPrintable(QString::number(face)));
  f.d.type<QDoubleSpinBox>("clearanceMapThreshold", "5.5");
  const double area = f.search().shown()->areas.nearerThan(0.0055);
  QVERIFY(area > 4e-4 && area < 4.8e-4);
  const QString text = f.d.text("clearanceMapAreas");
  QVERIFY2(text.startsWith(ui::formatArea(area) + QStringLiteral(" (")), qPrintable(text));
  QVERIFY2(text.contains(QStringLiteral("nearer than 5.50 mm")), qPrintable(text));
  QVERIFY2(text.contains(QStringLiteral("Min 5.00 mm")), qPrintable(text));
  QVERIFY2(!text.contains(QStringLiteral("inside other parts")), qPrintable(text));
  f.d.session().movePart(f.d.partId("moving"), {{1, 0, 0, 0}, {0, 0, -0.006}});
  QTRY_VERIFY(f.isLeast(-0.001));
  QVERIFY(f.d.text("clearanceMapAreas").contains(QStringLiteral("inside other parts")));
  QVERIFY(f.d.text("clearanceMapAreas").contains(QStringLiteral("Min about -1.00 mm")));
}

void DesktopClearanceMapTest::theMapFollowsMovesAndDrags() {
  MapFixture f;
  QTRY_VERIFY(f.isLeast(0.005));
  const PartId moving = f.d.partId("moving");
  f.d.session().movePart(moving, {{1, 0, 0, 0}, {0, 0, 0.001}});
  QTRY_VERIFY(f.isLeast(0.006));
  // A drag that the session does not know of yet; only its newest pose matters.
  ui::ShownPoses& poses = f.d.window().viewport().poses();
  for (int i = 0; i <= 100; ++i) {
    poses.show(ui::ShownPoses::Source::Drag, {{moving, {{1, 0, 0, 0}, {0, 0, 0.001 - 1e-5 * i}}}});
    QCoreApplication::processEvents();
  }
  QTRY_VERIFY(f.isLeast(0.005));
  QTRY_VERIFY(!f.search().isStale());
  QVERIFY(std::abs(f.search().shown()->map.surfaces.front().worldFromPart.translation.z) < 1e-9);
  poses.show(ui::ShownPoses::Source::Drag, {});
  QTRY_VERIFY(f.isLeast(0.006));
  f.d.session().undo();
  QTRY_VERIFY(f.isLeast(0.005));
}

void DesktopClearanceMapTest::theMapFollowsThePartThatIsFelt() {
  MapFixture f;
  QTRY_VERIFY(f.isLeast(0.005));
  f.d.startWith(ui::Hand::Manual);
  f.d.clickPart(1, ui::PartsModel::Name);
  f.d.type<QDoubleSpinBox>("positionZ", "2");
  QTRY_VERIFY(std::abs(f.least() - 0.007) < 1e-5);
}

void DesktopClearanceMapTest::theSelectedPartIsMapped() {
  MapFixture f;
  QTRY_VERIFY(f.colours("moving") != nullptr);
  f.d.window().selection().select(f.d.partId("fixed"));
  QVERIFY2(f.colours("moving") == nullptr, "colours of another part would be taken for its own");
  QTRY_VERIFY(f.colours("fixed") != nullptr);
  QVERIFY(f.colours("moving") == nullptr);
  f.d.window().selection().select(std::nullopt);
  QTRY_VERIFY(f.colours("moving") != nullptr);
}

void DesktopClearanceMapTest::aGroupInHandIsMappedAsOne() {
  MapFixture f;
  f.d.add({f.d.movingFile});
  QTRY_COMPARE(f.d.session().scene().parts().size(), std::size_t{3});
  // 2 mm higher than the first of the group, and half of it inside that.
  const PartId lead = f.d.partId("moving"), other = f.d.session().scene().parts().back()->id;
  f.d.session().movePart(other, {{1, 0, 0, 0}, {0.01, 0.0, 0.002}});
  const GroupId group = f.d.session().group({{lead, other}, {}}, "Pair");
  f.d.session().setMovingGroup(group);
  f.d.window().selection().set({});
  const auto isSubject = [&f](std::size_t parts) {
    return f.search().shown() != nullptr && f.search().shown()->subject.size() == parts;
  };
  QTRY_VERIFY(isSubject(2) && f.isLeast(0.005));
  QCOMPARE(f.search().shown()->areas.overlapping(), 0.0);
  QVERIFY(f.d.text("clearanceMapSubject").contains(QStringLiteral("Pair")));
  for (const PartId part : {lead, other})
    QVERIFY(f.d.window().viewport().parts().find(part)->colours() != nullptr);
  QVERIFY(f.colours("fixed") == nullptr);
  keepPictures(f.d.window(), QStringLiteral("clearance-map-group"));
  // One of them alone is measured to the other one too.
  f.d.window().selection().select(other);
  QTRY_VERIFY(isSubject(1));
  QTRY_VERIFY(f.search().shown() != nullptr && f.search().shown()->areas.overlapping() > 0.0);
}

void DesktopClearanceMapTest::nearPartsAreColouredToo() {
  MapFixture f;
  QTRY_VERIFY(f.colours("moving") != nullptr);
  QTest::mouseClick(f.d.widget<QCheckBox>("clearanceMapNear"), Qt::LeftButton, {}, QPoint(8, 8));
  QTRY_VERIFY(f.colours("fixed") != nullptr);
  const MappedSurface* fixed = f.search().shown()->map.find(f.d.partId("fixed"));
  double least = INFINITY;
  for (const double distance : fixed->distances)
    if (!std::isnan(distance)) least = std::min(least, distance);
  QVERIFY(std::abs(least - 0.005) < 1e-9);
}

void DesktopClearanceMapTest::theRangeIsChosen() {
  MapFixture f;
  QTRY_VERIFY(f.isLeast(0.005));
  QCOMPARE(f.d.widget<QDoubleSpinBox>("clearanceMapRange")->text(), QStringLiteral("10 mm"));
  QTest::mouseClick(f.d.widget<QCheckBox>("clearanceMapAutomatic"), Qt::LeftButton, {}, QPoint(8, 8));
  f.d.type<QDoubleSpinBox>("clearanceMapRange", "6");
  QTRY_VERIFY(f.isRange(0.006));
  f.d.type<QDoubleSpinBox>("clearanceMapRange", "4");
  QTRY_VERIFY(f.isRange(0.004));
  const QString text = f.d.text("clearanceMapSubject");
  QVERIFY2(text.contains(QStringLiteral("no other part is within 4.00 mm")), qPrintable(text));
  QTest::mouseClick(f.d.widget<QCheckBox>("clearanceMapAutomatic"), Qt::LeftButton, {}, QPoint(8, 8));
  QTRY_VERIFY(f.isRange(0.01));
}

void DesktopClearanceMapTest::theValueUnderThePointerIsSaid() {
  MapFixture f;
  QTRY_VERIFY(f.isLeast(0.005));
  ViewDriver view(f.d);
  view.look("viewFront");
  auto* probe = f.d.widget<QLabel>("clearanceProbe");
  const QPoint low = view.seen({0.002, -0.01, 0.0273}), high = view.seen({0.002, -0.01, 0.041});
  view.moveTo(low);
  QTRY_VERIFY(probe->isVisible());
  const auto picked = view.view().pointAt(low);
  QVERIFY(picked && picked->part == f.d.partId("moving"));
  QCOMPARE(probe->text(), ui::formatLength(picked->point.z - 0.02));
  view.moveTo(high);
  QTRY_COMPARE(probe->text(), QStringLiteral("beyond 10.0 mm"));
  view.moveTo({3, 3});
  QTRY_VERIFY(!probe->isVisible());
  // From above, the upper cube is before the lower one's face.
  f.d.window().selection().select(f.d.partId("fixed"));
  QTRY_VERIFY(f.colours("fixed") != nullptr);
  view.look("viewTop");
  view.moveTo(view.seen({0.002, 0.003, 0.02}));
  QTest::qWait(50);
  QVERIFY2(!probe->isVisible(), "an opaque part hides the colours");
  f.d.session().setOpacity({f.d.partId("moving")}, 0.5);
  view.moveTo(view.seen({0.003, 0.003, 0.02}));
  QTRY_VERIFY(probe->isVisible());
  QCOMPARE(probe->text(), QStringLiteral("5.00 mm"));
}

void DesktopClearanceMapTest::theLegendAndTheMapAreOfTheChosenUnit() {
  MapFixture f;
  QTRY_VERIFY(f.isLeast(0.005));
  f.d.choose("unit-in");
  QVERIFY2(f.d.text("clearanceMapAreas").contains(QStringLiteral("Min 0.197 in")),
           qPrintable(f.d.text("clearanceMapAreas")));
  QVERIFY(f.d.text("clearanceMapAreas").contains(QStringLiteral(" in²")));
  f.d.choose("unit-mm");
}

void DesktopClearanceMapTest::aLargeMeshDoesNotHoldUpTheWindow() {
  DesktopDriver d;
  const PartId ball = addLargeBall(d);
  const ui::ClearanceMapSearch& search = d.window().clearanceMap().search();
  int whileRunning = 0;
  QTimer events;
  connect(&events, &QTimer::timeout, this, [&] { whileRunning += search.isRunning() ? 1 : 0; });
  events.start(0);
  d.choose("colourByClearance");
  QTRY_VERIFY(search.shown() != nullptr);
  QVERIFY2(whileRunning > 10, "events were handled meanwhile");
  QVERIFY(search.shown()->map.samples() > ui::ClearanceMapSearch::kMaxLiveSamples);
  QVERIFY(std::abs(search.shown()->areas.least().value() - 0.004) < 1e-4);
  // It does not follow motion: what is shown is marked as old until the part rests.
  d.session().movePart(ball, {{1, 0, 0, 0}, {0, 0, 0.001}});
  QVERIFY(search.isStale());
  QVERIFY(d.text("clearanceMapSubject").contains(QStringLiteral("of the last pose")));
  QTRY_VERIFY(!search.isStale());
  QVERIFY(std::abs(search.shown()->areas.least().value() - 0.005) < 1e-4);
  QVERIFY(!d.text("clearanceMapSubject").contains(QStringLiteral("of the last pose")));
}

void DesktopClearanceMapTest::aLargeMapIsCancelledAndComputedAgain() {
  DesktopDriver d;
  const PartId ball = addLargeBall(d);
  const ui::ClearanceMapSearch& search = d.window().clearanceMap().search();
  d.choose("colourByClearance");
  QTRY_VERIFY(search.shown() != nullptr);
  const auto before = search.shown();
  auto* cancel = d.widget<QPushButton>("cancelClearanceMap");
  QTRY_VERIFY(!cancel->isVisible());
  bool isPressed = false;
  const auto connection = connect(&search, &ui::ClearanceMapSearch::workChanged, this, [&] {
    // As soon as it runs: it may be quick.
    if (!search.isRunning() || std::exchange(isPressed, true)) return;
    QVERIFY(cancel->isVisible() && d.widget<QProgressBar>("clearanceMapProgress")->isVisible());
    QTest::mouseClick(cancel, Qt::LeftButton);
  });
  d.session().movePart(ball, {{1, 0, 0, 0}, {0, 0, 0.001}});
  QTRY_VERIFY(isPressed && !search.isRunning());
  disconnect(connection);
  QVERIFY(search.isCancelled() && search.isStale());
  QCOMPARE(search.shown(), before);
  QVERIFY(cancel->isVisible());
  QTest::mouseClick(cancel, Qt::LeftButton);
  QTRY_VERIFY(!search.isStale());
  QVERIFY(search.shown() != before);
}

void DesktopClearanceMapTest::mapAndHistogramAreExported() {
  MapFixture f;
  QTRY_VERIFY(f.isLeast(0.005));
  const auto map = f.d.folder.path() / "map.ply", histogram = f.d.folder.path() / "h.csv";
  QString summary;
  chooseExport(5, false, &summary);
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(map.string())); });
  pressShortcut(f.d, Qt::Key_E, Qt::ControlModifier);
  QTRY_COMPARE(f.d.window().statusBar()->currentMessage(), QStringLiteral("Exported map.ply"));
  QVERIFY2(summary.contains(QStringLiteral("The surface of moving within 10.0 mm")) ||
               summary.contains(QStringLiteral("The surface of moving within an automatic range")),
           qPrintable(summary));
  const PlyValues read = readPlyValues(map);
  double least = INFINITY;
  for (const double distance : read.vertex.at("distance"))
    if (!std::isnan(distance)) least = std::min(least, distance);
  QVERIFY2(std::abs(least - 5.0) < 1e-6, "in millimetres, as the coordinates");
  const auto lowest = std::ranges::min(read.vertex.at("z"));
  QVERIFY2(std::abs(lowest - 25.0) < 1e-9, "in millimetres, in the world");
  const double highest = std::ranges::max(read.vertex.at("z"));
  QVERIFY2(highest >= 30.0 && highest < 35.0, "only what is within the range of 10 mm, to a sample");
  // The panel's button offers the map first, whatever was exported last.
  chooseExport(6, false);
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(histogram.string())); });
  QTest::mouseClick(f.d.widget<QPushButton>("exportClearanceMap"), Qt::LeftButton);
  QTRY_COMPARE(f.d.window().statusBar()->currentMessage(), QStringLiteral("Exported h.csv"));
  QVERIFY(readBytes(histogram).starts_with("from [m],to [m],area [m^2],share\n"));
  bool isMapOffered = false;
  whenModal<ui::ExportDialog>([&](ui::ExportDialog* dialog) {
    isMapOffered = dialog->choice().kind == ExportKind::ClearanceMapPly;
    QTest::keyClick(dialog, Qt::Key_Escape);
  });
  QTest::mouseClick(f.d.widget<QPushButton>("exportClearanceMap"), Qt::LeftButton);
  QVERIFY(isMapOffered);
}

void DesktopClearanceMapTest::anotherSceneHasNoMapOfThisOne() {
  MapFixture f;
  QTRY_VERIFY(f.search().shown() != nullptr);
  f.d.session().reset();
  QVERIFY(f.search().shown() == nullptr);
  QVERIFY(!f.d.widget<QWidget>("clearanceLegend")->isVisible());
  QCOMPARE(f.d.text("clearanceMapSubject"), QStringLiteral("Select a part, or take one in hand."));
}

NEARFIT_QT_SUITE(DesktopClearanceMapTest, runDesktopTest<DesktopClearanceMapTest>)
#include "desktop_clearance_map_test.moc"
