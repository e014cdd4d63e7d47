#include "tests/bench/many_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/aabb.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/portable_random.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

/// Between the boxes of neighbours [m]; bodies have a radius of about one.
constexpr double kStackGap = 0.02;
/// How far apart the centres of two bodies are that clash, of the radii of the balls that they hold: these overlap, even
/// where triangles cut across the surface of a ball.
constexpr double kClashShare = 0.9;

/// Blocks with a square hole and pegs in them: radii of the corners and height of a peg, and the gap between neighbours
/// [m]. A peg has (kHoleRadius - kPegRadius) / sqrt(2) = 0.035 on each side.
constexpr double kHoleRadius = 1.0, kBlockRadius = 2.0, kPegRadius = 0.95, kPegHeight = 3.0, kFitGap = 0.06;
/// From one to the next in a layer, and from layer to layer [m].
constexpr double kFitPitch = std::numbers::sqrt2 * kBlockRadius + kFitGap, kFitRise = kPegHeight + kFitGap;
/// By how much each is off its place [m, rad]: two that are turned and moved towards each other come nearer by less than
/// 0.02, so that nothing meets; and no two pairs are alike.
constexpr double kFitShift = 0.005, kFitTurn = 0.002;

Aabb placedBounds(const TriangleMesh& mesh, const RigidTransform& pose) {
  Aabb box;
  for (const glm::dvec3& p : mesh.vertices())
    box.add(pose.applyToPoint(p));
  return box;
}

double leastRadius(const TriangleMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const glm::dvec3& p : mesh.vertices())
    least = std::min(least, glm::length(p));
  return least;
}

RigidTransform anyOrientation(std::mt19937_64& random) {
  const glm::dvec3 axis = randomDirection(random);
  return {glm::angleAxis(2.0 * std::numbers::pi * uniform(random), axis), glm::dvec3(0.0)};
}

/// Pegs in a row, and rows in a layer.
std::size_t fittedEdge(const FittedPartsSize& size) {
  return static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(size.pegs))));
}

/// At a place with its flat sides along the axes, but for a little.
RigidTransform fittedPose(const glm::dvec3& place, std::mt19937_64& random) {
  const glm::dquat square = glm::angleAxis(std::numbers::pi / 4.0, glm::dvec3(0, 0, 1));
  const glm::dvec3 axis = randomDirection(random), way = randomDirection(random);
  const double turn = kFitTurn * uniform(random), shift = kFitShift * uniform(random);
  return RigidTransform{glm::angleAxis(turn, axis) * square, place + shift * way}.normalized();
}

/// Bodies in rows along x, rows in layers along y, layers along z, each as low as those before it allow.
class Stack {
 public:
  Stack(ManyPartsScene& scene, const ManyPartsSize& size)
      : scene_(scene), size_(size), random_(size.seed), inRow_(rowLength(size.parts)) {
    const double rows = static_cast<double>(size.parts) / static_cast<double>(inRow_);
    inLayer_ = inRow_ * static_cast<std::size_t>(std::ceil(std::sqrt(rows)));
    for (const TriangleMesh& mesh : scene.meshes)
      radii_.push_back(leastRadius(mesh));
  }

  void run() {
    for (std::size_t i = 0; i < size_.parts; ++i)
      add(i);
    Aabb all;
    for (const Aabb& box : boxes_) {
      all.add(box.lower);
      all.add(box.upper);
    }
    scene_.diagonal = all.diagonal();
  }

 private:
  static std::size_t rowLength(std::size_t parts) {
    return static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(parts))));
  }

  void add(std::size_t i) {
    const auto mesh = static_cast<std::uint32_t>(i % scene_.meshes.size());
    RigidTransform pose = anyOrientation(random_);
    const Aabb turned = placedBounds(scene_.meshes[mesh], pose);
    const bool isRowStart = i % inRow_ == 0;
    if (isRowStart) rowEnd_ = 0.0;
    const bool isClash = size_.clashEvery > 0 && i % size_.clashEvery == size_.clashEvery - 1 && !isRowStart;
    pose.translation = isClash ? clashing(i, mesh) : stacked(i, turned);
    boxes_.push_back({turned.lower + pose.translation, turned.upper + pose.translation});
    rowEnd_ = std::max(rowEnd_, boxes_.back().upper.x + kStackGap);
    scene_.parts.push_back({mesh, pose});
  }

  glm::dvec3 clashing(std::size_t i, std::uint32_t mesh) {
    const ManyPartsPlace& before = scene_.parts[i - 1];
    scene_.meantClashes.emplace_back(static_cast<std::uint32_t>(i - 1), static_cast<std::uint32_t>(i));
    glm::dvec3 centre = before.worldFromPart.translation;
    centre.x += kClashShare * (radii_[before.mesh] + radii_[mesh]);
    return centre;
  }

  glm::dvec3 stacked(std::size_t i, const Aabb& turned) const {
    const std::size_t row = i / inRow_ * inRow_, layer = i / inLayer_ * inLayer_;
    glm::dvec3 place(rowEnd_, 0.0, 0.0);
    const glm::dvec3 size = turned.upper - turned.lower;
    for (std::size_t k = layer; k < row; ++k) {
      if (areBeside(boxes_[k], place, size, 0)) place.y = std::max(place.y, boxes_[k].upper.y + kStackGap);
    }
    for (std::size_t k = 0; k < layer; ++k) {
      if (areBeside(boxes_[k], place, size, 0) && areBeside(boxes_[k], place, size, 1))
        place.z = std::max(place.z, boxes_[k].upper.z + kStackGap);
    }
    return place - turned.lower;
  }

  /// True if a box and another one from `lower` have less than a gap between them along an axis.
  static bool areBeside(const Aabb& box, const glm::dvec3& lower, const glm::dvec3& size,
                        glm::length_t axis) {
    return box.lower[axis] <= lower[axis] + size[axis] + kStackGap &&
           box.upper[axis] >= lower[axis] - kStackGap;
  }

  ManyPartsScene& scene_;
  const ManyPartsSize& size_;
  std::mt19937_64 random_;
  std::size_t inRow_, inLayer_ = 1;
  std::vector<double> radii_;
  std::vector<Aabb> boxes_;
  double rowEnd_ = 0.0;
};

}  // namespace

std::size_t ManyPartsScene::triangles() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
    count += meshOf(i).triangles().size();
  return count;
}

ManyPartsScene stackedParts(const std::string& name, const ManyPartsSize& size) {
  ManyPartsScene scene;
  scene.name = name;
  for (std::uint32_t i = 0; i < size.shapes; ++i)
    scene.meshes.push_back(organicMesh(size.frequency + i % 2, i + 1));
  Stack(scene, size).run();
  scene.threshold = size.thresholdFraction * scene.diagonal;
  return scene;
}

ManyPartsScene fittedParts(const std::string& name, const FittedPartsSize& size) {
  ManyPartsScene scene;
  scene.name = name;
  scene.meshes = {test::subdivided(test::tubeMesh(kHoleRadius, kBlockRadius, 1.0, 4), size.fineness),
                  test::subdivided(test::cylinderMesh(kPegRadius, kPegHeight, 4), size.fineness)};
  const std::size_t edge = fittedEdge(size);
  std::mt19937_64 random(size.seed);
  Aabb all;
  for (std::size_t i = 0; i < size.pegs; ++i) {
    const std::size_t row = i / edge % edge, layer = i / (edge * edge);
    const glm::dvec3 cell(static_cast<double>(i % edge) * kFitPitch, static_cast<double>(row) * kFitPitch,
                          static_cast<double>(layer) * kFitRise);
    for (std::uint32_t mesh = 0; mesh < 2; ++mesh) {
      scene.parts.push_back({mesh, fittedPose(cell, random)});
      const Aabb box = placedBounds(scene.meshes[mesh], scene.parts.back().worldFromPart);
      all.add(box.lower);
      all.add(box.upper);
    }
  }
  scene.diagonal = all.diagonal();
  scene.threshold = size.thresholdFraction * scene.diagonal;
  return scene;
}

ChannelGrid channelsOf(const FittedPartsSize& size) {
  const std::size_t edge = fittedEdge(size), inLayer = edge * edge;
  const double block = kBlockRadius / std::numbers::sqrt2;
  return {.first = {-block, 0.5 * kFitPitch, 0.5 * kFitRise},
          .length = static_cast<double>(edge - 1) * kFitPitch + 2.0 * block,
          .pitch = kFitPitch,
          .rise = kFitRise,
          .rows = edge - 1,
          .layers = (size.pegs + inLayer - 1) / inLayer - 1};
}

ManyPartsScene manyPartsOf(const std::string& name, const Scene& scene, double thresholdFraction) {
  ManyPartsScene many;
  many.name = name;
  std::map<const PartGeometry*, std::uint32_t> meshOf;
  Aabb all;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!part->isVisible || !hasTriangles(*part)) continue;
    const auto [known, isNew] =
        meshOf.emplace(part->geometry.get(), static_cast<std::uint32_t>(many.meshes.size()));
    if (isNew) many.meshes.push_back(part->geometry->mesh);
    many.parts.push_back({known->second, part->worldFromPart});
    const Aabb box = placedBounds(part->geometry->mesh, part->worldFromPart);
    all.add(box.lower);
    all.add(box.upper);
  }
  many.diagonal = many.parts.empty() ? 0.0 : all.diagonal();
  many.threshold = thresholdFraction * many.diagonal;
  return many;
}

}  // namespace nearfit::bench
