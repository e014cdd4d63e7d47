#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/path/certificate.h"
#include "core/path/path_certifier.h"
#include "core/path/path_file.h"
#include "core/path/path_verifier.h"
#include "core/scene/scene_file.h"
#include "core/text/json_text.h"

namespace nearfit::cli {
namespace {

using VerdictJson = nlohmann::ordered_json;

struct CertifyOptions {
  std::string path, scene, out;
  std::optional<double> separation;
  bool isJson = false;
};

constexpr const char* kCertifyFooter =
    "Proves that everywhere on the path, not only at its poses, the surfaces of what moves and of all other\n"
    "visible parts are at least the separation apart, and that none is inside another. A path is refused "
    "where\n"
    "it comes nearer than 17/16 of the separation. The certificate holds the path, hashes of the scene file "
    "and\n"
    "of all meshes, the bounds of the proof, and where scene and path file are from its own folder on;\n"
    "nearfit-cli verify CERT proves it anew.\n"
    "Exit code 3, and no certificate, if the path is not proven free; the first such place is printed.\n"
    "Example: nearfit-cli certify in.nfpath fit.nearfit -o in.nfcert --separation 1e-5";

/// Throws UsageError if an output would replace an input.
void checkCertificateTarget(const CertifyOptions& options, const Scene& scene) {
  std::vector<std::filesystem::path> inputs = partFiles(scene);
  inputs.insert(inputs.end(), {options.path, options.scene});
  checkTarget(options.out, inputs);
}

void printVerdict(const VerdictJson& verdict, const std::string& sentence, bool isJson) {
  printCacheWarnings();
  print(isJson ? prettyJson(verdict) : oneLine(sentence) + "\n");
  flushOutput();
}

VerdictJson unprovenJson(const Scene& scene, const UnprovenPlace& place, double separation) {
  return {{"free", false},
          {"separation", separation},
          {"time", place.time},
          {"part", scene.get(place.part).name},
          {"other", scene.get(place.other).name},
          {"distance", place.distance},
          {"inside", place.isInside}};
}

std::string unprovenSentence(const Scene& scene, const UnprovenPlace& place, double separation) {
  const std::string &part = scene.get(place.part).name, &other = scene.get(place.other).name;
  if (place.isInside) {
    return fmt::format(
        "not certified: \"{}\" meets \"{}\", or one is inside the other, at the start of the path", part,
        other);
  }
  return fmt::format(
      "not certified: at {:.6g} s \"{}\" and \"{}\" are {:.6g} m apart, which does not prove {:.6g} m",
      place.time, part, other, place.distance, separation);
}

void runCertify(const CertifyOptions& options) {
  if (options.separation) checkPositive("--separation", *options.separation);
  if (!isJsonFile(options.path))
    throw FileError(options.path, "it is not a path file",
                    "make one of a recording (nearfit-cli path RECORDING SCENE -o OUT.nfpath)");
  const std::string pathFileSha256 = sha256OfFile(options.path);
  const AssemblyPath path = readPathFile(options.path);
  const std::string sceneSha256 = sha256OfFile(options.scene);
  const Scene scene = readSceneFile(options.scene);
  checkCertificateTarget(options, scene);
  const double separation = options.separation ? *options.separation : defaultSeparation(scene, path);
  const PathProof proof = PathCertifier(scene, path, separation).prove(path);
  if (!proof.isFree()) {
    printVerdict(unprovenJson(scene, *proof.unproven, separation),
                 unprovenSentence(scene, *proof.unproven, separation), options.isJson);
    throw NegativeVerdict();
  }
  Certificate certificate = certificateOf(scene, path, proof, sceneSha256);
  certificate.sceneFile = certifiedName(options.scene, options.out);
  certificate.pathFile = certifiedName(options.path, options.out);
  certificate.pathFileSha256 = pathFileSha256;
  atomicWrite(options.out, certificateText(certificate));
  std::size_t stretches = 0;
  for (const PairProof& pair : proof.pairs)
    stretches += pair.stretches.size();
  printVerdict(
      {{"free", true},
       {"separation", separation},
       {"poses", path.poses.size()},
       {"pairs", proof.pairs.size()},
       {"stretches", stretches},
       {"certificate", options.out}},
      fmt::format("certified: {} poses keep {:.6g} m from each other part, by {} stretches of {} pairs",
                  path.poses.size(), separation, stretches, proof.pairs.size()),
      options.isJson);
}

struct VerifyOptions {
  std::string certificate, scene, path;
  bool isWithoutPath = false, isJson = false;
};

constexpr const char* kVerifyFooter =
    "Proves the certificate anew, by code that shares no search with what made it, and checks that scene "
    "file,\n"
    "meshes, poses and path are those that it is about. Where SCENE or PATH is not given, the files that "
    "the\n"
    "certificate names are taken, from its folder on; they count only if their hashes are those in it.\n"
    "--no-path checks no path file: what the certificate says of the path is proven all the same.\n"
    "Exit code 3 if anything differs or is not proven; what it is is printed.\n"
    "Example: nearfit-cli verify in.nfcert";

/// Throws NegativeVerdict after saying why.
[[noreturn]] void refuse(const std::string& problem, bool isJson) {
  printVerdict({{"verified", false}, {"problem", problem}}, "refused: " + problem, isJson);
  throw NegativeVerdict();
}

/// Calls `read`. What is wrong with a file's content is a reason to refuse.
template <class Read>
auto orRefuse(const Read& read, bool isJson) -> decltype(read()) {
  try {
    return read();
  } catch (const FileError& e) {
    refuse(e.what(), isJson);
  }
}

/// The file that the certificate names. Throws FileError, with what to give instead, unless an ordinary file is there.
std::filesystem::path namedInput(const VerifyOptions& options, const std::string& name, const char* instead) {
  const std::filesystem::path file = fileOfCertifiedName(name, options.certificate);
  try {
    static_cast<void>(InputFile(file));
  } catch (const FileError& e) {
    throw FileError(e.where(), "the certificate names this file, and " + e.problem(), instead);
  }
  return file;
}

/// The scene to prove the certificate in. Throws UsageError if neither names one.
std::filesystem::path sceneToVerify(const VerifyOptions& options, const Certificate& certificate) {
  if (!options.scene.empty()) return options.scene;
  if (!certificate.sceneFile.empty())
    return namedInput(options, certificate.sceneFile,
                      "say where the scene is: nearfit-cli verify CERT SCENE");
  throw UsageError(options.certificate,
                   certificate.sceneSha256.empty()
                       ? "it holds no hash of a scene file: the scene was not saved when it was made"
                       : "it does not name its scene file",
                   "give the scene: nearfit-cli verify CERT SCENE");
}

/// Hash of the scene file, or a refusal if it is not the certified one.
std::string checkedSceneHash(const std::filesystem::path& scene, const Certificate& certificate,
                             bool isJson) {
  const bool isTooLarge = InputFile(scene).size() > kMaxSceneFileBytes;
  const std::string sha256 = isTooLarge ? std::string() : sha256OfFile(scene);
  if (isTooLarge || (!certificate.sceneSha256.empty() && certificate.sceneSha256 != sha256))
    refuse("the scene file is not the one that was certified: its bytes differ", isJson);
  return sha256;
}

/// The path file's path, or std::nullopt if none is to be checked; a refusal if it is not the certified one.
std::optional<AssemblyPath> pathToVerify(const VerifyOptions& options, const Certificate& certificate) {
  std::filesystem::path file = options.path;
  if (file.empty()) {
    if (options.isWithoutPath || certificate.pathFile.empty()) return std::nullopt;
    file =
        namedInput(options, certificate.pathFile,
                   "say where the path is: nearfit-cli verify CERT SCENE PATH; or leave it out: --no-path");
  }
  // A file that is not there is a failure, not a verdict.
  static_cast<void>(InputFile(file));
  AssemblyPath path = orRefuse([&] { return readPathFile(file); }, options.isJson);
  if (!certificate.pathFileSha256.empty() && sha256OfFile(file) != certificate.pathFileSha256)
    refuse("the path file is not the one that was certified: its bytes differ", options.isJson);
  return path;
}

void runVerify(const VerifyOptions& options) {
  const std::vector<char> text = readWholeFile(options.certificate);
  const Certificate certificate = orRefuse(
      [&] { return parseCertificate({text.data(), text.size()}, options.certificate); }, options.isJson);
  const std::filesystem::path sceneFile = sceneToVerify(options, certificate);
  const std::optional<AssemblyPath> path = pathToVerify(options, certificate);
  const std::string sceneSha256 = checkedSceneHash(sceneFile, certificate, options.isJson);
  std::vector<std::filesystem::path> changed;
  const Scene scene = readSceneFile(sceneFile, {}, &changed);
  if (!changed.empty()) refuse("the mesh file " + changed.front().string() + " was changed", options.isJson);
  const Verification verified = verifyCertificate(certificate, scene, sceneSha256, path);
  if (!verified.isProven()) refuse(verified.problem, options.isJson);
  // Without it names, meshes and places of all parts, to the last bit, say that the scene is the same.
  const bool hasSceneHash = !certificate.sceneSha256.empty();
  printVerdict(
      {{"verified", true},
       {"separation", certificate.separation},
       {"poses", certificate.path.poses.size()},
       {"stretches", verified.stretches},
       {"scene_file_hashed", hasSceneHash},
       {"path_file_checked", path.has_value()}},
      fmt::format("verified: {} poses keep {:.6g} m from each other part, by {} stretches proven anew{}",
                  certificate.path.poses.size(), certificate.separation, verified.stretches,
                  hasSceneHash ? "" : "; the certificate holds no hash of a scene file, but of all meshes"),
      options.isJson);
}

}  // namespace

void addCertifyCommand(CLI::App& program) {
  const auto options = std::make_shared<CertifyOptions>();
  CLI::App* command = program.add_subcommand(
      "certify", "Proves that a path keeps a separation from all other parts, and writes a certificate.");
  command->add_option("path", options->path, "Path file (*.nfpath)")->required()->type_name("PATH");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("-o,--out", options->out, "Certificate to write")->required()->type_name("CERT.nfcert");
  command->add_option("--separation", options->separation,
                      "Distance to keep [m]; default: a millionth of the part, at most 1 um");
  command->add_flag("--json", options->isJson, "Print the verdict as one JSON object");
  command->footer(kCertifyFooter);
  command->callback([options] { runCertify(*options); });
}

void addVerifyCommand(CLI::App& program) {
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App* command = program.add_subcommand("verify", "Proves the certificate of a path anew.");
  command->add_option("certificate", options->certificate, "Certificate (*.nfcert)")
      ->required()
      ->type_name("CERT");
  command->add_option("scene", options->scene, "Scene file (*.nearfit); default: the one that it names")
      ->type_name("SCENE");
  CLI::Option* path = command->add_option("path", options->path,
                                          "Path file that it must be about; default: the one that it names");
  path->type_name("PATH");
  command->add_flag("--no-path", options->isWithoutPath, "Check no path file")->excludes(path);
  command->add_flag("--json", options->isJson, "Print the verdict as one JSON object");
  command->footer(kVerifyFooter);
  command->callback([options] { runVerify(*options); });
}

}  // namespace nearfit::cli
