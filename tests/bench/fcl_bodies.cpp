#include "tests/bench/fcl_bodies.h"

#include <vector>

namespace nearfit::bench {

std::unique_ptr<FclModel> fclModelOf(const TriangleMesh& mesh) {
  std::vector<fcl::Vector3d> vertices;
  for (const glm::dvec3& p : mesh.vertices())
    vertices.emplace_back(p.x, p.y, p.z);
  std::vector<fcl::Triangle> triangles;
  for (const Triangle& t : mesh.triangles())
    triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_unique<FclModel>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

fcl::Transform3d toFcl(const RigidTransform& pose) {
  fcl::Transform3d out = fcl::Transform3d::Identity();
  const glm::dquat& q = pose.rotation;
  out.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  out.translation() = fcl::Vector3d(pose.translation.x, pose.translation.y, pose.translation.z);
  return out;
}

}  // namespace nearfit::bench
