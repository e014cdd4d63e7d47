#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/report/html/page_sections.h"

namespace nearfit {
namespace {

/// Writes an entry that names parts; none if there are none.
void namedEntry(ReportPageWriter& page, const std::string& text, const std::vector<std::string>& parts) {
  if (parts.empty()) return;
  page.element("li", [&] {
    page.put(text + ": ");
    page.putList(parts.size(), kMaxListedCases, ", ", [&](std::size_t i) { page.putName(parts[i]); });
    page.put(".");
  });
}

template <class Choose>
std::vector<std::string> namesWhere(const Scene& scene, const Choose& isChosen) {
  std::vector<std::string> chosen;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (part->isVisible && hasTriangles(*part) && isChosen(*part)) chosen.push_back(part->name);
  }
  return chosen;
}

template <class Choose>
void casesEntry(ReportPageWriter& page, const SceneCheck& check, const char* what, const Choose& isCase) {
  std::vector<PartPair> pairs;
  for (const PairFinding& finding : check.findings) {
    if (isCase(finding)) pairs.push_back(finding.pair);
  }
  if (pairs.empty()) return;
  page.element("li", [&] {
    page.put(fmt::format("{} with {}: ", countOf(pairs.size(), "pair", "pairs"), what));
    page.putList(pairs.size(), kMaxListedCases, "; ", [&](std::size_t i) { page.putPair(pairs[i]); });
    page.put(".");
  });
}

void putUncheckedParts(ReportPageWriter& page, const Scene& scene) {
  std::vector<std::string> hidden, withoutTriangles;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!part->isVisible) hidden.push_back(part->name);
    if (!hasTriangles(*part)) withoutTriangles.push_back(part->name);
  }
  namedEntry(page, fmt::format("{} hidden, not checked", countOf(hidden.size(), "part is", "parts are")),
             hidden);
  namedEntry(page, "Parts without triangles, not checked", withoutTriangles);
  namedEntry(page,
             "Meshes that are not closed, so that nothing can be found inside them and no volume is known",
             namesWhere(scene, [](const Part& part) { return !part.geometry->mesh.topology().isClosed(); }));
  namedEntry(
      page, "Meshes whose faces are not all turned outward alike",
      namesWhere(scene, [](const Part& part) { return !part.geometry->mesh.topology().isOriented(); }));
  namedEntry(page, "Meshes that differ from their files by repairs",
             namesWhere(scene, [](const Part& part) { return !part.geometry->repairs.empty(); }));
  double chord = 0.0;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (part->isVisible && part->geometry)
      chord = std::max(chord, part->geometry->effectiveTessellation.chord);
  }
  if (chord > 0.0)
    page.add("li", fmt::format("Triangles stand for exact surfaces, from which they are up to {} away; "
                               "distances are those of the "
                               "triangles.",
                               mmText(chord)));
}

void putUncheckedPairs(ReportPageWriter& page, const FitReport& report) {
  const SceneCheck& check = report.check;
  if (!check.leftOut.empty()) {
    page.element("li", [&] {
      page.put(fmt::format("Rules left out {} within the threshold: ",
                           countOf(check.leftOut.size(), "pair", "pairs")));
      page.putList(check.leftOut.size(), kMaxListedCases, "; ", [&](std::size_t i) {
        page.putPair(check.leftOut[i].pair);
        page.put(fmt::format(" (rule {})", check.leftOut[i].rule + 1));
      });
      page.put(".");
    });
  }
  page.add("li", fmt::format("How far pairs are apart beyond the threshold of {} was not measured.",
                             mmText(check.threshold)));
  casesEntry(page, check, "more minima than are kept",
             [](const PairFinding& f) { return !f.isEveryMinimum; });
  casesEntry(page, check, "surfaces that meet, whose other near places were not looked for",
             [](const PairFinding& f) { return f.verdict >= PairVerdict::Clash || f.distance == 0.0; });
  casesEntry(page, check, "a volume that is not known",
             [](const PairFinding& f) { return f.clash && !f.clash->volume; });
  casesEntry(page, check, "no known translation that frees the part",
             [](const PairFinding& f) { return f.clash && !f.clash->freeing; });
  casesEntry(page, check, "more curves than were searched",
             [](const PairFinding& f) { return f.clash && !f.clash->isEveryCurve; });
  if (findingsNotKept(report.findings) > 0)
    page.add("li", fmt::format("Not all of these findings can be kept for the next check: {}.",
                               notKeptText(report.findings)));
  std::size_t kept = 0;
  for (const ComparedFinding& finding : report.findings) {
    if (finding.now == nullptr && finding.change != FindingChange::Gone) ++kept;
  }
  if (kept > 0)
    page.add("li", fmt::format("{} of earlier checks were not checked this time, or were gone before.",
                               countOf(kept, "finding", "findings")));
}

void putUncheckedPath(ReportPageWriter& page, const FitReport& report) {
  if (!report.path) return page.add("li", "How the parts get to their places: no path was given.");
  const PathFindings& path = *report.path;
  if (!path.isProven()) page.add("li", "Between the poses of the path nothing is proven.");
  if (!path.verification) page.add("li", "No certificate of the path was given.");
  if (path.range == 0.0)
    page.add("li", "Clearance along the path of the refused certificate was not computed.");
}

}  // namespace

void putUnchecked(ReportPageWriter& page, const FitReportRequest& request, const FitReport& report) {
  page.element("ul", [&] {
    putUncheckedParts(page, request.scene);
    putUncheckedPairs(page, report);
    putUncheckedPath(page, report);
    page.add("li", "Parts are rigid; tolerances of manufacture, weight and heat are not considered.");
  });
}

}  // namespace nearfit
