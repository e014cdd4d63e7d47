// Own parser, since the available libraries misread this format (tried on malicious and unusual files).
// OpenMesh 9 reduces doubles to single precision, loses its place after a CRLF header (ply_crlf_header_binary
// becomes noise), hangs or fills memory if a header or list is cut off, and does not know all types of list
// counts. CGAL 5.5 reads valid files correctly, but throws bad_alloc on large or negative list counts,
// rejects NaN in text, and accepts indices out of range. Neither reports the faulty line or byte, so each
// list would have to be checked here first, which leaves them nothing to do.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/import/mesh_readers.h"
#include "core/import/text_cursor.h"

namespace nearfit {
namespace {

static_assert(std::endian::native == std::endian::little,
              "binary values are swapped for a little-endian machine");

constexpr const char* kCutOff = "it is cut off or damaged: export or copy it again";
constexpr const char* kExportAgain = "export the file again";

/// Max number of elements and, of all together, of properties: hundreds of times what meshes and clouds of
/// splats have. Elements are compared with one another.
constexpr std::size_t kMaxElements = 1000, kMaxProperties = 10'000;

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

/// Size of a value in a binary file [bytes].
constexpr std::size_t byteCount(PlyType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

/// A property of a PLY element: a value or a list.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float32;  ///< Of the value, or of each value in the list.
  /// Set for a list: type of the count that precedes its values.
  std::optional<PlyType> listCountType;
};

/// A PLY element, such as "vertex": `count` items with the same properties.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

/// Header of a PLY file.
struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;
  std::size_t dataOffset = 0;  ///< First byte after the header.
  std::size_t dataLine = 1;    ///< Line of that byte.

  /// The element with that name; null if there is none.
  const PlyElement* find(std::string_view name) const {
    const auto found = std::ranges::find(elements, name, &PlyElement::name);
    return found == elements.end() ? nullptr : &*found;
  }
};

PlyType parseType(const TextCursor& cursor, std::string_view word) {
  if (word.empty()) cursor.fail("expected a type, but the line ends", kExportAgain);
  // Two names for each type, in the order of PlyType.
  constexpr std::array<std::string_view, 16> kNames{
      "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
      "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};
  const auto* const found = std::ranges::find(kNames, word);
  if (found == kNames.end())
    cursor.fail(fmt::format("expected a type, but {} is not one", inQuotes(word)), kExportAgain);
  return static_cast<PlyType>((found - kNames.begin()) / 2);
}

PlyFormat parseFormat(const TextCursor& cursor, std::string_view word) {
  if (word == "ascii") return PlyFormat::Ascii;
  if (word == "binary_little_endian") return PlyFormat::LittleEndian;
  if (word == "binary_big_endian") return PlyFormat::BigEndian;
  cursor.fail(fmt::format("the format {} is unknown", inQuotes(word)),
              "export it as ascii or binary_little_endian");
}

PlyElement parseElement(TextCursor& cursor, const PlyHeader& header) {
  if (header.elements.size() >= kMaxElements)
    cursor.fail(fmt::format("the header declares more than {} elements", kMaxElements), kExportAgain);
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

/// Reads the header of a PLY file. Line ends may be LF, CRLF or CR. Throws FileError.
PlyHeader readPlyHeader(const ReaderInput& input) {
  const ReaderInput silent{input.name, input.bytes, {}};
  TextCursor cursor(silent, {.comment = '\0'});
  if (cursor.token() != "ply") cursor.fail("it does not begin with 'ply'", "check that this is a PLY file");
  PlyHeader header;
  bool hasFormat = false;
  std::size_t properties = 0;
  while (cursor.nextLine()) {
    const std::string_view keyword = cursor.token();
    if (keyword == "format") {
      header.format = parseFormat(cursor, cursor.token());
      hasFormat = true;
    } else if (keyword == "element") {
      header.elements.push_back(parseElement(cursor, header));
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("a property comes before the first element", kExportAgain);
      if (++properties > kMaxProperties)
        cursor.fail(fmt::format("the header declares more than {} properties", kMaxProperties), kExportAgain);
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

/// Reads values of a text file.
class TextValues {
 public:
  TextValues(const ReaderInput& input, const PlyHeader& header)
      : cursor_(input, {.comment = '\0'}, header.dataOffset, header.dataLine) {}

  double number(PlyType) { return cursor_.number("a number"); }
  void skip(PlyType) {
    if (cursor_.tokenAcrossLines().empty()) cursor_.failAtEnd("a number");
  }
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    cursor_.fail(problem, remedy);
  }
  std::size_t bytesLeft() const { return cursor_.bytesLeft() + 1; }  // The last line may lack its end.
  static std::size_t smallestByteCount(PlyType) { return std::string_view("0 ").size(); }

 private:
  TextCursor cursor_;
};

/// Reads values of a binary file.
class BinaryValues {
 public:
  BinaryValues(const ReaderInput& input, const PlyHeader& header)
      : input_(input), offset_(header.dataOffset), isSwapped_(header.format == PlyFormat::BigEndian) {}

  double number(PlyType type) {
    switch (type) {
      case PlyType::Int8:
        return read<std::int8_t>();
      case PlyType::UInt8:
        return read<std::uint8_t>();
      case PlyType::Int16:
        return read<std::int16_t>();
      case PlyType::UInt16:
        return read<std::uint16_t>();
      case PlyType::Int32:
        return read<std::int32_t>();
      case PlyType::UInt32:
        return read<std::uint32_t>();
      case PlyType::Float32:
        return read<float>();
      case PlyType::Float64:
        return read<double>();
    }
    return 0.0;
  }
  void skip(PlyType type) {
    require(byteCount(type));
    offset_ += byteCount(type);
    reportProgress();
  }
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw FileError(fmt::format("{}: byte {}", input_.name, offset_), problem, remedy);
  }
  std::size_t bytesLeft() const { return input_.bytes.size() - offset_; }
  static std::size_t smallestByteCount(PlyType type) { return byteCount(type); }

 private:
  template <typename T>
  T read() {
    require(sizeof(T));
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), input_.bytes.data() + offset_, sizeof(T));
    if (isSwapped_) std::ranges::reverse(bytes);
    offset_ += sizeof(T);
    reportProgress();
    return std::bit_cast<T>(bytes);
  }
  void require(std::size_t bytes) const {
    if (bytesLeft() < bytes) fail("the file ends in the middle of its data", kCutOff);
  }
  void reportProgress() {
    constexpr std::size_t kReportBytes = std::size_t{1} << 20;
    if (offset_ < nextReport_) return;
    nextReport_ = offset_ + kReportBytes;
    input_.report(static_cast<double>(offset_) / static_cast<double>(input_.bytes.size()));
  }

  const ReaderInput& input_;
  std::size_t offset_, nextReport_ = 0;
  bool isSwapped_;
};

/// Throws if the rest of the file is too short for the elements that the header promises.
template <typename Values>
void checkRoom(const Values& values, const PlyElement& element) {
  std::size_t smallest = 0;
  for (const PlyProperty& p : element.properties) {
    smallest += Values::smallestByteCount(p.listCountType.value_or(p.type));
  }
  if (smallest > 0 && element.count > values.bytesLeft() / smallest) {
    values.fail(fmt::format("the header declares {} elements {}, more than the {} bytes that follow can hold",
                            element.count, inQuotes(element.name), values.bytesLeft()),
                kCutOff);
  }
}

template <typename Values>
std::uint64_t readListCount(Values& values, const PlyProperty& list) {
  const double count = values.number(*list.listCountType);
  if (!(count >= 0.0) || count != std::floor(count)) {
    values.fail(fmt::format("a list has {} values", count), kExportAgain);
  }
  const std::uint64_t most = values.bytesLeft() / Values::smallestByteCount(list.type);
  if (count > static_cast<double>(most)) {
    values.fail(fmt::format("a list of {} values does not fit into the {} bytes that follow", count,
                            values.bytesLeft()),
                kCutOff);
  }
  return static_cast<std::uint64_t>(count);
}

template <typename Values>
void skipProperty(Values& values, const PlyProperty& property) {
  const std::uint64_t count = property.listCountType ? readListCount(values, property) : 1;
  for (std::uint64_t i = 0; i < count; ++i)
    values.skip(property.type);
}

template <typename Values>
void readVertices(Values& values, const PlyElement& element, PolygonSoup& soup) {
  constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
  for (const std::string_view name : kNames) {
    const auto isCoordinate = [&](const PlyProperty& p) { return p.name == name && !p.listCountType; };
    if (std::ranges::count_if(element.properties, isCoordinate) != 1) {
      values.fail(fmt::format("vertices need one property '{}'", name),
                  "export it as a mesh in three dimensions");
    }
  }
  checkRoom(values, element);
  soup.vertices.resize(element.count);
  for (glm::dvec3& vertex : soup.vertices) {
    for (const PlyProperty& property : element.properties) {
      const auto axis = std::ranges::find(kNames, property.name) - kNames.begin();
      if (axis < 3 && !property.listCountType) {
        vertex[static_cast<int>(axis)] = values.number(property.type);
      } else {
        skipProperty(values, property);
      }
    }
  }
}

template <typename Values>
void readCorners(Values& values, const PlyProperty& list, std::uint64_t vertices, PolygonSoup& soup) {
  const std::uint64_t count = readListCount(values, list);
  for (std::uint64_t i = 0; i < count; ++i) {
    const double index = values.number(list.type);
    if (!(index >= 0.0) || index >= static_cast<double>(vertices) || index != std::floor(index)) {
      values.fail(fmt::format("a face refers to vertex {}, but vertices go from 0 to {}", index,
                              static_cast<std::int64_t>(vertices) - 1),
                  kExportAgain);
    }
    soup.corners.push_back(static_cast<std::uint32_t>(index));
  }
  soup.closePolygon();
}

template <typename Values>
void readFaces(Values& values, const PlyElement& element, std::uint64_t vertices, PolygonSoup& soup) {
  const auto isCornerList = [](const PlyProperty& p) {
    return p.listCountType && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  const auto corners = std::ranges::find_if(element.properties, isCornerList);
  if (corners == element.properties.end() && element.count > 0) {
    values.fail("faces have no list 'vertex_indices'", kExportAgain);
  }
  checkRoom(values, element);
  soup.firstCorner.reserve(element.count + 1);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (&property == &*corners) {
        readCorners(values, property, vertices, soup);
      } else {
        skipProperty(values, property);
      }
    }
  }
}

template <typename Values>
PolygonSoup readElements(Values values, const PlyHeader& header) {
  const PlyElement* const vertexElement = header.find("vertex");
  if (vertexElement == nullptr) values.fail("the header names no vertices", "export it as a mesh");
  PolygonSoup soup;
  for (const PlyElement& element : header.elements) {
    if (&element == vertexElement) {
      readVertices(values, element, soup);
    } else if (element.name == "face") {
      readFaces(values, element, vertexElement->count, soup);
    } else if (element.name == "tristrips" && element.count > 0) {
      values.fail("it holds triangle strips, which Nearfit does not read", "export it with plain faces");
    } else if (!element.properties.empty()) {
      checkRoom(values, element);
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties)
          skipProperty(values, property);
      }
    }
  }
  return soup;
}

}  // namespace

ReaderResult readPly(const ReaderInput& input) {
  const PlyHeader header = readPlyHeader(input);
  if (header.format == PlyFormat::Ascii) return {readElements(TextValues(input, header), header), {}};
  return {readElements(BinaryValues(input, header), header), {}};
}

}  // namespace nearfit
