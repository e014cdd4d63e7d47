#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/import/cad_document.h"
#include "core/import/document_file.h"

/// Request to nearfit-export, and its result.
namespace nearfit {

/// Schemas of STEP files; both hold assemblies, solids, names and colours.
enum class StepSchema : std::uint8_t { Ap214, Ap242 };

/// Where the exact surfaces of a shape are.
struct StepSource {
  std::filesystem::path file;  ///< STEP, IGES or BREP.
  std::string sha256;          ///< SHA-256 of the file; if that has changed, the shape is of triangles.
  std::string key;             ///< CadShape::key in that file.
  double metresPerUnit = 1.0;  ///< Of the shape's coordinates as its importer gives them.
};

/// An assembly to be written as a STEP file.
struct StepRequest {
  StepSchema schema = StepSchema::Ap214;
  std::string name;  ///< Name of the whole assembly.
  /// In metres. Keys of shapes are the names of products. Shapes have their triangles also where they have a source.
  CadDocument document;
  std::vector<std::optional<StepSource>> sources;  ///< By shape; std::nullopt: of triangles.
};

/// Limits of texts and paths in a request [bytes].
constexpr std::size_t kMaxStepNameBytes = 1000, kMaxStepPathBytes = 4096;

/// Writes a request as bytes. Throws Error if it exceeds a limit (checkDocument()), and what `sink` throws.
void writeStepRequest(const StepRequest& request, const DocumentSink& sink);
/// Reads it. Nothing in it is trusted, as for readDocument(). Throws Error.
StepRequest readStepRequest(std::span<const std::byte> bytes);

/// A STEP file, and what a user should know about it.
struct StepResult {
  std::vector<std::string> notes;   ///< Sentences, such as which files have changed.
  std::span<const std::byte> file;  ///< Within the bytes that were read.
};

/// Bytes that come before those of the STEP file in a result.
void writeStepNotes(const std::vector<std::string>& notes, const DocumentSink& sink);
/// Throws Error if the bytes are no result.
StepResult readStepResult(std::span<const std::byte> bytes);

}  // namespace nearfit
