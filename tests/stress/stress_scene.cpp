#include "tests/stress/stress_scene.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"
#include "core/proximity/query/broad_phase.h"
#include "tests/bench/feel_scenes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::stress {
namespace {

/// Minima are looked for this many margins around.
constexpr double kCutoffMargins = 20.0;

PartGeometryPtr solidOf(const TriangleMesh& mesh) {
  PartGeometryPtr geometry = test::solidGeometryOf(mesh);
  geometry->tree();
  return geometry;
}

/// As StressEntry has it.
double costOf(const std::string& feelScene) {
  constexpr std::array<std::pair<const char*, double>, 7> kCosts{{{"cylinder-tube", 150.0},
                                                                  {"box-hole", 22.0},
                                                                  {"wheels", 57.0},
                                                                  {"round-peg", 310.0},
                                                                  {"rectangular-peg", 140.0},
                                                                  {"nut-bolt", 5000.0},
                                                                  {"gears", 320.0}}};
  const auto found = std::ranges::find(kCosts, feelScene, [](const auto& known) { return known.first; });
  return found == kCosts.end() ? StressEntry::kUsualCost : found->second;
}

/// One that is pressed and moved for other ends, with a hand that is harder on it.
StressEntry fromFeel(const bench::FeelEntry& entry) {
  return {entry.name, entry.description,
          [make = entry.make] {
            const bench::FeelScene feel = make();
            StressScene out;
            out.scene = feel.scene;
            out.margin = 5e-5;
            out.cutoff = kCutoffMargins * out.margin;
            out.size = feel.size;
            out.lure = feel.motion.start;
            return out;
          },
          costOf(entry.name)};
}

void append(std::vector<StressEntry>& to, std::vector<StressEntry> entries) {
  std::move(entries.begin(), entries.end(), std::back_inserter(to));
}

}  // namespace

StressScene stressScene(const std::vector<PlacedBody>& bodies, const TriangleMesh& part,
                        const RigidTransform& start, double margin) {
  auto scene = std::make_shared<ServoScene>();
  std::uint32_t next = 1;
  scene->setMoving({PartId{next++}, solidOf(part), start});
  Aabb box = boundsOf(part.bounds(), start);
  for (const PlacedBody& body : bodies) {
    scene->bodies.push_back({PartId{next++}, solidOf(body.mesh), body.worldFromBody});
    const Aabb other = boundsOf(body.mesh.bounds(), body.worldFromBody);
    box.add(other.lower);
    box.add(other.upper);
  }
  scene->mass = 0.1;
  scene->prepareSurfaces();
  StressScene out;
  out.scene = std::move(scene);
  out.margin = margin;
  out.cutoff = kCutoffMargins * margin;
  out.size = box.diagonal();
  out.lure = start;
  return out;
}

StressScene cubeOverFloor(const RigidTransform& start, double margin) {
  return stressScene({{test::boxMesh({0.3, 0.3, 0.05}, {0.0, 0.0, -0.025})}},
                     test::boxMesh(glm::dvec3(kCubeSide)), start, margin);
}

std::vector<StressEntry> stressScenes(const std::filesystem::path& sharedFolder) {
  std::vector<StressEntry> all = narrowScenes();
  append(all, thinScenes());
  append(all, shapeScenes());
  append(all, scaleScenes());
  for (const bench::FeelEntry& entry : bench::generatedFeelScenes())
    all.push_back(fromFeel(entry));
  for (const bench::FeelEntry& entry : bench::sharedFeelScenes(sharedFolder))
    all.push_back(fromFeel(entry));
  return all;
}

std::vector<StressEntry> chosenScenes(const std::vector<StressEntry>& all,
                                      const std::vector<std::string>& names) {
  if (names.empty()) return all;
  std::vector<StressEntry> chosen;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const StressEntry& entry) { return entry.name == name; });
    if (found == all.end())
      throw UsageError("--scenes", "there is no scene '" + name + "'", "see nearfit-stress scenes");
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace nearfit::stress
