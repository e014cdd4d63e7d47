#pragma once

#include <memory>

#include <coal/BVH/BVH_model.h>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Bodies as Coal has them; for the sources that are built with it.
namespace nearfit::bench {

using CoalModel = coal::BVHModel<coal::OBBRSS>;

std::unique_ptr<CoalModel> coalModelOf(const TriangleMesh& mesh);

coal::Transform3s toCoal(const RigidTransform& pose);

}  // namespace nearfit::bench
