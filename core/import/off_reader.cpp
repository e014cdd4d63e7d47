// Own parser, since the available libraries misread this format (tried on malicious and unusual files).
// OpenMesh 9 keeps only single precision, rejects comments, fills memory or runs for hours on the counts of
// off_huge_count and similar two-line files, and silently continues after text that is not a number. CGAL 5.5
// rejects counts after the keyword, throws bad_alloc on huge counts, and accepts indices out of range.
// Neither reports the faulty line.
#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "core/import/mesh_readers.h"
#include "core/import/text_cursor.h"

namespace nearfit {
namespace {

/// The fields of "[ST][C][N][4][n]OFF[count]".
struct Keyword {
  bool isHomogeneous = false;  ///< "4": a fourth coordinate divides the others.
  bool hasDimension = false;   ///< "n": the number of dimensions precedes the counts.
  std::string_view rest;       ///< Text directly after "OFF".
};

std::optional<Keyword> parseKeyword(std::string_view token) {
  Keyword keyword;
  const auto take = [&](std::string_view prefix) {
    if (!token.starts_with(prefix)) return false;
    token.remove_prefix(prefix.size());
    return true;
  };
  take("ST");
  take("C");
  take("N");
  keyword.isHomogeneous = take("4");
  keyword.hasDimension = take("n");
  if (!take("OFF")) return std::nullopt;
  keyword.rest = token;
  if (!token.empty() && !parseInteger(token)) return std::nullopt;
  return keyword;
}

struct Header {
  std::size_t vertices = 0, faces = 0;
  bool isHomogeneous = false;
};

/// Checks that the rest of the file has room for a count. `smallest` is the min size of one item [bytes].
std::size_t checkedCount(const TextCursor& cursor, std::int64_t count, std::size_t smallest,
                         std::string_view what) {
  if (count < 0) cursor.fail(fmt::format("it declares {} {}", count, what), "export the file again");
  // The last line may lack its line end.
  const std::size_t room = (cursor.bytesLeft() + 1) / smallest;
  if (static_cast<std::uint64_t>(count) > room) {
    cursor.fail(fmt::format("it declares {} {}, more than the {} bytes that follow can hold", count, what,
                            cursor.bytesLeft()),
                "the file is cut off or damaged: export or copy it again");
  }
  return static_cast<std::size_t>(count);
}

Header readHeader(TextCursor& cursor) {
  Header header;
  std::string_view first = cursor.tokenAcrossLines();
  std::optional<std::int64_t> vertices = parseInteger(first);  // The keyword is optional.
  if (!vertices) {
    const std::optional<Keyword> keyword = parseKeyword(first);
    if (!keyword) cursor.fail("it does not begin with OFF", "check that this is an OFF file");
    header.isHomogeneous = keyword->isHomogeneous;
    vertices = parseInteger(keyword->rest);
    if (keyword->hasDimension && cursor.integer("the number of dimensions") != 3) {
      cursor.fail("the mesh is not three-dimensional", "export it as a mesh in three dimensions");
    }
  }
  if (!vertices) {
    first = cursor.tokenAcrossLines();
    if (first == "BINARY") cursor.fail("it is a binary OFF file", "export it as text, or as PLY");
    if (first.empty()) cursor.failAtEnd("the number of vertices");
    vertices = cursor.asInteger(first, "the number of vertices");
  }
  const std::int64_t faces = cursor.integer("the number of faces");
  cursor.skipRest();  // The number of edges is often wrong.
  header.vertices = checkedCount(cursor, *vertices, std::string_view("0 0 0\n").size(), "vertices");
  header.faces = checkedCount(cursor, faces, std::string_view("0\n").size(), "faces");
  return header;
}

glm::dvec3 readVertex(TextCursor& cursor, bool isHomogeneous) {
  glm::dvec3 p;
  for (int i = 0; i < 3; ++i)
    p[i] = cursor.number("a coordinate");
  if (isHomogeneous) p /= cursor.number("a coordinate");
  cursor.skipRest();
  return p;
}

void readFace(TextCursor& cursor, std::size_t vertices, PolygonSoup& soup) {
  const std::int64_t corners = cursor.integer("the number of corners of a face");
  checkedCount(cursor, corners, std::string_view("0 ").size(), "corners");
  for (std::int64_t i = 0; i < corners; ++i) {
    const std::int64_t index = cursor.integer("the number of a vertex");
    if (index < 0 || index >= static_cast<std::int64_t>(vertices)) {
      cursor.fail(fmt::format("the face refers to vertex {}, but vertices go from 0 to {}", index,
                              static_cast<std::int64_t>(vertices) - 1),
                  "export the file again");
    }
    soup.corners.push_back(static_cast<std::uint32_t>(index));
  }
  soup.closePolygon();
  cursor.skipRest();
}

}  // namespace

bool startsLikeOff(std::string_view firstToken) {
  return parseKeyword(firstToken).has_value();
}

ReaderResult readOff(const ReaderInput& input) {
  TextCursor cursor(input, {});
  const Header header = readHeader(cursor);
  ReaderResult result;
  result.soup.vertices.reserve(header.vertices);
  result.soup.firstCorner.reserve(header.faces + 1);
  for (std::size_t i = 0; i < header.vertices; ++i) {
    result.soup.vertices.push_back(readVertex(cursor, header.isHomogeneous));
  }
  for (std::size_t i = 0; i < header.faces; ++i)
    readFace(cursor, header.vertices, result.soup);
  return result;
}

}  // namespace nearfit
