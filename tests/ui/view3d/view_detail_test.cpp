#include "ui/view3d/view_detail.h"

#include <QThread>
#include <QtTest>
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include <glm/geometric.hpp>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkOpenGLVertexBufferObjectGroup.h>

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

constexpr std::uint32_t kSubdivisions = 5;
constexpr std::size_t kTriangles = 20 << (2 * kSubdivisions), kParts = 6, kBudget = 9'000;

/// A row of balls that share a mesh, in a view that may draw few triangles while something moves.
struct Row {
  /// @param opaque  How many of them; the others are seen through.
  explicit Row(std::size_t opaque = kParts) {
    for (std::size_t i = 0; i < kParts; ++i) {
      Part part = test::partOf(ball, "ball");
      if (i >= opaque) part.opacity = 0.4;
      part.worldFromPart.translation.x = 0.05 * static_cast<double>(i);
      ids.push_back(scene.add(part));
    }
    view.detail().setBudget(kBudget);
    view.resize(500, 400);
    view.setScene(scene);
    view.show();
    (void)QTest::qWaitForWindowExposed(&view);
  }
  void turn() {
    view.camera()->Azimuth(5.0);
    view.requestRender();
  }
  /// Triangles of the first picture after a turn.
  std::size_t drawnOnceTurned() {
    std::size_t first = 0;
    const QMetaObject::Connection watch = QObject::connect(&view, &ui::Viewport::drawn, &view, [&] {
      if (first == 0) first = view.detail().detail().triangles;
    });
    turn();
    (void)QTest::qWaitFor([&] { return first > 0; }, test::kQtPatienceMs);
    QObject::disconnect(watch);
    return first;
  }
  bool isFull() { return view.detail().detail().isFull; }
  /// Also when the window system asks for a picture late.
  bool comesToRest() {
    for (int again = 0; again < 30; ++again) {
      const int before = view.pictureCount();
      QTest::qWait(700);
      if (view.pictureCount() == before && isFull()) return true;
    }
    return false;
  }

  PartGeometryPtr ball = test::solidGeometryOf(test::icosphereMesh(0.02, kSubdivisions));
  Scene scene;
  std::vector<PartId> ids;
  Session session;
  ui::Selection selection{session};
  ui::ShownPoses poses{session};
  ui::Viewport view{std::make_shared<ui::PartShapeCache>(), selection, poses};
};

}  // namespace

class ViewDetailTest : public QObject {
  Q_OBJECT

 private slots:
  void whatMovesStaysWithinTheBudget();
  void howMuchIsDrawnWhileFeelingIsChosen();
  void aSnapshotMeansFeelingUntilItIsPast();
  void aStillViewShowsEveryTriangle();
  void aFullPictureIsThatOfTheMeshesThemselves();
  void nothingIsDrawnOnceItIsFull();
  void whatShinesThroughIsWholeAtRestToo();
  void aViewFromWithinComesToRest();
  void aPartThatMovesIsDrawnOverWhatIsKept();
  void manyRequestsAreOnePicture();
  void partsOfOneMeshShareItsBuffers();
  void picksAreOfTheMeshWhileDraftsAreShown();
  void whatIsHiddenLeavesThePicture();
  void slowPicturesOfWhatMovesAreNotTakenForRest();
};

void ViewDetailTest::whatMovesStaysWithinTheBudget() {
  Row row;
  QVERIFY(row.comesToRest());
  std::size_t most = 0;
  int drawn = 0;
  connect(&row.view, &ui::Viewport::drawn, &row.view, [&] {
    // The first picture after the turn.
    if (drawn++ == 0) most = row.view.detail().detail().triangles;
  });
  row.turn();
  QTRY_VERIFY(drawn > 0);
  QVERIFY(most > 0);
  QVERIFY2(most <= kBudget, qPrintable(QString::number(most)));
}

/// Parts became crumpled shells in which bolt holes were lost.
void ViewDetailTest::howMuchIsDrawnWhileFeelingIsChosen() {
  Row row;
  QVERIFY(row.comesToRest());
  const auto drawnOnceTurned = [&] { return row.drawnOnceTurned(); };
  constexpr std::size_t kAll = kParts * kTriangles;
  QVERIFY(drawnOnceTurned() <= kBudget);
  row.view.detail().setFeeling(true);
  QCOMPARE(drawnOnceTurned(), kAll);
  row.view.detail().setFeelQuality(ui::FeelQuality::Fast);
  QVERIFY(drawnOnceTurned() <= kBudget);
  row.view.detail().setFeelQuality(ui::FeelQuality::Full);
  QCOMPARE(drawnOnceTurned(), kAll);
  row.view.detail().setFeeling(false);
  QVERIFY(drawnOnceTurned() <= kBudget);
}

/// The view tells its pictures by the snapshots that it is given.
void ViewDetailTest::aSnapshotMeansFeelingUntilItIsPast() {
  Row row;
  QVERIFY(row.comesToRest());
  constexpr std::size_t kAll = kParts * kTriangles;
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->moving = row.ids.front();
  snapshot->proxy = snapshot->handle = row.scene.find(row.ids.front())->worldFromPart;
  QVERIFY(row.drawnOnceTurned() <= kBudget);
  row.view.showSnapshot(*snapshot);
  QCOMPARE(row.drawnOnceTurned(), kAll);
  row.view.keepSnapshot();
  QVERIFY(row.drawnOnceTurned() <= kBudget);
  row.view.showSnapshot(*snapshot);
  QCOMPARE(row.drawnOnceTurned(), kAll);
  row.view.clearSnapshot();
  QVERIFY(row.drawnOnceTurned() <= kBudget);
}

void ViewDetailTest::aStillViewShowsEveryTriangle() {
  Row row;
  QVERIFY(row.comesToRest());
  row.turn();
  QTRY_VERIFY(!row.isFull());
  QTRY_VERIFY(row.isFull());
  // All that is opaque and stands is kept, as it is.
  QVERIFY(row.view.detail().detail().isKept);
  row.view.parts().letGoOfKept();
  QCOMPARE(row.view.parts().applyDetail({kParts * kTriangles + 1}).triangles, kParts * kTriangles);
}

void ViewDetailTest::aFullPictureIsThatOfTheMeshesThemselves() {
  Row limited;
  QVERIFY(limited.comesToRest());
  const QImage kept = limited.view.grabFramebuffer().convertToFormat(QImage::Format_RGB32);
  QVERIFY(limited.view.detail().detail().isKept);
  // The same again, drawn at once.
  limited.view.detail().setBudget(10 * kParts * kTriangles);
  limited.view.detail().drop();
  limited.view.detail().drawFullNext();
  limited.view.requestRender();
  QTRY_VERIFY(!limited.view.detail().detail().isKept);
  const QImage whole = limited.view.grabFramebuffer().convertToFormat(QImage::Format_RGB32);
  QCOMPARE(kept.size(), whole.size());
  int different = 0;
  for (int y = 0; y < whole.height(); ++y) {
    for (int x = 0; x < whole.width(); ++x) {
      const QRgb a = kept.pixel(x, y), b = whole.pixel(x, y);
      const int off = std::max(
          {std::abs(qRed(a) - qRed(b)), std::abs(qGreen(a) - qGreen(b)), std::abs(qBlue(a) - qBlue(b))});
      if (off > 8) ++different;
    }
  }
  // Depths differ in their last bits, where surfaces and edges meet.
  QVERIFY2(different < whole.width() * whole.height() / 500, qPrintable(QString::number(different)));
}

void ViewDetailTest::nothingIsDrawnOnceItIsFull() {
  Row row;
  row.turn();
  QVERIFY(row.comesToRest());
  const int before = row.view.pictureCount();
  for (int i = 0; i < 20; ++i)
    QTest::qWait(20);
  QCOMPARE(row.view.pictureCount(), before);
}

/// It cannot be kept, and was drawn coarsely again and again.
void ViewDetailTest::whatShinesThroughIsWholeAtRestToo() {
  for (const std::size_t opaque : {std::size_t{1}, std::size_t{0}}) {
    Row row(opaque);
    row.turn();
    QVERIFY(row.comesToRest());
    QVERIFY(row.view.detail().detail().triangles >= (kParts - opaque) * kTriangles);
  }
}

/// Depths that begin at the eye were never taken for those that had been kept, and all was drawn again and
/// again.
void ViewDetailTest::aViewFromWithinComesToRest() {
  Row row;
  QVERIFY(row.comesToRest());
  // Between the first and the second, along the row.
  row.view.camera()->SetPosition(0.025, 0.0, 0.0);
  row.view.camera()->SetFocalPoint(0.3, 0.0, 0.0);
  row.view.requestRender();
  QTRY_VERIFY(!row.isFull());
  QVERIFY(row.comesToRest());
  QVERIFY(row.view.detail().detail().isKept);
}

void ViewDetailTest::aPartThatMovesIsDrawnOverWhatIsKept() {
  Row row;
  QVERIFY(row.comesToRest());
  RigidTransform pose = row.scene.find(row.ids[2])->worldFromPart;
  // It goes on until the others, which stand, are kept.
  bool isKept = false;
  std::size_t drawn = 0;
  for (int step = 0; step < 3000 && !isKept; ++step) {
    pose.translation.z = 0.005 * std::sin(0.1 * step);
    row.poses.show(ui::ShownPoses::Source::Drag, {{row.ids[2], pose}});
    QTest::qWait(10);
    drawn = row.view.detail().detail().triangles;
    isKept = row.view.detail().detail().isKept && drawn > 0;
  }
  QVERIFY(isKept);
  QVERIFY2(drawn > 0 && drawn <= kTriangles, qPrintable(QString::number(drawn)));
  QVERIFY(row.comesToRest());
}

void ViewDetailTest::manyRequestsAreOnePicture() {
  Row row;
  row.view.detail().setBudget(10 * kParts * kTriangles);
  QVERIFY(row.comesToRest());
  const int before = row.view.pictureCount();
  for (int i = 0; i < 50; ++i)
    row.turn();
  QVERIFY(row.comesToRest());
  // One while it moves, and at most a few until it is whole.
  const int pictures = row.view.pictureCount() - before;
  QVERIFY2(pictures >= 1 && pictures <= 3, qPrintable(QString::number(pictures)));
}

void ViewDetailTest::partsOfOneMeshShareItsBuffers() {
  Row row;
  row.view.detail().setBudget(10 * kParts * kTriangles);
  QVERIFY(row.comesToRest());
  std::set<vtkMapper*> mappers;
  std::set<vtkOpenGLVertexBufferObject*> buffers;
  std::size_t actors = 0;
  for (const PartId id : row.ids) {
    for (const auto& piece : row.view.parts().find(id)->pieces()) {
      ++actors;
      mappers.insert(piece->GetMapper());
      auto* mapper = vtkOpenGLPolyDataMapper::SafeDownCast(piece->GetMapper());
      QVERIFY(mapper != nullptr);
      buffers.insert(mapper->GetVBOs()->GetVBO("vertexMC"));
    }
  }
  QCOMPARE(actors, kParts);
  QCOMPARE(mappers.size(), std::size_t{1});
  QCOMPARE(buffers.size(), std::size_t{1});
  QVERIFY(*buffers.begin() != nullptr);
}

void ViewDetailTest::picksAreOfTheMeshWhileDraftsAreShown() {
  Row row;
  QVERIFY(row.comesToRest());
  const QPoint centre(row.view.width() / 2, row.view.height() / 2);
  row.view.parts().applyDetail({1});
  std::optional<ui::PickedPoint> picked;
  for (int x = -200; x <= 200 && !picked; x += 10)
    picked = row.view.pointAt(centre + QPoint(x, 0));
  QVERIFY(picked);
  QVERIFY(picked->triangle < kTriangles);
  const auto& mesh = row.ball->mesh;
  const Triangle& corners = mesh.triangles()[picked->triangle];
  const glm::dvec3 point = picked->point - row.scene.find(picked->part)->worldFromPart.translation;
  // In the plane of that triangle.
  const glm::dvec3 a = mesh.vertices()[corners[0]], b = mesh.vertices()[corners[1]],
                   c = mesh.vertices()[corners[2]];
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  QVERIFY(std::abs(glm::dot(point - a, normal)) < 1e-9);
}

void ViewDetailTest::whatIsHiddenLeavesThePicture() {
  Row row;
  QVERIFY(row.comesToRest());
  QVERIFY(row.view.detail().detail().isKept);
  const QImage before = row.view.grabFramebuffer();
  for (const PartId id : row.ids) {
    Part part = *row.scene.find(id);
    part.isVisible = false;
    row.scene.replace(part);
  }
  row.view.setScene(row.scene);
  QVERIFY(row.comesToRest());
  const QImage after = row.view.grabFramebuffer();
  QVERIFY(before != after);
  QVERIFY(!row.view.pointAt({row.view.width() / 2, row.view.height() / 2}));
}

/// Pictures that took longer than a rest were each followed by a whole one, while the camera still turned.
void ViewDetailTest::slowPicturesOfWhatMovesAreNotTakenForRest() {
  Row row;
  QVERIFY(row.comesToRest());
  // The overlay is drawn last.
  vtkNew<vtkCallbackCommand> slowly;
  slowly->SetCallback([](vtkObject*, unsigned long, void*, void*) { QThread::msleep(300); });
  const unsigned long observer = row.view.overlay().AddObserver(vtkCommand::StartEvent, slowly);
  int moving = 0, whole = 0;
  connect(&row.view, &ui::Viewport::drawn, &row.view, [&] {
    const auto& detail = row.view.detail().detail();
    ++(detail.isKept || detail.isFull ? whole : moving);
    row.turn();
  });
  row.turn();
  QTRY_VERIFY_WITH_TIMEOUT(moving + whole >= 8, 30'000);
  QVERIFY2(whole <= 2, qPrintable(QString::number(whole)));
  disconnect(&row.view, &ui::Viewport::drawn, &row.view, nullptr);
  row.view.overlay().RemoveObserver(observer);
  QVERIFY(row.comesToRest());
}

NEARFIT_QT_SUITE(ViewDetailTest, [](int argc, char** argv) {
  ui::Viewport::setDefaultSurfaceFormat();
  return test::runQtTest<ViewDetailTest>(argc, argv);
})
#include "view_detail_test.moc"
