#include "core/import/mesh_import.h"

#include <algorithm>
#include <cctype>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/import/mesh_format.h"
#include "core/import/obj_reader.h"
#include "core/import/off_reader.h"
#include "core/import/ply_reader.h"
#include "core/import/stl_binary_reader.h"
#include "core/import/stl_text_reader.h"

namespace nearfit {
namespace {

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

std::string lowerCaseExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
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

ImportedMesh importUnguarded(const std::filesystem::path& file, std::vector<char> bytes,
                             const MeshBuildOptions& options, const Progress& progress) {
  ImportedMesh imported;
  imported.sha256 = sha256OfBytes(bytes);
  bytes = withoutByteOrderMark(std::move(bytes));
  const ReaderInput input{file.string(), bytes,
                          [&](double done) { progress.report(kReadFraction, kParsedFraction, done); }};
  ReaderResult read = readSoup(input, detectMeshFormat(input, lowerCaseExtension(file)));
  std::vector<char>().swap(bytes);
  requireFaces(file, read.soup);
  progress.report(kReadFraction, kParsedFraction, 1.0);
  imported.mesh = buildMesh(read.soup, options, imported.report,
                            [&](double done) { progress.report(kParsedFraction, 1.0, done); });
  imported.report.warnings.insert(imported.report.warnings.begin(), read.warnings.begin(),
                                  read.warnings.end());
  progress.report(kParsedFraction, 1.0, 1.0);
  return imported;
}

/// Runs work on a file; its errors name the file.
template <class Work>
ImportedMesh naming(const std::filesystem::path& file, Work work) {
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

const std::vector<std::string>& importableExtensions() {
  static const std::vector<std::string> extensions{"stl", "obj", "ply", "off"};
  return extensions;
}

}  // namespace nearfit
