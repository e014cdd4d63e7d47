#include "core/mesh/check/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/mesh/check/border_loops.h"
#include "core/mesh/check/crossing_triangles.h"
#include "core/mesh/check/face_faults.h"
#include "core/mesh/check/finding_places.h"
#include "core/mesh/check/hairline_cracks.h"
#include "core/mesh/check/mesh_shells.h"

namespace nearfit {
namespace {

/// Progress after each step; roughly the shares of time, most of which goes into the search for intersections.
constexpr double kFacesDone = 0.05, kEdgesDone = 0.1, kVerticesDone = 0.2, kShellsDone = 0.3,
                 kCracksDone = 0.4;

void requireTolerance(double tolerance) {
  if (std::isfinite(tolerance) && tolerance >= 0.0) return;
  throw UsageError("crack tolerance", fmt::format("{} m is out of range", tolerance),
                   "give a length of 0 or more");
}

/// The steps of checkMesh().
class Checker {
 public:
  Checker(const TriangleMesh& mesh, const MeshCheckOptions& options, const ProgressCallback& progress)
      : mesh_(mesh), options_(options), progress_(progress) {
    check_.crackTolerance =
        options.crackTolerance > 0.0 ? options.crackTolerance : kCrackShare * mesh.bounds().diagonal();
  }

  MeshCheck check() {
    checkFaces();
    report(kFacesDone);
    checkEdges();
    report(kEdgesDone);
    checkVertices();
    report(kVerticesDone);
    checkShells();
    report(kShellsDone);
    checkCracks();
    checkIntersections();
    std::ranges::stable_sort(check_.findings, {}, &MeshFinding::kind);
    return std::move(check_);
  }

 private:
  void report(double fraction) const { stageOf(progress_, 0.0, 1.0)(fraction); }
  FindingPlaces::Defect defectOf(std::uint32_t triangle, FindingSeverity severity) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {{t[0], t[1], t[2]}, {}, {triangle}, severity};
  }

  void checkFaces() {
    FindingPlaces degenerate(mesh_), duplicate(mesh_);
    for (const std::uint32_t face : facesWithoutArea(mesh_))
      degenerate.add(defectOf(face, FindingSeverity::Note));
    degenerate.finish(check_, FindingKind::DegenerateFaces);
    for (const FaceCopies& copies : copiesOfFaces(mesh_)) {
      // Copies of one sense are felt as one face; a face of two sides has no inside.
      const FindingSeverity severity = copies.areOpposite ? FindingSeverity::Warning : FindingSeverity::Note;
      FindingPlaces::Defect defect = defectOf(copies.faces.front(), severity);
      defect.count = copies.faces.size() - 1;
      duplicate.add(defect);
    }
    duplicate.finish(check_, FindingKind::DuplicateFaces);
  }

  void checkEdges() {
    checkLoops();
    FindingPlaces nonManifold(mesh_), inconsistent(mesh_);
    for (std::uint32_t e = 0; e < mesh_.edges().size(); ++e) {
      const std::size_t faces = mesh_.facesOfEdge(e).size();
      if (faces > 2) nonManifold.addEdge(e, FindingSeverity::Warning);
      if (faces == 2 && !mesh_.isEdgeConsistent(e)) inconsistent.addEdge(e, FindingSeverity::Serious);
    }
    nonManifold.finish(check_, FindingKind::NonManifoldEdges);
    inconsistent.finish(check_, FindingKind::InconsistentEdges);
  }

  /// Each loop is a place of its own, even where two touch.
  void checkLoops() {
    std::vector<BorderLoop> loops = borderLoopsOf(mesh_);
    FindingTotal& total = check_.totals[static_cast<std::size_t>(FindingKind::OpenEdges)];
    total.places = loops.size();
    total.count = mesh_.topology().openEdges;
    std::ranges::stable_sort(loops, std::greater<>(), &BorderLoop::edgeCount);
    for (const BorderLoop& loop : std::span(loops).first(std::min(loops.size(), MeshCheck::kMaxPlaces)))
      check_.findings.push_back(findingOf(loop));
  }

  MeshFinding findingOf(const BorderLoop& loop) const {
    MeshFinding finding;
    finding.kind = FindingKind::OpenEdges;
    finding.severity = FindingSeverity::Warning;
    finding.count = loop.edgeCount();
    finding.length = loop.length;
    for (const std::uint32_t v : loop.vertices)
      finding.box.add(mesh_.vertices()[v]);
    for (std::size_t i = 0; i < std::min(loop.edgeCount(), MeshFinding::kMaxShown); ++i) {
      const std::uint32_t from = loop.vertices[i], to = loop.vertices[(i + 1) % loop.vertices.size()];
      finding.edges.push_back({mesh_.vertices()[from], mesh_.vertices()[to]});
    }
    finding.point = 0.5 * (finding.edges.front()[0] + finding.edges.front()[1]);
    return finding;
  }

  /// Finds vertices whose triangles are not all connected by edges at the vertex.
  void checkVertices() {
    const std::size_t corners = 3 * mesh_.triangles().size();
    std::vector<std::uint32_t> parent(corners);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto rootOf = [&parent](std::uint32_t i) {
      while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
      }
      return i;
    };
    const auto cornerAt = [&](std::uint32_t triangle, std::uint32_t vertex) {
      const Triangle& t = mesh_.triangles()[triangle];
      return 3 * triangle + static_cast<std::uint32_t>(std::ranges::find(t, vertex) - t.begin());
    };
    for (std::uint32_t e = 0; e < mesh_.edges().size(); ++e) {
      const auto faces = mesh_.facesOfEdge(e);
      for (std::size_t i = 1; i < faces.size(); ++i) {
        for (const std::uint32_t v : {mesh_.edges()[e].v0, mesh_.edges()[e].v1})
          parent[rootOf(cornerAt(faces[i], v))] = rootOf(cornerAt(faces[0], v));
      }
    }
    std::vector<std::uint32_t> sheets(mesh_.vertices().size(), 0);
    for (std::uint32_t corner = 0; corner < corners; ++corner)
      sheets[mesh_.triangles()[corner / 3][corner % 3]] += rootOf(corner) == corner ? 1 : 0;
    FindingPlaces places(mesh_);
    for (std::uint32_t v = 0; v < sheets.size(); ++v) {
      if (sheets[v] < 2) continue;
      FindingPlaces::Defect defect{{v}, {}, {}, FindingSeverity::Note};
      // A point alone would be hard to see.
      for (const std::uint32_t e : mesh_.edgesOfVertex(v)) {
        defect.edges.push_back(e);
        if (defect.edges.size() == kEdgesShownAtVertex) break;
      }
      places.add(defect);
    }
    places.finish(check_, FindingKind::NonManifoldVertices);
  }

  void checkShells() {
    const MeshShells shells = shellsOf(mesh_);
    FindingTotal& total = check_.totals[static_cast<std::size_t>(FindingKind::InvertedShells)];
    total.isCut = !shells.isDepthExact;
    std::vector<std::uint32_t> inverted;
    std::vector<std::uint32_t> findingOf(shells.shells.size(), kNoFinding);
    for (std::uint32_t i = 0; i < shells.shells.size(); ++i) {
      if (!shells.shells[i].isInverted()) continue;
      inverted.push_back(i);
      ++total.places;
      total.count += shells.shells[i].triangles;
    }
    const auto size = [&](std::uint32_t i) { return shells.shells[i].triangles; };
    std::ranges::stable_sort(inverted, std::greater<>(), size);
    inverted.resize(std::min(inverted.size(), MeshCheck::kMaxPlaces));
    for (const std::uint32_t i : inverted) {
      const MeshShell& shell = shells.shells[i];
      MeshFinding finding;
      finding.kind = FindingKind::InvertedShells;
      // A solid within another's material is not reached from outside.
      finding.severity = shell.volume < 0.0 ? FindingSeverity::Serious : FindingSeverity::Note;
      finding.count = shell.triangles;
      finding.box = shell.box;
      findingOf[i] = static_cast<std::uint32_t>(check_.findings.size());
      check_.findings.push_back(std::move(finding));
    }
    if (inverted.empty()) return;
    for (std::uint32_t i = 0; i < shells.shellOf.size(); ++i) {
      const std::uint32_t at = findingOf[shells.shellOf[i]];
      if (at == kNoFinding) continue;
      MeshFinding& finding = check_.findings[at];
      const TriangleCorners corners = cornersOfTriangle(i);
      if (finding.triangles.empty()) finding.point = (corners[0] + corners[1] + corners[2]) / 3.0;
      if (finding.triangles.size() < MeshFinding::kMaxShown) finding.triangles.push_back(corners);
    }
  }

  void checkCracks() {
    const ProgressCallback stage = stageCallback(progress_, kShellsDone, kCracksDone);
    const HairlineCracks cracks = findHairlineCracks(mesh_, check_.crackTolerance, stage);
    FindingPlaces places(mesh_);
    for (std::size_t begin = 0; begin < cracks.pairs.size();) {
      const std::uint32_t edge = cracks.pairs[begin].edge;
      const MeshEdge& e = mesh_.edges()[edge];
      FindingPlaces::Defect defect{{e.v0, e.v1}, {edge}, {}, FindingSeverity::Warning};
      for (; begin < cracks.pairs.size() && cracks.pairs[begin].edge == edge; ++begin) {
        defect.vertices.push_back(cracks.pairs[begin].vertex);
        defect.length = std::max(defect.length, cracks.pairs[begin].distance);
      }
      places.add(defect);
    }
    places.finish(check_, FindingKind::HairlineCracks, !cracks.isComplete);
  }

  void checkIntersections() {
    const ProgressCallback stage = stageCallback(progress_, kCracksDone, 1.0);
    const CrossingTriangles crossings = findCrossingTriangles(mesh_, options_.maxIntersections, stage);
    FindingPlaces places(mesh_);
    const std::vector<std::uint32_t> shellOf =
        crossings.pairs.empty() ? std::vector<std::uint32_t>() : shellsOf(mesh_).shellOf;
    for (const auto& [first, second] : crossings.pairs) {
      // Solids that cross each other are felt as their union.
      const FindingSeverity severity =
          shellOf[first] == shellOf[second] ? FindingSeverity::Warning : FindingSeverity::Note;
      FindingPlaces::Defect defect = defectOf(first, severity);
      const Triangle& other = mesh_.triangles()[second];
      defect.vertices.insert(defect.vertices.end(), other.begin(), other.end());
      defect.triangles.push_back(second);
      places.add(defect);
    }
    places.finish(check_, FindingKind::SelfIntersections, !crossings.isComplete);
  }

  TriangleCorners cornersOfTriangle(std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {mesh_.vertices()[t[0]], mesh_.vertices()[t[1]], mesh_.vertices()[t[2]]};
  }

  static constexpr std::size_t kEdgesShownAtVertex = 12;
  static constexpr std::uint32_t kNoFinding = 0xFFFFFFFFU;

  const TriangleMesh& mesh_;
  const MeshCheckOptions& options_;
  const ProgressCallback& progress_;
  MeshCheck check_;
};

}  // namespace

std::optional<FindingSeverity> MeshCheck::worst() const noexcept {
  std::optional<FindingSeverity> worst;
  for (const MeshFinding& finding : findings) {
    if (!finding.isMended) worst = std::max(worst.value_or(finding.severity), finding.severity);
  }
  return worst;
}

std::uint64_t MeshCheck::places() const noexcept {
  std::uint64_t sum = 0;
  for (const FindingTotal& each : totals)
    sum += each.places;
  const auto mended = std::ranges::count_if(findings, &MeshFinding::isMended);
  return sum - static_cast<std::uint64_t>(mended);
}

MeshCheck checkMesh(const TriangleMesh& mesh, const MeshCheckOptions& options,
                    const ProgressCallback& progress) {
  requireTolerance(options.crackTolerance);
  MeshCheck check = Checker(mesh, options, progress).check();
  stageOf(progress, 0.0, 1.0)(1.0);
  return check;
}

void addMended(MeshCheck& check, FindingKind kind, std::uint64_t count, std::vector<TriangleCorners> places) {
  if (count == 0) return;
  MeshFinding finding;
  finding.kind = kind;
  finding.isMended = true;
  finding.count = count;
  finding.hasPlace = !places.empty();
  if (places.size() > MeshFinding::kMaxShown) places.resize(MeshFinding::kMaxShown);
  for (const TriangleCorners& corners : places) {
    for (const glm::dvec3& p : corners)
      finding.box.add(p);
  }
  if (finding.hasPlace) finding.point = (places[0][0] + places[0][1] + places[0][2]) / 3.0;
  finding.triangles = std::move(places);
  FindingTotal& total = check.totals[static_cast<std::size_t>(kind)];
  ++total.places;
  total.count += count;
  check.findings.push_back(std::move(finding));
  std::ranges::stable_sort(check.findings, {}, &MeshFinding::kind);
}

std::string_view wordOf(FindingKind kind) noexcept {
  constexpr std::array<std::string_view, kFindingKinds> kWords{
      "openEdges",      "hairlineCracks",    "nonManifoldEdges", "nonManifoldVertices", "selfIntersections",
      "invertedShells", "inconsistentEdges", "degenerateFaces",  "duplicateFaces"};
  return kWords[static_cast<std::size_t>(kind)];
}

std::string_view wordOf(FindingSeverity severity) noexcept {
  switch (severity) {
    case FindingSeverity::Note:
      return "note";
    case FindingSeverity::Warning:
      return "warning";
    case FindingSeverity::Serious:
      break;
  }
  return "serious";
}

}  // namespace nearfit
