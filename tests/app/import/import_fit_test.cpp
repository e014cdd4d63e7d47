// A round peg goes into a bore, both drawn in STEP, by the proxy; and its bore is aligned by its exact surface. Sizes and
// the tilt of the file are those that make_models.py gives them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/placing/align.h"
#include "core/placing/feature_pick.h"
#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "core/scene/scene_file.h"
#include "core/servo/motion_reader.h"
#include "tests/app/import/import_fixture.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/places.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::import_fit_test {
namespace {

using test::importModel;

constexpr double kMm = 1e-3;
constexpr double kBoreRadius = 8 * kMm, kPegRadius = 7.8 * kMm;
/// How far the peg's lower end is above the bore in the file, and how far the hand leads it into the bore.
constexpr double kAbove = 5 * kMm, kDepth = 12 * kMm;
/// How far the hand is beside the axis: twice the play, and less than the chamfer takes in.
constexpr double kAside = 0.4 * kMm;
/// Between neighbouring facets of the default tessellation: the middles of the peg's are within the round one.
constexpr double kFacetAngle = 12 * std::numbers::pi / 180;

/// Where the file places the plate: 40 degrees about (1, 2, 3), then moved.
RigidTransform worldFromPlate() {
  return {glm::angleAxis(40 * std::numbers::pi / 180, glm::normalize(glm::dvec3(1, 2, 3))),
          glm::dvec3(31, -12, 7) * kMm};
}

/// A point of the bore's axis, in the plate's frame: the middle of its upper edge.
const glm::dvec3 kBoreTop = glm::dvec3(6.5, -4.25, 0.0) * kMm;

/// Distance of a point of the world from the axis of the bore [m].
double offAxis(const glm::dvec3& point) {
  const glm::dvec3 p = worldFromPlate().inverse().applyToPoint(point) - kBoreTop;
  return std::hypot(p.x, p.y);
}

/// Poses of the peg on a path that turns it by a fifth of a degree, goes aside above the plate, then down, and stays
/// there until the proxy has come as far as it can.
std::string pathInto(const RigidTransform& worldFromPeg) {
  constexpr int kGoesAside = 200, kGoesDown = 1700, kStays = 300;
  constexpr double kTurn = 0.2 * std::numbers::pi / 180;
  const RigidTransform plate = worldFromPlate();
  std::string text = "tx,ty,tz,qw,qx,qy,qz\n";
  for (int i = 0; i <= kGoesAside + kGoesDown + kStays; ++i) {
    const double aside = std::min(1.0, i / double{kGoesAside});
    const double down = std::clamp((i - kGoesAside) / double{kGoesDown}, 0.0, 1.0);
    const glm::dvec3 way =
        plate.applyToVector({0.6 * kAside * aside, 0.8 * kAside * aside, -(kAbove + kDepth) * down});
    const glm::dquat turn = glm::angleAxis(kTurn * aside, plate.applyToVector({1, 0, 0}));
    const glm::dvec3 at = worldFromPeg.translation + way;
    const glm::dquat q = glm::normalize(turn * worldFromPeg.rotation);
    text += fmt::format("{},{},{},{},{},{},{}\n", at.x, at.y, at.z, q.w, q.x, q.y, q.z);
  }
  return text;
}

TEST(ImportFit, ARoundPegGoesIntoABoreThroughTheProxyAndNeverMeetsThePlate) {
  const test::ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  const test::TemporaryFolder folder;
  test::ProcessOptions options;
  options.workingFolder = folder.path();
  const auto run = [&](const std::vector<std::string>& arguments) {
    const test::ProcessResult result = test::runCli(arguments, options);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return result.out;
  };
  // The margin on either side leaves most of the play, 0.15 mm between facets.
  run({"scene", "new", "fit.nearfit", "--import", importModel("peg_and_bore.step").string(), "--moving",
       "peg", "--cutoff", "0.002", "--margin", "2e-5"});
  const Scene scene = readSceneFile(folder.path() / "fit.nearfit");
  const Part *plate = scene.findByName("plate"), *peg = scene.findByName("peg");
  ASSERT_TRUE(plate != nullptr && peg != nullptr);
  folder.write("path.csv", pathInto(peg->worldFromPart));
  const auto summary = nlohmann::json::parse(run({"place", "fit.nearfit", "--part", "peg", "--path",
                                                  "path.csv", "--fast", "--record", "felt.csv", "--json"}));
  EXPECT_EQ(summary["proxy"]["released_ticks"], 0) << "a part that is not felt keeps nothing out";

  const std::vector<MotionRow> rows = readMotion(folder.path() / "felt.csv");
  ASSERT_GT(rows.size(), 2000U);
  const RigidTransform plateFromWorld = plate->worldFromPart.inverse();
  const auto plateFromPeg = [&](const RigidTransform& worldFromPeg) {
    return (plateFromWorld * worldFromPeg).normalized();
  };
  const test::PoseCertifier certifier(plate->geometry->mesh, peg->geometry->mesh);
  std::vector<RigidTransform> poses;
  for (const MotionRow& row : rows)
    poses.push_back(plateFromPeg(row.proxy));
  const std::vector<char> meetings = certifier.meetings(poses);
  EXPECT_EQ(std::ranges::count(meetings, 0), std::ssize(poses));
  EXPECT_TRUE(certifier.doMeet(plateFromPeg(rows.back().handle))) << "the hand alone would be in the wall";

  const RigidTransform& last = rows.back().proxy;
  const double depth = -worldFromPlate().inverse().applyToPoint(last.translation).z;
  // It leans on the wall, which leaves it free along the axis; its tilt within the play moves its end by less.
  EXPECT_NEAR(depth, kDepth, 0.1 * kMm);
  // Above its chamfer, and below the rim.
  const double play = kBoreRadius - kPegRadius * std::cos(0.5 * kFacetAngle);
  for (const double along : {1.0 * kMm, kDepth - 0.5 * kMm})
    EXPECT_LT(offAxis(last.applyToPoint({0.0, 0.0, along})), play);
}

/// A part of the file, with other triangles or the default ones.
struct DrawnPart {
  PartGeometryPtr geometry;
  RigidTransform worldFromPart;
};

DrawnPart partNamed(const NewNodes& nodes, const std::string& name) {
  for (const auto& part : nodes.parts)
    if (part.name == name) return {part.geometry, part.worldFromPart};
  throw std::runtime_error("there is no part " + name);
}

/// Features of the part's only cylinder in the world, picked at the middle of each triangle of it.
std::vector<AlignFeature> cylinderPicks(const DrawnPart& part) {
  const TriangleMesh& mesh = part.geometry->mesh;
  const SurfaceFaces& surfaces = *part.geometry->surfaces;
  std::vector<AlignFeature> features;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    if (surfaces.faces[surfaces.faceOfTriangle[i]].kind != SurfaceKind::Cylinder) continue;
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 middle = (mesh.vertices()[t[0]] + mesh.vertices()[t[1]] + mesh.vertices()[t[2]]) / 3.0;
    const auto picked = pickFeature(mesh, {i, middle}, 0.0, FeatureFilter::Rounds, &surfaces);
    if (picked) features.push_back(placed(picked->feature, part.worldFromPart));
  }
  return features;
}

/// Two axes are one, within what Align promises by exact surfaces.
void expectOneAxis(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& truePoint,
                   const glm::dvec3& trueDirection) {
  constexpr double kAlign = 1e-9;  // [m, rad]
  EXPECT_LE(glm::length(glm::cross(direction, trueDirection)), kAlign);
  EXPECT_LE(glm::length(glm::cross(point - truePoint, trueDirection)), kAlign);
}

TEST(ImportFit, AlignFindsTheTrueAxisAndRadiusOfTheBoreWhateverItsFacets) {
  const test::ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  const glm::dvec3 boreTop = worldFromPlate().applyToPoint(kBoreTop);
  const glm::dvec3 boreAxis = worldFromPlate().applyToVector({0, 0, 1});
  std::size_t coarsest = SIZE_MAX, finest = 0;
  for (const Tessellation& tessellation :
       {Tessellation{}, Tessellation{2e-3, 1.5}, Tessellation{1e-6, 0.02}}) {
    const NewNodes nodes =
        partsOfDocument(loadDocument(importModel("peg_and_bore.step"), 1.0, tessellation), Scene());
    const DrawnPart plate = partNamed(nodes, "plate"), peg = partNamed(nodes, "peg");
    const std::vector<AlignFeature> bores = cylinderPicks(plate), pegs = cylinderPicks(peg);
    ASSERT_FALSE(bores.empty() || pegs.empty());
    coarsest = std::min(coarsest, bores.size());
    finest = std::max(finest, bores.size());
    for (const AlignFeature& bore : bores) {
      ASSERT_EQ(bore.shape, FeatureShape::Axis);
      EXPECT_TRUE(bore.isExact);
      EXPECT_NEAR(bore.radius, kBoreRadius, 1e-9);
      expectOneAxis(bore.point, bore.direction, boreTop, boreAxis);
    }
    // From beside the bore and askew; the peg's axis is the z axis of its own frame.
    const RigidTransform away{glm::angleAxis(0.7, glm::normalize(glm::dvec3(-1, 3, 2))), {0.05, -0.02, 0.11}};
    const RigidTransform aligned = alignMotion(placed(pegs.front(), away), bores.front()) * away;
    const RigidTransform worldFromPeg = aligned * peg.worldFromPart;
    expectOneAxis(worldFromPeg.translation, worldFromPeg.applyToVector({0, 0, 1}), boreTop, boreAxis);
  }
  // Six times as many facets and more: it is not the facets that agree.
  EXPECT_GT(finest, 6 * coarsest);
}

}  // namespace
}  // namespace nearfit::import_fit_test
