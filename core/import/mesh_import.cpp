#include "core/import/mesh_import.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <new>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/gunzip.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/import/mesh_file_check.h"
#include "core/import/mesh_readers.h"
#include "core/import/text_cursor.h"
#include "core/math/finite.h"

namespace nearfit {
namespace {

/// Max size of a mesh file that was compressed by gzip, unpacked [bytes]: a file of a megabyte can stand for a gigabyte.
/// Text of that size holds some 15 million triangles.
constexpr std::uint64_t kMaxUnpackedMesh = std::uint64_t{2} << 30;

/// Progress at the end of each stage.
constexpr double kReadFraction = 0.2, kParsedFraction = 0.6;

/// Maps progress of one stage to the whole; throws Cancelled if the user stops.
class Progress {
 public:
  explicit Progress(const ProgressCallback& callback) : callback_(callback) {}
  void report(double from, double to, double fraction) const {
    if (callback_ && !callback_(from + (to - from) * std::clamp(fraction, 0.0, 1.0))) throw Cancelled();
  }

 private:
  const ProgressCallback& callback_;
};

enum class MeshFormat { StlText, StlBinary, Obj, Ply, Off };

constexpr const char* kExportMesh = "export it as STL, OBJ, PLY or OFF";

/// Rejects common unsupported formats, recognised by their first bytes, with a helpful message.
void refuseForeignFormats(const ReaderInput& input, std::string_view text) {
  struct Signature {
    std::string_view start;
    const char* problem;
    const char* remedy;
  };
  constexpr std::array kSignatures{
      Signature{"\x1f\x8b", "it is compressed twice (gzip)", "unpack it with gunzip first"},
      Signature{"BZh", "it is compressed (bzip2)", "unpack it with bunzip2 first"},
      Signature{"\xfd"
                "7zXZ",
                "it is compressed (xz)", "unpack it with unxz first"},
      Signature{"PK\x03\x04", "it is an archive (zip, 3MF)",
                "rename it to .3mf if it is one, else unpack it"},
      Signature{"ISO-10303-21", "it is a STEP file by another name", "rename it to .step"},
      Signature{"glTF", "it is a binary glTF file by another name", "rename it to .glb"},
      Signature{"{", "it is a JSON or glTF file",
                "rename it to .gltf if it is one, else export STL, OBJ, PLY or OFF"},
      Signature{"<", "it is an XML file",
                "rename it to .urdf if it is one, else export STL, OBJ, PLY or OFF"},
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

/// Detects the format by content if possible, else by the file name.
/// @param extension  Lower case, without the dot.
/// Throws FileError if the file is empty or in no supported format, and names the actual format if known.
MeshFormat detectMeshFormat(const ReaderInput& input, const std::string& extension) {
  if (input.bytes.empty()) throw FileError(input.name, "it is empty", "export or copy it again");
  if (const std::optional<MeshFormat> format = formatByContent(input)) return *format;
  if (extension == "xacro")
    throw FileError(input.name, "it is a template of a URDF file",
                    "expand it first: xacro in.xacro > out.urdf");
  refuseForeignFormats(input, {input.bytes.data(), input.bytes.size()});
  if (extension == "stl") return looksLikeText(input.bytes) ? MeshFormat::StlText : MeshFormat::StlBinary;
  if (extension == "obj") return MeshFormat::Obj;
  if (extension == "ply") return MeshFormat::Ply;
  if (extension == "off") return MeshFormat::Off;
  throw FileError(input.name, "Nearfit does not read its format", kExportMesh);
}

/// Converts UTF-16 text with a byte order mark to one byte per character ('?' for non-ASCII), and removes the
/// byte order mark of UTF-8. Leaves other bytes as they are.
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

/// Without that of a compression.
std::string lowerCaseExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (extension == ".gz") extension = file.stem().extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

ReaderResult readSoup(const ReaderInput& input, MeshFormat format) {
  switch (format) {
    case MeshFormat::StlText:
      return readStlText(input);
    case MeshFormat::StlBinary:
      return readStlBinary(input);
    case MeshFormat::Obj:
      return readObj(input);
    case MeshFormat::Ply:
      return readPly(input);
    case MeshFormat::Off:
      return readOff(input);
  }
  return {};
}

void requireFaces(const std::filesystem::path& file, const PolygonSoup& soup) {
  if (soup.polygonCount() > 0) return;
  throw FileError(file.string(),
                  soup.vertices.empty()
                      ? "it holds no faces"
                      : fmt::format("it holds {} points but no faces", soup.vertices.size()),
                  "export the part as a mesh of triangles");
}

/// Reads the polygons of a file from its bytes, in the file's units.
ReaderResult readPolygons(const std::filesystem::path& file, std::vector<char> bytes,
                          const Progress& progress) {
  if (isGzip(bytes)) {
    bytes = gunzip(bytes, file.string(), kMaxUnpackedMesh,
                   [&](double) { progress.report(kReadFraction, kParsedFraction, 0.0); });
  }
  bytes = withoutByteOrderMark(std::move(bytes));
  const ReaderInput input{file.string(), bytes,
                          [&](double done) { progress.report(kReadFraction, kParsedFraction, done); }};
  ReaderResult read = readSoup(input, detectMeshFormat(input, lowerCaseExtension(file)));
  requireFaces(file, read.soup);
  progress.report(kReadFraction, kParsedFraction, 1.0);
  return read;
}

ImportedMesh importUnguarded(const std::filesystem::path& file, std::vector<char> bytes,
                             const MeshBuildOptions& options, const Progress& progress) {
  ImportedMesh imported;
  imported.sha256 = sha256OfBytes(bytes);
  const ReaderResult read = readPolygons(file, std::move(bytes), progress);
  imported.mesh = buildMesh(read.soup, options, imported.report,
                            [&](double done) { progress.report(kParsedFraction, 1.0, done); });
  imported.report.warnings.insert(imported.report.warnings.begin(), read.warnings.begin(),
                                  read.warnings.end());
  progress.report(kParsedFraction, 1.0, 1.0);
  return imported;
}

/// Bounds of the finite corners of all polygons, in the soup's units.
Aabb boundsOf(const PolygonSoup& soup) {
  Aabb box;
  for (const std::uint32_t corner : soup.corners) {
    if (corner < soup.vertices.size() && isFinite(soup.vertices[corner])) box.add(soup.vertices[corner]);
  }
  return box;
}

/// Runs work on a file; its errors name the file.
template <class Work>
std::invoke_result_t<Work> naming(const std::filesystem::path& file, Work work) {
  try {
    return work();
  } catch (const FileError&) {
    throw;
  } catch (const UsageError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw FileError(error.where().empty() ? file.string() : file.string() + ", " + error.where(),
                    error.problem(), error.remedy());
  } catch (const std::bad_alloc&) {
    throw FileError(file.string(), "there is not enough memory for it",
                    "close other programs or reduce the mesh");
  }
}

}  // namespace

ImportedMesh importMesh(const std::filesystem::path& file, const MeshBuildOptions& options,
                        const ProgressCallback& callback) {
  const Progress progress(callback);
  return naming(file, [&] {
    checkMeshFile(file);
    std::vector<char> bytes =
        readWholeFile(file, [&](double done) { progress.report(0.0, kReadFraction, done); });
    return importUnguarded(file, std::move(bytes), options, progress);
  });
}

ImportedMesh importMeshBytes(const std::filesystem::path& file, std::vector<char> bytes,
                             const MeshBuildOptions& options, const ProgressCallback& callback) {
  const Progress progress(callback);
  return naming(file, [&] { return importUnguarded(file, std::move(bytes), options, progress); });
}

ImportedPolygons importPolygons(const std::filesystem::path& file, const ProgressCallback& callback) {
  const Progress progress(callback);
  return naming(file, [&] {
    checkMeshFile(file);
    std::vector<char> bytes =
        readWholeFile(file, [&](double done) { progress.report(0.0, kReadFraction, done); });
    std::string sha256 = sha256OfBytes(bytes);
    return ImportedPolygons{readPolygons(file, std::move(bytes), progress).soup, std::move(sha256)};
  });
}

Aabb readMeshBounds(const std::filesystem::path& file, const ProgressCallback& callback) {
  const Progress progress(callback);
  return naming(file, [&] {
    std::vector<char> bytes =
        readWholeFile(file, [&](double done) { progress.report(0.0, kReadFraction, done); });
    return boundsOf(readPolygons(file, std::move(bytes), progress).soup);
  });
}

const std::vector<std::string>& importableExtensions() {
  static const std::vector<std::string> extensions{"stl", "obj", "ply", "off"};
  return extensions;
}

}  // namespace nearfit
