// Checks and repairs of small meshes, as they are read and with faces that reading would drop. Repairs change what they
// say and nothing else, know where each face came from, and give the same mesh each time.
#include "core/mesh/check/mesh_repair.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/check/mesh_check.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/small_mesh.h"
#include "tests/support/cached_meshes.h"

namespace nearfit::fuzz {
namespace {

/// Meshes that are read reach no farther [m]: squares and cubes of what is checked stay finite.
constexpr double kFarthest = 1e9;

/// The triangles as they are, also flat and doubled ones. None where TriangleMesh refuses them.
std::optional<TriangleMesh> rawMesh(ByteSource& bytes) {
  const PolygonSoup soup = smallSoup(bytes);
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < soup.corners.size(); i += 3)
    triangles.push_back({soup.corners[i], soup.corners[i + 1], soup.corners[i + 2]});
  std::erase_if(triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (triangles.empty()) return std::nullopt;
  try {
    return TriangleMesh(soup.vertices, std::move(triangles));
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::optional<TriangleMesh> someMesh(ByteSource& bytes) {
  std::optional<TriangleMesh> mesh = bytes.flag() ? rawMesh(bytes) : smallMesh(bytes);
  if (mesh && !(mesh->bounds().largestCoordinate() <= kFarthest)) mesh.reset();
  return mesh;
}

/// Totals of the kinds that only need counting.
std::map<FindingKind, std::uint64_t> countedTotals(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::uint64_t, 2>> runs;
  std::map<std::set<std::uint32_t>, std::uint64_t> copies;
  for (const Triangle& t : mesh.triangles()) {
    ++copies[{t[0], t[1], t[2]}];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      ++runs[std::minmax(from, to)][from < to ? 0 : 1];
    }
  }
  std::map<FindingKind, std::uint64_t> totals;
  for (const auto& [edge, ways] : runs) {
    const std::uint64_t faces = ways[0] + ways[1];
    totals[FindingKind::OpenEdges] += faces == 1 ? 1 : 0;
    totals[FindingKind::NonManifoldEdges] += faces > 2 ? 1 : 0;
    totals[FindingKind::InconsistentEdges] += faces == 2 && ways[0] != 1 ? 1 : 0;
  }
  for (const auto& [corners, count] : copies)
    totals[FindingKind::DuplicateFaces] += count - 1;
  return totals;
}

void requirePlace(const MeshFinding& finding) {
  require(finding.hasPlace && isFinite(finding.point) && std::isfinite(finding.length), "places are finite");
  require(
      finding.edges.size() <= MeshFinding::kMaxShown && finding.triangles.size() <= MeshFinding::kMaxShown,
      "no more is shown than there is room for");
  require(!finding.edges.empty() || !finding.triangles.empty(), "each finding shows something");
  require(finding.count > 0 && !finding.box.isEmpty(), "each finding is about something");
}

void requireCheck(const MeshCheck& check, const TriangleMesh& mesh, const MeshCheckOptions& options) {
  require(std::ranges::is_sorted(check.findings, {}, &MeshFinding::kind), "findings are sorted by kind");
  std::array<FindingTotal, kFindingKinds> listed{};
  for (const MeshFinding& finding : check.findings) {
    requirePlace(finding);
    FindingTotal& total = listed[static_cast<std::size_t>(finding.kind)];
    total.count += finding.count;
    ++total.places;
  }
  for (std::size_t k = 0; k < kFindingKinds; ++k) {
    const FindingTotal &has = listed[k], &said = check.totals[k];
    require(has.places == std::min<std::uint64_t>(said.places, MeshCheck::kMaxPlaces),
            "all places are listed for which there is room");
    require(has.count <= said.count && (has.places < said.places || has.count == said.count),
            "totals are the sums of what is listed");
  }
  for (const auto& [kind, count] : countedTotals(mesh))
    require(check.total(kind).count == count, "totals are what counting gives");
  require(check.total(FindingKind::SelfIntersections).count <= options.maxIntersections,
          "no more intersections are listed than asked for");
}

bool areSameFindings(const MeshCheck& a, const MeshCheck& b) {
  return std::ranges::equal(a.findings, b.findings, [](const MeshFinding& x, const MeshFinding& y) {
    return std::tie(x.kind, x.severity, x.count, x.length, x.point, x.edges, x.triangles) ==
           std::tie(y.kind, y.severity, y.count, y.length, y.point, y.edges, y.triangles);
  });
}

void checkChecks(const TriangleMesh& mesh, const MeshCheckOptions& options) {
  const bool isTolerance = std::isfinite(options.crackTolerance) && options.crackTolerance >= 0.0;
  try {
    const MeshCheck check = checkMesh(mesh, options);
    require(isTolerance, "tolerances that are negative or not finite are refused");
    requireCheck(check, mesh, options);
    require(areSameFindings(check, checkMesh(mesh, options)), "the same mesh gives the same findings");
  } catch (const UsageError&) {
    require(!isTolerance, "tolerances of 0 and more are taken");
  }
}

MeshRepair someRepair(ByteSource& bytes, double diagonal) {
  MeshRepair repair{static_cast<RepairKind>(bytes.below(kRepairKinds))};
  if (!hasSize(repair.kind)) return repair;
  // Mostly of the order of the mesh, where something happens.
  repair.size = bytes.flag() ? diagonal * static_cast<double>(bytes.byte()) / 128.0 : bytes.number();
  return repair;
}

bool isRepair(const MeshRepair& repair) {
  return !hasSize(repair.kind) || (repair.size >= kMinRepairSize && repair.size <= kMaxRepairSize);
}

bool fillsHoles(const MeshRepairs& repairs) {
  return std::ranges::find(repairs, RepairKind::FillHoles, &MeshRepair::kind) != repairs.end();
}

void requireOrigins(const RepairedMesh& repaired, const TriangleMesh& original, const MeshRepairs& repairs) {
  require(repaired.originOf.size() == repaired.mesh.triangles().size(), "each face has an origin");
  for (const std::uint32_t origin : repaired.originOf) {
    require(
        origin < original.triangles().size() || (origin == RepairedMesh::kNoOrigin && fillsHoles(repairs)),
        "origins are faces of the original, except of what fills a hole");
  }
  if (fillsHoles(repairs)) return;
  using Point = std::array<double, 3>;
  std::set<Point> points;
  for (const glm::dvec3& v : original.vertices())
    points.insert({v.x, v.y, v.z});
  for (const glm::dvec3& v : repaired.mesh.vertices())
    require(points.contains({v.x, v.y, v.z}), "no vertex moves, and none comes but to fill a hole");
}

void requireSteps(const RepairedMesh& repaired, const TriangleMesh& original, const MeshRepairs& repairs) {
  require(repaired.steps.size() == repairs.size(), "there is a step for each repair");
  std::uint64_t faces = original.triangles().size();
  for (std::size_t i = 0; i < repairs.size(); ++i) {
    require(repaired.steps[i].repair == repairs[i], "steps are in the order of the repairs");
    faces += repaired.steps[i].addedFaces;
    require(repaired.steps[i].removedFaces <= faces, "no more faces go than there are");
    faces -= repaired.steps[i].removedFaces;
  }
  require(repaired.mesh.triangles().size() == faces, "steps say how many faces came and went");
  require(
      repaired.mesh.sharesArraysOf(original) == std::ranges::all_of(repaired.steps, &RepairStep::isNothing),
      "a mesh is copied if something changed, and only then");
}

/// What one repair by itself leaves.
void requireDone(const RepairedMesh& repaired, const TriangleMesh& original) {
  const RepairStep& step = repaired.steps.back();
  const MeshTopology &before = original.topology(), &after = repaired.mesh.topology();
  if (step.repair.kind == RepairKind::Orient)
    require(after.inconsistentEdges == step.left, "edges that still disagree are counted");
  if (repaired.steps.size() > 1) return;
  if (step.repair.kind == RepairKind::FillHoles)
    require(after.openEdges <= before.openEdges, "what fills a hole is not open itself");
  if (step.repair.kind == RepairKind::DropShells)
    require(after.components + step.changed == before.components, "components that go are counted");
}

void requireRepaired(const RepairedMesh& repaired, const TriangleMesh& original, const MeshRepairs& repairs) {
  requireOrigins(repaired, original, repairs);
  requireSteps(repaired, original, repairs);
  if (!repairs.empty()) requireDone(repaired, original);
  const MeshChange change = changeBetween(original, repaired.mesh);
  require(std::isfinite(change.maxDistance) && change.maxDistance >= 0.0, "changes have a size");
  require(change.after.triangles == repaired.mesh.triangles().size(), "changes count faces");
}

void requireSame(const RepairedMesh& a, const RepairedMesh& b) {
  require(test::areSame(a.mesh, b.mesh) && a.originOf == b.originOf, "the same repairs give the same mesh");
  require(std::ranges::equal(a.steps, b.steps,
                             [](const RepairStep& x, const RepairStep& y) {
                               return std::tie(x.changed, x.addedFaces, x.removedFaces, x.left) ==
                                      std::tie(y.changed, y.addedFaces, y.removedFaces, y.left);
                             }),
          "the same repairs do the same");
}

/// The repaired mesh; none where nothing would be left, or a repair is impossible.
std::optional<RepairedMesh> repairedOrRefused(const TriangleMesh& mesh, const MeshRepairs& repairs) {
  const bool arePossible = std::ranges::all_of(repairs, isRepair);
  try {
    RepairedMesh repaired = repairMesh(mesh, repairs);
    require(arePossible, "sizes out of range are refused");
    return repaired;
  } catch (const UsageError&) {
    require(!arePossible, "sizes within range are taken");
  } catch (const Error& error) {
    require(arePossible && !error.problem().empty(), "an error says what is wrong");
  }
  return std::nullopt;
}

void run(ByteSource& bytes) {
  const std::optional<TriangleMesh> mesh = someMesh(bytes);
  if (!mesh) return;
  MeshCheckOptions options;
  if (bytes.flag()) options.crackTolerance = bytes.number();
  if (bytes.flag()) options.maxIntersections = bytes.below(8);
  MeshRepairs repairs;
  constexpr std::size_t kMaxRepairsTried = 5;
  for (std::size_t i = bytes.below(kMaxRepairsTried + 1); i > 0; --i)
    repairs.push_back(someRepair(bytes, mesh->bounds().diagonal()));
  checkChecks(*mesh, options);
  const std::optional<RepairedMesh> repaired = repairedOrRefused(*mesh, repairs);
  if (!repaired) return;
  requireRepaired(*repaired, *mesh, repairs);
  requireSame(*repaired, repairMesh(*mesh, repairs));
  // What repairs make is checked too: they go on from what others left.
  checkChecks(repaired->mesh, {});
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
