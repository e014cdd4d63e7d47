#include "tests/bench/path_row.h"

#include <fmt/format.h>

namespace nearfit::bench {
namespace {

std::string pathGoalText(const PathRow& row) {
  return row.goal > 0.0 ? fmt::format("{:g}", row.goal) : std::string();
}

std::string pathMetText(const PathRow& row, const char* missed) {
  if (row.goal <= 0.0) return {};
  return row.isMet() ? "yes" : missed;
}

}  // namespace

std::string pathTableHeader() {
  return fmt::format("{:<16}{:>8}{:>11}{:>13}{:>12}{:>8}{:>10}{:>10}{:>8} {}\n", "scene", "poses",
                     "triangles", "certified_s", "verified_s", "ratio", "places", "meetings", "goal_s",
                     "met");
}

std::string pathTableLine(const PathRow& r) {
  return fmt::format("{:<16}{:>8}{:>11}{:>13.3f}{:>12.3f}{:>8.2f}{:>10}{:>10}{:>8} {}\n", r.scene, r.poses,
                     r.triangles, r.certified, r.verified, r.ratio(), r.places, r.meetings, pathGoalText(r),
                     pathMetText(r, "NO"));
}

std::string pathCsvHeader() {
  return "scene,poses,triangles,certified_s,verified_s,ratio,places,meetings,goal_s,met\n";
}

std::string pathCsvLine(const PathRow& r) {
  return fmt::format("{},{},{},{:.6g},{:.6g},{:.4g},{},{},{},{}\n", r.scene, r.poses, r.triangles,
                     r.certified, r.verified, r.ratio(), r.places, r.meetings, pathGoalText(r),
                     pathMetText(r, "no"));
}

}  // namespace nearfit::bench
