#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace nearfit::bench {

/// Counts of what was read from a document.
struct DocumentCounts {
  std::size_t shapes = 0;           ///< Geometries, each counted once.
  std::size_t instances = 0;        ///< Places that they are put at.
  std::size_t triangles = 0;        ///< Of all shapes.
  std::size_t placedTriangles = 0;  ///< Of all instances.

  bool operator==(const DocumentCounts&) const = default;
};

/// A document that Nearfit has read until it could be felt, in a process of its own.
struct ImportRun {
  double seconds = 0.0;      ///< From the file until the servo could start.
  double loadSeconds = 0.0;  ///< Thereof until all meshes were there.
  bool isFromCache = false;
  DocumentCounts counts;
  std::uint64_t ownPeakBytes = 0;     ///< Max resident memory of that process.
  std::uint64_t importPeakBytes = 0;  ///< The same of nearfit-import; 0 if it did not run.
  /// Max resident memory of that process until nearfit-import had ended; 0 if it did not run.
  std::uint64_t besideImportBytes = 0;
};

/// A document that OpenCASCADE alone has read and meshed, in a process of its own.
struct OccRun {
  std::string version;
  double readSeconds = 0.0, transferSeconds = 0.0, meshSeconds = 0.0;
  DocumentCounts counts;
  std::uint64_t peakBytes = 0;  ///< Max resident memory.

  double seconds() const { return readSeconds + transferSeconds + meshSeconds; }
};

/// A line of JSON, as one program tells it another; all numbers read back the same.
std::string textOf(const ImportRun& run);
std::string textOf(const OccRun& run);
/// Throw Error where the text is none of those.
ImportRun readImportRun(const std::string& text);
OccRun readOccRun(const std::string& text);

/// Max resident memory of this process so far [bytes]; 0 if the system does not tell.
std::uint64_t peakResidentBytes();
/// Max resident memory of any one child that has ended and was waited for [bytes]; 0 without children.
std::uint64_t peakChildBytes();

}  // namespace nearfit::bench
