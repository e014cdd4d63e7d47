// Own parser, since the available libraries misread this dialect (tried on malicious and unusual files).
// OpenMesh 9 keeps only single precision, finds "outer" in a solid's name, reads text that is not a number as
// 0, and takes a file that is cut off or has CR line ends for a shorter or empty one. CGAL 5.5 reads a file
// that begins with a comment as binary, and returns facets of noise. Neither reports the faulty line.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "core/import/mesh_readers.h"
#include "core/import/text_cursor.h"

namespace nearfit {
namespace {

constexpr const char* kCorrectLine = "correct the line or export the file again";

bool isWord(std::string_view token, std::string_view word) {
  const auto lower = [](unsigned char c) { return std::tolower(c); };
  return std::ranges::equal(token, word, {}, lower, lower);
}

void expect(TextCursor& cursor, std::string_view word) {
  const std::string_view token = cursor.tokenAcrossLines();
  if (token.empty()) cursor.failAtEnd(inQuotes(word));
  if (!isWord(token, word)) {
    cursor.fail(fmt::format("expected {}, but found {}", inQuotes(word), inQuotes(token)), kCorrectLine);
  }
}

/// Skips "normal x y z" and "outer". Some programs omit the numbers or write invalid ones.
void skipToOuter(TextCursor& cursor) {
  constexpr int kMaxTokens = 5;
  for (int i = 0; i < kMaxTokens; ++i) {
    const std::string_view token = cursor.tokenAcrossLines();
    if (token.empty()) cursor.failAtEnd("'outer'");
    if (isWord(token, "outer")) return;
  }
  cursor.fail("a facet has no 'outer loop'", kCorrectLine);
}

/// Reads a facet from after the word "facet" to "endfacet".
void readFacet(TextCursor& cursor, PolygonSoup& soup) {
  skipToOuter(cursor);
  expect(cursor, "loop");
  int corners = 0;
  for (std::string_view token = cursor.tokenAcrossLines(); !isWord(token, "endloop");
       token = cursor.tokenAcrossLines(), ++corners) {
    if (token.empty()) cursor.failAtEnd("'endloop'");
    if (!isWord(token, "vertex")) {
      cursor.fail(fmt::format("expected 'vertex' or 'endloop', but found {}", inQuotes(token)), kCorrectLine);
    }
    glm::dvec3 p;
    for (int i = 0; i < 3; ++i)
      p[i] = cursor.number("a coordinate");
    soup.corners.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
    soup.vertices.push_back(p);
  }
  if (corners < 3) cursor.fail("a facet has fewer than three vertices", kCorrectLine);
  expect(cursor, "endfacet");
  soup.closePolygon();
}

}  // namespace

ReaderResult readStlText(const ReaderInput& input) {
  // Min size of a facet.
  constexpr std::string_view kShortestFacet =
      "facet outer loop vertex 0 0 0 vertex 0 0 0 vertex 0 0 0 endloop endfacet ";
  // Typical facets take some 250 bytes. One allocation instead of many.
  constexpr std::size_t kUsualFacetBytes = 3 * kShortestFacet.size();
  ReaderResult result;
  result.soup.vertices.reserve(3 * (input.bytes.size() / kUsualFacetBytes));

  TextCursor cursor(input, {});
  bool isSolidOpen = false;
  for (;;) {
    const std::string_view token = cursor.tokenAcrossLines();
    if (token.empty()) break;
    if (isWord(token, "solid") || isWord(token, "endsolid")) {
      isSolidOpen = isWord(token, "solid");
      cursor.skipRest();  // The solid's name.
    } else if (isWord(token, "facet")) {
      readFacet(cursor, result.soup);
    } else {
      cursor.fail(fmt::format("expected 'facet' or 'endsolid', but found {}", inQuotes(token)), kCorrectLine);
    }
  }
  if (isSolidOpen) result.warnings.emplace_back("The file ends without 'endsolid': it may be cut off.");
  return result;
}

}  // namespace nearfit
