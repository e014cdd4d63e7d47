#include "core/report/scene_check_export.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/report/csv_text.h"
#include "core/text/json_text.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

using CheckJson = nlohmann::ordered_json;

constexpr int kSceneCheckVersion = 1;

/// Length of all curves [m].
double lengthOfCurves(const ClashMeasures& clash) {
  double length = 0.0;
  for (const std::vector<glm::dvec3>& curve : clash.curves) {
    for (std::size_t i = 1; i < curve.size(); ++i)
      length += glm::distance(curve[i - 1], curve[i]);
  }
  return length;
}

std::string ruleText(const SceneCheck& check, const PairFinding& finding) {
  return finding.allowedBy ? textOf(check.rules[*finding.allowedBy]) : std::string();
}

std::string depthText(const PairFinding& finding) {
  const std::optional<double> depth = finding.depth();
  if (!depth) return "";
  return fmt::format("{}{:.4g}", finding.clash->isDepthExact ? "" : "<= ", *depth);
}

CheckJson lengthJson(const std::optional<double>& length) {
  return length && std::isfinite(*length) ? CheckJson(*length) : CheckJson();
}

CheckJson placeJson(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

CheckJson minimaJson(const PairFinding& finding) {
  CheckJson minima = CheckJson::array();
  for (const FoundMinimum& minimum : finding.minima)
    minima.push_back({{"distance", minimum.distance},
                      {"part", placeJson(minimum.partPoint)},
                      {"other", placeJson(minimum.otherPoint)},
                      {"region", minimum.isRegion},
                      {"blocked", minimum.isBlocked},
                      {"marginal", minimum.isMarginal}});
  return minima;
}

CheckJson clashJson(const ClashMeasures& clash) {
  CheckJson json;
  json["volume"] = lengthJson(clash.volume);
  json["volumeProblem"] = clash.volume ? CheckJson() : CheckJson(textOf(clash.volumeProblem));
  json["depth"] = CheckJson();
  if (clash.freeing)
    json["depth"] = {{"length", clash.freeing->length},
                     {"direction", placeJson(clash.freeing->direction)},
                     {"exact", clash.isDepthExact}};
  json["interference"] = CheckJson();
  if (const auto& depth = clash.interference)
    json["interference"] = {{"least", depth->least}, {"most", lengthJson(depth->most)}};
  json["everyCurve"] = clash.isEveryCurve;
  json["curves"] = CheckJson::array();
  for (const std::vector<glm::dvec3>& curve : clash.curves) {
    CheckJson points = CheckJson::array();
    for (const glm::dvec3& point : curve)
      points.push_back(placeJson(point));
    json["curves"].push_back(std::move(points));
  }
  return json;
}

CheckJson pairJson(const Scene& scene, const PartPair& pair) {
  return {{"part", scene.get(pair.part).name}, {"other", scene.get(pair.other).name}};
}

CheckJson recordJson(const PairRecord& record) {
  return {{"verdict", wordOf(record.verdict)},
          {"distance", record.distance},
          {"depth", lengthJson(record.depth)}};
}

CheckJson findingJson(const Scene& scene, const ComparedFinding& compared) {
  const PairFinding& finding = *compared.now;
  CheckJson json = pairJson(scene, finding.pair);
  json["verdict"] = wordOf(finding.verdict);
  json["allowed"] = !finding.isForbidden();
  json["rule"] = finding.allowedBy ? CheckJson(*finding.allowedBy) : CheckJson();
  json["state"] = stateWord(compared.state, compared.reason);
  json["reason"] = compared.reason;
  json["change"] = wordOf(compared.change);
  json["before"] = compared.before ? recordJson(*compared.before) : CheckJson();
  json["distance"] = finding.distance;
  json["points"] = {{"part", placeJson(finding.partPoint)}, {"other", placeJson(finding.otherPoint)}};
  json["everyMinimum"] = finding.isEveryMinimum;
  json["minima"] = minimaJson(finding);
  json["clash"] = finding.clash ? clashJson(*finding.clash) : CheckJson();
  return json;
}

CheckJson rulesJson(const SceneCheck& check) {
  CheckJson rules = CheckJson::array();
  for (const PairRule& rule : check.rules)
    rules.push_back({{"kind", wordOf(rule.kind)},
                     {"part", rule.part},
                     {"other", rule.other},
                     {"interference", rule.interference}});
  return rules;
}

CheckJson countsJson(const SceneCheck& check, const std::vector<ComparedFinding>& compared) {
  CheckJson counts = {{"pairs", check.checkedPairs()}, {"leftOut", check.leftOut.size()}};
  for (const PairVerdict verdict : {PairVerdict::Clear, PairVerdict::Near, PairVerdict::Touching,
                                    PairVerdict::Clash, PairVerdict::Contained})
    counts[wordOf(verdict)] = check.count(verdict);
  counts["forbidden"] = check.forbidden();
  counts["accepted"] = acceptedIn(compared);
  return counts;
}

std::string csvRow(const Scene& scene, const SceneCheck& check, const ComparedFinding& compared) {
  std::string row;
  const auto add = [&row](const std::string& cell) { row += (row.empty() ? "" : ",") + cell; };
  const auto addNumber = [&add](const std::optional<double>& number) {
    add(number && std::isfinite(*number) ? fmt::format("{}", *number) : std::string());
  };
  const auto addPoint = [&addNumber](const std::optional<glm::dvec3>& p) {
    for (glm::length_t i = 0; i < 3; ++i)
      addNumber(p ? std::optional((*p)[i]) : std::nullopt);
  };
  const PairFinding* now = compared.now;
  const ClashMeasures* clash = now != nullptr && now->clash ? &*now->clash : nullptr;
  add(csvField(scene.get(compared.pair.part).name));
  add(csvField(scene.get(compared.pair.other).name));
  add(wordOf(now != nullptr ? now->verdict : PairVerdict::Clear));
  add(now == nullptr || !now->isForbidden() ? "1" : "0");
  add(now != nullptr ? csvField(ruleText(check, *now)) : "");
  add(stateWord(compared.state, compared.reason));
  add(wordOf(compared.change));
  add(csvField(compared.reason));
  addNumber(now != nullptr ? std::optional(now->distance) : std::nullopt);
  addPoint(now != nullptr ? std::optional(now->partPoint) : std::nullopt);
  addPoint(now != nullptr ? std::optional(now->otherPoint) : std::nullopt);
  add(now != nullptr ? fmt::format("{}", now->minima.size()) : "");
  add(now != nullptr ? fmt::format("{:d}", now->isEveryMinimum) : "");
  const bool hasDepth = clash != nullptr && clash->freeing.has_value();
  addNumber(hasDepth ? std::optional(clash->freeing->length) : std::nullopt);
  add(hasDepth ? fmt::format("{:d}", clash->isDepthExact) : "");
  addPoint(hasDepth ? std::optional(clash->freeing->direction) : std::nullopt);
  addNumber(clash != nullptr ? clash->volume : std::nullopt);
  add(clash != nullptr ? csvField(textOf(clash->volumeProblem)) : "");
  addNumber(clash != nullptr ? std::optional(lengthOfCurves(*clash)) : std::nullopt);
  const bool hasFit = clash != nullptr && clash->interference.has_value();
  addNumber(hasFit ? std::optional(clash->interference->most) : std::nullopt);
  const std::optional<PairRecord>& before = compared.before;
  add(before ? wordOf(before->verdict) : "");
  addNumber(before ? std::optional(before->distance) : std::nullopt);
  addNumber(before ? before->depth : std::nullopt);
  return row + "\n";
}

}  // namespace

std::vector<const ComparedFinding*> findingsBySeverity(const std::vector<ComparedFinding>& compared) {
  std::vector<const ComparedFinding*> rows;
  for (const ComparedFinding& finding : compared) {
    if (finding.now != nullptr || finding.change == FindingChange::Gone) rows.push_back(&finding);
  }
  std::ranges::stable_sort(rows, {}, [](const ComparedFinding* finding) {
    const PairFinding* now = finding->now;
    if (now == nullptr) return std::tuple(2, 0, 0.0, 0.0);
    return std::tuple(now->isForbidden() ? 0 : 1, -static_cast<int>(now->verdict),
                      -now->depth().value_or(0.0), now->distance);
  });
  return rows;
}

std::string sceneCheckTable(const Scene& scene, const SceneCheck& check,
                            const std::vector<ComparedFinding>& compared) {
  std::string text = fmt::format("{:<10}{:<11}{:<8}{:>13}{:>14}{:>14}  {}\n", "verdict", "state", "change",
                                 "distance [m]", "depth [m]", "volume [m^3]", "parts");
  for (const ComparedFinding* row : findingsBySeverity(compared)) {
    const PairFinding* now = row->now;
    const std::string rule = now != nullptr ? ruleText(check, *now) : std::string();
    const bool hasVolume = now != nullptr && now->clash && now->clash->volume;
    fmt::format_to(
        std::back_inserter(text), "{:<10}{:<11}{:<8}{:>13}{:>14}{:>14}  {} | {}{}\n",
        wordOf(now != nullptr ? now->verdict : PairVerdict::Clear), stateWord(row->state, row->reason),
        wordOf(row->change), now != nullptr ? fmt::format("{:.4g}", now->distance) : "",
        now != nullptr ? depthText(*now) : "", hasVolume ? fmt::format("{:.4g}", *now->clash->volume) : "",
        printableText(scene.get(row->pair.part).name), printableText(scene.get(row->pair.other).name),
        rule.empty() ? "" : fmt::format("  (allowed: {})", rule));
  }
  return text;
}

std::string sceneCheckSummary(const SceneCheck& check, const std::vector<ComparedFinding>& compared) {
  const std::size_t accepted = acceptedIn(compared);
  return fmt::format(
      "{} pairs checked, {} left out: {} clear, {} near, {} touching, {} clashes, {} contained; "
      "{} not allowed{}\n",
      check.checkedPairs(), check.leftOut.size(), check.count(PairVerdict::Clear),
      check.count(PairVerdict::Near), check.count(PairVerdict::Touching), check.count(PairVerdict::Clash),
      check.count(PairVerdict::Contained), check.forbidden(),
      accepted > 0 ? fmt::format(", {} of them accepted", accepted) : "");
}

std::string sceneCheckChanges(const std::vector<ComparedFinding>& compared) {
  if (std::ranges::none_of(compared,
                           [](const ComparedFinding& finding) { return finding.before.has_value(); }))
    return "";
  const FindingChanges changes = changesIn(compared);
  return fmt::format("since the last check: {} new, {} worse, {} better, {} gone\n", changes.added,
                     changes.worse, changes.better, changes.gone);
}

std::string sceneCheckCsv(const Scene& scene, const SceneCheck& check,
                          const std::vector<ComparedFinding>& compared) {
  std::string text =
      "part,other,verdict,allowed,rule,state,change,reason,distance [m],part_x [m],part_y [m],part_z [m],"
      "other_x [m],other_y [m],other_z [m],minima,every_minimum,depth [m],depth_exact,free_x,free_y,free_z,"
      "volume [m^3],volume_problem,curves [m],interference [m],before_verdict,before_distance "
      "[m],before_depth [m]\n";
  for (const ComparedFinding* row : findingsBySeverity(compared))
    text += csvRow(scene, check, *row);
  return text;
}

std::string sceneCheckJson(const Scene& scene, const SceneCheck& check,
                           const std::vector<ComparedFinding>& compared) {
  CheckJson json;
  json["nearfitCheck"] = kSceneCheckVersion;
  json["units"] = {{"length", "m"}, {"volume", "m^3"}};
  json["threshold"] = check.threshold;
  json["rules"] = rulesJson(check);
  json["counts"] = countsJson(check, compared);
  json["findings"] = CheckJson::array();
  json["gone"] = CheckJson::array();
  for (const ComparedFinding* row : findingsBySeverity(compared)) {
    if (row->now != nullptr) {
      json["findings"].push_back(findingJson(scene, *row));
    } else {
      CheckJson gone = pairJson(scene, row->pair);
      gone["verdict"] = wordOf(row->before->verdict);
      gone["reason"] = row->reason;
      json["gone"].push_back(std::move(gone));
    }
  }
  json["leftOut"] = CheckJson::array();
  for (const LeftOutPair& pair : check.leftOut) {
    CheckJson entry = pairJson(scene, pair.pair);
    entry["rule"] = pair.rule;
    json["leftOut"].push_back(std::move(entry));
  }
  return prettyJson(json);
}

}  // namespace nearfit
