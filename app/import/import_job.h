#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/import/cad_document.h"

namespace nearfit::importer {

/// Arguments of the importer.
struct ImportOptions {
  std::filesystem::path file;
  Tessellation tessellation;
  std::vector<std::string> onlyShapes;  ///< Keys; empty: all.
  int result = -1;                      ///< Descriptor to write the result to.
  int messages = -1;                    ///< Descriptor for messages; -1: none are written.
  bool isVersionAsked = false;
  bool triesSandbox = false;  ///< Only tells what the sandbox refuses.
  bool showsTimes = false;    ///< Writes to stderr what each stage took.
};

/// Reads the command line. Throws UsageError.
ImportOptions parseImportOptions(int argc, char** argv);

/// Formats of documents.
enum class DocumentFormat { Step, Iges, Brep, Gltf, ThreeMf, Urdf };

struct ExactShape;

/// A file to read, and what readers share.
struct ImportJob {
  std::filesystem::path file;  ///< As the user named it: for messages, and to find files beside it.
  DocumentFormat format = DocumentFormat::Step;
  std::string stem;  ///< Name of the file without folder and extensions; stands for names that are missing.
  std::vector<char> bytes;  ///< Of the file, unpacked.
  bool wasPacked = false;   ///< The file on disk is compressed: readers that take its path cannot read it.
  std::string sha256;       ///< Of the file as it is on disk.
  Tessellation tessellation;
  std::vector<std::string> onlyShapes;
  /// If it is set, it takes the exact shapes of a STEP, IGES or BREP file that are wanted (xcaf_document.h), nothing is
  /// meshed, and the document that the reader returns is empty.
  std::function<void(const ExactShape& shape)> takeExact;
  /// Takes the fraction done, and a name of what goes on, for times.
  std::function<void(double fraction)> progress;
  std::function<void(const char* stage)> endStage;
  /// If it is set, takes how many solids of a STEP file were seen while it was transferred, and how many of them were
  /// meshed by then.
  std::function<void(std::size_t solids, std::size_t meshed)> tellEarly = {};

  bool wants(const std::string& key) const;
};

/// Reads and unpacks the file, and tells its format by extension and content. Throws FileError.
ImportJob openJob(const ImportOptions& options);

/// Folders and files that a format may read besides the file itself, such as those of buffers and meshes.
std::vector<std::filesystem::path> readablePaths(const ImportJob& job);

/// Readers. Each throws Error, or what its library throws.
CadDocument readStep(const ImportJob& job);
CadDocument readIges(const ImportJob& job);
CadDocument readBrep(const ImportJob& job);
CadDocument readGltf(const ImportJob& job);
CadDocument readThreeMf(const ImportJob& job);
CadDocument readUrdf(const ImportJob& job);

}  // namespace nearfit::importer
