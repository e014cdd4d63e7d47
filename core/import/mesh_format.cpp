#include "core/import/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include "core/base/error.h"
#include "core/import/off_reader.h"
#include "core/import/stl_binary_reader.h"
#include "core/import/text_cursor.h"

namespace nearfit {
namespace {

constexpr const char* kExportMesh = "export it as STL, OBJ, PLY or OFF";

/// Rejects common unsupported formats, recognised by their first bytes, with a helpful message.
void refuseForeignFormats(const ReaderInput& input, std::string_view text) {
  struct Signature {
    std::string_view start;
    const char* problem;
    const char* remedy;
  };
  constexpr std::array kSignatures{
      Signature{"\x1f\x8b", "it is compressed (gzip)", "unpack it with gunzip first"},
      Signature{"BZh", "it is compressed (bzip2)", "unpack it with bunzip2 first"},
      Signature{"\xfd"
                "7zXZ",
                "it is compressed (xz)", "unpack it with unxz first"},
      Signature{"PK\x03\x04", "it is an archive (zip, 3MF), which Nearfit does not read",
                "unpack it, or export STL, OBJ, PLY or OFF"},
      Signature{"ISO-10303-21", "it is a STEP file, which Nearfit does not read", kExportMesh},
      Signature{"glTF", "it is a glTF file, which Nearfit does not read", kExportMesh},
      Signature{"{", "it is a JSON or glTF file, which Nearfit does not read", kExportMesh},
      Signature{"<", "it is an XML file, which Nearfit does not read", kExportMesh},
  };
  for (const Signature& s : kSignatures) {
    if (text.starts_with(s.start)) throw FileError(input.name, s.problem, s.remedy);
  }
}

bool isBinaryStlOfThatLength(std::span<const char> bytes) {
  return bytes.size() >= kStlHeaderBytes &&
         bytes.size() == kStlHeaderBytes + std::uint64_t{stlFacetCount(bytes)} * kStlFacetBytes;
}

/// Text has no control characters except white space; its first bytes suffice to tell.
bool looksLikeText(std::span<const char> bytes) {
  constexpr std::size_t kLookAt = 1024;
  return std::ranges::none_of(bytes.first(std::min(kLookAt, bytes.size())), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < ' ' && std::isspace(code) == 0;
  });
}

std::optional<MeshFormat> formatByContent(const ReaderInput& input) {
  if (isBinaryStlOfThatLength(input.bytes)) return MeshFormat::StlBinary;
  const ReaderInput silent{input.name, input.bytes, {}};
  const std::string_view first = TextCursor(silent, {}).tokenAcrossLines();
  if (first == "ply") return MeshFormat::Ply;
  if (startsLikeOff(first)) return MeshFormat::Off;
  constexpr std::string_view kSolid = "solid";
  const bool isSolid = std::ranges::equal(first, kSolid, {}, [](unsigned char c) { return std::tolower(c); });
  if (isSolid && looksLikeText(input.bytes)) return MeshFormat::StlText;
  return std::nullopt;
}

}  // namespace

MeshFormat detectMeshFormat(const ReaderInput& input, const std::string& extension) {
  if (input.bytes.empty()) throw FileError(input.name, "it is empty", "export or copy it again");
  if (const std::optional<MeshFormat> format = formatByContent(input)) return *format;
  refuseForeignFormats(input, {input.bytes.data(), input.bytes.size()});
  if (extension == "stl") return looksLikeText(input.bytes) ? MeshFormat::StlText : MeshFormat::StlBinary;
  if (extension == "obj") return MeshFormat::Obj;
  if (extension == "ply") return MeshFormat::Ply;
  if (extension == "off") return MeshFormat::Off;
  throw FileError(input.name, "Nearfit does not read its format", kExportMesh);
}

std::vector<char> withoutByteOrderMark(std::vector<char> bytes) {
  const auto startsWith = [&](std::string_view mark) {
    return std::string_view(bytes.data(), bytes.size()).starts_with(mark);
  };
  if (startsWith("\xEF\xBB\xBF")) bytes.erase(bytes.begin(), bytes.begin() + 3);
  const bool isBigEndian = startsWith("\xFE\xFF");
  if (!isBigEndian && !startsWith("\xFF\xFE")) return bytes;
  const std::size_t units = bytes.size() / 2;
  for (std::size_t i = 1; i < units; ++i) {
    const char high = bytes[2 * i + (isBigEndian ? 0 : 1)], low = bytes[2 * i + (isBigEndian ? 1 : 0)];
    bytes[i - 1] = high == 0 && static_cast<unsigned char>(low) < 0x80 ? low : '?';
  }
  bytes.resize(units - 1);
  return bytes;
}

}  // namespace nearfit
