#include "app/import/import_job.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/gunzip.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/import/companion_files.h"
#include "core/text/utf8.h"

namespace nearfit::importer {
namespace {

/// Max size of a file, and of a compressed one, unpacked [bytes]: readers take some twenty times as much memory.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30, kMaxUnpackedBytes = std::uint64_t{1} << 30;

template <class T>
T numberOf(const std::string& option, const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw UsageError(option, fmt::format("\"{}\" is no number", printableText(text)), "give a number");
  return value;
}

/// The arguments after the program's name, one after the other.
class Arguments {
 public:
  Arguments(int argc, char** argv) : all_(argv + 1, argv + std::max(argc, 1)) {}
  bool isAtEnd() const { return next_ == all_.size(); }
  std::string take() { return all_[next_++]; }
  std::string valueOf(const std::string& option) {
    if (isAtEnd()) throw UsageError(option, "it needs a value", "see the manual");
    return take();
  }

 private:
  std::vector<std::string> all_;
  std::size_t next_ = 0;
};

void takeOption(const std::string& option, Arguments& arguments, ImportOptions& options) {
  const auto number = [&] { return numberOf<double>(option, arguments.valueOf(option)); };
  const auto descriptor = [&] { return numberOf<int>(option, arguments.valueOf(option)); };
  if (option == "--chord") {
    options.tessellation.chord = number();
  } else if (option == "--angle") {
    options.tessellation.angle = number();
  } else if (option == "--only") {
    options.onlyShapes.push_back(arguments.valueOf(option));
  } else if (option == "--result") {
    options.result = descriptor();
  } else if (option == "--messages") {
    options.messages = descriptor();
  } else if (option == "--version") {
    options.isVersionAsked = true;
  } else if (option == "--try-sandbox") {
    options.triesSandbox = true;
  } else if (option == "--times") {
    options.showsTimes = true;
  } else if (option == "--") {
    options.file = arguments.valueOf(option);
  } else if (!option.starts_with('-')) {
    options.file = option;
  } else {
    throw UsageError(option, "there is no such option", "nearfit starts this program by itself");
  }
}

std::string lowerCase(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::optional<DocumentFormat> formatOfExtension(const std::string& extension) {
  constexpr std::array kExtensions{
      std::pair{".step", DocumentFormat::Step}, std::pair{".stp", DocumentFormat::Step},
      std::pair{".iges", DocumentFormat::Iges}, std::pair{".igs", DocumentFormat::Iges},
      std::pair{".brep", DocumentFormat::Brep}, std::pair{".gltf", DocumentFormat::Gltf},
      std::pair{".glb", DocumentFormat::Gltf},  std::pair{".3mf", DocumentFormat::ThreeMf},
      std::pair{".urdf", DocumentFormat::Urdf}};
  for (const auto& [known, format] : kExtensions)
    if (extension == known) return format;
  return std::nullopt;
}

}  // namespace

ImportOptions parseImportOptions(int argc, char** argv) {
  ImportOptions options;
  for (Arguments arguments(argc, argv); !arguments.isAtEnd();)
    takeOption(arguments.take(), arguments, options);
  const auto isTolerance = [](double x) { return std::isfinite(x) && x >= 0.0; };
  if (!isTolerance(options.tessellation.chord) || !isTolerance(options.tessellation.angle))
    throw UsageError("--chord, --angle", "a tolerance is negative or not finite", "give 0 for the default");
  if (!options.isVersionAsked && !options.triesSandbox && options.file.empty())
    throw UsageError("nearfit-import", "no file is given", "nearfit starts this program by itself");
  return options;
}

bool ImportJob::wants(const std::string& key) const {
  return onlyShapes.empty() || std::ranges::find(onlyShapes, key) != onlyShapes.end();
}

ImportJob openJob(const ImportOptions& options) {
  ImportJob job;
  job.file = options.file;
  job.tessellation = options.tessellation;
  job.onlyShapes = options.onlyShapes;
  std::filesystem::path name = options.file.filename();
  InputFile input(options.file);
  if (input.size() > kMaxFileBytes)
    throw FileError(options.file.string(), "it is larger than 4 GiB", "export a part of the assembly");
  job.bytes = input.readAll();
  job.sha256 = sha256OfBytes(job.bytes);
  if (isGzip(job.bytes)) {
    job.bytes = gunzip(job.bytes, options.file.string(), kMaxUnpackedBytes);
    job.wasPacked = true;
    if (lowerCase(name.extension().string()) == ".gz") name = name.stem();
  }
  const std::optional<DocumentFormat> format = formatOfExtension(lowerCase(name.extension().string()));
  if (!format) {
    throw FileError(options.file.string(), "its name does not say which format it has",
                    "rename it to end in .step, .iges, .brep, .gltf, .glb, .3mf or .urdf");
  }
  if (job.bytes.empty()) throw FileError(options.file.string(), "it is empty", "export or copy it again");
  job.format = *format;
  job.stem = name.stem().string();
  return job;
}

std::vector<std::filesystem::path> readablePaths(const ImportJob& job) {
  switch (job.format) {
    case DocumentFormat::Gltf:
      // Its buffers lie beside it, and it may be a link to a file elsewhere.
      return {std::filesystem::absolute(job.file).parent_path(), std::filesystem::canonical(job.file)};
    case DocumentFormat::Urdf:
      return UrdfFiles(job.file, {job.bytes.data(), job.bytes.size()}).folders();
    default:
      return {};
  }
}

}  // namespace nearfit::importer
