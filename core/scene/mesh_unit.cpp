#include "core/scene/mesh_unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/math/aabb.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/scene/document_parts.h"
#include "core/scene/part_geometry.h"
#include "core/scene/pose_csv.h"

namespace nearfit {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 6> kMeshUnits{
    {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"um", 1e-6}, {"in", 0.0254}, {"ft", 0.3048}}};

/// Likely units of files that state none, the most common first [m]. Rarer ones would cause wrong guesses, and tenths of
/// a millimetre and centimetres are never nearer than millimetres by kRareUnit.
constexpr std::array kLikelyUnits{1e-3, 0.0254, 1.0, 1e-6};

}  // namespace

double parseMeshUnit(std::string_view text, const std::string& where) {
  for (const auto& [name, metres] : kMeshUnits) {
    if (text == name) return metres;
  }
  const std::optional<double> metres = csv::parseNumber(csv::trimmed(text));
  if (!metres) {
    throw UsageError(where, fmt::format("\"{}\" is not a unit", text),
                     "give m, cm, mm, um, in, ft, or a number of metres");
  }
  checkMetresPerUnit(*metres);
  return *metres;
}

double likelyMeshUnit(double size, double least, double most) {
  double best = kLikelyUnits.front(), bestDistance = 0.0;
  if (!std::isfinite(size) || size <= 0.0) return best;
  for (const double unit : kLikelyUnits) {
    const double ratio = std::max({least / (size * unit), size * unit / most, 1.0});
    const double distance = std::log(unit == kLikelyUnits.front() ? ratio : kRareUnit * ratio);
    if (unit == kLikelyUnits.front() || distance < bestDistance) {
      best = unit;
      bestDistance = distance;
    }
  }
  return best;
}

std::string meshUnitText(double metresPerUnit) {
  for (const auto& [name, metres] : kMeshUnits) {
    if (metresPerUnit == metres) return std::string(name);
  }
  return fmt::format("units of {} m", metresPerUnit);
}

std::optional<glm::dvec3> extentOfMeshFiles(std::span<const std::filesystem::path> files,
                                            const ProgressCallback& progress) {
  SharedProgress all(progress, static_cast<double>(std::max<std::size_t>(files.size(), 1)));
  std::vector<Aabb> boxes(files.size());
  parallelFor(files.size(), [&](std::size_t i) {
    // Within a file, progress only serves to cancel.
    const ProgressCallback isWanted = [&all](double) {
      all.add(0.0);
      return true;
    };
    try {
      // In the file's units: as if those were metres.
      boxes[i] = isDocumentFile(files[i]) ? boundsOfDocument(loadDocument(files[i], 1.0, {}, isWanted))
                                          : readMeshBounds(files[i], isWanted);
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception&) {
      // Loading the file says what is wrong with it.
    }
    all.add(1.0);
  });
  Aabb whole;
  for (const Aabb& box : boxes) {
    if (box.isEmpty()) continue;
    whole.add(box.lower);
    whole.add(box.upper);
  }
  if (whole.isEmpty()) return std::nullopt;
  return whole.upper - whole.lower;
}

}  // namespace nearfit
