#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "core/import/mesh_import.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"
#include "tests/support/trial_share.h"

namespace nearfit::lmd_paper_pairs_test {
namespace {

using test::BodyPair;
using test::LmdTally;

/// The bodies of the paper's appendix where the shared models are there, else stand-ins of the same counts.
class PaperBodies {
 public:
  TriangleMesh load(const std::string& file, const std::function<TriangleMesh()>& standIn) const {
    const std::filesystem::path path = test::sharedFolder() / "models/public/paper_counts" / file;
    return std::filesystem::exists(path) ? importMesh(path, {}).mesh : standIn();
  }
  /// Scaled to a bounding box of unit diagonal, as the parts of one assembly would be alike in size.
  static TriangleMesh unitSize(const TriangleMesh& mesh) {
    return test::transformed(mesh, 1.0 / mesh.bounds().diagonal());
  }
  TriangleMesh sphere() const {
    return unitSize(load("sphere_128.obj", [] { return test::uvSphereMesh(1.0, 16, 5); }));
  }
  TriangleMesh bunny() const {
    return unitSize(load("bunny_2204.ply", [] { return test::starMesh(7, 1.0, 3, 0.2); }));
  }
  TriangleMesh teapot() const {
    return unitSize(load("teapot_5648.ply", [] {
      return test::joined(test::starMesh(8, 1.0, 4, 0.05), test::squareMesh(1.0, 16));
    }));
  }
  TriangleMesh spring() const {
    return unitSize(load("spring_23578.ply", [] { return test::torusMesh(1.0, 0.1, 393, 30); }));
  }
  TriangleMesh gear() const {
    return unitSize(load("gear_6302.ply", [] { return test::tubeMesh(0.5, 1.0, 0.4, 787); }));
  }
  TriangleMesh disc() const {
    return unitSize(load("disc_512.stl", [] { return test::cylinderMesh(1.0, 0.2, 128); }));
  }
  TriangleMesh crankshaft() const {
    return unitSize(load("crankshaft_12802.ply", [] { return test::torusMesh(1.0, 0.3, 100, 64); }));
  }
};

void expectPaperPairAgrees(const BodyPair& pair, std::size_t poses) {
  poses /= test::kTrialShare;
  const LmdTally tally = test::compareWithOracle(pair, poses, 0.05, 2003);
  EXPECT_EQ(tally.poses, poses);
  // The poses are near contact: there is something to compare, if little at the few poses of sanitized builds.
  EXPECT_GE(tally.minima, test::kTrialShare == 1 ? poses / 8 : 1);
  EXPECT_LT(tally.marginal, tally.minima / 1000 + 5);
}

TEST(LmdQueryOnPaperPairs, BunnyAgainstSphereHasTheBruteForceSet) {
  expectPaperPairAgrees({"bunny-sphere", PaperBodies().bunny(), PaperBodies().sphere()}, 400);
}
TEST(LmdQueryOnPaperPairs, SpringAgainstTeapotHasTheBruteForceSet) {
  expectPaperPairAgrees({"spring-teapot", PaperBodies().spring(), PaperBodies().teapot()}, 60);
}
TEST(LmdQueryOnPaperPairs, GearAgainstDiscHasTheBruteForceSet) {
  expectPaperPairAgrees({"gear-disc", PaperBodies().gear(), PaperBodies().disc()}, 200);
}
TEST(LmdQueryOnPaperPairs, GearAgainstGearHasTheBruteForceSet) {
  expectPaperPairAgrees({"gear-gear", PaperBodies().gear(), PaperBodies().gear()}, 80);
}
TEST(LmdQueryOnPaperPairs, CrankshaftAgainstGearHasTheBruteForceSet) {
  expectPaperPairAgrees({"crankshaft-gear", PaperBodies().crankshaft(), PaperBodies().gear()}, 80);
}
TEST(LmdQueryOnPaperPairs, CrankshaftAgainstSphereHasTheBruteForceSet) {
  expectPaperPairAgrees({"crankshaft-sphere", PaperBodies().crankshaft(), PaperBodies().sphere()}, 200);
}

}  // namespace
}  // namespace nearfit::lmd_paper_pairs_test
