#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/progress_line.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/sha256.h"
#include "core/path/path_file.h"
#include "core/report/html/fit_report.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct ReportOptions {
  std::string scene, path, certificate, threshold, author, out;
  std::size_t pictures = kDefaultPicturedFindings;
};

constexpr const char* kReportFooter =
    "Checks all pairs of visible parts by the scene's rules, as clearance --all does, and writes one HTML "
    "file\n"
    "that needs nothing else, for screen and paper: the verdict, pictures of the scene and of the worst "
    "findings,\n"
    "tables of pairs and parts, the path with its clearance, the certificate proven anew, rules and "
    "settings,\n"
    "versions, SHA-256 of all inputs, and what was not checked. No window or display is needed.\n"
    "The verdict is printed. Exit code 3, and the report all the same, if there is a clash that no rule "
    "allows\n"
    "and that was not accepted as it is, if the path meets a part at a pose, or if the certificate is "
    "refused.\n"
    "Example: nearfit-cli report pump.nearfit --path in.nfpath --certificate in.nfcert -o pump.html";

/// Throws UsageError if the report would replace an input.
void checkReportTarget(const ReportOptions& options, const Scene& scene) {
  std::vector<std::filesystem::path> inputs = partFiles(scene);
  inputs.emplace_back(options.scene);
  for (const std::string& file : {options.path, options.certificate}) {
    if (!file.empty()) inputs.emplace_back(file);
  }
  checkTarget(options.out, inputs);
}

FitReportRequest requestFor(const ReportOptions& options, const Scene& scene,
                            const std::string& sceneSha256) {
  double threshold = scene.haptics().springs.cutoff;
  if (!options.threshold.empty()) threshold = parseLength("--threshold", options.threshold);
  checkPositive("--threshold", threshold, true);
  FitReportRequest request = fitReportRequest(scene, options.scene, sceneSha256, threshold);
  if (!options.author.empty()) request.origin.author = options.author;
  request.maxPictured = options.pictures;
  if (!options.path.empty()) {
    if (!isJsonFile(options.path))
      throw FileError(options.path, "it is not a path file",
                      "make one of a recording (nearfit-cli path RECORDING SCENE -o OUT.nfpath)");
    addPath(request, options.path);
  }
  if (!options.certificate.empty()) addCertificate(request, options.certificate);
  return request;
}

void runReport(const ReportOptions& options) {
  const InterruptGuard interrupt;
  std::optional<FitReportOutcome> outcome;
  {
    ProgressLine line("reporting");
    const std::string sceneSha256 = sha256OfFile(options.scene);
    const Scene scene = readSceneFile(options.scene, [](double) { return !InterruptGuard::isInterrupted(); });
    checkReportTarget(options, scene);
    outcome = writeFitReport(requestFor(options, scene, sceneSha256), options.out, [&line](double fraction) {
      line.show(fraction);
      return !InterruptGuard::isInterrupted();
    });
  }
  printCacheWarnings();
  print(oneLine(outcome->sentence) + "\n");
  flushOutput();
  if (!outcome->isGood) throw NegativeVerdict();
}

}  // namespace

void addReportCommand(CLI::App& program) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      program.add_subcommand("report", "Checks a scene and writes a report with pictures, as one HTML file.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("--path", options->path, "Path file (*.nfpath) to report on")->type_name("FILE");
  command
      ->add_option("--certificate", options->certificate, "Certificate (*.nfcert) of the path, to prove anew")
      ->type_name("FILE");
  command
      ->add_option("--threshold", options->threshold,
                   "Find pairs no farther apart [m, or with a unit]; default: the scene's cutoff")
      ->type_name("D");
  command
      ->add_option("--pictures", options->pictures, "Findings to show in pictures, the worst first; 0: each")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  command->add_option("--author", options->author, "Who made the report; default: the user's name here")
      ->type_name("NAME");
  command->add_option("-o,--out", options->out, "Report to write")->required()->type_name("OUT.html");
  command->footer(kReportFooter);
  command->callback([options] { runReport(*options); });
}

}  // namespace nearfit::cli
