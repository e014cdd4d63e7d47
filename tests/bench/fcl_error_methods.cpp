#include <memory>

#include <fcl/narrowphase/distance.h>

#include "tests/bench/error_method.h"
#include "tests/bench/fcl_bodies.h"

namespace nearfit::bench {
namespace {

glm::dvec3 fromFcl(const fcl::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// The least distance alone, between the points where it is.
class FclGlobalDistance : public ErrorMethod {
 public:
  explicit FclGlobalDistance(const ErrorScene& scene)
      : scene_(scene),
        sceneModel_(fclModelOf(scene.bodies.meshes.scene)),
        partModel_(fclModelOf(scene.bodies.meshes.part)) {}

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    fcl::DistanceRequestd request;
    request.enable_nearest_points = true;
    fcl::DistanceResultd result;
    fcl::distance(sceneModel_.get(), fcl::Transform3d::Identity(), partModel_.get(), toFcl(sceneFromPart),
                  request, result);
    if (!(result.min_distance > 0.0) || result.min_distance > scene_.bodies.cutoff) return;
    Lmd& lmd = answer.minima.emplace_back();
    lmd.scenePoint = fromFcl(result.nearest_points[0]);
    lmd.partPoint = fromFcl(result.nearest_points[1]);
    lmd.distance = result.min_distance;
    lmd.direction = (lmd.partPoint - lmd.scenePoint) / lmd.distance;
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }

 private:
  const ErrorScene& scene_;
  std::unique_ptr<FclModel> sceneModel_, partModel_;
};

}  // namespace

std::vector<ErrorMethodEntry> fclErrorMethods() {
  return {{"FCL global distance", "FCL's least distance and its two points: at most one contact", 1, false,
           [](const ErrorScene& scene) { return std::make_unique<FclGlobalDistance>(scene); }}};
}

}  // namespace nearfit::bench
