#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "core/path/path_certification.h"
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

void printVerdict(const VerdictJson& verdict, const std::string& sentence, bool isJson) {
  printCacheWarnings();
  print(isJson ? prettyJson(verdict) : oneLine(sentence) + "\n");
  flushOutput();
}

VerdictJson unprovenJson(const PathCertification& found) {
  const UnprovenPlace& place = *found.unproven;
  return {{"free", false},           {"separation", found.separation}, {"time", place.time},
          {"part", found.part},      {"other", found.other},           {"distance", place.distance},
          {"inside", place.isInside}};
}

std::string unprovenSentence(const PathCertification& found) {
  const UnprovenPlace& place = *found.unproven;
  if (place.isInside) {
    return fmt::format(
        "not certified: \"{}\" meets \"{}\", or one is inside the other, at the start of the path",
        found.part, found.other);
  }
  return fmt::format(
      "not certified: at {:.6g} s \"{}\" and \"{}\" are {:.6g} m apart, which does not prove {:.6g} m",
      place.time, found.part, found.other, place.distance, found.separation);
}

void runCertify(const CertifyOptions& options) {
  if (options.separation) checkPositive("--separation", *options.separation);
  const PathCertification found = certifyPathFile(
      {.path = options.path, .scene = options.scene, .certificate = options.out}, options.separation);
  if (!found.isFree()) {
    printVerdict(unprovenJson(found), unprovenSentence(found), options.isJson);
    throw NegativeVerdict();
  }
  printVerdict(
      {{"free", true},
       {"separation", found.separation},
       {"poses", found.poses},
       {"pairs", found.pairs},
       {"stretches", found.stretches},
       {"certificate", options.out}},
      fmt::format("certified: {} poses keep {:.6g} m from each other part, by {} stretches of {} pairs",
                  found.poses, found.separation, found.stretches, found.pairs),
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

void runVerify(const VerifyOptions& options) {
  const PathVerification found = verifyCertificateFile({.certificate = options.certificate,
                                                        .scene = options.scene,
                                                        .path = options.path,
                                                        .isWithoutPath = options.isWithoutPath});
  if (!found.isProven()) {
    printVerdict({{"verified", false}, {"problem", found.problem}}, "refused: " + found.problem,
                 options.isJson);
    throw NegativeVerdict();
  }
  // Without it names, meshes and places of all parts, to the last bit, say that the scene is the same.
  printVerdict(
      {{"verified", true},
       {"separation", found.separation},
       {"poses", found.poses},
       {"stretches", found.stretches},
       {"scene_file_hashed", found.hasSceneHash},
       {"path_file_checked", found.isPathChecked}},
      fmt::format(
          "verified: {} poses keep {:.6g} m from each other part, by {} stretches proven anew{}", found.poses,
          found.separation, found.stretches,
          found.hasSceneHash ? "" : "; the certificate holds no hash of a scene file, but of all meshes"),
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
