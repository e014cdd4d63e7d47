#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "core/base/progress.h"

namespace nearfit {

/// Returns metres per unit of a mesh file, for "m", "cm", "mm", "um", "in", "ft" or a number of metres.
/// Throws UsageError, also if the number is out of range (checkMetresPerUnit()).
/// @param where  Option or field that holds the text, for the error.
double parseMeshUnit(std::string_view text, const std::string& where);

/// Returns a unit in words that follow "in": "mm", "in", "units of 0.5 m".
std::string meshUnitText(double metresPerUnit);

/// Returns the extent of mesh files, and of CAD documents without units, along each axis, in their units: of the box around all of them, each at
/// its own coordinates. Leaves out files that cannot be read; std::nullopt if none can. Reads files in
/// parallel. Blocking: not for the GUI thread. Throws Cancelled.
std::optional<glm::dvec3> extentOfMeshFiles(std::span<const std::filesystem::path> files,
                                            const ProgressCallback& progress = {});

}  // namespace nearfit
