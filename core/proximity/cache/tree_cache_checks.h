#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

/// True if arrays from a file, whoever wrote it, are safe: no use of them leaves their memory or loops
/// forever. Checksums tell if they are what was computed. O(n), on all processors.
namespace nearfit {

bool isSound(const TriangleMesh::Arrays& mesh);

bool isSound(const NormalConeTree::Arrays& tree);

}  // namespace nearfit
