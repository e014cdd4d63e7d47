#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/report/html/page_sections.h"
#include "core/verdict/finding_states.h"
#include "core/verdict/pair_rules.h"

namespace nearfit {
namespace {

/// Findings of the last check, where this one finds something else.
void putBefore(ReportPageWriter& page, const std::optional<PairRecord>& before) {
  if (!before) return;
  page.put(fmt::format(", was {}", wordOf(before->verdict)));
  if (before->verdict == PairVerdict::Near || before->depth) {
    page.put(", ");
    page.putLength(before->depth.value_or(before->distance));
  }
}

void putVolume(ReportPageWriter& page, const PairFinding& finding) {
  if (!finding.clash) return;
  if (finding.clash->volume) {
    page.putNumber(*finding.clash->volume, fmt::format("{:.5g} mm³", 1e9 * *finding.clash->volume));
  } else {
    page.put(textOf(finding.clash->volumeProblem));
  }
}

void putPairRow(ReportPageWriter& page, const SceneCheck& check, std::size_t number,
                const ComparedFinding& row) {
  const PairFinding* now = row.now;
  page.countCell(number);
  page.cell([&] { page.putPair(row.pair); });
  page.cell([&] {
    page.putVerdict(now != nullptr ? now->verdict : PairVerdict::Clear);
    if (now == nullptr) page.put(" (gone)");
  });
  page.numberCell([&] {
    if (now != nullptr) page.putLength(now->distance);
  });
  page.numberCell([&] {
    if (now == nullptr || !now->depth()) return;
    if (!now->clash->isDepthExact) page.put("≤ ");
    page.putLength(*now->depth());
  });
  page.numberCell([&] {
    if (now != nullptr) putVolume(page, *now);
  });
  page.cell([&] {
    if (now != nullptr && now->allowedBy) page.putRule(check.rules[*now->allowedBy]);
    if (now != nullptr && now->isForbidden()) page.put("not allowed");
  });
  page.cell([&] {
    const std::string_view state = stateWord(row.state, row.reason), change = wordOf(row.change);
    page.put(state);
    if (change != state)
      page.put(row.change == FindingChange::Same ? ", as before" : fmt::format(", {}", change));
    if (row.change != FindingChange::Same) putBefore(page, row.before);
    if (row.reason.empty()) return;
    page.put(": ");
    page.putName(row.reason);
  });
}

void putMeasures(ReportPageWriter& page, const PairFinding& finding) {
  page.put("Distance ");
  page.putLength(finding.distance);
  const auto place = [&](const glm::dvec3& p) {
    page.put(fmt::format("({:.6g}, {:.6g}, {:.6g}) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z));
  };
  if (!finding.clash) {
    page.put(", from ");
    place(finding.partPoint);
    page.put(" to ");
    place(finding.otherPoint);
    if (finding.verdict == PairVerdict::Near)
      page.put(fmt::format("; {}{} within the threshold", finding.isEveryMinimum ? "" : "more than ",
                           countOf(finding.minima.size(), "minimum", "minima")));
  }
  if (finding.depth()) {
    // Rounding leaves traces in components that are 0.
    constexpr double kNothing = 1e-9;
    const auto said = [](double x) { return std::abs(x) < kNothing ? 0.0 : x; };
    const glm::dvec3& direction = finding.clash->freeing->direction;
    page.put(finding.clash->isDepthExact ? "; depth " : "; depth at most ");
    page.putLength(*finding.depth());
    page.put(fmt::format(", along ({:.4g}, {:.4g}, {:.4g})", said(direction.x), said(direction.y),
                         said(direction.z)));
  }
  if (finding.clash && finding.clash->volume) {
    page.put("; shared volume ");
    putVolume(page, finding);
  }
  page.put(".");
}

void putFinding(ReportPageWriter& page, const Scene& scene, const ReportPictures& pictures,
                std::size_t number, const PicturedFinding& pictured) {
  const PairFinding& finding = *pictured.finding->now;
  const std::string parts =
      fmt::format("“{}” and “{}”", scene.get(finding.pair.part).name, scene.get(finding.pair.other).name);
  page.element("h3", [&] {
    page.put(fmt::format("{}. ", number));
    page.putPair(finding.pair);
    page.put(": ");
    page.putVerdict(finding.verdict);
  });
  page.element("p", [&] { putMeasures(page, finding); });
  page.element("div", {{"class", "figures"}}, [&] {
    putFigure(page, pictures.all[pictured.whole],
              fmt::format("Both parts, {}: {}", parts, wordOf(finding.verdict)), "Both parts.");
    if (pictured.close)
      putFigure(page, pictures.all[*pictured.close],
                fmt::format("The place where {} are nearest or meet", parts), "Close.");
  });
}

}  // namespace

void putPairs(ReportPageWriter& page, const SceneCheck& check, std::span<const ComparedFinding* const> rows) {
  if (rows.empty()) return page.sentence("No pair is within the threshold.");
  const std::size_t shown = std::min(rows.size(), kMaxFindingRows);
  page.table({"No.", "Parts", "Verdict", "Distance", "Depth", "Shared volume", "Rule", "State"}, [&] {
    for (std::size_t i = 0; i < shown; ++i)
      page.element("tr", [&] { putPairRow(page, check, i + 1, *rows[i]); });
  });
  page.leftOutNote(rows.size(), shown, "pairs");
  page.sentence(
      "Depth: length of the least translation known to free the part; ≤ where a shorter one may exist. "
      "Numbers are those "
      "of the triangles. Each is in the file as it was computed, in SI units (the value of its data "
      "element).");
}

void putFindings(ReportPageWriter& page, const Scene& scene, const ReportPictures& pictures,
                 std::span<const ComparedFinding* const> rows) {
  if (pictures.findings.empty()) return page.sentence("There is none to show.");
  page.sentence(
      "The other parts are left out, and the larger part is translucent. Orange segments are local minimum "
      "distances, the "
      "nearest in red; crimson curves are where surfaces meet; a green line frees the part named first. "
      "What is behind a "
      "surface is drawn through it. The frame shows where the close picture is.");
  for (std::size_t i = 0; i < pictures.findings.size(); ++i) {
    page.element("section", {{"class", "finding"}, {"id", fmt::format("finding-{}", i + 1)}},
                 [&] { putFinding(page, scene, pictures, i + 1, pictures.findings[i]); });
  }
  const auto all = static_cast<std::size_t>(
      std::ranges::count_if(rows, [](const ComparedFinding* row) { return row->now != nullptr; }));
  page.leftOutNote(all, pictures.findings.size(), "findings");
}

}  // namespace nearfit
