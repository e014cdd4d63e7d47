#include "tests/bench/coal_bodies.h"

#include <vector>

namespace nearfit::bench {

std::unique_ptr<CoalModel> coalModelOf(const TriangleMesh& mesh) {
  std::vector<coal::Vec3s> vertices;
  for (const glm::dvec3& p : mesh.vertices())
    vertices.emplace_back(p.x, p.y, p.z);
  std::vector<coal::Triangle> triangles;
  for (const Triangle& t : mesh.triangles())
    triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_unique<CoalModel>();
  model->beginModel(static_cast<unsigned>(triangles.size()), static_cast<unsigned>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

coal::Transform3s toCoal(const RigidTransform& pose) {
  const glm::dquat& q = pose.rotation;
  return {coal::Quatf(q.w, q.x, q.y, q.z),
          coal::Vec3s(pose.translation.x, pose.translation.y, pose.translation.z)};
}

}  // namespace nearfit::bench
