#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/path/assembly_path.h"
#include "core/path/certificate.h"
#include "core/path/path_clearance.h"
#include "core/path/path_verifier.h"
#include "core/report/html/report_origin.h"
#include "core/scene/scene.h"
#include "core/verdict/finding_states.h"
#include "core/verdict/scene_check.h"

namespace nearfit {

/// A file that a report is made from.
struct ReportInput {
  std::string kind;  ///< "scene", "path", "certificate".
  std::filesystem::path file;
  std::string sha256;  ///< Empty: the scene is not what its file holds.
};

/// Number of findings that a report has pictures of, if nothing else is asked for.
constexpr std::size_t kDefaultPicturedFindings = 30;

/// Input of a report.
struct FitReportRequest {
  std::string title;  ///< The scene's name.
  Scene scene;        ///< With all parts where they are.
  SceneCheckRequest check;
  std::vector<ReportInput> inputs;
  std::string sceneSha256;           ///< SHA-256 of the scene's file; empty if the scene differs from it.
  std::optional<AssemblyPath> path;  ///< Given as a file of its own.
  std::optional<Certificate> certificate;
  std::size_t maxPictured = kDefaultPicturedFindings;  ///< The worst findings get pictures; 0: each.
  ReportOrigin origin;
};

/// A request for a report of a scene's visible parts by its own rules.
/// @param file          Of the scene; empty if it has none.
/// @param fileSha256    Empty if the scene is not what the file holds.
/// @param threshold     As for a check [m].
FitReportRequest fitReportRequest(const Scene& scene, const std::filesystem::path& file,
                                  const std::string& fileSha256, double threshold);

/// Adds the path of a path file. Throws FileError.
void addPath(FitReportRequest& request, const std::filesystem::path& file);
/// Adds a certificate, and its path where none was given. Throws FileError, also if the certificate was changed.
void addCertificate(FitReportRequest& request, const std::filesystem::path& file);

/// Findings about the path of a report.
struct PathFindings {
  AssemblyPath path;
  double range = 0.0;  ///< Distances are looked for up to this [m].
  std::vector<PathClearance>
      clearances;  ///< At the poses; empty if a refused certificate alone has the path.
  std::optional<LeastPathClearance> least;   ///< No value if nothing is within the range.
  std::optional<Verification> verification;  ///< Of the certificate, proven anew for this report.

  bool isProven() const noexcept { return verification && verification->isProven(); }
};

/// All that a report says, before it is written. Not copied: findings are kept by pointer.
struct FitReport {
  FitReport() = default;
  FitReport(FitReport&&) = default;
  FitReport& operator=(FitReport&&) = default;
  FitReport(const FitReport&) = delete;
  FitReport& operator=(const FitReport&) = delete;
  ~FitReport() = default;

  SceneCheck check;
  std::vector<ComparedFinding> findings;
  std::optional<PathFindings> path;

  /// True if no clash is forbidden but those that the user has accepted as they are, no pose of the path meets a part, and
  /// no certificate was refused.
  bool isGood() const noexcept;
};

/// "1 pair", "3 pairs".
std::string countOf(std::size_t count, const char* one, const char* several);

/// Checks the scene, finds clearances along the path, proves the certificate anew. On all processors. Throws UsageError
/// as checkScene() and pathBodies(); Cancelled.
FitReport makeFitReport(const FitReportRequest& request, const ProgressCallback& progress = {});

/// The verdict in one sentence.
std::string verdictSentence(const FitReportRequest& request, const FitReport& report);

/// Limits on what a report shows, so that a browser opens it; it says what is left out.
constexpr std::size_t kMaxFindingRows = 1000, kMaxPartRows = 2000, kMaxListedCases = 200;

/// The report as one HTML5 document that needs nothing else, for screen and paper. The same for the same request and
/// report. Draws the pictures, on all processors. Throws Cancelled.
std::string fitReportPage(const FitReportRequest& request, const FitReport& report,
                          const ProgressCallback& progress = {});

/// Outcome of a report that was written.
struct FitReportOutcome {
  bool isGood = true;  ///< FitReport::isGood().
  std::string sentence;
};

/// Makes a report and writes it atomically. Throws like makeFitReport(); FileError.
FitReportOutcome writeFitReport(const FitReportRequest& request, const std::filesystem::path& file,
                                const ProgressCallback& progress = {});

}  // namespace nearfit
