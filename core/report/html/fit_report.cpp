#include "core/report/html/fit_report.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/files/atomic_write.h"
#include "core/files/sha256.h"
#include "core/path/path_bodies.h"
#include "core/path/path_file.h"

namespace nearfit {
namespace {

/// Share of the progress when pictures begin.
constexpr double kMade = 0.8;
/// Share of the check in the making of a report with a path.
constexpr double kCheckBesidePath = 0.6;
/// Clearances along a path are looked for up to this share of its parts' size: farther away nothing is near.
constexpr double kPathRangeShare = 0.05;
constexpr double kInMillimetres = 1e3;

PathFindings findPath(const FitReportRequest& request, const ProgressCallback& progress) {
  PathFindings found;
  found.path = request.path ? *request.path : request.certificate->path;
  if (request.certificate)
    found.verification = verifyCertificate(*request.certificate, request.scene, request.sceneSha256,
                                           request.path, stageCallback(progress, 0.0, 0.5));
  // The parts of a certificate that is not about this scene need not be in it.
  if (!request.path && !found.isProven()) return found;
  const double size = 2.0 * pathBodies(request.scene, found.path).radius;
  found.range = std::max(kPathRangeShare * size, request.check.threshold);
  found.clearances =
      clearancesAlong(request.scene, found.path, found.range, stageCallback(progress, 0.5, 1.0));
  found.least = leastOf(found.clearances, found.path);
  return found;
}

const std::string& nameOf(const FitReportRequest& request, PartId id) {
  return request.scene.get(id).name;
}

std::string clashSentence(const FitReportRequest& request, const FitReport& report) {
  const SceneCheck& check = report.check;
  const std::size_t pairs = check.checkedPairs(), forbidden = check.forbidden();
  const std::size_t accepted = acceptedIn(report.findings);
  if (pairs == 0) return "Nothing was judged: no two visible parts were to be checked";
  if (forbidden > accepted) {
    return fmt::format(
        "Does not fit: {} of {} clash, or one part is inside the other, and no rule allows it{}", forbidden,
        countOf(pairs, "pair", "pairs"),
        accepted > 0 ? fmt::format(" ({} accepted by the user)", accepted) : "");
  }
  if (forbidden > 0)
    return fmt::format(
        "Fits but for what the user has accepted: {} of {} clash, or one part is inside the other, and no "
        "rule "
        "allows it",
        forbidden, countOf(pairs, "pair", "pairs"));
  const auto allowed = check.count(PairVerdict::Clash) + check.count(PairVerdict::Contained);
  std::string sentence =
      allowed > 0
          ? fmt::format("Fits by its rules: they allow the clashes of {} of {}, and no other pair clashes",
                        allowed, countOf(pairs, "pair", "pairs"))
          : fmt::format("Fits: of {} none clashes", countOf(pairs, "pair", "pairs"));
  const auto nearest = std::ranges::min_element(check.findings, {}, [](const PairFinding& finding) {
    return finding.verdict >= PairVerdict::Clash ? std::numeric_limits<double>::infinity() : finding.distance;
  });
  if (nearest == check.findings.end() || nearest->verdict >= PairVerdict::Clash)
    return sentence + fmt::format("; all {}are farther apart than {:.6g} mm", allowed > 0 ? "others " : "",
                                  kInMillimetres * check.threshold);
  return sentence + fmt::format("; nearest are \"{}\" and \"{}\", {:.6g} mm apart",
                                nameOf(request, nearest->pair.part), nameOf(request, nearest->pair.other),
                                kInMillimetres * nearest->distance);
}

std::string pathSentence(const FitReportRequest& request, const PathFindings& path) {
  if (path.verification && !path.verification->isProven()) return " The certificate of the path is refused.";
  if (path.verification)
    return fmt::format(" The path is proven to keep {:.6g} mm from all other parts.",
                       kInMillimetres * request.certificate->separation);
  if (!path.least)
    return fmt::format(
        " At its poses the path stays {:.6g} mm from all other parts; between them nothing is proven.",
        kInMillimetres * path.range);
  if (path.least->distance == 0.0)
    return fmt::format(" The path meets \"{}\" at {:.6g} s.", nameOf(request, path.least->other),
                       path.least->time);
  return fmt::format(
      " At its poses the path comes no nearer than {:.6g} mm, to \"{}\"; between them nothing is proven.",
      kInMillimetres * path.least->distance, nameOf(request, path.least->other));
}

}  // namespace

std::string countOf(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

FitReportRequest fitReportRequest(const Scene& scene, const std::filesystem::path& file,
                                  const std::string& fileSha256, double threshold) {
  FitReportRequest request;
  request.title = file.empty() ? "Unnamed scene" : file.stem().string();
  request.scene = scene;
  request.check = sceneCheckRequest(scene, threshold);
  request.sceneSha256 = fileSha256;
  if (!file.empty()) request.inputs.push_back({"scene", file, fileSha256});
  request.origin = reportOrigin();
  const bool hasDocument = std::ranges::any_of(scene.parts(), [](const Scene::PartPtr& part) {
    return part->geometry && !part->geometry->shapeKey.empty();
  });
  if (hasDocument) request.origin.importer = importerOfReport();
  return request;
}

void addPath(FitReportRequest& request, const std::filesystem::path& file) {
  const std::string sha256 = sha256OfFile(file);
  request.path = readPathFile(file);
  request.inputs.push_back({"path", file, sha256});
}

void addCertificate(FitReportRequest& request, const std::filesystem::path& file) {
  const std::vector<char> text = readCertificateFile(file);
  request.certificate = parseCertificate({text.data(), text.size()}, file);
  request.inputs.push_back({"certificate", file, sha256OfBytes(text)});
}

bool FitReport::isGood() const noexcept {
  const bool isRefused = path && path->verification && !path->verification->isProven();
  const bool isMeeting = path && path->least && path->least->distance == 0.0;
  return check.forbidden() == acceptedIn(findings) && !isRefused && !isMeeting;
}

FitReport makeFitReport(const FitReportRequest& request, const ProgressCallback& progress) {
  FitReport report;
  const bool hasPath = request.path || request.certificate;
  const double checked = hasPath ? kCheckBesidePath : 1.0;
  report.check = checkScene(request.check, stageCallback(progress, 0.0, checked));
  report.findings = compareFindings(report.check, request.scene.pairRecords());
  if (hasPath) report.path = findPath(request, stageCallback(progress, checked, 1.0));
  return report;
}

std::string verdictSentence(const FitReportRequest& request, const FitReport& report) {
  return clashSentence(request, report) + "." + (report.path ? pathSentence(request, *report.path) : "");
}

FitReportOutcome writeFitReport(const FitReportRequest& request, const std::filesystem::path& file,
                                const ProgressCallback& progress) {
  // Not after minutes of work.
  checkReplaceable(file);
  const FitReport report = makeFitReport(request, stageCallback(progress, 0.0, kMade));
  atomicWrite(file, fitReportPage(request, report, stageCallback(progress, kMade, 1.0)));
  return {report.isGood(), verdictSentence(request, report)};
}

}  // namespace nearfit
