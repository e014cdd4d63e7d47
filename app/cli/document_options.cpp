#include "app/cli/document_options.h"

#include <exception>
#include <filesystem>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "core/base/error.h"
#include "core/scene/document_load.h"

namespace nearfit::cli {

void addTessellationOptions(CLI::App& command, TessellationOptions& options) {
  command
      .add_option("--chord", options.chord,
                  "Max distance between the exact surfaces of a CAD document and their triangles [m]; "
                  "default: chosen "
                  "from each shape's size")
      ->type_name("METRES");
  command
      .add_option(
          "--angle", options.angleDegrees,
          "Max angle between neighbouring facets of such a surface [degrees]; default: the importer's")
      ->type_name("DEGREES");
}

Tessellation tessellationOf(const TessellationOptions& options) {
  return tessellationOfOptions(options.chord, options.angleDegrees);
}

FileArgument fileArgumentOf(const std::string& text) {
  std::error_code failure;
  const std::size_t mark = text.rfind('#');
  if (mark == std::string::npos || mark == 0 || std::filesystem::exists(text, failure)) return {text, {}};
  const std::string file = text.substr(0, mark);
  if (!isDocumentFile(file)) return {text, {}};
  return {file, text.substr(mark + 1)};
}

PartGeometryPtr loadArgument(const FileArgument& argument, double metresPerUnit,
                             const Tessellation& tessellation) {
  const MeshSource source{
      argument.file, unitToOpen(argument.file, metresPerUnit), {}, argument.shape, tessellation};
  const LoadedPart loaded = loadPartGeometries({&source, 1}).front();
  if (loaded.problem) std::rethrow_exception(loaded.problem);
  return loaded.geometry;
}

double unitOfFiles(const std::string& unit, std::span<const std::string> files) {
  if (!unit.empty()) return parseUnit(unit);
  for (const std::string& file : files) {
    if (!storesUnit(file)) {
      throw UsageError("--unit", fmt::format("{} stores no unit of length", file),
                       "give the one that its numbers are in, such as --unit mm");
    }
  }
  return 1.0;
}

}  // namespace nearfit::cli
