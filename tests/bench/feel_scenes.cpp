#include "tests/bench/feel_scenes.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/import/mesh_import.h"
#include "core/scene/scene.h"
#include "tests/bench/bench_shapes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;

/// How far beyond contact a hand presses [m].
constexpr double kPressDepth = 1e-3;
constexpr double kDegree = pi / 180.0;

FeelScene feelScene(const TriangleMesh& scene, const TriangleMesh& part, PressingMotion motion) {
  FeelScene out;
  out.scene = solidScene(scene, part, motion.start);
  out.motion = motion;
  out.size = std::max(scene.bounds().diagonal(), part.bounds().diagonal());
  out.motion.centreInPart = out.scene->centreInPart;
  return out;
}

RigidTransform raised(double z, double turn = 0.0) {
  return {glm::angleAxis(turn, glm::dvec3(0.0, 0.0, 1.0)), {0.0, 0.0, z}};
}

/// A peg along z in its hole: all the way round, up and down, turned and tilted.
PressingMotion inHole(double gap, const RigidTransform& start = {}) {
  PressingMotion motion;
  motion.start = start;
  motion.press = gap + kPressDepth;
  motion.swing = pi;
  motion.slide = 8e-3;
  motion.turn = 20.0 * kDegree;
  motion.tilt = 1.0 * kDegree;
  return motion;
}

FeelScene cylinderInTube() {
  // Of the size of the round peg, with its gap.
  constexpr double kBore = 8.25e-3, kPeg = 8e-3;
  return feelScene(test::tubeMesh(kBore, 12.5e-3, 9e-3, 64), test::cylinderMesh(kPeg, 50e-3, 64),
                   inHole(kBore - kPeg));
}

FeelScene boxInHole() {
  // A tube of four corners is a square one; its bore's radius is that to the corners.
  constexpr double kHalfHole = 6.25e-3, kHalfBox = 6e-3;
  const TriangleMesh hole = test::transformed(test::tubeMesh(std::numbers::sqrt2 * kHalfHole, 18e-3, 9e-3, 4),
                                              1.0, raised(0.0, pi / 4));
  return feelScene(hole, test::boxMesh({2.0 * kHalfBox, 2.0 * kHalfBox, 40e-3}),
                   inHole(kHalfHole - kHalfBox));
}

/// A wheel against another on its `towards` side: pressed into it, with its teeth driven against the others'.
PressingMotion inMesh(const RigidTransform& start, double gap, const glm::dvec3& towards) {
  PressingMotion motion;
  motion.start = start;
  motion.towards = towards;
  motion.press = gap + kPressDepth;
  motion.swing = 40.0 * kDegree;
  motion.slide = 3e-3;
  motion.turn = 6.0 * kDegree;
  motion.tilt = 0.5 * kDegree;
  return motion;
}

FeelScene generatedWheels() {
  constexpr std::uint32_t kTeeth = 25;
  // Tip radius 20 mm, root 17 mm; the corner that a tooth begins with is in a gap.
  constexpr double kScale = 0.01, kApart = 38.4e-3;
  const TriangleMesh wheel = test::transformed(gearMesh(kTeeth), kScale);
  // The part's tooth points along -x, into the gap on the other's +x side.
  const RigidTransform start{glm::angleAxis(pi + pi / kTeeth, glm::dvec3(0.0, 0.0, 1.0)), {kApart, 0.0, 0.0}};
  return feelScene(wheel, wheel, inMesh(start, 0.3e-3, {-1.0, 0.0, 0.0}));
}

TriangleMesh imported(const fs::path& file) {
  return importMesh(file, {}).mesh;
}

FeelScene nutOnBolt(const fs::path& folder) {
  constexpr double kPitch = 2e-3, kTurns = 3.0, kGap = 0.2e-3;
  PressingMotion motion;
  motion.start = raised(kTurns * kPitch, 2.0 * pi * kTurns);
  motion.press = kGap + kPressDepth;
  motion.swing = pi;
  motion.slide = kPressDepth;
  motion.turn = 120.0 * kDegree;
  motion.lead = kPitch / (2.0 * pi);
  motion.tilt = 0.5 * kDegree;
  FeelScene out = feelScene(imported(folder / "factory_bolt_m16_loose.obj"),
                            imported(folder / "factory_nut_m16_loose_subdiv_3x.obj"), motion);
  // Between the flanks there are 0.1 mm on either side: of which a fifth leaves the nut its play.
  out.margin = 2e-5;
  out.mostSeconds = 1.0;
  out.mostSpringSeconds = 0.1;
  return out;
}

FeelScene gearsInMesh(const fs::path& models) {
  constexpr double kGap = 0.18e-3;
  const TriangleMesh wheel = imported(models / "paper_counts/gear_6302.ply");
  const TriangleMesh pinion = imported(models / "gears/factory_gear_small_space_5e-4.obj");
  const glm::dvec3 way = wheel.bounds().centre() - pinion.bounds().centre();
  return feelScene(wheel, pinion, inMesh({}, kGap, glm::normalize(glm::dvec3(way.x, way.y, 0.0))));
}

}  // namespace

std::shared_ptr<const ServoScene> solidScene(const TriangleMesh& scene, const TriangleMesh& part,
                                             const RigidTransform& start) {
  Scene both;
  both.add(test::partOf(test::solidGeometryOf(scene), "scene"));
  both.setMovingPart(both.add(test::partOf(test::solidGeometryOf(part), "in hand", start)));
  return makeServoScene(both);
}

std::vector<FeelEntry> generatedFeelScenes() {
  return {{"cylinder-tube", "cylinder of 256 triangles in a tube of 512, gap 0.25 mm", cylinderInTube},
          {"box-hole", "box in a square hole, gap 0.25 mm", boxInHole},
          {"wheels", "two toothed wheels of 6,300 triangles", generatedWheels}};
}

std::vector<FeelEntry> sharedFeelScenes(const fs::path& folder) {
  const fs::path models = folder / "models/public", pegs = models / "peghole";
  if (folder.empty() || !fs::is_directory(models)) return {};
  // The holes are 9 mm high: the pegs reach through them.
  const auto pegInHole = [=](const char* hole, const char* peg, double gap) {
    return feelScene(imported(pegs / hole), imported(pegs / peg), inHole(gap, raised(-20e-3)));
  };
  return {
      {"round-peg", "peg of 1,152 triangles in its hole, gap 0.26 mm",
       [=] {
         return pegInHole("factory_round_hole_16mm_subdiv_3x.obj", "factory_round_peg_16mm_loose.obj",
                          0.26e-3);
       }},
      {"rectangular-peg", "peg of 1,792 triangles in its hole",
       [=] {
         return pegInHole("factory_rectangular_hole_12mm_subdiv_3x.obj",
                          "factory_rectangular_peg_12mm_loose_subdiv_3x.obj", 0.26e-3);
       }},
      {"nut-bolt", "nut of 15,080 triangles on a bolt of 25,668, three turns up",
       [=] { return nutOnBolt(models / "nutbolt"); }},
      {"gears", "gear of 20,532 triangles in mesh with one of 6,302", [=] { return gearsInMesh(models); }},
  };
}

}  // namespace nearfit::bench
