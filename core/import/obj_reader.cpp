// Own parser, since the available libraries misread this format (tried on malicious and unusual files).
// OpenMesh 9 keeps only single precision, drops vertex lines that it cannot parse (so that later indices name
// other vertices), removes repeated corners from bridged polygons, accepts indices out of range, and opens
// any file that `mtllib` names. CGAL 5.5 rejects line continuations and reads index 0 as 2^64 - 1. Neither
// reports the faulty line.
#include <cstdint>

#include <fmt/format.h>

#include "core/import/mesh_readers.h"
#include "core/import/text_cursor.h"

namespace nearfit {
namespace {

constexpr TextCursor::Syntax kSyntax{.comment = '#', .hasContinuations = true};

struct Counts {
  std::size_t vertices = 0, faces = 0;
};

/// Faces may name later vertices, so count the vertices first.
Counts countElements(const ReaderInput& input) {
  const ReaderInput silent{input.name, input.bytes, {}};
  TextCursor cursor(silent, kSyntax);
  Counts counts;
  do {
    const std::string_view keyword = cursor.token();
    if (keyword == "v") ++counts.vertices;
    if (keyword == "f" || keyword == "fo") ++counts.faces;
    cursor.skipRest();
  } while (cursor.nextLine());
  return counts;
}

/// Vertex index, from 0, of a corner such as 7, 7/1, 7//3 or 7/1/3.
std::uint32_t cornerVertex(const TextCursor& cursor, std::string_view corner, std::size_t vertices,
                           std::size_t verticesSoFar) {
  const std::optional<std::int64_t> index = parseInteger(corner.substr(0, corner.find('/')));
  if (!index) {
    cursor.fail(fmt::format("expected a vertex number, but {} is not one", inQuotes(corner)),
                "correct the line or export the file again");
  }
  const auto before = static_cast<std::int64_t>(verticesSoFar);
  const std::int64_t fromZero = *index < 0 ? before + *index : *index - 1;
  if (*index == 0 || fromZero < 0 || fromZero >= static_cast<std::int64_t>(vertices)) {
    cursor.fail(fmt::format("the face refers to vertex {} of {}", *index, vertices),
                *index == 0 ? "vertices count from 1: export the file again" : "export the file again");
  }
  return static_cast<std::uint32_t>(fromZero);
}

}  // namespace

ReaderResult readObj(const ReaderInput& input) {
  const Counts counts = countElements(input);
  ReaderResult result;
  PolygonSoup& soup = result.soup;
  soup.vertices.reserve(counts.vertices);
  soup.firstCorner.reserve(counts.faces + 1);
  soup.corners.reserve(3 * counts.faces);

  TextCursor cursor(input, kSyntax);
  do {
    const std::string_view keyword = cursor.token();
    if (keyword == "v") {
      glm::dvec3 p;
      for (int i = 0; i < 3; ++i) {
        const std::string_view token = cursor.token();
        if (token.empty()) cursor.fail("a vertex has fewer than three coordinates", "export the file again");
        p[i] = cursor.asNumber(token, "a coordinate");
      }
      soup.vertices.push_back(p);
    } else if (keyword == "f" || keyword == "fo") {
      for (std::string_view corner = cursor.token(); !corner.empty(); corner = cursor.token()) {
        soup.corners.push_back(cornerVertex(cursor, corner, counts.vertices, soup.vertices.size()));
      }
      soup.closePolygon();
    }
    cursor.skipRest();
  } while (cursor.nextLine());
  return result;
}

}  // namespace nearfit
