#include "core/mesh/check/mesh_repair.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/mesh/check/repair_steps.h"

namespace nearfit {
namespace {

constexpr std::array<std::string_view, kRepairKinds> kRepairWords{"weld",   "stitch",    "clean",
                                                                  "orient", "fillHoles", "dropShells"};

RepairStep made(MeshInRepair& mesh, const MeshRepair& repair, const ProgressCallback& progress) {
  switch (repair.kind) {
    case RepairKind::Weld:
      return weldVertices(mesh, repair.size);
    case RepairKind::Stitch:
      return stitchBorders(mesh, repair.size);
    case RepairKind::Clean:
      return cleanFaces(mesh);
    case RepairKind::Orient:
      return orientFaces(mesh);
    case RepairKind::FillHoles:
      return fillHoles(mesh, repair.size, progress);
    case RepairKind::DropShells:
      break;
  }
  return dropShells(mesh, repair.size);
}

void dropUnusedVertices(MeshInRepair& mesh) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> index(mesh.vertices.size(), kUnused);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t)
      index[v] = 0;
  }
  std::uint32_t used = 0;
  for (std::uint32_t v = 0; v < index.size(); ++v) {
    if (index[v] == kUnused) continue;
    index[v] = used;
    mesh.vertices[used++] = mesh.vertices[v];
  }
  mesh.vertices.resize(used);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t)
      v = index[v];
  }
}

}  // namespace

MeshRepairs repairsOf(const RepairChoice& choice) {
  MeshRepairs repairs;
  const auto add = [&repairs](RepairKind kind, const std::optional<double>& size) {
    if (size) repairs.push_back({kind, *size});
  };
  add(RepairKind::Weld, choice.weld);
  // A doubled face hides that its border is open.
  if (choice.clean) repairs.push_back({RepairKind::Clean});
  add(RepairKind::Stitch, choice.stitch);
  add(RepairKind::DropShells, choice.drop);
  if (choice.orient) repairs.push_back({RepairKind::Orient});
  add(RepairKind::FillHoles, choice.fill);
  // Only what is closed has an outside.
  if (choice.orient && choice.fill) repairs.push_back({RepairKind::Orient});
  return repairs;
}

bool hasSize(RepairKind kind) noexcept {
  return kind != RepairKind::Clean && kind != RepairKind::Orient;
}

void checkRepairs(std::span<const MeshRepair> repairs) {
  if (repairs.size() > kMaxRepairs)
    throw UsageError("repairs", fmt::format("there are more than {}", kMaxRepairs),
                     "export the repaired mesh, and go on with that");
  for (const MeshRepair& repair : repairs) {
    if (!hasSize(repair.kind) || (repair.size >= kMinRepairSize && repair.size <= kMaxRepairSize)) continue;
    throw UsageError(std::string(wordOf(repair.kind)), fmt::format("{} m is out of range", repair.size),
                     fmt::format("give a length from {} to {} m", kMinRepairSize, kMaxRepairSize));
  }
}

MeshRepairs scaledRepairs(MeshRepairs repairs, double factor) {
  for (MeshRepair& repair : repairs) {
    if (hasSize(repair.kind)) repair.size = std::clamp(repair.size * factor, kMinRepairSize, kMaxRepairSize);
  }
  return repairs;
}

std::string textOf(std::span<const MeshRepair> repairs) {
  std::string text;
  for (const MeshRepair& repair : repairs) {
    const std::uint64_t bits = hasSize(repair.kind) ? std::bit_cast<std::uint64_t>(repair.size) : 0;
    fmt::format_to(std::back_inserter(text), "{} {:016x};", wordOf(repair.kind), bits);
  }
  return text;
}

std::string_view wordOf(RepairKind kind) noexcept {
  return kRepairWords[static_cast<std::size_t>(kind)];
}

std::optional<RepairKind> repairNamed(std::string_view word) noexcept {
  const auto found = std::ranges::find(kRepairWords, word);
  if (found == kRepairWords.end()) return std::nullopt;
  return static_cast<RepairKind>(found - kRepairWords.begin());
}

RepairedMesh repairMesh(const TriangleMesh& mesh, std::span<const MeshRepair> repairs,
                        const ProgressCallback& progress) {
  checkRepairs(repairs);
  MeshInRepair work(mesh);
  RepairedMesh result;
  const auto count = static_cast<double>(repairs.size());
  for (std::size_t i = 0; i < repairs.size(); ++i) {
    const double from = static_cast<double>(i) / count, to = static_cast<double>(i + 1) / count;
    stageOf(progress, 0.0, 1.0)(from);
    const ProgressCallback stage = stageCallback(progress, from, to);
    RepairStep step = made(work, repairs[i], stage);
    step.repair = repairs[i];
    result.steps.push_back(step);
    if (work.triangles.empty()) {
      throw Error("", fmt::format("the repair \"{}\" leaves no face", wordOf(repairs[i].kind)),
                  "choose a smaller size, or leave it out");
    }
  }
  if (std::ranges::all_of(result.steps, &RepairStep::isNothing)) {
    result.mesh = mesh;
  } else {
    dropUnusedVertices(work);
    result.mesh = TriangleMesh(std::move(work.vertices), std::move(work.triangles));
  }
  result.originOf = std::move(work.originOf);
  stageOf(progress, 0.0, 1.0)(1.0);
  return result;
}

}  // namespace nearfit
