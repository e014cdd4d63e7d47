#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/import/step_request.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Size of a STEP file that was written, and notes about it.
struct StepExport {
  std::uint64_t bytes = 0;
  std::vector<std::string>
      notes;  ///< Sentences, such as which parts are facets because their file has changed.
};

/// Writes parts as a STEP assembly in millimetres by the program nearfit-export, in a process of its own, atomically.
///
/// - Groups are assemblies within one of the file's name, parts are occurrences of their name at their worldFromPart. A
///   geometry is a product, once for each colour that its parts have: STEP readers differ in what they make of colours of
///   occurrences. Faces keep colours of their own. Opacity is lost.
/// - A part of a STEP, IGES or BREP file has that file's exact surfaces, if the file still has the same bytes and the mesh
///   was not repaired; others, and all from meshes, are facets: planar faces, one for each flat.
/// - Groups that are nested deeper than kMaxDocumentDepth are left out; their parts are in the group around them.
///
/// @param scene  Has the moving part where it is now (placedScene()).
/// @param parts  Of the scene; see chosenParts().
/// Throws FileError; UsageError (no parts); Cancelled, which keeps the old file. Blocking.
StepExport exportStep(const Scene& scene, std::span<const Scene::PartPtr> parts, StepSchema schema,
                      const std::filesystem::path& file, const ProgressCallback& progress = {});

/// Makes the request to nearfit-export, for exportStep() and tests.
StepRequest stepRequest(const Scene& scene, std::span<const Scene::PartPtr> parts, StepSchema schema,
                        const std::string& name);

}  // namespace nearfit
