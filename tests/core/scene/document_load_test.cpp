#include "core/scene/document_load.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::document_load_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// A document in a file of its own, an importer that makes it, and a cache of its own.
class DocumentLoad : public testing::Test {
 protected:
  test::TemporaryFolder folder_, cache_;
  const test::ScopedVariable variable_{"NEARFIT_CACHE", cache_.path().string()};
  const std::filesystem::path file_ = folder_.write("vise.step", "the vise");
};

std::string messageOf(const std::exception_ptr& problem) {
  try {
    if (problem) std::rethrow_exception(problem);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

/// Max distance of the triangles' corners from the exact surface of their face [m].
double offSurface(const PartGeometry& geometry) {
  double off = 0.0;
  for (std::size_t i = 0; i < geometry.mesh.triangles().size(); ++i) {
    const ExactSurface& surface = geometry.surfaces->faces[geometry.surfaces->faceOfTriangle[i]];
    for (const std::uint32_t v : geometry.mesh.triangles()[i]) {
      const glm::dvec3 d = geometry.mesh.vertices()[v] - surface.point;
      const double along = glm::dot(d, surface.direction);
      off = std::max(off, surface.kind == SurfaceKind::Plane
                              ? std::abs(along)
                              : std::abs(glm::length(d - along * surface.direction) - surface.radius));
    }
  }
  return off;
}

TEST_F(DocumentLoad, DocumentComesWithItsTreeAndEachShapeOnce) {
  const test::FakeImporter importer;
  const LoadedDocument document = loadDocument(file_, 1.0);
  EXPECT_EQ(document.file, std::filesystem::canonical(file_));
  EXPECT_FALSE(document.isFromCache);
  ASSERT_EQ(document.nodes.size(), 6U);
  EXPECT_EQ(document.nodes[2].name, "jaws");
  EXPECT_EQ(document.nodes[3].shape, 1);
  ASSERT_EQ(document.shapes.size(), 2U);
  const PartGeometry &body = *document.shapes[0], &pin = *document.shapes[1];
  EXPECT_EQ(body.shapeKey, "body");
  EXPECT_EQ(body.sha256, sha256OfFile(file_));
  EXPECT_EQ(body.metresPerUnit, 1.0);
  EXPECT_TRUE(body.hasOwnUnit && body.isExact);
  EXPECT_NEAR(body.mass.volume, 0.1 * 0.06 * 0.04, 1e-15);
  EXPECT_NEAR(pin.exactVolume, std::numbers::pi * 0.005 * 0.005 * 0.03, 1e-15);
  EXPECT_EQ(pin.tessellation, Tessellation{});
  EXPECT_NEAR(pin.effectiveTessellation.chord, 1e-4, 1e-12);
  ASSERT_EQ(body.faceColours.size(), 6U);
  EXPECT_EQ(body.faceColours.back(), (CadColour{1.0F, 0.0F, 0.0F}));
}

TEST_F(DocumentLoad, TrianglesLieOnTheExactSurfacesOfTheirFaces) {
  const test::FakeImporter importer;
  for (const PartGeometryPtr& shape : loadDocument(file_, 1.0).shapes) {
    ASSERT_NE(shape->surfaces, nullptr);
    ASSERT_EQ(shape->surfaces->faceOfTriangle.size(), shape->mesh.triangles().size());
    EXPECT_LT(offSurface(*shape), 1e-12) << shape->shapeKey;
  }
}

TEST_F(DocumentLoad, FacesOfAShapeThatWasInsideOutAreTurnedWithItsTriangles) {
  const test::FakeImporter importer([](const Tessellation& tessellation) {
    CadDocument document;
    document.shapes = {test::cylinderShape("pin", 0.005, 0.03, tessellation)};
    document.nodes = {test::instanceNode("pin", -1, 0)};
    for (Triangle& t : document.shapes[0].triangles)
      std::swap(t[0], t[1]);
    for (ExactSurface& surface : document.shapes[0].surfaces.faces) {
      surface.isHollow = surface.kind == SurfaceKind::Cylinder;
      if (surface.kind == SurfaceKind::Plane) surface.direction = -surface.direction;
    }
    return document;
  });
  const LoadedDocument document = loadDocument(file_, 1.0);
  const PartGeometry& pin = *document.shapes[0];
  EXPECT_TRUE(pin.report.turnedInsideOut);
  EXPECT_FALSE(pin.surfaces->faces[0].isHollow);
  EXPECT_EQ(pin.surfaces->faces[1].direction, glm::dvec3(0.0, 0.0, 1.0));
  EXPECT_EQ(pin.surfaces->faces[2].direction, glm::dvec3(0.0, 0.0, -1.0));
}

TEST_F(DocumentLoad, SecondOpeningNeedsNoImporterAndIsTheSame) {
  const test::FakeImporter importer;
  const LoadedDocument first = loadDocument(file_, 1.0), second = loadDocument(file_, 1.0);
  EXPECT_EQ(importer.runs(), 1);
  EXPECT_TRUE(second.isFromCache);
  ASSERT_EQ(second.nodes.size(), first.nodes.size());
  for (std::size_t i = 0; i < first.nodes.size(); ++i) {
    EXPECT_EQ(second.nodes[i].name, first.nodes[i].name);
    EXPECT_EQ(second.nodes[i].parent, first.nodes[i].parent);
    EXPECT_EQ(second.nodes[i].shape, first.nodes[i].shape);
    EXPECT_EQ(second.nodes[i].colour, first.nodes[i].colour);
    EXPECT_EQ(second.nodes[i].parentFromNode.translation, first.nodes[i].parentFromNode.translation);
    EXPECT_EQ(second.nodes[i].parentFromNode.rotation, first.nodes[i].parentFromNode.rotation);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const PartGeometry &a = *first.shapes[i], &b = *second.shapes[i];
    EXPECT_TRUE(test::areSame(CachedMesh{a.mesh, a.report, a.mass}, CachedMesh{b.mesh, b.report, b.mass}));
    EXPECT_EQ(a.shapeKey, b.shapeKey);
    EXPECT_EQ(a.sha256, b.sha256);
    EXPECT_EQ(a.effectiveTessellation, b.effectiveTessellation);
    EXPECT_EQ(a.faceColours, b.faceColours);
    EXPECT_EQ(a.exactVolume, b.exactVolume);
    EXPECT_EQ(a.isExact, b.isExact);
    EXPECT_EQ(a.surfaces->faceOfTriangle, b.surfaces->faceOfTriangle);
    EXPECT_EQ(a.surfaces->faces, b.surfaces->faces);
  }
}

TEST_F(DocumentLoad, HierarchyOfASmallShapeIsKeptToo) {
  const test::FakeImporter importer;
  loadDocument(file_, 1.0).shapes[0]->tree();
  const LoadedDocument again = loadDocument(file_, 1.0);
  again.shapes[0]->tree();
  EXPECT_TRUE(again.shapes[0]->hierarchy->origin()->isFromCache);
}

TEST_F(DocumentLoad, OtherContentAndOtherTessellationAreImportedAnew) {
  const test::FakeImporter importer;
  const std::size_t coarse = loadDocument(file_, 1.0, {1e-3, 0.0}).shapes[1]->mesh.triangles().size();
  EXPECT_GT(loadDocument(file_, 1.0, {1e-5, 0.0}).shapes[1]->mesh.triangles().size(), 4 * coarse);
  EXPECT_EQ(importer.runs(), 2);
  folder_.write("vise.step", "the vise, changed");
  EXPECT_FALSE(loadDocument(file_, 1.0, {1e-3, 0.0}).isFromCache);
}

TEST_F(DocumentLoad, DamagedCacheCostsTimeOnly) {
  const test::FakeImporter importer;
  loadDocument(file_, 1.0);
  std::vector<std::filesystem::path> names;
  for (const auto& entry : std::filesystem::directory_iterator(cache_.path()))
    names.push_back(entry.path().filename());
  ASSERT_EQ(names.size(), 3U) << "two shapes and the tree";
  for (const std::filesystem::path& name : names) {
    const std::string bytes = test::readBytes(cache_.path() / name);
    for (const std::size_t place : {std::size_t{3}, bytes.size() / 2}) {
      std::string damaged = bytes;
      damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
      cache_.write(name, damaged);
      const int before = importer.runs();
      const LoadedDocument document = loadDocument(file_, 1.0);
      EXPECT_EQ(importer.runs(), before + 1) << name << " " << place;
      EXPECT_EQ(document.nodes.size(), 6U);
      EXPECT_NEAR(document.shapes[0]->mass.volume, 0.1 * 0.06 * 0.04, 1e-15);
    }
  }
}

/// A glTF document of a box, whose height [m] is the text of a file beside it.
class DocumentOfTwoFiles : public DocumentLoad {
 protected:
  void writeHeight(const std::string& height) const { folder_.write("box.bin", height); }
  double loadedHeight() const { return loadDocument(gltf_, 1.0).shapes[0]->mesh.bounds().upper.z * 2.0; }

  const std::filesystem::path gltf_ = folder_.write("box.gltf", "{}"),
                              buffer_ = folder_.write("box.bin", "0.5");
  /// Lets the importer list a file that it did not find, and so cannot vouch for what it made.
  bool areCompanionsKnown_ = true;
  std::string listed_ = "box.bin";
  const test::FakeImporter importer_{[this](const Tessellation&) {
    double height = 0.0;
    if (!(std::ifstream(buffer_) >> height))
      throw FileError(gltf_.string(), "its buffer box.bin cannot be read", "put it back");
    CadDocument document;
    document.shapes = {test::boxShape("box", {0.1, 0.1, height}), test::boxShape("lid", {0.1, 0.1, 0.01})};
    document.nodes = {test::instanceNode("box", -1, 0), test::instanceNode("lid", -1, 1)};
    document.companions = {{listed_, sha256OfFile(buffer_)}};
    document.areCompanionsKnown = areCompanionsKnown_;
    return document;
  }};
};

TEST_F(DocumentOfTwoFiles, SecondOpeningNeedsNoImporterWhileBothAreTheSame) {
  const LoadedDocument first = loadDocument(gltf_, 1.0), second = loadDocument(gltf_, 1.0);
  EXPECT_EQ(importer_.runs(), 1);
  EXPECT_TRUE(second.isFromCache);
  for (const LoadedDocument* document : {&first, &second}) {
    const PartGeometry& box = *document->shapes.at(0);
    EXPECT_EQ(box.sha256, sha256OfFile(gltf_));
    ASSERT_NE(box.companions, nullptr);
    ASSERT_EQ(box.companions->size(), 1U);
    EXPECT_EQ(box.companions->front().sha256, sha256OfFile(buffer_));
    EXPECT_TRUE(std::filesystem::equivalent(box.companions->front().file, buffer_));
    EXPECT_EQ(document->shapes[1]->companions, box.companions) << "they are kept once";
  }
  first.shapes[0]->tree();
  const LoadedDocument third = loadDocument(gltf_, 1.0);
  third.shapes[0]->tree();
  EXPECT_TRUE(third.shapes[0]->hierarchy->origin()->isFromCache);
}

TEST_F(DocumentOfTwoFiles, ShapesByTheirKeysComeFromTheCacheTooWithoutTheirTree) {
  const std::vector<MeshSource> box{{gltf_, 1.0, {}, "box"}}, both{box[0], {gltf_, 1.0, {}, "lid"}};
  loadPartGeometries(box);
  EXPECT_NE(loadPartGeometries(box)[0].geometry, nullptr);
  EXPECT_EQ(importer_.runs(), 1);
  loadPartGeometries(both);
  ASSERT_EQ(importer_.runs(), 2);
  EXPECT_THAT(importer_.asked()[1].onlyShapes, UnorderedElementsAre("lid"));
  writeHeight("0.7");
  const std::vector<LoadedPart> changed = loadPartGeometries(both);
  EXPECT_EQ(importer_.runs(), 3);
  EXPECT_NEAR(2.0 * changed[0].geometry->mesh.bounds().upper.z, 0.7, 1e-12);
}

TEST_F(DocumentOfTwoFiles, ChangedCompanionIsSeenAndTheOldOneComesFromTheCacheAgain) {
  EXPECT_NEAR(loadedHeight(), 0.5, 1e-12);
  writeHeight("0.7");
  EXPECT_NEAR(loadedHeight(), 0.7, 1e-12);
  EXPECT_NEAR(loadedHeight(), 0.7, 1e-12);
  EXPECT_EQ(importer_.runs(), 2);
  writeHeight("0.5");
  EXPECT_NEAR(loadedHeight(), 0.5, 1e-12);
  EXPECT_EQ(importer_.runs(), 2);
}

TEST_F(DocumentOfTwoFiles, MissingCompanionGivesTheImportersError) {
  loadedHeight();
  std::filesystem::remove(buffer_);
  for (int i = 0; i < 2; ++i) {
    try {
      loadDocument(gltf_, 1.0);
      ADD_FAILURE() << "it opened";
    } catch (const FileError& error) {
      EXPECT_EQ(error.problem(), "its buffer box.bin cannot be read");
    }
    std::filesystem::create_directory(buffer_);
  }
  std::filesystem::remove(buffer_);
  writeHeight("0.5");
  EXPECT_TRUE(loadDocument(gltf_, 1.0).isFromCache);
}

TEST_F(DocumentOfTwoFiles, DocumentIsImportedEachTimeWhileNotAllItsCompanionsAreKnownAndKeepsItsHierarchies) {
  areCompanionsKnown_ = false;
  for (const char* listed : {"box.bin", "../box.bin", "/etc/passwd", "../../../../../../etc/passwd"}) {
    listed_ = listed;
    const int before = importer_.runs();
    loadDocument(gltf_, 1.0).shapes[0]->tree();
    const LoadedDocument again = loadDocument(gltf_, 1.0);
    EXPECT_EQ(importer_.runs(), before + 2) << listed;
    EXPECT_EQ(again.shapes[0]->companions, nullptr) << listed;
    again.shapes[0]->tree();
    EXPECT_TRUE(again.shapes[0]->hierarchy->origin()->isFromCache);
    // From the second round on, it is where they lie alone that is wrong.
    areCompanionsKnown_ = true;
  }
}

TEST_F(DocumentLoad, AllShapesOfADocumentComeFromOneRun) {
  const test::FakeImporter importer;
  const std::vector<MeshSource> sources{{file_, 1.0, {}, "pin"},
                                        {file_, 1.0, {}, "body"},
                                        {file_, 1.0, {}, "pin"},
                                        {file_, 1.0, {}, "nut"},
                                        {file_, 1.0, {}, "pin", {1e-5, 0.0}}};
  const std::vector<LoadedPart> loaded = loadPartGeometries(sources);
  // One for each tessellation.
  EXPECT_EQ(importer.runs(), 2);
  ASSERT_TRUE(loaded[0].geometry && loaded[1].geometry && loaded[4].geometry);
  EXPECT_EQ(loaded[0].geometry, loaded[2].geometry);
  EXPECT_EQ(loaded[1].geometry->shapeKey, "body");
  EXPECT_GT(loaded[4].geometry->mesh.triangles().size(), loaded[0].geometry->mesh.triangles().size());
  EXPECT_THAT(messageOf(loaded[3].problem), HasSubstr("it holds no shape \"nut\""));
}

/// A vise whose body lacks one of the two triangles of each of its sides at -x and +x; no. 0 and 1 of its faces.
CadDocument viseWithHoles() {
  CadDocument document = test::viseDocument();
  CadShape& body = document.shapes[0];
  for (const std::uint32_t face : {0U, 1U}) {
    const auto it = std::ranges::find(body.surfaces.faceOfTriangle, face);
    const auto i = it - body.surfaces.faceOfTriangle.begin();
    body.surfaces.faceOfTriangle.erase(it);
    body.triangles.erase(body.triangles.begin() + i);
  }
  return document;
}

/// How many triangles are of a face.
std::ptrdiff_t trianglesOf(const PartGeometry& geometry, std::uint32_t face) {
  return std::ranges::count(geometry.surfaces->faceOfTriangle, face);
}

TEST_F(DocumentLoad, TrianglesThatRepairsAddAreOfAFaceOfTheirOwnAndTheOthersKeepTheirs) {
  const test::FakeImporter importer([](const Tessellation&) { return viseWithHoles(); });
  const MeshSource whole{.file = file_, .shape = "body"};
  MeshSource filled = whole;
  filled.repairs = {{RepairKind::FillHoles, 1.0}};
  for (int round = 0; round < 2; ++round) {
    const auto loaded = loadPartGeometries(std::vector{whole, filled, filled});
    ASSERT_TRUE(loaded[0].geometry && loaded[1].geometry) << messageOf(loaded[1].problem);
    EXPECT_EQ(loaded[1].geometry, loaded[2].geometry);
    const PartGeometry &open = *loaded[0].geometry, &closed = *loaded[1].geometry;
    EXPECT_EQ(open.mesh.triangles().size(), 10U);
    EXPECT_EQ(open.surfaces->faces.size(), 6U);
    EXPECT_TRUE(closed.mesh.topology().isClosed());
    EXPECT_NEAR(closed.mass.volume, 0.1 * 0.06 * 0.04, 1e-15);
    EXPECT_EQ(closed.shapeKey, "body");
    EXPECT_EQ(closed.repairs, filled.repairs);
    ASSERT_EQ(closed.surfaces->faces.size(), 7U);
    EXPECT_EQ(closed.surfaces->faces[6].kind, SurfaceKind::Other);
    EXPECT_EQ(trianglesOf(closed, 6), 2);
    for (std::uint32_t face = 0; face < 6; ++face)
      EXPECT_EQ(trianglesOf(closed, face), face < 2 ? 1 : 2) << face;
    ASSERT_EQ(closed.faceColours.size(), 7U);
    EXPECT_EQ(closed.faceColours[5], (CadColour{1.0F, 0.0F, 0.0F}));
    EXPECT_FALSE(closed.faceColours[6]);
  }
  EXPECT_EQ(importer.runs(), 1) << "the second round comes from the cache";
}

TEST_F(DocumentLoad, FacesThatARepairTurnsRoundFaceTheOtherWay) {
  // The side at +x faces inward, its neighbours outward.
  const test::FakeImporter importer([](const Tessellation&) {
    CadDocument document;
    document.shapes = {test::boxShape("box", {0.1, 0.2, 0.3})};
    document.nodes = {test::instanceNode("box", -1, 0)};
    CadShape& box = document.shapes[0];
    box.surfaces.faces[1].direction = -box.surfaces.faces[1].direction;
    for (std::size_t i = 0; i < box.triangles.size(); ++i)
      if (box.surfaces.faceOfTriangle[i] == 1) std::swap(box.triangles[i][0], box.triangles[i][1]);
    return document;
  });
  const PartGeometryPtr before = loadPartGeometry(file_, 1.0);
  ASSERT_EQ(before->mesh.topology().inconsistentEdges, 4U);
  ASSERT_EQ(before->surfaces->faces[1].direction, glm::dvec3(-1.0, 0.0, 0.0));
  const GeometryRepair repair = repairGeometry(*before, {{RepairKind::Orient}});
  ASSERT_NE(repair.geometry, nullptr);
  EXPECT_TRUE(repair.geometry->mesh.topology().isOriented());
  EXPECT_NEAR(repair.geometry->mass.volume, 0.006, 1e-12);
  const std::vector<ExactSurface>& faces = repair.geometry->surfaces->faces;
  ASSERT_EQ(faces.size(), 6U);
  EXPECT_EQ(faces[0].direction, glm::dvec3(-1.0, 0.0, 0.0)) << "this one was right";
  EXPECT_EQ(faces[1].direction, glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(before->surfaces->faces[1].direction, glm::dvec3(-1.0, 0.0, 0.0)) << "the original stays";
}

TEST_F(DocumentLoad, OnlyWhatTheCacheLacksIsImported) {
  const test::FakeImporter importer;
  loadPartGeometries(std::vector<MeshSource>{{file_, 1.0, {}, "pin"}});
  const auto loaded =
      loadPartGeometries(std::vector<MeshSource>{{file_, 1.0, {}, "pin"}, {file_, 1.0, {}, "body"}});
  EXPECT_TRUE(loaded[0].geometry && loaded[1].geometry);
  ASSERT_EQ(importer.asked().size(), 2U);
  EXPECT_THAT(importer.asked()[0].onlyShapes, UnorderedElementsAre("pin"));
  EXPECT_THAT(importer.asked()[1].onlyShapes, UnorderedElementsAre("body"));
  loadPartGeometries(std::vector<MeshSource>{{file_, 1.0, {}, "body"}});
  EXPECT_EQ(importer.runs(), 2);
}

TEST_F(DocumentLoad, RequiredContentThatIsNotThereGivesNothing) {
  const test::FakeImporter importer;
  const auto loaded = loadPartGeometries(std::vector<MeshSource>{{file_, 1.0, std::string(64, '0'), "pin"}});
  EXPECT_TRUE(loaded[0].geometry == nullptr && loaded[0].problem == nullptr);
  EXPECT_EQ(importer.runs(), 0);
}

TEST_F(DocumentLoad, FileAloneNamesTheOnlyShape) {
  {
    const test::FakeImporter importer([](const Tessellation&) {
      CadDocument document;
      document.shapes = {test::boxShape("block", {0.1, 0.2, 0.3})};
      document.nodes = {test::instanceNode("block", -1, 0)};
      return document;
    });
    EXPECT_EQ(loadPartGeometry(file_, 0.001)->shapeKey, "block");
    EXPECT_NEAR(loadPartGeometry(file_, 0.001)->mass.volume, 0.006, 1e-12) << "the file stores its unit";
    EXPECT_EQ(importer.runs(), 1);
  }
  const std::filesystem::path other = folder_.write("other.step", "of two shapes");
  const test::FakeImporter importer;
  try {
    loadPartGeometry(other, 1.0);
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("2 shapes"), HasSubstr("\"body\""), HasSubstr("\"pin\"")));
  }
}

TEST_F(DocumentLoad, FormatWithoutAUnitIsReadInTheUnitThatIsGiven) {
  const test::FakeImporter importer([](const Tessellation& tessellation) {
    CadDocument document;
    document.hasUnit = false;
    document.shapes = {test::cylinderShape("pin", 5.0, 30.0, tessellation)};
    document.nodes = {test::instanceNode("pin", -1, 0, {{1, 0, 0, 0}, {100.0, 0.0, 0.0}})};
    return document;
  });
  const std::filesystem::path brep = folder_.write("pin.brep", "a pin");
  const LoadedDocument document = loadDocument(brep, 0.001, {1e-5, 0.0});
  const PartGeometry& pin = *document.shapes[0];
  EXPECT_FALSE(pin.hasOwnUnit);
  EXPECT_NEAR(document.nodes[0].parentFromNode.translation.x, 0.1, 1e-15);
  EXPECT_NEAR(pin.mesh.bounds().upper.z, 0.015, 1e-15);
  EXPECT_NEAR(pin.surfaces->faces[0].radius, 0.005, 1e-15);
  EXPECT_LT(offSurface(pin), 1e-12);
  EXPECT_NEAR(pin.exactVolume, std::numbers::pi * 0.005 * 0.005 * 0.03, 1e-18);
  EXPECT_NEAR(pin.effectiveTessellation.chord, 1e-5, 1e-15);
  ASSERT_EQ(importer.asked().size(), 1U);
  EXPECT_NEAR(importer.asked()[0].tessellation.chord, 0.01, 1e-12) << "in the file's units";
}

TEST_F(DocumentLoad, ShapeWithoutAnAreaIsLeftOutWithAWarning) {
  const test::FakeImporter importer([](const Tessellation&) {
    CadDocument document = test::viseDocument();
    document.shapes[0].vertices.assign(document.shapes[0].vertices.size(), glm::dvec3(0.0));
    return document;
  });
  for (const bool isFromCache : {false, true}) {
    const LoadedDocument document = loadDocument(file_, 1.0);
    EXPECT_EQ(document.isFromCache, isFromCache);
    EXPECT_EQ(document.shapes[0], nullptr);
    EXPECT_NE(document.shapes[1], nullptr);
    ASSERT_EQ(document.warnings.size(), 1U);
    EXPECT_THAT(document.warnings[0], AllOf(HasSubstr("\"body\""), HasSubstr("left out")));
  }
}

/// What loading a document says that `damage` was done to.
std::string errorAfter(const std::filesystem::path& file, const std::function<void(CadDocument&)>& damage) {
  const test::FakeImporter importer([&damage](const Tessellation&) {
    CadDocument document = test::viseDocument();
    damage(document);
    return document;
  });
  try {
    loadDocument(file, 1.0);
  } catch (const FileError& e) {
    return e.what();
  }
  return "";
}

TEST_F(DocumentLoad, DocumentsThatMakeNoSenseAreRefused) {
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.nodes[1].parent = 1; }),
              HasSubstr("in none that comes before"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.nodes[0].parent = -2; }),
              HasSubstr("in none that comes before"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.nodes[1].shape = 2; }),
              HasSubstr("shape that does not exist"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.nodes[1].parentFromNode.translation.x = NAN; }),
              HasSubstr("out of range"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.nodes[1].parentFromNode.rotation = {0, 0, 0, 0}; }),
              HasSubstr("its length is 0"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.nodes[4].colour = CadColour{2.0F, 0.0F, 0.0F}; }),
              HasSubstr("colour that is none"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.shapes[1].key = "body"; }),
              HasSubstr("no name of its own"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.shapes[1].key = ""; }),
              HasSubstr("no name of its own"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.hasUnit = false; }), HasSubstr("unit of length"));
  EXPECT_THAT(errorAfter(file_, [](CadDocument& d) { d.shapes.clear(), d.nodes.clear(); }),
              HasSubstr("it holds no shape"));
  const auto spoilAll = [](const std::function<void(CadShape&)>& spoil) {
    return [spoil](CadDocument& d) { std::ranges::for_each(d.shapes, spoil); };
  };
  EXPECT_THAT(errorAfter(file_, spoilAll([](CadShape& s) { s.surfaces.faceOfTriangle[0] = 100; })),
              HasSubstr("do not fit its triangles"));
  EXPECT_THAT(errorAfter(file_, spoilAll([](CadShape& s) { s.surfaces.faceOfTriangle.pop_back(); })),
              HasSubstr("do not fit its triangles"));
  EXPECT_THAT(errorAfter(file_, spoilAll([](CadShape& s) { s.faceColours.resize(1); })),
              HasSubstr("do not fit its triangles"));
  EXPECT_THAT(errorAfter(file_, spoilAll([](CadShape& s) { s.triangles[0][0] = 1'000'000; })),
              HasSubstr("refers to vertex 1000000"));
}

TEST_F(DocumentLoad, NamesThatAreNotTextAreShownAsBytes) {
  const test::FakeImporter importer([](const Tessellation&) {
    CadDocument document = test::viseDocument();
    document.nodes[0].name = "v\xFFise\n";
    document.nodes[1].name = std::string(500, 'x');
    return document;
  });
  for (int i = 0; i < 2; ++i) {
    const LoadedDocument document = loadDocument(file_, 1.0);
    EXPECT_EQ(document.nodes[0].name, "v\\xffise\\x0a");
    EXPECT_EQ(document.nodes[1].name.size(), 200U);
  }
}

TEST_F(DocumentLoad, TessellationsOutOfRangeAreRefused) {
  const test::FakeImporter importer;
  for (const Tessellation wrong : {Tessellation{-1.0, 0.0},
                                   {1e-9, 0.0},
                                   {1e9, 0.0},
                                   {std::nan(""), 0.0},
                                   {0.0, -0.1},
                                   {0.0, 1e-4},
                                   {0.0, 3.0},
                                   {0.0, std::nan("")}}) {
    EXPECT_THROW(loadDocument(file_, 1.0, wrong), UsageError) << wrong.chord << " " << wrong.angle;
  }
  EXPECT_EQ(importer.runs(), 0);
}

TEST_F(DocumentLoad, ProgressRisesToOneAndCanStopTheWork) {
  const test::FakeImporter importer;
  double last = 0.0;
  loadDocument(file_, 1.0, {}, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_THROW(loadDocument(file_, 1.0, {1e-3, 0.0}, [](double fraction) { return fraction < 0.3; }),
               Cancelled);
  EXPECT_THROW(loadPartGeometries(std::vector<MeshSource>{{file_, 1.0, {}, "pin", {1e-4, 0.0}}},
                                  [](double fraction) { return fraction < 0.3; }),
               Cancelled);
}

TEST_F(DocumentLoad, GltfOpensInMetresAndIsReadAgainInAnotherUnit) {
  const test::FakeImporter importer;
  const std::filesystem::path glb = folder_.write("vise.glb", "the vise");
  const LoadedDocument opened = loadDocument(glb, 0.001);
  const PartGeometry& body = *opened.shapes[0];
  EXPECT_EQ(body.metresPerUnit, 1.0) << "the format says metres";
  EXPECT_TRUE(canChangeUnit(body));
  EXPECT_FALSE(canChangeUnit(*loadDocument(file_, 1.0).shapes[0]));
  const std::vector<LoadedPart> smaller =
      loadPartGeometries(std::vector<MeshSource>{{glb, 0.001, body.sha256, body.shapeKey}});
  ASSERT_NE(smaller[0].geometry, nullptr);
  EXPECT_EQ(smaller[0].geometry->metresPerUnit, 0.001);
  EXPECT_NEAR(smaller[0].geometry->mesh.bounds().upper.x, 0.001 * body.mesh.bounds().upper.x, 1e-15);
  const std::vector<LoadedPart> step =
      loadPartGeometries(std::vector<MeshSource>{{file_, 0.001, {}, "body"}});
  EXPECT_EQ(step[0].geometry->metresPerUnit, 1.0) << "a STEP file is right";
}

TEST_F(DocumentLoad, ThreeMfKeepsTheUnitThatItStatesBesideItsCorrection) {
  const test::FakeImporter importer([](const Tessellation&) {
    CadDocument document;
    document.statedUnit = 1e-3;
    document.shapes = {test::boxShape("block", {0.1, 0.06, 0.04})};
    document.nodes = {test::instanceNode("block", -1, 0)};
    return document;
  });
  const std::filesystem::path file = folder_.write("block.3mf", "a block");
  const LoadedDocument opened = loadDocument(file, 1.0);
  const PartGeometry& block = *opened.shapes[0];
  EXPECT_EQ(block.metresPerUnit, 1.0);
  EXPECT_EQ(block.unitOfNumbers(), 1e-3);
  EXPECT_TRUE(canChangeUnit(block));
  // In inches, its numbers give 25.4 times the size.
  const std::vector<LoadedPart> larger =
      loadPartGeometries(std::vector<MeshSource>{{file, 25.4, block.sha256, block.shapeKey}});
  ASSERT_NE(larger[0].geometry, nullptr);
  EXPECT_EQ(larger[0].geometry->statedUnit, 1e-3);
  EXPECT_NEAR(larger[0].geometry->unitOfNumbers(), 0.0254, 1e-15);
  EXPECT_NEAR(larger[0].geometry->mesh.bounds().upper.x, 25.4 * block.mesh.bounds().upper.x, 1e-12);
}

TEST(DocumentFormats, OnlyGltfUrdfAndThreeMfMayBeInAnotherUnitThanTheyStore) {
  for (const char* file : {"a.gltf", "a.GLB", "a.urdf", "a.gltf.gz", "a.3mf"})
    EXPECT_TRUE(mayBeInWrongUnit(file)) << file;
  for (const char* file : {"a.step", "a.iges", "a.brep", "a.stl", "a"})
    EXPECT_FALSE(mayBeInWrongUnit(file)) << file;
  EXPECT_EQ(unitToOpen("a.glb", 0.001), 1.0);
  EXPECT_EQ(unitToOpen("a.stl", 0.001), 0.001);
}

TEST(DocumentFormats, AllButBrepAndMeshesStoreTheirUnit) {
  for (const char* file : {"a.step", "a.STP", "a.iges", "a.gltf", "a.glb", "a.3mf", "a.urdf", "a.step.gz"})
    EXPECT_TRUE(storesUnit(file)) << file;
  for (const char* file : {"a.brep", "a.brep.gz", "a.stl", "a.obj", "a"})
    EXPECT_FALSE(storesUnit(file)) << file;
}

}  // namespace
}  // namespace nearfit::document_load_test
