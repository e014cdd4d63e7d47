#include <fmt/format.h>

#include "tests/bench/error_run.h"

namespace nearfit::bench {

std::string errorCsvHeader() {
  return "pair,method,fineness,edge_m,scene_triangles,part_triangles,poses,p50_us,p99_us,truths,minima,"
         "missed,"
         "spurious,extra,distance_rms_m,distance_max_m,position_rms_m,position_max_m,direction_rms,"
         "direction_max,force_rms,force_max,torque_rms_m,torque_max_m,differing,bytes,aside_us\n";
}

std::string errorCsvLine(const ErrorRow& r) {
  std::string line = fmt::format("{},{},{},{:.6g},{},{},{},{:.3f},{:.3f},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}",
                                 r.pair, r.method, r.fineness, r.edge, r.sceneTriangles, r.partTriangles,
                                 r.poses, r.p50, r.p99, r.truths, r.minima, r.missed, r.spurious, r.extra);
  for (const ErrorSummary& e : {r.distance, r.position, r.direction, r.force, r.torque})
    line += fmt::format(",{:.4g},{:.4g}", e.rms, e.max);
  return line + fmt::format(",{},{},{:.3f}\n", r.differing, r.bytes, r.aside);
}

std::string errorTableHeader() {
  return fmt::format(
      "{:<16}{:<22}{:>9}{:>9}{:>9}{:>10}{:>10}{:>8}{:>8}{:>8}{:>8}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "pair",
      "method", "edge", "faces", "faces", "p50", "p99", "minima", "missed", "spur.", "extra", "distance",
      "position", "direct.", "force", "torque");
}

std::string errorTableLine(const ErrorRow& r) {
  return fmt::format(
      "{:<16}{:<22}{:>9.4f}{:>9}{:>9}{:>10.1f}{:>10.1f}{:>8.2f}{:>8.2f}{:>8.2f}{:>8.2f}{:>10.1e}{:>10.1e}{:>"
      "10.1e}{:>10."
      "1e}{:>10.1e}\n",
      r.pair, r.method, r.edge, r.sceneTriangles, r.partTriangles, r.p50, r.p99, r.minima, r.missed,
      r.spurious, r.extra, r.distance.rms, r.position.rms, r.direction.rms, r.force.rms, r.torque.rms);
}

}  // namespace nearfit::bench
