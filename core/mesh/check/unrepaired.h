#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/mesh/check/mesh_check.h"
#include "core/mesh/check/mesh_repair.h"

namespace nearfit {

/// A kind of finding that no repair mends, or that repairs have left.
struct UnrepairedKind {
  FindingKind kind{};
  bool areAll = true;  ///< False: others can still be repaired, such as holes larger than those filled.
  std::string reason;  ///< Why, as the rest of a sentence: "the surface has one side only".
};

/// The kinds of findings in a mesh that cannot be repaired, in the order of FindingKind, with the reason. Findings that
/// loading has mended, and those beyond MeshCheck::kMaxPlaces, are not looked at.
/// @param made  Repairs of the mesh before it was checked. What they should have mended, and what no later one of them
///              can have brought, cannot be repaired.
std::vector<UnrepairedKind> unrepairedKinds(const MeshCheck& check, std::span<const MeshRepair> made);

}  // namespace nearfit
