#include "tests/bench/instances.h"

#include <cstring>

#include <gtest/gtest.h>
#include <sys/mman.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench::instances_test {
namespace {

TEST(GeometryTotals, EachGeometryCountsOnce) {
  const PartGeometryPtr ball = test::geometryOf(test::icosphereMesh(1.0, 1));
  const PartGeometryPtr box = test::freshGeometryOf(test::boxMesh({1, 1, 1}));
  Scene scene;
  for (const PartGeometryPtr& geometry : {ball, box, ball, ball})
    scene.add(test::partOf(geometry, "part"));
  const GeometryTotals totals = geometryTotals(scene);
  EXPECT_EQ(totals.geometries, 2U);
  EXPECT_EQ(totals.meshBytes, ball->mesh.byteSize() + box->mesh.byteSize());
  EXPECT_EQ(totals.treeBytes, ball->tree().byteSize());
}

TEST(Instances, InMemoryAndFromAFileHaveOneGeometryHoweverManyThereAre) {
  const TriangleMesh mesh = test::icosphereMesh(1.0, 2);
  const PartGeometryPtr one = test::geometryOf(mesh);
  for (const std::size_t parts : {std::size_t{2}, std::size_t{200}}) {
    for (const InstancesRow& row :
         {measureInstancesInMemory(mesh, parts), measureInstancesFromFile(mesh, parts)}) {
      EXPECT_EQ(row.parts, parts);
      EXPECT_EQ(row.geometries, 1U);
      EXPECT_EQ(row.meshBytes, one->mesh.byteSize());
      EXPECT_EQ(row.treeBytes, one->tree().byteSize());
      EXPECT_GT(row.residentAfter, 0U);
    }
  }
}

TEST(ResidentBytes, GrowWithMemoryThatIsTouchedAndShrinkWhenItIsFreed) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  const std::uint64_t before = residentBytes();
  // From the system itself: what the heap gives back, and when, is its own affair.
  void* const memory = ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  std::memset(memory, 'x', kBytes);
  EXPECT_GE(residentBytes(), before + kBytes / 2);
  ASSERT_EQ(::munmap(memory, kBytes), 0);
  EXPECT_LT(residentBytes(), before + kBytes / 2);
}

}  // namespace
}  // namespace nearfit::bench::instances_test
