#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/proximity/normal_cone_tree.h"

/// Whether arrays that come from a file are such that no use of them leaves their memory or runs on for ever,
/// whoever wrote them. That they are what was computed is for checksums to say. O(n), on all processors.
namespace nearfit {

bool isSound(const TriangleMesh::Arrays& mesh);

bool isSound(const NormalConeTree::Arrays& tree);

}  // namespace nearfit
