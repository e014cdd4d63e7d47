#include "ui/view3d/viewport.h"

#include <QtTest>
#include <cstdlib>
#include <memory>
#include <vector>

#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPropCollection.h>
#include <vtkRendererCollection.h>

#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/glyphs/colour_legend.h"

using namespace nearfit;

class ViewportTest : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase();
  void aViewAtRestDrawsNothing();
  void oneChangeIsOnePicture();
  void changesBetweenTwoFramesAreOnePicture();
  void aPictureDrawnAgainIsTheSame();
  void whatIsDrawnBesidesPartsIsLittle();
  void nothingBehindTheWindowShinesThrough();
  void numbersChangeWithTheGlyphsTheyExplain();
  void aSnapshotIsToldAsDrawnWithItsPicture();
  void aPastSnapshotStaysPaler();

 private:
  /// Pictures since the last call, once the view is at rest.
  int newPictures() {
    QTest::qWait(100);
    const int before = seen_;
    seen_ = viewport_->pictureCount();
    return seen_ - before;
  }

  /// Shows the snapshot in the order that the window keeps: the pose first, then the view.
  void showSnapshot() {
    poses_.show(ui::ShownPoses::Source::Hand, {{snapshot_->moving, snapshot_->proxy}});
    viewport_->showSnapshot(*snapshot_);
  }

  Session session_;
  ui::Selection selection_{session_};
  ui::ShownPoses poses_{session_};
  std::unique_ptr<ui::Viewport> viewport_;
  std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
  int seen_ = 0;
};

void ViewportTest::initTestCase() {
  viewport_ = std::make_unique<ui::Viewport>(std::make_shared<ui::PartShapeCache>(), selection_, poses_);
  const PartGeometryPtr cube = test::freshGeometryOf(test::boxMesh(glm::dvec3(0.02)));
  Scene scene;
  const PartId moving = scene.add(test::partOf(cube, "in hand"));
  Part other = test::partOf(cube, "other");
  other.worldFromPart.translation = {0.05, 0.0, 0.0};
  scene.add(other);
  scene.setMovingPart(moving);
  snapshot_->moving = moving;
  snapshot_->proxy = snapshot_->handle = RigidTransform{};
  viewport_->resize(400, 300);
  viewport_->setScene(scene);
  viewport_->show();
  QVERIFY(QTest::qWaitForWindowExposed(viewport_.get()));
  showSnapshot();
  QTest::qWait(300);
  QVERIFY(newPictures() > 0);
}

void ViewportTest::aViewAtRestDrawsNothing() {
  for (int i = 0; i < 30; ++i) {
    showSnapshot();
    QTest::qWait(5);
  }
  QCOMPARE(newPictures(), 0);
}

void ViewportTest::oneChangeIsOnePicture() {
  snapshot_->proxy.translation.x += 0.001;
  showSnapshot();
  QCOMPARE(newPictures(), 1);
  showSnapshot();
  QCOMPARE(newPictures(), 0);
}

void ViewportTest::changesBetweenTwoFramesAreOnePicture() {
  for (int i = 0; i < 5; ++i) {
    snapshot_->proxy.translation.y += 0.001;
    showSnapshot();
  }
  viewport_->setEdgesVisible(false);
  QCOMPARE(newPictures(), 1);
}

void ViewportTest::aPictureDrawnAgainIsTheSame() {
  const QImage left = viewport_->grabFramebuffer();
  viewport_->renderWindow()->Render();
  const QImage drawn = viewport_->grabFramebuffer();
  QVERIFY(!left.isNull());
  QCOMPARE(left, drawn);
}

/// VTK's marker in the corner had more triangles than most scenes, made anew for each picture.
void ViewportTest::whatIsDrawnBesidesPartsIsLittle() {
  constexpr vtkIdType kMax = 5'000;
  vtkRendererCollection* renderers = viewport_->renderWindow()->GetRenderers();
  QVERIFY(renderers->GetNumberOfItems() > 2);
  vtkIdType count = 0;
  renderers->InitTraversal();
  while (vtkRenderer* renderer = renderers->GetNextItem()) {
    vtkNew<vtkPropCollection> actors;
    vtkPropCollection* props = renderer->GetViewProps();
    props->InitTraversal();
    while (vtkProp* prop = props->GetNextProp())
      prop->GetActors(actors);
    actors->InitTraversal();
    while (auto* actor = vtkActor::SafeDownCast(actors->GetNextProp())) {
      auto* mapper = vtkPolyDataMapper::SafeDownCast(actor->GetMapper());
      if (actor->GetVisibility() == 0 || mapper == nullptr) continue;
      mapper->Update();
      count += mapper->GetInput()->GetNumberOfPolys() + 2 * mapper->GetInput()->GetNumberOfStrips();
    }
  }
  QVERIFY2(count > 100 && count < kMax, qPrintable(QString::number(count)));
}

/// What shines through leaves the picture thin there, and a window whose surface has an alpha shows the
/// desktop.
void ViewportTest::nothingBehindTheWindowShinesThrough() {
  viewport_->setSeeThrough(true);
  for (const bool hasForce : {false, true}) {
    snapshot_->wrench.force = {0.0, 0.0, hasForce ? 2.0 : 0.0};
    snapshot_->proxy.translation.z += 0.001;
    showSnapshot();
    QVERIFY(newPictures() > 0);
    const QImage picture = viewport_->grabFramebuffer().convertToFormat(QImage::Format_ARGB32);
    int thin = 0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x)
        thin += qAlpha(picture.pixel(x, y)) < 255 ? 1 : 0;
    }
    QCOMPARE(thin, 0);
  }
}

/// The legend said the next picture's numbers while the arrows of the last one stood beside it.
void ViewportTest::numbersChangeWithTheGlyphsTheyExplain() {
  auto* legend = viewport_->findChild<ui::ColourLegend*>();
  (void)newPictures();
  const int pictures = viewport_->pictureCount();
  const QImage before = legend->grab().toImage();
  snapshot_->wrench.force = {0.0, 1.5, 0.25};
  showSnapshot();
  QCOMPARE(viewport_->pictureCount(), pictures);
  QCOMPARE(legend->grab().toImage(), before);
  QTRY_VERIFY(viewport_->pictureCount() > pictures);
  QVERIFY(legend->grab().toImage() != before);
}

/// The panel had the next picture's numbers while the legend had those of the last one: torque 1.17 and 0.00.
void ViewportTest::aSnapshotIsToldAsDrawnWithItsPicture() {
  (void)newPictures();
  std::vector<double> told;
  const auto connection =
      connect(viewport_.get(), &ui::Viewport::snapshotDrawn, this,
              [&told](const ServoSnapshot& snapshot) { told.push_back(snapshot.energyToHand); });
  for (const double energy : {1.0, 2.0}) {
    snapshot_->proxy.translation.x += 0.001;
    snapshot_->energyToHand = energy;
    showSnapshot();
  }
  QVERIFY(told.empty());
  QCOMPARE(newPictures(), 1);
  QCOMPARE(told, (std::vector{2.0}));
  // It changes no glyph, so that no picture follows.
  snapshot_->energyToHand = 3.0;
  showSnapshot();
  QCOMPARE(told, (std::vector{2.0, 3.0}));
  QCOMPARE(newPictures(), 0);
  disconnect(connection);
}

/// Stop wiped the glyphs. Past ones differ from the background less than present ones.
void ViewportTest::aPastSnapshotStaysPaler() {
  auto* legend = viewport_->findChild<ui::ColourLegend*>();
  const auto picture = [&] {
    (void)newPictures();
    return viewport_->grabFramebuffer();
  };
  const auto pastPicture = [&] {
    viewport_->keepSnapshot();
    [&] { QVERIFY(newPictures() > 0); }();
    return viewport_->grabFramebuffer();
  };
  snapshot_->wrench.force = {0.0, 0.0, 0.0};
  showSnapshot();
  const QImage presentWithout = picture();
  const QImage pastWithout = pastPicture();
  snapshot_->wrench.force = {0.0, 2.0, 0.0};
  showSnapshot();
  const QImage present = picture();
  const QImage legendPresent = legend->grab().toImage();
  const QImage past = pastPicture();
  const auto strength = [](const QImage& with, const QImage& without) {
    qint64 sum = 0;
    for (int y = 0; y < with.height(); ++y) {
      for (int x = 0; x < with.width(); ++x) {
        const QRgb a = with.pixel(x, y), b = without.pixel(x, y);
        sum += std::abs(qRed(a) - qRed(b)) + std::abs(qGreen(a) - qGreen(b)) + std::abs(qBlue(a) - qBlue(b));
      }
    }
    return sum;
  };
  const qint64 strongArrow = strength(present, presentWithout), paleArrow = strength(past, pastWithout);
  QVERIFY2(paleArrow > 0, "it stays");
  QVERIFY2(paleArrow < 3 * strongArrow / 4, "it is paler");
  QVERIFY(legend->isVisible());
  QVERIFY(legend->grab().toImage() != legendPresent);
  // The same snapshot felt again is present again.
  showSnapshot();
  QVERIFY(newPictures() > 0);
  QCOMPARE(viewport_->grabFramebuffer(), present);
  QCOMPARE(legend->grab().toImage(), legendPresent);
  viewport_->keepSnapshot();
  viewport_->clearSnapshot();
  QVERIFY(newPictures() > 0);
  QVERIFY(!legend->isVisible());
}

NEARFIT_QT_SUITE(ViewportTest, [](int argc, char** argv) {
  ui::Viewport::setDefaultSurfaceFormat();
  return test::runQtTest<ViewportTest>(argc, argv);
})
#include "viewport_test.moc"
