#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/import/reader_input.h"

namespace nearfit {

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
  const PlyElement* find(std::string_view name) const;
};

/// Reads the header of a PLY file. Line ends may be LF, CRLF or CR. Throws FileError.
PlyHeader readPlyHeader(const ReaderInput& input);

}  // namespace nearfit
