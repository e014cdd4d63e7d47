#include "tests/bench/scene_path.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/files/atomic_write.h"
#include "core/proximity/query/lmd_query.h"

namespace nearfit::bench {
namespace {

double radiusAbout(const TriangleMesh& mesh, const glm::dvec3& centre) {
  double radius = 0.0;
  for (const glm::dvec3& p : mesh.vertices())
    radius = std::max(radius, glm::distance(p, centre));
  return radius;
}

}  // namespace

PathBodies pathBodies(const BenchScene& scene) {
  const glm::dvec3 sceneCentre = scene.scene.bounds().centre(), partCentre = scene.part.bounds().centre();
  return {sceneCentre, partCentre, radiusAbout(scene.scene, sceneCentre), radiusAbout(scene.part, partCentre),
          scene.size()};
}

std::vector<RigidTransform> makePath(const PreparedScene& scene, HandPathOptions options) {
  if (options.cutoff == 0.0) options.cutoff = scene.cutoff;
  options.reach = 1.5 * options.cutoff;
  options.start = scene.meshes.start;
  options.range = scene.meshes.range;
  if (scene.meshes.isStraight) options.turn = 0.0;
  LmdScratch scratch;
  const DistanceProbe probe = [&](const RigidTransform& pose) -> std::optional<Nearest> {
    std::array<Lmd, 1> nearest;
    const LmdResult found = findLmds(scene.sceneTree, scene.partTree, pose, options.reach, scratch, nearest);
    if (found.count == 0) return std::nullopt;
    return Nearest{nearest[0].distance, nearest[0].direction};
  };
  return handPath(pathBodies(scene.meshes), probe, options);
}

void writePath(const std::filesystem::path& file, std::span<const RigidTransform> path) {
  std::string text = "tx,ty,tz,qw,qx,qy,qz\n";
  for (const RigidTransform& pose : path) {
    const glm::dvec3& t = pose.translation;
    const glm::dquat& q = pose.rotation;
    text += fmt::format("{},{},{},{},{},{},{}\n", t.x, t.y, t.z, q.w, q.x, q.y, q.z);
  }
  atomicWrite(file, text);
}

}  // namespace nearfit::bench
