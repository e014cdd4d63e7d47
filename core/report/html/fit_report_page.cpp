#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/report/html/fit_report.h"
#include "core/report/html/page_sections.h"
#include "core/report/html/report_page_writer.h"
#include "core/report/html/report_pictures.h"
#include "core/report/scene_check_export.h"

namespace nearfit {
namespace {

void putHeader(ReportPageWriter& page, const FitReportRequest& request) {
  page.element("h1", [&] {
    page.put("Fit report: ");
    page.putName(request.title);
  });
  const ReportOrigin& origin = request.origin;
  page.element("dl", [&] {
    page.textTerm("Date", origin.date);
    if (!origin.author.empty()) page.term("Made by", [&] { page.putName(origin.author); });
    page.textTerm("With", origin.program);
  });
}

/// Where nothing was judged the page is neither green nor red.
const char* verdictClass(const FitReport& report) {
  if (!report.isGood()) return "verdict bad";
  return report.check.checkedPairs() > 0 || report.path ? "verdict good" : "verdict";
}

void putSummary(ReportPageWriter& page, const FitReportRequest& request, const FitReport& report) {
  const SceneCheck& check = report.check;
  page.add("p", {{"class", verdictClass(report)}}, verdictSentence(request, report));
  page.table(
      {"Parts", "Pairs checked", "Clear", "Near", "Touching", "Clash", "Contained", "Not allowed",
       "Left out"},
      [&] {
        page.element("tr", [&] {
          page.countCell(check.parts.size());
          page.countCell(check.checkedPairs());
          for (const PairVerdict verdict : {PairVerdict::Clear, PairVerdict::Near, PairVerdict::Touching,
                                            PairVerdict::Clash, PairVerdict::Contained})
            page.countCell(check.count(verdict));
          page.countCell(check.forbidden());
          page.countCell(check.leftOut.size());
        });
      });
  page.sentence(fmt::format(
      "Clear: farther apart than the threshold of {}. Near: apart, but nearer. Touching: within what "
      "rounding comes to. Clash: surfaces pass through each other. Contained: one part is inside the "
      "other. Not allowed: clashes and contained parts that no rule allows. Accepted ones do not count for "
      "the "
      "verdict as long as they are as they were accepted.",
      mmText(check.threshold)));
  const bool hasLast = std::ranges::any_of(
      report.findings, [](const ComparedFinding& finding) { return finding.before.has_value(); });
  if (!hasLast) return;
  const FindingChanges changes = changesIn(report.findings);
  if (changes.added + changes.worse + changes.better + changes.gone == 0)
    return page.sentence("Nothing has changed since the last check.");
  page.sentence(fmt::format(
      "Since the last check {} new, {} worse, {} better and {} gone. Changed: accepted by the user, and "
      "worse or of "
      "another verdict since.",
      countOf(changes.added, "finding is", "findings are"), changes.worse, changes.better, changes.gone));
}

void putScenePictures(ReportPageWriter& page, const ReportPictures& pictures) {
  if (pictures.all.front().scene.parts.empty())
    return page.sentence("No visible part has triangles to show.");
  page.element("div", {{"class", "figures"}}, [&] {
    for (std::size_t i = 0; i < kReportSides.size(); ++i)
      putFigure(page, pictures.all[i],
                fmt::format("The visible parts of the scene. {}", kReportSides[i].caption),
                kReportSides[i].caption);
  });
}

}  // namespace

std::string fitReportPage(const FitReportRequest& request, const FitReport& report,
                          const ProgressCallback& progress) {
  const std::vector<const ComparedFinding*> rows = findingsBySeverity(report.findings);
  const ReportPictures pictures = drawReportPictures(request, report, rows, progress);
  const Scene& scene = request.scene;
  ReportPageWriter page("Fit report: " + request.title, scene);
  page.element("header", [&] { putHeader(page, request); });
  page.element("main", [&] {
    page.section("summary", "Summary", [&] { putSummary(page, request, report); });
    page.section("pictures", "The scene", [&] { putScenePictures(page, pictures); });
    page.section("pairs", "Pairs of parts", [&] { putPairs(page, report.check, rows); });
    page.section("findings", "Findings in pictures", [&] { putFindings(page, scene, pictures, rows); });
    if (report.path) page.section("path", "Path", [&] { putPath(page, request, *report.path); });
    page.section("unchecked", "What was not checked", [&] { putUnchecked(page, request, report); });
    page.section("parts", "Parts", [&] { putParts(page, scene); });
    page.section("settings", "Settings and rules", [&] { putSettings(page, request, report); });
    page.section("inputs", "Inputs", [&] { putInputs(page, request); });
    page.section("versions", "Versions", [&] { putVersions(page, request.origin); });
  });
  return page.take();
}

}  // namespace nearfit
