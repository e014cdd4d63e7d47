// How the parts of a document just opened come into the view, without a check of any time.
#include <QtTest>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include <vtkCallbackCommand.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkOpenGLVertexBufferObjectGroup.h>

#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/view_detail.h"
#include "ui/view3d/view_picture.h"
#include "ui/view3d/viewport.h"

using namespace nearfit;

namespace {

/// Radii of balls in a row [m]: each is seen larger than the next smaller one, at whichever end of the row.
constexpr std::array kRadii{0.009, 0.03, 0.006, 0.02, 0.0135};
constexpr std::size_t kBalls = kRadii.size(), kLargestBall = 1, kSmallestBall = 2, kClearBall = 4;
constexpr double kBallStep = 0.08;  ///< From one ball to the next [m].

using Balls = std::vector<std::size_t>;

Balls allBalls() {
  return {0, 1, 2, 3, 4};
}

/// Every turn uploads one part, and a picture follows it.
ui::FillLimits oneByOne() {
  return {{0, 0}, std::chrono::microseconds{0}, std::chrono::milliseconds{0}};
}

/// An empty view that has been drawn, and a row of balls of one mesh each to be opened in it.
struct BallsToOpen {
  explicit BallsToOpen(const ui::FillLimits& limits = oneByOne()) {
    for (std::size_t i = 0; i < kBalls; ++i) {
      Part part = test::partOf(test::solidGeometryOf(test::icosphereMesh(kRadii[i], 2)), "ball",
                               {{1, 0, 0, 0}, centreOf(i)});
      part.colour = {1.0F, 0.0F, 0.0F};
      if (i == kClearBall) part.opacity = 0.5;
      ids.push_back(scene.add(part));
    }
    view.detail().setFillLimits(limits);
    view.resize(500, 400);
    view.show();
    (void)QTest::qWaitForWindowExposed(&view);
    (void)QTest::qWaitFor([this] { return view.pictureCount() > 0; }, test::kQtPatienceMs);
    ground = view.grabFramebuffer();
  }
  static glm::dvec3 centreOf(std::size_t ball) { return {kBallStep * static_cast<double>(ball), 0.0, 0.0}; }
  void open() { view.setScene(scene); }
  /// Opens them and draws one picture, before any event.
  void openAndDraw() {
    open();
    view.renderWindow()->Render();
  }
  vtkActor* surfaceOf(std::size_t ball) {
    const ui::PartActor* actor = view.parts().find(ids[ball]);
    return actor == nullptr ? nullptr : actor->pieces().front().Get();
  }
  /// Balls that VTK draws.
  Balls shown() {
    return those([](vtkActor& surface) { return surface.GetVisibility() != 0; });
  }
  /// Balls whose surface OpenGL has.
  Balls uploaded() {
    return those([](vtkActor& surface) {
      auto* mapper = vtkOpenGLPolyDataMapper::SafeDownCast(surface.GetMapper());
      return mapper != nullptr && mapper->GetVBOs()->GetVBO("vertexMC") != nullptr;
    });
  }
  Balls those(const std::function<bool(vtkActor&)>& isOne) {
    Balls balls;
    for (std::size_t i = 0; i < kBalls; ++i) {
      vtkActor* surface = surfaceOf(i);
      if (surface != nullptr && isOne(*surface)) balls.push_back(i);
    }
    return balls;
  }
  QPoint pixelOf(std::size_t ball) {
    const auto pixel = view.projection().pixelOf(centreOf(ball));
    return pixel ? QPoint(static_cast<int>(pixel->x), static_cast<int>(pixel->y)) : QPoint(-1, -1);
  }
  /// Balls in whose middle a picture of the view is not as the empty view was.
  Balls picturedIn(const QImage& picture) {
    constexpr int kOther = 30;  // Of 255; the light on a ball and what shines through it differ.
    Balls balls;
    for (std::size_t i = 0; i < kBalls; ++i) {
      const QRgb a = picture.pixel(pixelOf(i)), b = ground.pixel(pixelOf(i));
      const int off = std::max(
          {std::abs(qRed(a) - qRed(b)), std::abs(qGreen(a) - qGreen(b)), std::abs(qBlue(a) - qBlue(b))});
      if (off > kOther) balls.push_back(i);
    }
    return balls;
  }

  Scene scene;
  std::vector<PartId> ids;
  QImage ground;
  Session session;
  ui::Selection selection{session};
  ui::ShownPoses poses{session};
  ui::Viewport view{std::make_shared<ui::PartShapeCache>(), selection, poses};
};

}  // namespace

class ViewFillingTest : public QObject {
  Q_OBJECT

 private slots:
  void aTurnAddsOnePartAndTheLargestComesFirst();
  void compilingShadersLeavesNoTrace();
  void fewPartsAreInTheFirstPicture();
  void whatIsExportedIsCompleteAtOnce_data();
  void whatIsExportedIsCompleteAtOnce();
  void whatIsHiddenOrRemovedMeanwhileIsNeverDrawn();
  void picksAndBoundsAreOfAllParts();
  void aPartShownOnceStaysWhileOthersCome();
};

void ViewFillingTest::aTurnAddsOnePartAndTheLargestComesFirst() {
  BallsToOpen balls;
  std::vector<Balls> pictures;
  // Once all are there they may come from a kept picture.
  const auto areAllIn = [&] { return !pictures.empty() && pictures.back().size() == kBalls; };
  connect(&balls.view, &ui::Viewport::drawn, &balls.view, [&] {
    if (!areAllIn()) pictures.push_back(balls.shown());
  });
  bool isUploadedBefore = true;
  std::function<void()> beforePicture = [&] {
    if (!pictures.empty() && !areAllIn())
      isUploadedBefore = isUploadedBefore && balls.uploaded() == balls.shown();
  };
  vtkNew<vtkCallbackCommand> begins;
  begins->SetClientData(&beforePicture);
  begins->SetCallback(
      [](vtkObject*, unsigned long, void* act, void*) { (*static_cast<std::function<void()>*>(act))(); });
  const unsigned long observer = balls.view.renderWindow()->AddObserver(vtkCommand::StartEvent, begins);
  balls.open();
  QTRY_VERIFY(areAllIn());
  balls.view.renderWindow()->RemoveObserver(observer);
  QVERIFY(isUploadedBefore);
  QVERIFY(pictures.front().empty());
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    const std::size_t before = pictures[i - 1].size(), now = pictures[i].size();
    // The last one is left to the picture itself.
    QVERIFY(now == before || now == before + 1 || (now == kBalls && before + 2 == kBalls));
    if (before == 0 && now == 1) QCOMPARE(pictures[i].front(), kLargestBall);
  }
  QTRY_VERIFY(balls.view.detail().isSettled());
  QVERIFY(balls.view.detail().detail().isFull);
  QCOMPARE(balls.picturedIn(balls.view.grabFramebuffer()), allBalls());
}

void ViewFillingTest::compilingShadersLeavesNoTrace() {
  BallsToOpen balls;
  QTRY_VERIFY(balls.view.detail().areShadersReady());
  balls.view.renderWindow()->Render();
  QCOMPARE(balls.view.grabFramebuffer(), balls.ground);
  balls.openAndDraw();
  QTRY_VERIFY(balls.view.detail().isSettled());
  QCOMPARE(balls.picturedIn(balls.view.grabFramebuffer()), allBalls());
}

void ViewFillingTest::fewPartsAreInTheFirstPicture() {
  BallsToOpen balls{ui::FillLimits{}};
  balls.openAndDraw();
  QCOMPARE(balls.shown(), allBalls());
  QCOMPARE(balls.uploaded(), allBalls());
}

void ViewFillingTest::whatIsExportedIsCompleteAtOnce_data() {
  QTest::addColumn<int>("way");
  QTest::newRow("exported") << 0;
  QTest::newRow("preview") << 1;
  QTest::newRow("completed") << 2;
  QTest::newRow("completed before the first picture") << 3;
}

void ViewFillingTest::whatIsExportedIsCompleteAtOnce() {
  QFETCH(int, way);
  BallsToOpen balls;
  way < 3 ? balls.openAndDraw() : balls.open();
  QVERIFY(balls.uploaded().empty());
  QImage picture;
  if (way == 0) picture = balls.view.pictures().take({});
  if (way == 1) picture = balls.view.pictures().preview({});
  if (way >= 2) {
    balls.view.completePicture();
    picture = balls.view.grabFramebuffer();
  }
  QCOMPARE(picture.size(), balls.ground.size());
  QCOMPARE(balls.picturedIn(picture), allBalls());
  QCOMPARE(balls.uploaded(), allBalls());
}

void ViewFillingTest::whatIsHiddenOrRemovedMeanwhileIsNeverDrawn() {
  BallsToOpen balls;
  balls.openAndDraw();
  QVERIFY(balls.shown().empty());
  Scene changed = balls.scene;
  Part hidden = *changed.find(balls.ids[kLargestBall]);
  hidden.isVisible = false;
  changed.replace(hidden);
  changed.remove(balls.ids[kSmallestBall]);
  bool isEverShown = false;
  connect(&balls.view, &ui::Viewport::drawn, &balls.view, [&] {
    const Balls shown = balls.shown();
    isEverShown = isEverShown || std::ranges::find(shown, kLargestBall) != shown.end();
  });
  balls.view.setScene(changed);
  QTRY_VERIFY(balls.view.detail().isSettled());
  QVERIFY(!isEverShown);
  const Balls left{0, 3, 4};
  QCOMPARE(balls.uploaded(), left);
  QCOMPARE(balls.picturedIn(balls.view.grabFramebuffer()), left);
  // It is new still, and comes once it is shown.
  balls.view.setScene(balls.scene);
  QTRY_VERIFY(balls.uploaded() == allBalls());
}

void ViewFillingTest::picksAndBoundsAreOfAllParts() {
  BallsToOpen balls;
  balls.openAndDraw();
  QVERIFY(balls.shown().empty());
  for (std::size_t i = 0; i < kBalls; ++i) {
    const auto picked = balls.view.pointAt(balls.pixelOf(i));
    QVERIFY(picked);
    QVERIFY(picked->part == balls.ids[i]);
  }
  QVERIFY(balls.view.partsIn(balls.view.rect()) == balls.ids);
  const Aabb bounds = balls.view.visibleBounds();
  QVERIFY(bounds.lower.x < 0.0 && bounds.upper.x > BallsToOpen::centreOf(kBalls - 1).x);
  balls.view.setView(ui::StandardView::Front);
  balls.view.renderWindow()->Render();
  QVERIFY(balls.view.rect().contains(balls.pixelOf(0)));
  QVERIFY(balls.view.rect().contains(balls.pixelOf(kBalls - 1)));
}

void ViewFillingTest::aPartShownOnceStaysWhileOthersCome() {
  BallsToOpen balls;
  Scene first;
  first.add(*balls.scene.find(balls.ids[0]));
  balls.ids[0] = first.parts().front()->id;
  balls.view.setScene(first);
  balls.view.renderWindow()->Render();
  for (std::size_t i = 1; i < kBalls; ++i)
    balls.ids[i] = first.add(*balls.scene.find(balls.ids[i]));
  balls.view.setScene(first);
  balls.view.setView(ui::StandardView::Isometric);
  balls.view.renderWindow()->Render();
  QCOMPARE(balls.shown(), Balls{0});
  QTRY_VERIFY(balls.view.detail().isSettled());
  QCOMPARE(balls.picturedIn(balls.view.grabFramebuffer()), allBalls());
}

NEARFIT_QT_SUITE(ViewFillingTest, [](int argc, char** argv) {
  ui::Viewport::setDefaultSurfaceFormat();
  return test::runQtTest<ViewFillingTest>(argc, argv);
})
#include "view_filling_test.moc"
