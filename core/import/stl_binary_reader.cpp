// Own parser: the layout is fixed, and OpenMesh 9 does not notice the end of a file that is cut off, orders vertices by
// comparisons that NaN breaks, and drops the facets that it takes for degenerate without a word.
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/import/mesh_readers.h"

namespace nearfit {
namespace {

/// Size of the facet's normal, which precedes its corners. Files fill it badly or not at all.
constexpr std::size_t kNormalBytes = 12;

}  // namespace

std::uint32_t stlFacetCount(std::span<const char> bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kStlHeaderBytes - sizeof(count), sizeof(count));
  return count;
}

ReaderResult readStlBinary(const ReaderInput& input) {
  if (input.bytes.size() < kStlHeaderBytes) {
    throw FileError(
        input.name,
        fmt::format("it has {} bytes, fewer than the header of a binary STL file", input.bytes.size()),
        "it is cut off or not an STL file: export or copy it again");
  }
  const std::uint32_t facets = stlFacetCount(input.bytes);
  const std::uint64_t expected = kStlHeaderBytes + std::uint64_t{facets} * kStlFacetBytes;
  if (input.bytes.size() < expected) {
    throw FileError(
        fmt::format("{}: byte {}", input.name, input.bytes.size()),
        fmt::format("the file ends here, but its header declares {} triangles, which take {} bytes", facets,
                    expected),
        "it is cut off or not an STL file: export or copy it again");
  }
  ReaderResult result;
  PolygonSoup& soup = result.soup;
  soup.vertices.reserve(3 * std::size_t{facets});
  soup.corners.reserve(3 * std::size_t{facets});
  for (std::uint32_t i = 0; i < facets; ++i) {
    constexpr std::uint32_t kReportFacets = 1U << 14U;
    if (i % kReportFacets == 0) input.report(static_cast<double>(i) / facets);
    std::array<float, 9> corners;
    std::memcpy(corners.data(), input.bytes.data() + kStlHeaderBytes + i * kStlFacetBytes + kNormalBytes,
                sizeof(corners));
    for (std::size_t c = 0; c < corners.size(); c += 3) {
      soup.corners.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
      soup.vertices.emplace_back(corners[c], corners[c + 1], corners[c + 2]);
    }
    soup.closePolygon();
  }
  if (input.bytes.size() > expected) {
    result.warnings.push_back(fmt::format("{} bytes after the last of {} triangles were ignored.",
                                          input.bytes.size() - expected, facets));
  }
  return result;
}

}  // namespace nearfit
