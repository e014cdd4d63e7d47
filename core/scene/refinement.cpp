#include "core/scene/refinement.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/document_load.h"

namespace nearfit {
namespace {

/// Tells shapes of a scene's documents apart.
using ShapeName = std::tuple<std::filesystem::path, std::string, std::string, double>;

ShapeName shapeNameOf(const PartGeometry& geometry) {
  return {geometry.file, geometry.sha256, geometry.shapeKey, geometry.metresPerUnit};
}

}  // namespace

bool isRefinable(const Part& part) noexcept {
  return part.geometry != nullptr && part.geometry->isExact && !part.geometry->shapeKey.empty();
}

Tessellation scaledTessellation(const Tessellation& tessellation, double factor) {
  if (tessellation.chord == 0.0) return tessellation;
  return {std::clamp(factor * tessellation.chord, kMinChord, kMaxChord), tessellation.angle};
}

Refinement refinementOf(const Scene& scene, std::span<const PartId> parts, const Tessellation& tessellation) {
  checkTessellation(tessellation);
  std::set<ShapeName> chosen;
  for (const PartId id : parts) {
    const Part& part = scene.get(id);
    if (!isRefinable(part)) {
      throw UsageError(fmt::format("part \"{}\"", part.name), "its file holds triangles, no exact surfaces",
                       "choose a part of a STEP, IGES or BREP file");
    }
    chosen.insert(shapeNameOf(*part.geometry));
  }
  Refinement refinement;
  std::map<std::pair<ShapeName, std::string>, std::size_t> known;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!isRefinable(*part) || !chosen.contains(shapeNameOf(*part->geometry))) continue;
    const PartGeometry& geometry = *part->geometry;
    const auto [source, isNew] =
        known.try_emplace({shapeNameOf(geometry), textOf(geometry.repairs)}, refinement.sources.size());
    if (isNew) {
      refinement.sources.push_back({geometry.file, geometry.metresPerUnit, geometry.sha256, geometry.shapeKey,
                                    tessellation, geometry.repairs});
    }
    refinement.members.push_back({part->id, source->second});
  }
  return refinement;
}

}  // namespace nearfit
