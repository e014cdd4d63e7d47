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

/// Guesses metres per unit of mesh files that do not say it: of millimetre, inch, metre and micrometre the one that
/// gives them a size nearest to a range, by ratio. Millimetres are by far the most common: another unit must be nearer
/// by kRareUnit.
/// @param size         Diagonal of their box, in their units; finite, > 0. Else returns a millimetre.
/// @param least, most  Sizes to compare with [m]; 0 < least <= most.
double likelyMeshUnit(double size, double least, double most);
/// Factor by which a unit other than millimetres must bring a size nearer to be guessed. Compared with a hand, numbers up
/// to 1.2 are then taken for metres, up to 12 for inches, up to 19,000 for millimetres, and larger ones for micrometres;
/// without it, a part of 53 mm would be taken for one of inches.
constexpr double kRareUnit = 10.0;

/// Returns a unit in words that follow "in": "mm", "in", "units of 0.5 m".
std::string meshUnitText(double metresPerUnit);

/// Returns the extent of mesh files, and of CAD documents without units, along each axis, in their units: of the box around all of them, each at
/// its own coordinates. Leaves out files that cannot be read; std::nullopt if none can. Reads files in
/// parallel. Blocking: not for the GUI thread. Throws Cancelled.
std::optional<glm::dvec3> extentOfMeshFiles(std::span<const std::filesystem::path> files,
                                            const ProgressCallback& progress = {});

}  // namespace nearfit
