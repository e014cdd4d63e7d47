#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/report/html/clearance_plot.h"
#include "core/report/html/page_sections.h"

namespace nearfit {
namespace {

/// Names are listed up to this number in a sentence.
constexpr std::size_t kMaxNamed = 20;

void putPlot(ReportPageWriter& page, const FitReportRequest& request, const PathFindings& path) {
  std::vector<double> times;
  for (const PathPose& pose : path.path.poses)
    times.push_back(pose.time);
  ClearancePlot plot{times, {}, path.range, {}};
  for (const PathClearance& clearance : path.clearances)
    plot.curves.push_back({request.scene.get(clearance.other).name, clearance.distances});
  if (path.isProven()) plot.separation = request.certificate->separation;
  page.element("figure", [&] {
    putClearancePlot(plot, page);
    page.add(
        "figcaption",
        fmt::format(
            "Clearance at the poses to the nearest {} of {} within {}. Gaps: farther away. Of more than {} "
            "poses the least in each stretch of time is drawn.",
            nearestCurves(plot).size(), countOf(plot.curves.size(), "part", "parts"), mmText(path.range),
            kMaxPlotPoints));
  });
}

void putCertificate(ReportPageWriter& page, const Certificate& certificate,
                    const Verification& verification) {
  page.add("h3", "Certificate");
  if (verification.isProven()) {
    page.sentence(
        fmt::format("Proven anew for this report: everywhere on the path, also between its poses, the "
                    "surfaces of what moves and of "
                    "all other visible parts are at least {} apart, and none is inside another. Verified "
                    "in {} of {}, by code that shares no "
                    "search with what made the certificate.",
                    mmText(certificate.separation), countOf(verification.stretches, "stretch", "stretches"),
                    countOf(certificate.pairs.size(), "pair", "pairs")));
  } else {
    page.element("p", {{"class", "verdict bad"}}, [&] {
      page.put("The certificate is refused: ");
      page.putName(verification.problem);
      page.put(". It proves nothing here.");
    });
  }
  page.element("dl", [&] {
    page.term("Separation", [&] { page.putLength(certificate.separation); });
    page.term("Made with", [&] { page.putName(certificate.program); });
    if (!certificate.sceneSha256.empty()) page.term("Scene", [&] { page.putHash(certificate.sceneSha256); });
  });
  std::size_t stretches = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const CertifiedPair& pair : certificate.pairs) {
    stretches += pair.stretches.size();
    for (const ProvenStretch& stretch : pair.stretches)
      least = std::min(least, stretch.bound);
  }
  if (stretches > 0)
    page.sentence(fmt::format("Least bound of its {}: {} between surfaces at the anchor.",
                              countOf(stretches, "stretch", "stretches"), mmText(least)));
  const std::size_t shown = std::min(certificate.parts.size(), kMaxPartRows);
  page.table({"Certified part", "Moves", "SHA-256 of its mesh"}, [&] {
    for (std::size_t i = 0; i < shown; ++i) {
      page.element("tr", [&] {
        page.cell([&] { page.putName(certificate.parts[i].name); });
        page.textCell(certificate.parts[i].isMoving ? "yes" : "no");
        page.cell([&] { page.putHash(certificate.parts[i].meshSha256); });
      });
    }
  });
  page.leftOutNote(certificate.parts.size(), shown, "parts");
}

}  // namespace

void putPath(ReportPageWriter& page, const FitReportRequest& request, const PathFindings& path) {
  const std::vector<PathPose>& poses = path.path.poses;
  page.element("dl", [&] {
    page.term("Moves", [&] {
      const std::vector<std::string>& parts = path.path.parts;
      page.putList(parts.size(), kMaxNamed, ", ", [&](std::size_t i) { page.putName(parts[i]); });
    });
    page.textTerm("Poses", fmt::format("{}, from {:.6g} s to {:.6g} s", poses.size(), poses.front().time,
                                       poses.back().time));
    if (path.least) {
      page.term("Least clearance", [&] {
        page.putLength(path.least->distance);
        page.put(" to ");
        page.putPart(path.least->other);
        page.put(fmt::format(" at {:.6g} s, at the poses", path.least->time));
      });
    }
  });
  if (!path.clearances.empty()) putPlot(page, request, path);
  if (path.clearances.empty() && path.range > 0.0)
    page.sentence(fmt::format("No other part comes within {} at the poses.", mmText(path.range)));
  if (path.verification) putCertificate(page, *request.certificate, *path.verification);
}

}  // namespace nearfit
