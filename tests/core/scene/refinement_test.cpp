#include "core/scene/refinement.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/document_parts.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::refinement_test {
namespace {

constexpr Tessellation kFine{1e-5, 0.0};

/// A scene of a vise: its body, and two pins.
class RefinementOfAVise : public testing::Test {
 protected:
  RefinementOfAVise() { addTo(scene_, partsOfDocument(loadDocument(file_, 1.0), scene_)); }

  PartId idOf(const char* name) const { return scene_.findByName(name)->id; }

  test::TemporaryFolder folder_;
  test::FakeImporter importer_;
  const std::filesystem::path file_ = folder_.write("vise.step", "the vise");
  Scene scene_;
};

TEST_F(RefinementOfAVise, AllInstancesOfTheShapeFollow) {
  const Refinement refinement = refinementOf(scene_, std::vector{idOf("pin 2")}, kFine);
  ASSERT_EQ(refinement.sources.size(), 1U);
  EXPECT_EQ(refinement.sources[0].shape, "pin");
  EXPECT_EQ(refinement.sources[0].tessellation, kFine);
  ASSERT_EQ(refinement.members.size(), 2U);
  EXPECT_EQ(refinement.members[0].part, idOf("pin"));
  EXPECT_EQ(refinement.members[1].part, idOf("pin 2"));
}

TEST_F(RefinementOfAVise, EachInstanceKeepsItsRepairs) {
  const MeshRepairs repairs{{RepairKind::Weld, 1e-6}};
  Part repaired = *scene_.findByName("pin 2");
  repaired.geometry =
      loadPartGeometries(std::vector{MeshSource{.file = file_, .shape = "pin", .repairs = repairs}})
          .front()
          .geometry;
  scene_.replace(repaired);
  const Refinement refinement = refinementOf(scene_, std::vector{idOf("pin")}, kFine);
  ASSERT_EQ(refinement.members.size(), 2U);
  ASSERT_EQ(refinement.sources.size(), 2U);
  EXPECT_TRUE(refinement.sources[refinement.members[0].source].repairs.empty());
  EXPECT_EQ(refinement.sources[refinement.members[1].source].repairs, repairs);
  for (const LoadedPart& loaded : loadPartGeometries(refinement.sources)) {
    ASSERT_NE(loaded.geometry, nullptr);
    EXPECT_GT(loaded.geometry->mesh.triangles().size(), repaired.geometry->mesh.triangles().size());
  }
}

TEST_F(RefinementOfAVise, PartsOfTrianglesOnlyAndTolerancesOutOfRangeAreRefused) {
  Part block;
  block.name = "Block";
  block.geometry = test::freshGeometryOf(test::boxMesh(glm::dvec3(0.1)));
  const PartId id = scene_.add(block);
  EXPECT_FALSE(isRefinable(scene_.get(id)));
  EXPECT_TRUE(isRefinable(scene_.get(idOf("pin"))));
  EXPECT_THROW(refinementOf(scene_, std::vector{idOf("pin"), id}, kFine), UsageError);
  EXPECT_THROW(refinementOf(scene_, std::vector{idOf("pin")}, {-1.0, 0.0}), UsageError);
}

TEST(ScaledTessellation, ChordGrowsWithTheShapeWithinItsLimitsAndTheAngleStays) {
  EXPECT_EQ(scaledTessellation({0.25, 0.5}, 4.0), (Tessellation{1.0, 0.5}));
  EXPECT_EQ(scaledTessellation({0.0, 0.5}, 4.0), (Tessellation{0.0, 0.5})) << "chosen from the size";
  EXPECT_EQ(scaledTessellation({1e-5, 0.5}, 1e-3), (Tessellation{kMinChord, 0.5}));
  EXPECT_EQ(scaledTessellation({1.0, 0.5}, 1e6), (Tessellation{kMaxChord, 0.5}));
}

}  // namespace
}  // namespace nearfit::refinement_test
