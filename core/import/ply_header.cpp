#include "core/import/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/import/text_cursor.h"

namespace nearfit {
namespace {

constexpr const char* kExportAgain = "export the file again";

PlyType parseType(const TextCursor& cursor, std::string_view word) {
  using enum PlyType;
  if (word.empty()) cursor.fail("expected a type, but the line ends", kExportAgain);
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{{"char", Int8},
                                                                         {"int8", Int8},
                                                                         {"uchar", UInt8},
                                                                         {"uint8", UInt8},
                                                                         {"short", Int16},
                                                                         {"int16", Int16},
                                                                         {"ushort", UInt16},
                                                                         {"uint16", UInt16},
                                                                         {"int", Int32},
                                                                         {"int32", Int32},
                                                                         {"uint", UInt32},
                                                                         {"uint32", UInt32},
                                                                         {"float", Float32},
                                                                         {"float32", Float32},
                                                                         {"double", Float64},
                                                                         {"float64", Float64}}};
  const auto* const found = std::ranges::find(kNames, word, &std::pair<std::string_view, PlyType>::first);
  if (found == kNames.end())
    cursor.fail(fmt::format("expected a type, but {} is not one", inQuotes(word)), kExportAgain);
  return found->second;
}

PlyFormat parseFormat(const TextCursor& cursor, std::string_view word) {
  if (word == "ascii") return PlyFormat::Ascii;
  if (word == "binary_little_endian") return PlyFormat::LittleEndian;
  if (word == "binary_big_endian") return PlyFormat::BigEndian;
  cursor.fail(fmt::format("the format {} is unknown", inQuotes(word)),
              "export it as ascii or binary_little_endian");
}

PlyElement parseElement(TextCursor& cursor, const PlyHeader& header) {
  PlyElement element;
  element.name = cursor.token();
  const std::string_view count = cursor.token();
  const std::optional<std::int64_t> value = parseInteger(count);
  if (element.name.empty() || !value || *value < 0) {
    cursor.fail("an element needs a name and a count", kExportAgain);
  }
  if (header.find(element.name) != nullptr) {
    cursor.fail(fmt::format("the element {} is declared twice", inQuotes(element.name)), kExportAgain);
  }
  element.count = static_cast<std::uint64_t>(*value);
  return element;
}

PlyProperty parseProperty(TextCursor& cursor) {
  PlyProperty property;
  std::string_view word = cursor.token();
  if (word == "list") {
    property.listCountType = parseType(cursor, cursor.token());
    word = cursor.token();
  }
  property.type = parseType(cursor, word);
  property.name = cursor.token();
  if (property.name.empty()) cursor.fail("a property has no name", kExportAgain);
  return property;
}

/// True if lines end in a lone carriage return; a line feed after it is then data.
bool hasLoneReturns(std::span<const char> bytes) {
  const auto lineEnd = std::ranges::find_if(bytes, [](char c) { return c == '\n' || c == '\r'; });
  return lineEnd != bytes.end() && *lineEnd == '\r' && lineEnd + 1 != bytes.end() && lineEnd[1] != '\n';
}

std::size_t offsetBehindLineEnd(std::span<const char> bytes, std::size_t offset) {
  if (offset == bytes.size()) return offset;
  const bool isPair = bytes[offset] == '\r' && offset + 1 < bytes.size() && bytes[offset + 1] == '\n';
  return offset + (isPair && !hasLoneReturns(bytes) ? 2 : 1);
}

}  // namespace

const PlyElement* PlyHeader::find(std::string_view name) const {
  const auto found = std::ranges::find(elements, name, &PlyElement::name);
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader readPlyHeader(const ReaderInput& input) {
  const ReaderInput silent{input.name, input.bytes, {}};
  TextCursor cursor(silent, {.comment = '\0'});
  if (cursor.token() != "ply") cursor.fail("it does not begin with 'ply'", "check that this is a PLY file");
  PlyHeader header;
  bool hasFormat = false;
  while (cursor.nextLine()) {
    const std::string_view keyword = cursor.token();
    if (keyword == "format") {
      header.format = parseFormat(cursor, cursor.token());
      hasFormat = true;
    } else if (keyword == "element") {
      header.elements.push_back(parseElement(cursor, header));
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("a property comes before the first element", kExportAgain);
      header.elements.back().properties.push_back(parseProperty(cursor));
    } else if (keyword == "end_header") {
      if (!hasFormat) cursor.fail("the header names no format", kExportAgain);
      cursor.skipRest();
      header.dataOffset = offsetBehindLineEnd(input.bytes, cursor.offset());
      header.dataLine = cursor.line() + 1;
      return header;
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      cursor.fail(fmt::format("{} is not a keyword of a PLY header", inQuotes(keyword)), kExportAgain);
    }
  }
  cursor.failAtEnd("'end_header'");
}

}  // namespace nearfit
