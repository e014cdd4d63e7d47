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

std::string secondsOrNothing(double seconds) {
  return seconds > 0.0 ? fmt::format("{:.6g}", seconds) : std::string();
}

std::string plainText(const PathRow& row) {
  return row.plain.places > 0 ? fmt::format("{},{}", row.plain.tested, row.plain.meetings) : std::string(",");
}

}  // namespace

std::string pathTableHeader() {
  return fmt::format("{:<16}{:>8}{:>11}{:>8}{:>13}{:>12}{:>8}{:>12}{:>11}{:>10}{:>11}{:>10}{:>10}{:>8} {}\n",
                     "scene", "poses", "triangles", "others", "certified_s", "verified_s", "ratio",
                     "certify_cli", "verify_cli", "places", "looks", "tested", "meetings", "goal_s", "met");
}

std::string pathTableLine(const PathRow& r) {
  return fmt::format(
      "{:<16}{:>8}{:>11}{:>8}{:>13.3f}{:>12.3f}{:>8.2f}{:>12.3f}{:>11.3f}{:>10}{:>11}{:>10}{:>10}{:>8} {}\n",
      r.scene, r.poses, r.triangles, r.others, r.certified, r.verified, r.ratio(), r.certifyProcess,
      r.verifyProcess, r.looks.places, r.looks.looks, r.looks.tested + r.plain.tested, r.meetings(),
      pathGoalText(r), pathMetText(r, "NO"));
}

std::string pathCsvHeader() {
  return "scene,poses,triangles,certified_s,verified_s,ratio,places,meetings,goal_s,met,within_twice_"
         "certified,moving,"
         "others,certify_process_s,verify_process_s,looks,tested,measured,boxed,argued,plainly_tested,plain_"
         "meetings\n";
}

std::string pathCsvLine(const PathRow& r) {
  return fmt::format("{},{},{},{:.6g},{:.6g},{:.4g},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.scene,
                     r.poses, r.triangles, r.certified, r.verified, r.ratio(), r.looks.places, r.meetings(),
                     pathGoalText(r), pathMetText(r, "no"), r.isWithinTwice() ? "yes" : "no", r.moving,
                     r.others, secondsOrNothing(r.certifyProcess), secondsOrNothing(r.verifyProcess),
                     r.looks.looks, r.looks.tested, r.looks.measured, r.looks.boxed, r.looks.argued(),
                     plainText(r));
}

}  // namespace nearfit::bench
