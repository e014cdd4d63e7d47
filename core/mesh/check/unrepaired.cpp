#include "core/mesh/check/unrepaired.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <ranges>

#include <fmt/format.h>

#include "core/exact/hole_triangulation.h"

namespace nearfit {
namespace {

/// The size up to which the last repair of a kind has mended things; nullopt if none was made, or one that is not among
/// the harmless came after it.
std::optional<double> sizeMade(std::span<const MeshRepair> made, RepairKind kind,
                               std::initializer_list<RepairKind> harmless) {
  for (const MeshRepair& repair : std::views::reverse(made)) {
    if (repair.kind == kind) return repair.size;
    if (std::ranges::find(harmless, repair.kind) == harmless.end()) return std::nullopt;
  }
  return std::nullopt;
}

class Remainder {
 public:
  Remainder(const MeshCheck& check, std::span<const MeshRepair> made)
      : filled_(sizeMade(made, RepairKind::FillHoles, {RepairKind::Orient, RepairKind::DropShells})),
        stitched_(sizeMade(made, RepairKind::Stitch,
                           {RepairKind::DropShells, RepairKind::Orient, RepairKind::FillHoles})),
        isOriented_(
            sizeMade(made, RepairKind::Orient, {RepairKind::FillHoles, RepairKind::DropShells}).has_value()),
        canBeCleaned_(std::ranges::any_of(check.findings, [](const MeshFinding& finding) {
          return !finding.isMended && (finding.kind == FindingKind::DegenerateFaces ||
                                       finding.kind == FindingKind::DuplicateFaces);
        })) {}

  bool isBeyondRepair(const MeshFinding& finding) const {
    switch (finding.kind) {
      case FindingKind::OpenEdges:
        return filled_ && finding.box.diagonal() <= *filled_;
      case FindingKind::HairlineCracks:
        return stitched_ && finding.length <= *stitched_;
      case FindingKind::NonManifoldEdges:
        // Faces that repeat others make some, which go with them.
        return !canBeCleaned_;
      case FindingKind::NonManifoldVertices:
      case FindingKind::SelfIntersections:
        return true;
      case FindingKind::InconsistentEdges:
        return isOriented_;
      case FindingKind::InvertedShells:
      case FindingKind::DegenerateFaces:
      case FindingKind::DuplicateFaces:
        break;
    }
    // Repairs may leave new ones of these, which the same repairs mend.
    return false;
  }

 private:
  std::optional<double> filled_, stitched_;  ///< Up to which size [m].
  bool isOriented_, canBeCleaned_;
};

std::string reasonOf(FindingKind kind) {
  switch (kind) {
    case FindingKind::OpenEdges:
      return fmt::format(
          "filling has left them, because their rim is no closed loop, has more than {} corners, "
          "or is that of a single face",
          kMaxHoleCorners);
    case FindingKind::HairlineCracks:
      return "stitching has left them, because it would swallow faces that are as narrow";
    case FindingKind::NonManifoldEdges:
      return "the mesh does not say which of the faces that meet there belong together";
    case FindingKind::NonManifoldVertices:
      return "sheets of the surface touch in a point, where no face is wrong";
    case FindingKind::SelfIntersections:
      return "the mesh does not say which of the faces should give way";
    case FindingKind::InconsistentEdges:
      return "the surface has one side only, as a Moebius strip has";
    case FindingKind::InvertedShells:
    case FindingKind::DegenerateFaces:
    case FindingKind::DuplicateFaces:
      break;
  }
  return {};
}

}  // namespace

std::vector<UnrepairedKind> unrepairedKinds(const MeshCheck& check, std::span<const MeshRepair> made) {
  const Remainder remainder(check, made);
  std::vector<UnrepairedKind> kinds;
  for (std::size_t i = 0; i < kFindingKinds; ++i) {
    const auto kind = static_cast<FindingKind>(i);
    std::size_t all = 0, left = 0;
    for (const MeshFinding& finding : check.findings) {
      if (finding.kind != kind || finding.isMended) continue;
      ++all;
      left += remainder.isBeyondRepair(finding) ? 1 : 0;
    }
    if (left > 0) kinds.push_back({kind, left == all, reasonOf(kind)});
  }
  return kinds;
}

}  // namespace nearfit
