#include "ui/view3d/parts/scene_renderer.h"

#include <QtTest>
#include <algorithm>
#include <array>

#include <vtkActorCollection.h>
#include <vtkCamera.h>
#include <vtkCollection.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/qt/contrast.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/shown_poses.h"
#include "ui/widgets/theme.h"

using namespace nearfit;

class SceneRendererTest : public QObject {
  Q_OBJECT

 private slots:
  void partsThatOverlapAreTintedAndGetTheirColourBack();
  void boundsOfAPartAreThoseInTheWorld();
  void edgesThatWouldCoverAPartAreLeftOut();
  void aSelectedPartIsTintedByTheVeilOfItsShape();
  void aShapeTakesThePlaceOfItsBoxWithItsColours();
  void aPartIsAddedWithoutASearchThroughAllOthers();
  void newPartsBeyondALimitAreHeldBackAndAdmittedShapeByShape();
  void outlinesBesideAMapStandOutAndFollowTheTheme();
  void edgesStandOutFromFacesAndFollowTheTheme();
  void cleanup() { ui::setColourScheme(ui::ColourScheme::Light); }

 private:
  static PartGeometryPtr cube() {
    auto geometry = std::make_shared<PartGeometry>();
    geometry->mesh = test::boxMesh(glm::dvec3(0.02));
    return geometry;
  }
  static Part partOf(const char* name) {
    Part part;
    part.name = name;
    part.geometry = cube();
    part.colour = {0.0F, 0.0F, 1.0F};
    return part;
  }
  int countOf(const QColor& colour) {
    int count = 0;
    vtkActorCollection* actors = renderer_->GetActors();
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor()) {
      const double* rgb = actor->GetProperty()->GetColor();
      const bool isSame = std::abs(rgb[0] - colour.redF()) < 1e-3 &&
                          std::abs(rgb[1] - colour.greenF()) < 1e-3 &&
                          std::abs(rgb[2] - colour.blueF()) < 1e-3;
      if (isSame) ++count;
    }
    return count;
  }

  /// Of what is drawn without light.
  int visibleLines() {
    int count = 0;
    vtkActorCollection* actors = renderer_->GetActors();
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor())
      count += actor->GetVisibility() != 0 && !actor->GetProperty()->GetLighting() ? 1 : 0;
    return count;
  }

  vtkNew<vtkRenderer> renderer_;
  Session session_;
  ui::ShownPoses poses_{session_};
  ui::SceneRenderer parts_{*renderer_.Get(), std::make_shared<ui::PartShapeCache>(), poses_};
};

void SceneRendererTest::partsThatOverlapAreTintedAndGetTheirColourBack() {
  Scene scene;
  const PartId a = scene.add(partOf("a"));
  scene.add(partOf("b"));
  parts_.setScene(scene);
  QCOMPARE(countOf(Qt::blue), 2);
  const std::array overlapping{a};
  parts_.setOverlapping(overlapping);
  QCOMPARE(countOf(ui::colours::kOverlap), 1);
  QCOMPARE(countOf(Qt::blue), 1);
  parts_.setOverlapping({});
  QCOMPARE(countOf(ui::colours::kOverlap), 0);
  QCOMPARE(countOf(Qt::blue), 2);
}

void SceneRendererTest::boundsOfAPartAreThoseInTheWorld() {
  Scene scene;
  Part part = partOf("a");
  part.worldFromPart.translation = {0.1, 0.0, 0.0};
  const PartId a = scene.add(part);
  parts_.setScene(scene);
  double bounds[6];
  QVERIFY(parts_.boundsOf(a, bounds));
  QVERIFY(std::abs(bounds[0] - 0.09) < 1e-9 && std::abs(bounds[1] - 0.11) < 1e-9);
  QVERIFY(!parts_.boundsOf(PartId{99}, bounds));
}

/// AddViewProp() looks for a prop among all others first: for all parts together that takes the square of their number.
void SceneRendererTest::aPartIsAddedWithoutASearchThroughAllOthers() {
  /// Grants the first element of a collection.
  struct Collection : vtkCollection {
    static vtkCollectionElement* firstOf(vtkCollection& collection) { return collection.*(&Collection::Top); }
  };
  const auto shape = std::make_shared<const ui::PartShape>(ui::makePartShape(cube()->mesh));
  const auto mappers = std::make_shared<ui::ShapeMappers>(shape);
  const auto props = [this] { return renderer_->GetViewProps()->GetNumberOfItems(); };
  const int before = props();
  const ui::PartActor first(*renderer_.Get(), mappers);
  const int ofOne = props() - before;
  QVERIFY(ofOne >= 2);
  vtkCollectionElement* top = Collection::firstOf(*renderer_->GetViewProps());
  vtkCollectionElement* const next = top->Next;
  // The list turns in a circle: a search for what is not there does not end, and adding at the end is not hindered.
  top->Next = top;
  const ui::PartActor second(*renderer_.Get(), mappers);
  top->Next = next;
  QCOMPARE(props(), before + 2 * ofOne);
}

void SceneRendererTest::newPartsBeyondALimitAreHeldBackAndAdmittedShapeByShape() {
  vtkNew<vtkRenderWindow> window;
  window->SetSize(600, 600);
  window->AddRenderer(renderer_);
  // Three parts of one shape, and two of one each.
  constexpr std::size_t kAllParts = 5, kEnough = 1'000'000;
  Scene scene;
  const Part shared = partOf("shared");
  std::vector<PartId> ids;
  for (std::size_t i = 0; i < kAllParts; ++i) {
    Part part = i % 2 == 0 ? shared : partOf("other");
    part.worldFromPart.translation.x = 0.1 * static_cast<double>(i);
    ids.push_back(scene.add(part));
  }
  parts_.setScene(scene);
  const auto visible = [&] {
    return static_cast<std::size_t>(std::ranges::count_if(
        ids, [&](PartId id) { return parts_.find(id)->pieces().front()->GetVisibility() != 0; }));
  };
  const auto applied = [&](const ui::NewPartLimits& limits) { return parts_.applyDetail({kEnough}, limits); };
  QCOMPARE(applied({2, kEnough}).triangles, std::size_t{0});
  QVERIFY(parts_.isHoldingBack());
  QCOMPARE(visible(), std::size_t{0});
  // 12 triangles each, and edges.
  applied({3, 35});
  QCOMPARE(visible(), std::size_t{0});
  std::size_t uploads = 0;
  while (!parts_.admitNext().empty())
    ++uploads;
  QCOMPARE(uploads, std::size_t{3});
  QVERIFY(!parts_.isHoldingBack());
  QCOMPARE(visible(), kAllParts);
  // None of them is new any more.
  applied({0, 0});
  QCOMPARE(visible(), kAllParts);
  // Others of a shape that is there cost nothing.
  for (int i = 0; i < 3; ++i)
    ids.push_back(scene.add(shared));
  parts_.setScene(scene);
  applied({0, 0});
  QCOMPARE(visible(), kAllParts + 3);
  // Few new ones are within the limit.
  for (int i = 0; i < 2; ++i)
    ids.push_back(scene.add(partOf("few")));
  parts_.setScene(scene);
  applied({2, kEnough});
  QVERIFY(!parts_.isHoldingBack());
  QCOMPARE(visible(), ids.size());
  window->RemoveRenderer(renderer_);
}

void SceneRendererTest::edgesThatWouldCoverAPartAreLeftOut() {
  vtkNew<vtkRenderWindow> window;
  window->SetSize(600, 600);
  window->AddRenderer(renderer_);
  Scene scene;
  scene.add(partOf("a"));
  parts_.setScene(scene);
  vtkCamera* camera = renderer_->GetActiveCamera();
  camera->ParallelProjectionOn();
  // A cube of 20 mm, so many pixels wide.
  for (const auto& [pixels, lines] : {std::pair{300.0, 1}, {40.0, 1}, {4.0, 0}, {300.0, 1}}) {
    camera->SetParallelScale(0.02 / pixels * 300.0);
    parts_.applyDetail({1'000'000});
    QCOMPARE(visibleLines(), lines);
  }
  window->RemoveRenderer(renderer_);
}

/// It was tinted by a draft, which is coarser.
void SceneRendererTest::aSelectedPartIsTintedByTheVeilOfItsShape() {
  auto geometry = std::make_shared<PartGeometry>();
  geometry->mesh = test::icosphereMesh(0.02, 4);
  Part ball = partOf("ball");
  ball.geometry = geometry;
  Scene scene;
  const PartId id = scene.add(ball);
  const auto shapes = std::make_shared<ui::PartShapeCache>();
  vtkNew<vtkRenderer> under, over;
  ui::SceneRenderer parts(*under.Get(), shapes, poses_, over.Get());
  parts.setScene(scene);
  QCOMPARE(over->GetActors()->GetNumberOfItems(), 0);
  parts.setSelected({id});
  const auto shape = shapes->shapeOf(geometry);
  QVERIFY(shape->veil.Get() != shape->finestDraft());
  int veils = 0;
  vtkActorCollection* actors = over->GetActors();
  actors->InitTraversal();
  while (vtkActor* actor = actors->GetNextActor()) {
    const vtkPolyData* drawn = vtkPolyDataMapper::SafeDownCast(actor->GetMapper())->GetInput();
    if (drawn == shape->edges.Get()) continue;
    QCOMPARE(drawn, static_cast<const vtkPolyData*>(shape->veil.Get()));
    veils += actor->GetVisibility() != 0 ? 1 : 0;
  }
  QCOMPARE(veils, 1);
  parts.setSelected({});
  QCOMPARE(over->GetActors()->GetNumberOfItems(), 0);
}

void SceneRendererTest::aShapeTakesThePlaceOfItsBoxWithItsColours() {
  auto geometry = std::make_shared<PartGeometry>();
  geometry->mesh = test::icosphereMesh(0.02, 7);
  Part ball = partOf("ball");
  ball.geometry = geometry;
  Scene scene;
  const PartId id = scene.add(ball);
  const auto shapes = std::make_shared<ui::PartShapeCache>();
  shapes->prepare(scene.geometries(), {});
  vtkNew<vtkRenderer> renderer;
  ui::SceneRenderer parts(*renderer.Get(), shapes, poses_);
  parts.setScene(scene);
  double boxed[6], whole[6];
  QVERIFY(parts.boundsOf(id, boxed));
  ui::ColouredSurface surface;
  surface.range = 0.01;
  const auto colours = std::make_shared<const ui::ColouredSurface>(surface);
  parts.setColours({{id, colours}}, true);
  QVERIFY(parts.find(id)->shape().isStandIn);
  QVERIFY(!parts.takeNewShapes());
  parts.makeShapes();
  QVERIFY(!parts.find(id)->shape().isStandIn);
  QCOMPARE(parts.find(id)->colours().get(), colours.get());
  QVERIFY(parts.find(id)->areColoursStale());
  QVERIFY(parts.boundsOf(id, whole));
  for (int i = 0; i < 6; ++i)
    QVERIFY(std::abs(boxed[i] - whole[i]) < 1e-6);
}

/// In the dark theme they were nearly as dark as the background.
void SceneRendererTest::outlinesBesideAMapStandOutAndFollowTheTheme() {
  Scene scene;
  const PartId mapped = scene.add(partOf("a"));
  Part beside = partOf("b");
  beside.opacity = 0.5;
  const PartId outlined = scene.add(beside);
  parts_.setScene(scene);
  ui::ColouredSurface surface;
  surface.range = 0.01;
  parts_.setColours({{mapped, std::make_shared<const ui::ColouredSurface>(surface)}}, false);
  for (const ui::ColourScheme scheme : {ui::ColourScheme::Light, ui::ColourScheme::Dark}) {
    ui::setColourScheme(scheme);
    parts_.followTheme();
    vtkProperty& lines = parts_.find(outlined)->edgeLook();
    double rgb[3];
    lines.GetColor(rgb);
    const QColor shown = QColor::fromRgbF(rgb[0], rgb[1], rgb[2]);
    const ui::ViewGround ground = ui::viewGround();
    QCOMPARE(lines.GetOpacity(), 1.0);
    QVERIFY2(test::contrast(shown, ground.lower) >= 3.0 && test::contrast(shown, ground.upper) >= 3.0,
             qPrintable(shown.name()));
  }
}

/// Dark edges on a dark ground could hardly be seen. WCAG 2.1 asks for 3 of lines.
void SceneRendererTest::edgesStandOutFromFacesAndFollowTheTheme() {
  Scene scene;
  std::vector<PartId> ids;
  for (const float grey : {0.02F, 0.25F, 0.4F, 0.55F, 0.7F, 0.95F}) {
    Part part = partOf("grey");
    part.name += std::to_string(ids.size());
    part.colour = {grey, grey, grey};
    ids.push_back(scene.add(part));
  }
  parts_.setScene(scene);
  const auto shown = [this](PartId id) {
    double rgb[3];
    parts_.find(id)->edgeLook().GetColor(rgb);
    return QColor::fromRgbF(rgb[0], rgb[1], rgb[2]);
  };
  for (const ui::ColourScheme scheme : {ui::ColourScheme::Light, ui::ColourScheme::Dark}) {
    ui::setColourScheme(scheme);
    parts_.followTheme();
    for (const PartId id : ids) {
      const auto grey = static_cast<double>(scene.get(id).colour.r);
      // Fully lit, and with what ambient and diffuse light leave of it.
      const QColor face = QColor::fromRgbF(0.94 * grey, 0.94 * grey, 0.94 * grey);
      QVERIFY2(test::contrast(shown(id), face) >= 3.0, qPrintable(face.name()));
    }
  }
  // Where both are enough, as at a luminance of 0.23, the ground decides.
  QVERIFY(test::contrast(shown(ids[3]), ui::viewGround().lower) >= 3.0);
  QVERIFY(test::contrast(shown(ids[3]), ui::viewGround().upper) >= 3.0);
  ui::setColourScheme(ui::ColourScheme::Light);
  parts_.followTheme();
  QVERIFY(test::contrast(shown(ids[3]), ui::viewGround().lower) >= 3.0);
}

NEARFIT_QT_SUITE(SceneRendererTest, test::runQtTest<SceneRendererTest>)
#include "scene_renderer_test.moc"
