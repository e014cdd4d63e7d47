#pragma once

#include <memory>

#include <fcl/geometry/bvh/BVH_model.h>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Bodies as FCL has them; for the sources that are built with it.
namespace nearfit::bench {

using FclModel = fcl::BVHModel<fcl::OBBRSSd>;

std::unique_ptr<FclModel> fclModelOf(const TriangleMesh& mesh);

fcl::Transform3d toFcl(const RigidTransform& pose);

}  // namespace nearfit::bench
