#include "tests/bench/bench_scene.h"

#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/import/mesh_import.h"
#include "tests/bench/bench_shapes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

namespace fs = std::filesystem;

TriangleMesh importedMesh(const fs::path& file, double metresPerUnit = 1.0) {
  MeshBuildOptions options;
  options.metresPerUnit = metresPerUnit;
  return importMesh(file, options).mesh;
}

/// Scaled about the middle of its bounding box, which becomes the origin, to a diagonal of 1.
TriangleMesh unitSized(const TriangleMesh& mesh) {
  RigidTransform toOrigin;
  toOrigin.translation = -mesh.bounds().centre();
  return test::transformed(test::transformed(mesh, 1.0, toOrigin), 1.0 / mesh.bounds().diagonal());
}

BenchScene unitPair(std::string name, const TriangleMesh& scene, const TriangleMesh& part) {
  return {std::move(name), unitSized(scene), unitSized(part), std::nullopt, std::nullopt};
}

struct Bore {
  double radius, length;
};

/// A disc, given with radius 1 about the origin and its axis on z, in a bore along z, which it does not
/// leave.
/// @param gear  The bore is about the middle of its bounding box.
BenchScene discInBore(std::string name, const TriangleMesh& gear, const Bore& bore,
                      const TriangleMesh& unitDisc) {
  constexpr double kFill = 0.9, kRange = 0.35;
  const double scale = 1.0 / gear.bounds().diagonal();
  return {std::move(name), unitSized(gear), test::transformed(unitDisc, kFill * bore.radius * scale),
          RigidTransform(), kRange * bore.length * scale};
}

/// A square peg in a square hole, its walls and the peg's finely meshed and parallel.
BenchScene pegInHole(std::string name, std::uint32_t fineness) {
  const TriangleMesh hole = test::subdivided(test::tubeMesh(1.0, 2.0, 1.0, 4), fineness),
                     peg = test::subdivided(test::cylinderMesh(0.95, 3.0, 4), fineness);
  const double scale = 1.0 / hole.bounds().diagonal();
  // Within reach of all four walls wherever the gap lets it go.
  constexpr double kRange = 0.3;
  BenchScene scene{std::move(name), test::transformed(hole, scale), test::transformed(peg, scale),
                   RigidTransform(), kRange * scale};
  scene.isStraight = true;
  return scene;
}

SceneEntry generatedPair(const char* name, const char* description,
                         const std::function<TriangleMesh()>& scene,
                         const std::function<TriangleMesh()>& part) {
  return {name, description, [=] { return unitPair(name, scene(), part()); }};
}

constexpr std::uint32_t kGearTeeth = 25, kAroundCrankshaft = 63;

}  // namespace

std::vector<SceneEntry> generatedScenes() {
  const auto gear = [] { return gearMesh(kGearTeeth); };
  const auto crankshaft = [] { return crankshaftMesh(kAroundCrankshaft); };
  const auto sphere = [] { return test::uvSphereMesh(1.0, 8, 9); };
  return {
      {"gear-disc", "512-triangle disc in the bore of a 6,300-triangle gear",
       [] {
         return discInBore("gear-disc", gearMesh(kGearTeeth), {kGearBoreRadius, kGearLength},
                           test::cylinderMesh(1.0, 0.2, 128));
       }},
      {"peg-hole", "8,192-triangle hole, 4,096-triangle square peg in it that does not turn",
       [] { return pegInHole("peg-hole", 4); }},
      generatedPair(
          "organic-sphere", "smooth body of 2,000 triangles, 128-triangle sphere",
          [] { return organicMesh(10, 3); }, sphere),
      generatedPair("teapot-spring", "5,632-triangle teapot, 23,544-triangle spring", teapotMesh,
                    [] { return springMesh(980, 12); }),
      generatedPair("crankshaft-gear", "12,852-triangle crankshaft, 6,300-triangle gear", crankshaft, gear),
      generatedPair("crankshaft-sphere", "12,852-triangle crankshaft, 128-triangle sphere", crankshaft,
                    sphere),
      generatedPair("gear-gear", "two gears of 6,300 triangles", gear, gear),
      generatedPair(
          "organic-70k", "smooth bodies of 69,620 and 87,120 triangles", [] { return organicMesh(59, 1); },
          [] { return organicMesh(66, 2); }),
      generatedPair(
          "organic-1m", "smooth bodies of 1,003,520 and 1,104,500 triangles",
          [] { return organicMesh(224, 1); }, [] { return organicMesh(235, 2); }),
  };
}

std::vector<SceneEntry> sharedScenes(const fs::path& folder) {
  const fs::path models = folder / "models" / "public", paper = models / "paper_counts";
  const auto pair = [](const char* name, const char* description, const fs::path& scene,
                       const fs::path& part) {
    return SceneEntry{name, description,
                      [=] { return unitPair(name, importedMesh(scene), importedMesh(part)); }};
  };
  const fs::path gear = paper / "gear_6302.ply", crankshaft = paper / "crankshaft_12802.ply",
                 sphere = paper / "sphere_128.obj";
  // Of gear_6302.ply [m].
  constexpr Bore kBore{0.005, 0.02};
  // Of the crankshaft's diagonal: passes between its webs.
  constexpr double kDiscSize = 0.3;
  return {
      pair("paper-bunny-sphere", "2,204 and 128 triangles", paper / "bunny_2204.ply", sphere),
      pair("paper-spring-teapot", "23,578 and 5,648 triangles", paper / "spring_23578.ply",
           paper / "teapot_5648.ply"),
      {"paper-gear-disc", "6,302 triangles, 512 in its bore",
       [=] {
         return discInBore("paper-gear-disc", importedMesh(gear), kBore,
                           importedMesh(paper / "disc_512.stl"));
       }},
      {"paper-crankshaft-disc", "12,802 and 512 triangles",
       [=] {
         BenchScene scene = unitPair("paper-crankshaft-disc", importedMesh(crankshaft),
                                     importedMesh(paper / "disc_512.stl"));
         scene.part = test::transformed(scene.part, kDiscSize);
         return scene;
       }},
      pair("paper-gear-gear", "6,302 triangles each", gear, gear),
      pair("paper-crankshaft-gear", "12,802 and 6,302 triangles", crankshaft, gear),
      pair("paper-crankshaft-sphere", "12,802 and 128 triangles", crankshaft, sphere),
      pair("scan-bunny-armadillo", "69,666 and 29,170 triangles", models / "bunny_69666.off",
           models / "armadillo_29170.obj"),
  };
}

BenchScene sceneFromFiles(const fs::path& scene, const fs::path& part, double metresPerUnit) {
  return {scene.stem().string() + "-" + part.stem().string(), importedMesh(scene, metresPerUnit),
          importedMesh(part, metresPerUnit), std::nullopt, std::nullopt};
}

std::vector<MeshEntry> generatedMeshes() {
  return {
      {"gear-6k", [] { return gearMesh(kGearTeeth); }},
      {"spring-24k", [] { return springMesh(980, 12); }},
      {"organic-70k", [] { return organicMesh(59, 1); }},
      {"organic-250k", [] { return organicMesh(112, 1); }},
      {"organic-1m", [] { return organicMesh(224, 1); }},
  };
}

}  // namespace nearfit::bench
