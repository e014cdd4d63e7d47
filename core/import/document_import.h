#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/import/cad_document.h"

namespace nearfit {

/// How to read a document.
struct DocumentOptions {
  Tessellation tessellation;
  /// Keys of the shapes wanted; empty: all. The document then holds these shapes, the nodes that place them and the
  /// groups around those.
  std::vector<std::string> onlyShapes;
};

/// True if the file is a CAD document by its extension, also with ".gz" behind that of a text format.
bool isDocumentFile(const std::filesystem::path& file);

/// File name extensions of documents: lower case, without the dot.
const std::vector<std::string>& documentExtensions();

/// Extension of a file's format: lower case, without the dot and without ".gz".
std::string documentFormat(const std::filesystem::path& file);

/// Reads a CAD document by the program nearfit-import, in a process of its own, so that a file that makes it crash, hang
/// or fill memory ends that process alone. Its result is checked as a file is that nobody trusts. Blocking;
/// thread-safe. The process ends at once if `progress` returns false, and with the thread that waits for it.
/// Throws FileError, UsageError (a tolerance is negative or not finite), Cancelled.
CadDocument importDocument(const std::filesystem::path& file, const DocumentOptions& options,
                           const ProgressCallback& progress = {});

}  // namespace nearfit
