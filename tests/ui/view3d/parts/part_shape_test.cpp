#include "ui/view3d/parts/part_shape.h"

#include <QtTest>
#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include <glm/geometric.hpp>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>

#include "core/mesh/coordinate_rounding.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/support/suggest_scenes.h"

using namespace nearfit;

namespace {

PartGeometryPtr geometryOf(TriangleMesh mesh) {
  return std::make_shared<PartGeometry>(PartGeometry{"", "", 1.0, std::move(mesh), {}, {}});
}

/// True if a triangle meets the line through (x, y) along z.
bool isCrossedBy(vtkPolyData* surface, double x, double y) {
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  surface->GetPolys()->InitTraversal();
  while (surface->GetPolys()->GetNextCell(count, ids) != 0) {
    double p[3][3];
    for (vtkIdType k = 0; k < 3; ++k)
      surface->GetPoint(ids[k], p[k]);
    std::array<double, 3> sides{};
    for (int k = 0; k < 3; ++k) {
      const double *a = p[k], *b = p[(k + 1) % 3];
      sides[static_cast<std::size_t>(k)] = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    }
    const auto [least, most] = std::ranges::minmax(sides);
    if (least > 0.0 || most < 0.0) return true;
  }
  return false;
}

}  // namespace

class PartShapeTest : public QObject {
  Q_OBJECT

 private slots:
  void boxShowsItsTwelveEdges();
  void openSquareShowsItsRim();
  void fineCylinderShowsOnlyItsRims();
  void sliversOfADenseFlatShowNoDiagonals();
  void normalsOfABoxPointOutOfItsFaces();
  void whatIsClusteredToAFewPointsIsShaded();
  void fansAndBooksAreShaded();
  void picksInTinyAndThinMeshesTakeLittleMemory();
  void theVeilOfAPartHasItsOutline();
  void theVeilOfALargePartKeepsToItsOutline();
  void facesThatHaveColoursAreDrawnInThem();
  void whatHasNoColoursOfFacesCostsNothingMore();
  void oneGeometryHasOneShape();
  void manyShapesAreKeptWhileTheirGeometriesExist();
  void unusedShapesAreNotLookedForAtEachNewOne();
  void threadsMayAskAtOnce();
  void muchToPrepareIsPostponedBehindBoxes();
  void aPostponedShapeOfWhatIsGoneIsNotMade();
  void theFinestDraftKeepsHolesAndTheSilhouette();
};

void PartShapeTest::boxShowsItsTwelveEdges() {
  const ui::PartShape shape = ui::makePartShape(test::boxMesh(glm::dvec3(1.0)));
  QCOMPARE(shape.edges->GetNumberOfLines(), vtkIdType{12});
  QCOMPARE(shape.surface->GetNumberOfPolys(), vtkIdType{12});
}

void PartShapeTest::openSquareShowsItsRim() {
  constexpr std::uint32_t kDivisions = 5;
  const ui::PartShape shape = ui::makePartShape(test::squareMesh(1.0, kDivisions));
  QCOMPARE(shape.edges->GetNumberOfLines(), vtkIdType{4} * kDivisions);
}

void PartShapeTest::fineCylinderShowsOnlyItsRims() {
  constexpr std::uint32_t kSegments = 36;  // Facets meet at 10 degrees.
  const ui::PartShape shape = ui::makePartShape(test::cylinderMesh(1.0, 2.0, kSegments));
  QCOMPARE(shape.edges->GetNumberOfLines(), vtkIdType{2} * kSegments);
}

/// A finely cut tray had diagonals all over its flats.
void PartShapeTest::sliversOfADenseFlatShowNoDiagonals() {
  constexpr std::uint32_t kDivisions = 30;
  const RigidTransform turned = RigidTransform{{0.7, -0.2, 0.4, 0.55}, {}}.normalized();
  const TriangleMesh flat = test::inSinglePrecision(
      test::transformed(test::withSlivers(test::squareMesh(1.0, kDivisions), 1e7, 0.0), 1.0, turned));
  const ui::PartShape shape = ui::makePartShape(flat, coordinateRounding(flat.vertices()));
  QCOMPARE(shape.edges->GetNumberOfLines(), vtkIdType{4} * kDivisions);
  QVERIFY(std::abs(shape.edgeLength - 4.0) < 1e-5);
}

void PartShapeTest::normalsOfABoxPointOutOfItsFaces() {
  const ui::PartShape shape = ui::makePartShape(test::boxMesh(glm::dvec3(2.0)));
  vtkDataArray* normals = shape.surface->GetPointData()->GetNormals();
  // Split along the edges: each of the 8 corners once for each of its 3 faces.
  QCOMPARE(normals->GetNumberOfTuples(), vtkIdType{24});
  for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); ++i) {
    double n[3], p[3];
    normals->GetTuple(i, n);
    shape.surface->GetPoint(i, p);
    // On a cube of half side 1 about the origin a face's plane is n.p = 1.
    QVERIFY(std::abs(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - 1.0) < 1e-6);
  }
}

/// While it is felt, a large part was a crumpled shell.
void PartShapeTest::theFinestDraftKeepsHolesAndTheSilhouette() {
  constexpr double kSide = 0.2, kThickness = 0.02, kHoleRadius = 0.0125;
  const TriangleMesh plate = test::subdivided(test::plateWithHoleMesh(kSide, kThickness, kHoleRadius, 48), 4);
  const ui::PartShape shape = ui::makePartShape(plate);
  QVERIFY(!shape.drafts.empty());
  const double cell = shape.levels[1].cell;
  vtkPolyData* draft = shape.finestDraft();
  // Where the hole is there is nothing, and something all around it, as far as a draft may be off.
  QVERIFY(cell < 0.5 * kHoleRadius);
  const double inside = kHoleRadius - 1.5 * cell, outside = kHoleRadius + 1.5 * cell;
  constexpr int kDirections = 16;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 0.1 + 2.0 * 3.14159 * i / kDirections;
    QVERIFY(!isCrossedBy(draft, inside * std::cos(angle), inside * std::sin(angle)));
    QVERIFY(isCrossedBy(draft, outside * std::cos(angle), outside * std::sin(angle)));
  }
  double box[6];
  draft->GetBounds(box);
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * (axis == 2 ? kThickness : kSide);
    QVERIFY(std::abs(box[2 * axis] + half) <= cell && std::abs(box[2 * axis + 1] - half) <= cell);
  }
}

/// Hundreds of triangles meet at each point of the coarsest draft. Its normals once took the square of the triangles:
/// 22 s for 20,000. With 300,000 that is more than an hour, and Qt Test gives a function five minutes.
void PartShapeTest::whatIsClusteredToAFewPointsIsShaded() {
  constexpr std::size_t kTriangles = 300'000;
  const ui::PartShape shape = ui::makePartShape(test::looseTriangles(1, kTriangles));
  QVERIFY(!shape.drafts.empty());
  for (vtkPolyData* draft : shape.drafts) {
    QVERIFY(draft->GetNumberOfPolys() > 0);
    QCOMPARE(draft->GetPointData()->GetNormals()->GetNumberOfTuples(), draft->GetNumberOfPoints());
  }
  // The finest stand-in has as many triangles as the mesh, a draft at most half of them.
  QVERIFY(shape.veil->GetNumberOfPolys() > 0);
  QVERIFY2(2 * shape.veil->GetNumberOfPolys() <= vtkIdType{kTriangles},
           qPrintable(QString::number(shape.veil->GetNumberOfPolys())));
}

void PartShapeTest::fansAndBooksAreShaded() {
  constexpr std::uint32_t kFaces = 200'000;
  for (const TriangleMesh& mesh : {test::jaggedFan(2, kFaces, 0.1), test::finsMesh(3, kFaces, 6.0)}) {
    const ui::PartShape shape = ui::makePartShape(mesh);
    QCOMPARE(shape.surface->GetNumberOfPolys(), vtkIdType{kFaces});
    QVERIFY(shape.edges->GetNumberOfLines() >= vtkIdType{kFaces});
  }
}

void PartShapeTest::picksInTinyAndThinMeshesTakeLittleMemory() {
  const TriangleMesh tiny = test::icosphereMesh(8e-5, 6), thin = test::cylinderMesh(0.01, 1.0, 25'000);
  for (const TriangleMesh& mesh : {tiny, thin}) {
    const ui::PartShape shape = ui::makePartShape(mesh);
    QVERIFY(shape.rays.byteSize() <= RayTree::kMaxBytesPerTriangle * mesh.triangles().size());
    const glm::dvec3 middle = mesh.bounds().centre(), above = middle + glm::dvec3(0.1, 0.2, 3.0);
    QVERIFY(shape.rays.firstHit(above, middle).has_value());
  }
}

void PartShapeTest::manyShapesAreKeptWhileTheirGeometriesExist() {
  ui::PartShapeCache cache;
  std::vector<PartGeometryPtr> geometries;
  std::vector<std::weak_ptr<const ui::PartShape>> shapes;
  for (int i = 0; i < 100; ++i) {
    geometries.push_back(geometryOf(test::tetrahedronMesh()));
    shapes.push_back(cache.shapeOf(geometries.back()));
  }
  for (std::size_t i = 0; i < geometries.size(); ++i)
    QCOMPARE(cache.shapeOf(geometries[i]), shapes[i].lock());
  geometries.erase(geometries.begin() + 1, geometries.end());
  cache.prepare(geometries, {});
  for (std::size_t i = 0; i < shapes.size(); ++i)
    QCOMPARE(shapes[i].expired(), i > 0);
}

/// It was a draft, whose points lie up to a cell beside the surface: the tint of a selection spilled over.
void PartShapeTest::theVeilOfAPartHasItsOutline() {
  const ui::PartShape usual = ui::makePartShape(test::icosphereMesh(1.0, 4));
  QVERIFY(!usual.drafts.empty());
  QCOMPARE(usual.veil.Get(), usual.surface.Get());
}

/// A draft of half the triangles has cells of a 28th of such a part. Its own mesh would take too long.
void PartShapeTest::theVeilOfALargePartKeepsToItsOutline() {
  const ui::PartShape large = ui::makePartShape(test::icosphereMesh(1.0, 6));
  vtkPolyData* veil = large.veil;
  QVERIFY(large.surface->GetNumberOfPolys() > 80'000);
  QVERIFY(veil->GetNumberOfPolys() < large.surface->GetNumberOfPolys());
  QVERIFY(veil->GetNumberOfPolys() > 10'000);
  // Points of a ball span triangles within it. Clustering rounds points to single precision.
  constexpr double kRounding = 1e-6;
  for (vtkIdType i = 0; i < veil->GetNumberOfPoints(); ++i) {
    const double* p = veil->GetPoint(i);
    QVERIFY2(std::abs(std::hypot(p[0], p[1], p[2]) - 1.0) < kRounding, qPrintable(QString::number(i)));
  }
  // A facet of edge 0.021 at most joins cells of a 96th of the size, which have a diagonal of 0.036. A chord of that
  // length is this deep in the ball.
  constexpr double kMaxEdge = 0.021 + 2.0 * 0.037, kMaxDepth = kMaxEdge * kMaxEdge / 8.0;
  for (vtkIdType cell = 0; cell < veil->GetNumberOfPolys(); ++cell) {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    veil->GetPolys()->GetCellAtId(cell, size, corners);
    for (int k = 0; k < 3; ++k) {
      double a[3], b[3];
      veil->GetPoint(corners[k], a);
      veil->GetPoint(corners[(k + 1) % 3], b);
      const double middle = 0.5 * std::hypot(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
      QVERIFY2(1.0 - middle < 1.1 * kMaxDepth, qPrintable(QString::number(1.0 - middle)));
    }
  }
}

void PartShapeTest::facesThatHaveColoursAreDrawnInThem() {
  const CadColour red{1.0F, 0.0F, 0.0F}, blue{0.0F, 0.0F, 1.0F};
  auto geometry = std::make_shared<PartGeometry>(*geometryOf(test::boxMesh(glm::dvec3(1.0))));
  SurfaceFaces surfaces;
  surfaces.faces.resize(6);
  for (std::uint32_t i = 0; i < 12; ++i)
    surfaces.faceOfTriangle.push_back(i / 2);
  geometry->surfaces = std::make_shared<const SurfaceFaces>(surfaces);
  geometry->faceColours = {red, std::nullopt, blue, red, std::nullopt, blue};
  ui::PartShapeCache cache;
  const auto shape = cache.shapeOf(geometry);
  QCOMPARE(shape->faceColours.size(), std::size_t{2});
  QVERIFY(shape->hasOwnColour);
  QCOMPARE(shape->colouredPieces.size(), shape->pieces.size());
  vtkDataArray* scalars = shape->colouredPieces[0]->GetCellData()->GetScalars();
  QCOMPARE(scalars->GetNumberOfTuples(), vtkIdType{12});
  for (vtkIdType i = 0; i < 12; ++i) {
    const std::optional<CadColour>& expected = geometry->faceColours[static_cast<std::size_t>(i) / 2];
    const auto number = static_cast<std::size_t>(scalars->GetTuple1(i));
    QCOMPARE(number > 0, expected.has_value());
    if (expected) QCOMPARE(shape->faceColours[number - 1], *expected);
  }
  QVERIFY(shape->surface->GetCellData()->GetScalars() == nullptr);
}

void PartShapeTest::whatHasNoColoursOfFacesCostsNothingMore() {
  auto geometry = std::make_shared<PartGeometry>(*geometryOf(test::boxMesh(glm::dvec3(1.0))));
  geometry->faceColours.resize(6);
  ui::PartShapeCache cache;
  const auto shape = cache.shapeOf(geometry);
  QVERIFY(shape->colouredPieces.empty());
  QVERIFY(shape->faceColours.empty());
}

void PartShapeTest::oneGeometryHasOneShape() {
  ui::PartShapeCache cache;
  PartGeometryPtr geometry = geometryOf(test::boxMesh(glm::dvec3(1.0)));
  const auto first = cache.shapeOf(geometry);
  QCOMPARE(cache.shapeOf(geometry).get(), first.get());
  const PartGeometryPtr other = geometryOf(test::boxMesh(glm::dvec3(2.0)));
  QVERIFY(cache.shapeOf(other).get() != first.get());
}

/// At each new shape all others were looked through, which takes the square of their number.
void PartShapeTest::unusedShapesAreNotLookedForAtEachNewOne() {
  constexpr int kCount = 1000, kMaxDrops = kCount / 10;
  ui::PartShapeCache cache;
  std::vector<std::weak_ptr<const ui::PartShape>> shapes;
  std::ptrdiff_t before = 0;
  int drops = 0;
  for (int i = 0; i < kCount; ++i) {
    // Unused from here on: a look through all would drop it.
    shapes.push_back(cache.shapeOf(geometryOf(test::tetrahedronMesh())));
    const std::ptrdiff_t kept =
        std::ranges::count_if(shapes, [](const auto& shape) { return !shape.expired(); });
    if (kept <= before) ++drops;
    before = kept;
  }
  QVERIFY2(drops > 0, "they are dropped some time");
  QVERIFY2(drops <= kMaxDrops, qPrintable(QString::number(drops)));
}

void PartShapeTest::threadsMayAskAtOnce() {
  ui::PartShapeCache cache;
  const PartGeometryPtr geometry = geometryOf(test::icosphereMesh(1.0, 3));
  std::vector<std::thread> threads;
  std::array<vtkIdType, 4> polygons{};
  for (vtkIdType& count : polygons) {
    threads.emplace_back([&] { count = cache.shapeOf(geometry)->surface->GetNumberOfPolys(); });
  }
  for (std::thread& thread : threads)
    thread.join();
  for (const vtkIdType count : polygons)
    QCOMPARE(count, vtkIdType{20} * 64);
}

void PartShapeTest::muchToPrepareIsPostponedBehindBoxes() {
  ui::PartShapeCache cache;
  const std::array few{geometryOf(test::boxMesh(glm::dvec3(1.0)))};
  cache.prepare(few, {});
  QVERIFY(!cache.hasPostponed());
  QVERIFY(!cache.shapeOf(few[0])->isStandIn);

  const std::array many{geometryOf(test::icosphereMesh(1.0, 6)), geometryOf(test::icosphereMesh(2.0, 5)),
                        few[0]};
  QVERIFY(many[0]->mesh.triangles().size() + many[1]->mesh.triangles().size() > ui::kMostAtOnce);
  cache.prepare(many, {});
  QVERIFY(cache.hasPostponed());
  QVERIFY(!cache.shapeOf(few[0])->isStandIn);
  const auto box = cache.shapeOf(many[1]);
  QVERIFY(box->isStandIn);
  QCOMPARE(box->surface->GetNumberOfLines(), vtkIdType{12});
  QCOMPARE(box->surface->GetNumberOfPolys(), vtkIdType{0});
  double bounds[6];
  box->surface->GetBounds(bounds);
  const Aabb expected = many[1]->mesh.bounds();
  for (int axis = 0; axis < 3; ++axis) {
    QCOMPARE(bounds[2 * axis], expected.lower[axis]);
    QCOMPARE(bounds[2 * axis + 1], expected.upper[axis]);
  }
  QVERIFY(!box->rays.firstHit({0.0, 0.0, 5.0}, {0.0, 0.0, -5.0}));

  cache.makePostponed();
  QVERIFY(!cache.hasPostponed());
  for (const PartGeometryPtr& geometry : many) {
    QVERIFY(!cache.shapeOf(geometry)->isStandIn);
    QCOMPARE(cache.shapeOf(geometry)->surface->GetNumberOfPolys(),
             static_cast<vtkIdType>(geometry->mesh.triangles().size()));
  }
}

void PartShapeTest::aPostponedShapeOfWhatIsGoneIsNotMade() {
  ui::PartShapeCache cache;
  {
    const std::array large{geometryOf(test::icosphereMesh(1.0, 7))};
    cache.prepare(large, {});
  }
  bool isAnyWork = false;
  cache.makePostponed([&](double) {
    isAnyWork = true;
    return true;
  });
  QVERIFY(!isAnyWork);
  QVERIFY(!cache.hasPostponed());
}

NEARFIT_QT_SUITE(PartShapeTest, test::runQtTest<PartShapeTest, QCoreApplication>)
#include "part_shape_test.moc"
