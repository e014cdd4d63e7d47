#pragma once

#include <span>
#include <string>

#include "core/import/cad_document.h"
#include "core/scene/part_geometry.h"

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Help text on the values of --unit where files are read that may store none.
inline constexpr const char* kFileUnitHelp =
    "Unit of the coordinates of mesh and BREP files, which store none: m, cm, mm, um, in, ft, or a number of "
    "metres";

/// Options --chord and --angle.
struct TessellationOptions {
  double chord = 0.0;         ///< [m]; 0: chosen from the shape's size.
  double angleDegrees = 0.0;  ///< 0: the default.
};
void addTessellationOptions(CLI::App& command, TessellationOptions& options);
/// Throws UsageError, naming the option, if a tolerance is out of range.
Tessellation tessellationOf(const TessellationOptions& options);

/// The file, and the key of a shape that a "#" behind its name may give. A file that exists is taken whole.
struct FileArgument {
  std::string file, shape;
};
FileArgument fileArgumentOf(const std::string& text);

/// Loads the mesh file, or the shape of a document. Throws what loadPartGeometry() throws.
PartGeometryPtr loadArgument(const FileArgument& argument, double metresPerUnit,
                             const Tessellation& tessellation);

/// Metres per unit for --unit. If it is empty, 1 for files that all store their unit; throws UsageError, naming --unit,
/// if one does not.
double unitOfFiles(const std::string& unit, std::span<const std::string> files);

}  // namespace nearfit::cli
