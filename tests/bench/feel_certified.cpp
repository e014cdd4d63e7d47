#include "tests/bench/feel_certified.h"

#include <vector>

#include "tests/exact/pose_certifier.h"

namespace nearfit::bench {
FeelRow certifiedRow(const std::string& group, const std::string& scene, const std::string& run,
                     const ServoScene& bodies, std::span<const RigidTransform> worldFromPart) {
  std::vector<RigidTransform> distinct;
  for (const RigidTransform& pose : worldFromPart) {
    if (distinct.empty() || pose != distinct.back()) distinct.push_back(pose);
  }
  std::vector<double> meets(distinct.size(), 0.0);
  for (const ServoScene::Body& body : bodies.bodies) {
    const RigidTransform bodyFromWorld = body.worldFromPart.inverse();
    std::vector<RigidTransform> poses;
    poses.reserve(distinct.size());
    for (const RigidTransform& pose : distinct)
      poses.push_back(bodyFromWorld * pose);
    const test::PoseCertifier certifier(body.geometry->mesh, bodies.moving.geometry->mesh);
    const std::vector<char> found = certifier.meetings(poses);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (found[i]) meets[i] = 1.0;
  }
  return feelRow(group, scene, run, kMeetings, meets);
}

}  // namespace nearfit::bench
