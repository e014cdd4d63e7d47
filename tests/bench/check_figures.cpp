#include "tests/bench/check_figures.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "tests/bench/statistics.h"
#include "tests/bench/units.h"

namespace nearfit::bench {
namespace {

std::vector<double> megabytesOf(const std::vector<double>& bytes) {
  std::vector<double> megabytes;
  for (const double b : bytes)
    megabytes.push_back(b / kMegabyte);
  return megabytes;
}

/// Of each turn, for the machine's speed drifts.
std::vector<double> checkRatios(const std::vector<double>& peer, const std::vector<double>& own) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(peer.size(), own.size()); ++i)
    ratios.push_back(peer[i] / own[i]);
  return ratios;
}

std::string cutRemark(const CheckMethodRuns& runs) {
  std::string remark;
  if (runs.isCut()) remark = fmt::format("cut: {} of {} pairs measured", runs.measured, runs.candidates);
  if (runs.fullLists > 0)
    remark += fmt::format("{}{} lists are full", remark.empty() ? "cut: " : "; ", runs.fullLists);
  return remark;
}

class CheckFigureList {
 public:
  explicit CheckFigureList(const ManyPartsScene& scene) : scene_(scene) {}

  CheckFigure& add(const CheckMethodRuns& runs, const char* name, const char* unit,
                   const std::vector<double>& samples) {
    figures_.push_back(checkFigureOf(scene_, runs.method, name, unit, samples));
    return figures_.back();
  }
  CheckFigure& addCount(const CheckMethodRuns& runs, const char* name, std::size_t count) {
    CheckFigure& figure = add(runs, name, "1", {static_cast<double>(count)});
    figure.runs = runs.whole.size();
    return figure;
  }
  void addTimes(const CheckMethodRuns& runs, double goal, bool isOfGoalSize = true) {
    CheckFigure& whole = add(runs, "whole check", "s", runs.whole);
    whole.goal = goal;
    whole.isOfGoalSize = isOfGoalSize;
    whole.remark = cutRemark(runs);
    add(runs, "thereof hierarchies", "s", runs.build);
    add(runs, "thereof pairs", "s", runs.pairs);
  }
  void addOwnFigures(const CheckMethodRuns& runs, const CheckGoals& goals) {
    const bool isOfGoalSize = runs.near >= goals.nearPairs;
    addTimes(runs, goals.seconds, isOfGoalSize);
    CheckFigure& memory = add(runs, "max resident memory", "MB", megabytesOf(runs.residentPeak));
    memory.goal = goals.bytes / kMegabyte;
    memory.isOfGoalSize = isOfGoalSize;
    memory.remark = fmt::format("{:.0f} MB before", runs.residentBefore / kMegabyte);
    CheckFigure& near = addCount(runs, "near pairs", runs.near);
    near.goal = static_cast<double>(goals.nearPairs);
    near.isAtLeast = true;
    addCount(runs, "touching pairs", runs.touching);
    addCount(runs, "clashes", runs.clashes);
    addCount(runs, "contained parts", runs.contained);
  }
  void addPeerFigures(const CheckMethodRuns& runs, const std::vector<CheckMethodRuns>& all, double goal) {
    addTimes(runs, 0.0);
    // A library that lists pairs of triangles has, like the second, what minima need and nothing of a clash.
    const bool hasLists = runs.listed > 0;
    addRatio(runs, "times nearfit", checkRatios(runs.whole, all[0].whole)).goal = hasLists ? 0.0 : goal;
    addRatio(runs, "times nearfit-unmeasured", checkRatios(runs.whole, all[1].whole)).goal =
        hasLists ? goal : 0.0;
    addRatio(runs, "the same of pairs alone", checkRatios(runs.pairs, all[1].pairs));
    addCount(runs, "pairs of the broad phase", runs.candidates);
    addCount(runs, "pairs within", runs.near);
    addCount(runs, "collisions", runs.clashes);
    if (runs.listed > 0) addCount(runs, "pairs of triangles listed", runs.listed);
    addCount(runs, "pairs compared", runs.agreement.compared);
    add(runs, "worst difference", "m", {runs.agreement.worstDistance}).runs = runs.whole.size();
  }
  CheckFigure& addRatio(const CheckMethodRuns& runs, const char* name, const std::vector<double>& ratios) {
    CheckFigure& ratio = add(runs, name, "x", ratios);
    ratio.isAtLeast = true;
    ratio.worst = std::ranges::min(ratios);
    ratio.remark = cutRemark(runs);
    return ratio;
  }
  std::vector<CheckFigure> take() { return std::move(figures_); }

 private:
  const ManyPartsScene& scene_;
  std::vector<CheckFigure> figures_;
};

std::string metTextOf(const CheckFigure& figure, const char* missed) {
  if (figure.goal <= 0.0) return {};
  return figure.isMet() ? "yes" : missed;
}

std::string goalTextOf(const CheckFigure& figure) {
  if (figure.goal <= 0.0) return {};
  return fmt::format("{}{:g}", figure.isAtLeast ? ">= " : "<= ", figure.goal);
}

}  // namespace

CheckFigure checkFigureOf(const ManyPartsScene& scene, std::string method, std::string name, std::string unit,
                          const std::vector<double>& samples) {
  const SampleSummary summary(samples);
  CheckFigure figure;
  figure.scene = scene.name;
  figure.method = std::move(method);
  figure.name = std::move(name);
  figure.unit = std::move(unit);
  figure.parts = scene.parts.size();
  figure.meshes = scene.meshes.size();
  figure.triangles = scene.triangles();
  figure.threshold = scene.threshold;
  figure.runs = samples.size();
  figure.median = summary.percentile(0.5);
  figure.worst = summary.max();
  return figure;
}

std::vector<CheckFigure> checkFigures(const ManyPartsScene& scene, const CheckGoals& goals,
                                      const std::vector<CheckMethodRuns>& runs) {
  CheckFigureList list(scene);
  list.addOwnFigures(runs[0], goals);
  list.addOwnFigures(runs[1], {});
  for (std::size_t i = 2; i < runs.size(); ++i)
    list.addPeerFigures(runs[i], runs, goals.peerRatio);
  return list.take();
}

std::string checkTableHeader() {
  return fmt::format("{:<16}{:<20}{:<26}{:<5}{:>5}{:>13}{:>13}{:>10} {:<4} {}\n", "scene", "method", "figure",
                     "unit", "runs", "median", "worst", "goal", "met", "remark");
}

std::string checkTableLine(const CheckFigure& f) {
  return fmt::format("{:<16}{:<20}{:<26}{:<5}{:>5}{:>13.6g}{:>13.6g}{:>10} {:<4} {}\n", f.scene, f.method,
                     f.name, f.unit, f.runs, f.median, f.worst, goalTextOf(f), metTextOf(f, "NO"), f.remark);
}

std::string checkCsvHeader() {
  return "scene,parts,meshes,triangles,threshold_m,method,figure,unit,runs,median,worst,goal,met,remark\n";
}

std::string checkCsvLine(const CheckFigure& f) {
  return fmt::format("{},{},{},{},{:.6g},{},{},{},{},{:.6g},{:.6g},{},{},{}\n", f.scene, f.parts, f.meshes,
                     f.triangles, f.threshold, f.method, f.name, f.unit, f.runs, f.median, f.worst,
                     goalTextOf(f), metTextOf(f, "no"), f.remark);
}

std::vector<std::string> checkProblems(const ManyPartsScene& scene,
                                       const std::vector<CheckMethodRuns>& runs) {
  std::vector<std::string> problems;
  for (const CheckMethodRuns& r : runs) {
    const CheckAgreement& a = r.agreement;
    if (a.holds) continue;
    problems.push_back(fmt::format(
        "{}: of {} pairs that {} found too, distances differ by up to {:.3g} m and {} clashes are apart; {} "
        "pairs it has not, {} it alone has",
        scene.name, a.compared, r.method, a.worstDistance, a.apart, a.missing, a.extra));
  }
  return problems;
}

}  // namespace nearfit::bench
