#include "core/import/document_import.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <new>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/import/document_file.h"
#include "core/import/import_process.h"
#include "core/import/mesh_file_check.h"

namespace nearfit {
namespace {

/// Fraction of the progress when the importer is done; what is left is reading and checking its result.
constexpr double kImportedFraction = 0.95;

/// Time without progress that an import may take, besides that for its size: on a busy machine a face of a fine spline
/// surface takes seconds [s]. Opening, unpacking and scanning a file have no progress of their own, and take a second for
/// some 10 MB; nor has reading 3MF.
constexpr double kSilence = 20.0, kSilencePerByte = 1e-6;

/// Formats of text, which may be compressed by gzip.
constexpr std::array<std::string_view, 7> kTextFormats{"step", "stp", "iges", "igs", "brep", "gltf", "urdf"};

std::string lowerCase(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Lower case, without the dot.
std::string extensionOf(const std::filesystem::path& file) {
  const std::string extension = lowerCase(file.extension().string());
  return extension.empty() ? extension : extension.substr(1);
}

void requireTolerance(double value, double max, const char* name) {
  if (value >= 0.0 && value <= max) return;
  throw UsageError(name, "a tolerance of a tessellation is negative, too large or no number",
                   fmt::format("give one between 0, which stands for the default, and {:g}", max));
}

}  // namespace

bool isDocumentFile(const std::filesystem::path& file) {
  const std::string extension = extensionOf(file);
  if (extension == "gz") {
    const std::string inner = extensionOf(file.stem());
    return std::ranges::find(kTextFormats, inner) != kTextFormats.end();
  }
  return std::ranges::find(documentExtensions(), extension) != documentExtensions().end();
}

const std::vector<std::string>& documentExtensions() {
  static const std::vector<std::string> extensions{"step", "stp", "iges", "igs", "brep",
                                                   "gltf", "glb", "3mf",  "urdf"};
  return extensions;
}

std::string documentFormat(const std::filesystem::path& file) {
  const std::string extension = extensionOf(file);
  return extension == "gz" ? extensionOf(file.stem()) : extension;
}

CadDocument importDocument(const std::filesystem::path& file, const DocumentOptions& options,
                           const ProgressCallback& progress) {
  requireTolerance(options.tessellation.chord, kMaxDocumentLength, "chord");
  requireTolerance(options.tessellation.angle, std::numbers::pi, "angle");
  // Refused here, with the same words as a mesh, before a process is started.
  checkMeshFile(file);
  std::vector<std::string> arguments{"--chord", fmt::format("{}", options.tessellation.chord), "--angle",
                                     fmt::format("{}", options.tessellation.angle)};
  for (const std::string& key : options.onlyShapes)
    arguments.insert(arguments.end(), {"--only", key});
  const ImportLimits limits{kSilence + kSilencePerByte * static_cast<double>(InputFile(file).size())};
  try {
    const std::vector<std::byte> result = runImporter(importProgram(), file, arguments, limits,
                                                      stageCallback(progress, 0.0, kImportedFraction));
    CadDocument document = readDocument(result, file.string());
    if (progress && !progress(1.0)) throw Cancelled();
    return document;
  } catch (const std::bad_alloc&) {
    throw FileError(file.string(), "there is not enough memory for it",
                    "close other programs or choose a coarser tessellation");
  }
}

}  // namespace nearfit
