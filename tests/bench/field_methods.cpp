#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "tests/bench/error_method.h"
#include "tests/bench/signed_distance_field.h"
#include "tests/bench/surface_samples.h"

namespace nearfit::bench {
namespace {

/// Points on the part against a distance field of the scene.
///
/// The methods of that family (McNeely, Puterbaugh & Troy 1999; Barbic & James 2008) push each point that is
/// within the layer with a spring of its own, so that the stiffness felt is that of as many springs as there
/// are points near. What is compared here is what such a field knows of contacts: a point that is nearer to
/// the scene than all points around it counts as a local minimum, its direction is the gradient's, and each
/// has one spring, as those of the other methods. Points lie as far apart as the field's cells are wide, and
/// balls of points that the field shows to be out of reach are left out, as Barbic and James do.
class PointsInField : public ErrorMethod {
 public:
  PointsInField(const ErrorScene& scene, std::size_t cells)
      : scene_(scene),
        field_(scene.bodies.sceneTree, cells, scene.bodies.cutoff),
        samples_(scene.bodies.meshes.part, field_.cell()),
        distance_(samples_.points().size(), kFar) {
    near_.reserve(samples_.points().size());
  }

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    const RigidTransform pose = sceneFromPart.normalized();
    find(pose);
    for (const Near& near : near_) {
      if (near.sample.distance <= 0.0 || !isLeast(near.point)) continue;
      const double slope = glm::length(near.sample.gradient);
      if (!(slope > 0.0)) continue;
      Lmd& lmd = answer.minima.emplace_back();
      lmd.distance = near.sample.distance;
      lmd.direction = near.sample.gradient / slope;
      lmd.partPoint = pose.applyToPoint(samples_.points()[near.point]);
      lmd.scenePoint = lmd.partPoint - lmd.distance * lmd.direction;
    }
    for (const Near& near : near_)
      distance_[near.point] = kFar;
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }

  std::size_t byteSize() const override { return field_.byteSize() + samples_.byteSize(); }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  struct Near {
    std::uint32_t point;
    SignedDistanceField::Sample sample;
  };

  void find(const RigidTransform& pose) {
    near_.clear();
    // What lies between two corners is known to a cell.
    const double reach = scene_.bodies.cutoff + field_.cell();
    samples_.forNear(
        [&](const glm::dvec3& centre, double radius) {
          const glm::dvec3 moved = pose.applyToPoint(centre);
          const auto sample = field_.at(moved);
          return sample ? sample->distance <= reach + radius : field_.distanceOfGrid(moved) <= radius;
        },
        [&](std::uint32_t point) {
          const auto sample = field_.at(pose.applyToPoint(samples_.points()[point]));
          if (!sample || sample->distance > scene_.bodies.cutoff) return;
          near_.push_back({point, *sample});
          distance_[point] = sample->distance;
        });
  }

  /// Of points as near as each other around one place, the first.
  bool isLeast(std::uint32_t point) const {
    for (const std::uint32_t other : samples_.around(point)) {
      if (distance_[other] < distance_[point] || (distance_[other] == distance_[point] && other < point))
        return false;
    }
    return true;
  }

  const ErrorScene& scene_;
  SignedDistanceField field_;
  SurfaceSamples samples_;
  std::vector<double> distance_;  ///< Of each point, at the pose; infinity where it is out of reach.
  std::vector<Near> near_;
};

}  // namespace

std::vector<ErrorMethodEntry> fieldErrorMethods() {
  std::vector<ErrorMethodEntry> entries;
  for (const std::size_t cells : {std::size_t{32}, std::size_t{64}, std::size_t{128}}) {
    entries.push_back(
        {fmt::format("points in field {}", cells),
         fmt::format("points on the part in a distance field of the scene, {} cells along it", cells), 1,
         false, [cells](const ErrorScene& scene) { return std::make_unique<PointsInField>(scene, cells); }});
  }
  return entries;
}

}  // namespace nearfit::bench
