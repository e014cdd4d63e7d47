#include "core/proximity/overlap/containment.h"

#include <gtest/gtest.h>

#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::containment_test {
namespace {

TEST(MeshComponents, AreNumberedByTheirFirstTriangleAndToldOpenFromClosed) {
  const TriangleMesh mesh = test::joined(test::joined(test::boxMesh({1, 1, 1}), test::squareMesh(1.0, 2)),
                                         test::turned(test::tetrahedronMesh()));
  const MeshComponents pieces = piecesOf(mesh);
  EXPECT_EQ(pieces.firstTriangle, (std::vector<std::uint32_t>{0, 12, 20}));
  EXPECT_EQ(pieces.isClosed, (std::vector<bool>{true, false, true}));
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i)
    EXPECT_EQ(pieces.pieceOf[i], i < 12 ? 0U : i < 20 ? 1U : 2U);
}

// Each of an edge's faces once visited all others.
TEST(MeshComponents, ABookOfManyPagesIsOne) {
  constexpr std::uint32_t kPages = 300'000;
  const MeshComponents pieces = piecesOf(test::finsMesh(1, kPages, 6.0));
  EXPECT_EQ(pieces.firstTriangle.size(), 1U);
  EXPECT_EQ(pieces.isClosed, std::vector<bool>{false});
  EXPECT_EQ(pieces.pieceOf, std::vector<std::uint32_t>(kPages, 0));
}

}  // namespace
}  // namespace nearfit::containment_test
