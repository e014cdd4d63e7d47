#include "app/cli/place_summary.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/output.h"
#include "core/haptics/virtual_coupling.h"
#include "core/haptics/workspace_mapper.h"
#include "device/servo/servo_loop.h"

namespace nearfit::cli {
namespace {

double microseconds(double seconds) {
  return seconds * 1e6;
}

std::string timesText(const LatencyHistogram& h) {
  return fmt::format("p50 {:.1f}, p99 {:.1f}, p99.9 {:.1f}, max {:.1f} us", microseconds(h.percentile(0.5)),
                     microseconds(h.percentile(0.99)), microseconds(h.percentile(0.999)),
                     microseconds(h.max()));
}

nlohmann::ordered_json timesJson(const LatencyHistogram& h) {
  return {{"p50", microseconds(h.percentile(0.5))},
          {"p99", microseconds(h.percentile(0.99))},
          {"p99.9", microseconds(h.percentile(0.999))},
          {"max", microseconds(h.max())}};
}

std::string paceText(const PlaceResult& result) {
  if (result.device) return fmt::format(" in {:.3f} s", result.device->seconds);
  if (result.schedulingNote.empty()) return ", as fast as possible";
  const double seconds = static_cast<double>(result.ticks + result.overruns) * ServoLoop::kPeriod;
  return fmt::format(" in {:.3f} s", seconds);
}

std::string overrunsText(std::uint64_t overruns) {
  return overruns == 0 ? "none"
                       : fmt::format("{} periods of 1 ms were skipped because ticks ended late", overruns);
}

std::string distanceText(const PlaceResult& result) {
  if (!std::isfinite(result.leastDistance)) return "nothing came within the cutoff";
  return fmt::format("min {}{:.6g} m at {:.3f} s", result.isLeastDistanceBound ? "at least " : "",
                     result.leastDistance, result.leastDistanceTime);
}

const char* modeName(const HapticSettings& haptics) {
  if (haptics.mode == HapticMode::Proxy) return "proxy";
  return haptics.springs.law == SpringLaw::Printed ? "printed" : "spring";
}

std::string modeText(const HapticSettings& haptics) {
  if (haptics.mode == HapticMode::Proxy) {
    return fmt::format("proxy, margin {:.6g} m, friction {:.6g}", haptics.proxy.margin,
                       haptics.proxy.friction);
  }
  const SpringParameters& springs = haptics.springs;
  const bool isPrinted = springs.law == SpringLaw::Printed;
  return fmt::format("{}, {:.6g} {} and {:.6g} N s/m within {:.6g} m{}", modeName(haptics), springs.stiffness,
                     isPrinted ? "N/m^2" : "N/m", springs.damping, springs.cutoff,
                     springs.onePerArea ? ", one spring for each area of contact" : "");
}

std::string summaryLine(const char* name, const std::string& text) {
  return fmt::format("{:<12}{}\n", name, text);
}

std::string couplingText(const CouplingState& c) {
  return fmt::format("{:.6g} N/m, {:.6g} N s/m; {:.6g} N m/rad, {:.6g} N m s/rad{}", c.stiffness, c.damping,
                     c.rotationalStiffness, c.rotationalDamping,
                     c.isHeldToBound ? " (limited to the bound)" : "");
}

/// Stiffness up to which the coupling is passive in any hand, at the period that the servo assumes.
struct StiffnessBounds {
  double linear, rotational;  ///< [N/m], [N m/rad]
};

StiffnessBounds boundsOf(const PlaceSummary& s) {
  const DeviceLimits device = limitsAtHandle(s.parameters.limits, s.parameters.haptics.mapping.scale);
  const CouplingState& coupling = s.result.coupling;
  return {stiffnessBound(device.damping, coupling.damping, s.result.period),
          stiffnessBound(device.rotationalDamping, coupling.rotationalDamping, s.result.period)};
}

/// Returns the lines that only the proxy mode has.
std::string proxyText(const PlaceSummary& s) {
  const PlaceResult& r = s.result;
  const StiffnessBounds bounds = boundsOf(s);
  std::string text = summaryLine("coupling", couplingText(r.coupling));
  text += summaryLine(
      "bound",
      fmt::format("{:.6g} N/m; {:.6g} N m/rad: max for passivity at {:.3g} ms with the device's damping",
                  bounds.linear, bounds.rotational, 1e3 * r.period));
  text += summaryLine("steps", fmt::format("max {} per tick, {} shortened, {} refused", r.maxSubSteps,
                                           r.shortenedSteps, r.refusedSteps));
  if (r.overlappingTicks > 0) {
    text += summaryLine("released",
                        fmt::format("{} ticks overlapped a part; it is not felt until the two are apart",
                                    r.overlappingTicks));
  }
  if (r.behindTicks > 0) {
    text += summaryLine(
        "behind", fmt::format("{} ticks ended before the part's way; it goes on in the next", r.behindTicks));
  }
  return text + summaryLine("proxy", timesText(r.proxyTime));
}

/// Returns the lines that only the spring modes have.
std::string springsText(const PlaceSummary& s) {
  const PlaceResult& r = s.result;
  std::string text;
  if (s.parameters.haptics.springs.onePerArea)
    text += summaryLine("areas", fmt::format("max {} at once", r.maxAreas));
  if (r.heldTicks > 0) {
    text += summaryLine("held",
                        fmt::format("springs stiffer than the device bears in {} ticks: down to {:.3g} of "
                                    "the law's wrench",
                                    r.heldTicks, r.leastShares.wrench));
  }
  return text;
}

nlohmann::ordered_json springsJson(const PlaceSummary& s) {
  const PlaceResult& r = s.result;
  return {{"one_per_area", s.parameters.haptics.springs.onePerArea},
          {"max_areas", r.maxAreas},
          {"held_ticks", r.heldTicks},
          {"least_wrench_share", r.leastShares.wrench},
          {"least_damping_share", r.leastShares.damping}};
}

nlohmann::ordered_json proxyJson(const PlaceSummary& s) {
  const PlaceResult& r = s.result;
  const StiffnessBounds bounds = boundsOf(s);
  return {{"coupling",
           {{"stiffness", r.coupling.stiffness},
            {"damping", r.coupling.damping},
            {"rotational_stiffness", r.coupling.rotationalStiffness},
            {"rotational_damping", r.coupling.rotationalDamping},
            {"stiffness_bound", bounds.linear},
            {"rotational_stiffness_bound", bounds.rotational},
            {"period", r.period},
            {"held_to_bound", r.coupling.isHeldToBound}}},
          {"max_sub_steps", r.maxSubSteps},
          {"shortened_steps", r.shortenedSteps},
          {"refused_steps", r.refusedSteps},
          {"released_ticks", r.overlappingTicks},
          {"behind_ticks", r.behindTicks},
          {"proxy_us", timesJson(r.proxyTime)}};
}

std::string deviceText(const DeviceReport& d) {
  std::string text = summaryLine("device", oneLine(d.name) + (d.wasArmed ? ", armed" : ", not armed"));
  text += summaryLine("reports", fmt::format("{} taken, {} missing, {} rejected", d.counters.poses,
                                             d.counters.missing, d.counters.rejected));
  if (d.roundTrip.count() > 0) text += summaryLine("round trip", timesText(d.roundTrip));
  return text;
}

nlohmann::ordered_json deviceJson(const DeviceReport& d) {
  nlohmann::ordered_json json{{"name", d.name},
                              {"armed", d.wasArmed},
                              {"seconds", d.seconds},
                              {"reports", d.counters.poses},
                              {"missing", d.counters.missing},
                              {"rejected", d.counters.rejected},
                              {"round_trips", d.roundTrip.count()},
                              {"round_trip_us", nullptr}};
  if (d.roundTrip.count() > 0) json["round_trip_us"] = timesJson(d.roundTrip);
  return json;
}

}  // namespace

std::string summaryText(const PlaceSummary& s) {
  const PlaceResult& r = s.result;
  std::string text =
      summaryLine(s.members.empty() ? "part" : "group",
                  fmt::format("{} against {} other{}", oneLine(s.part), s.others, s.others == 1 ? "" : "s"));
  if (!s.members.empty())
    text += summaryLine("members", oneLine(fmt::format("{}", fmt::join(s.members, ", "))));
  const std::string all = r.device ? "" : fmt::format(" of {}", s.poses);
  text += summaryLine("ticks", fmt::format("{}{}{}", r.ticks, all, paceText(r)));
  if (r.device) text += deviceText(*r.device);
  text += summaryLine("mode", modeText(s.parameters.haptics));
  text += summaryLine("minima", fmt::format("max {} at once", r.maxLmds));
  text += summaryLine("distance", distanceText(r));
  text += summaryLine("force", fmt::format("peak {:.6g} N at {:.3f} s", r.force.value, r.force.time));
  text += summaryLine("torque", fmt::format("peak {:.6g} N m at {:.3f} s", r.torque.value, r.torque.time));
  text += summaryLine("energy", fmt::format("max {:.6g} J given to the hand", r.maxEnergyToHand));
  text += s.parameters.haptics.mode == HapticMode::Proxy ? proxyText(s) : springsText(s);
  if (r.clampedTicks > 0)
    text += summaryLine("clamped", fmt::format("force or torque in {} ticks", r.clampedTicks));
  if (r.truncatedTicks > 0) {
    text += summaryLine("truncated",
                        fmt::format("more minima or work than a tick allows in {} ticks", r.truncatedTicks));
  }
  if (r.lateTicks > 0) {
    text += summaryLine(
        "late", fmt::format("{} ticks ran their own search: the motion was off the forecast", r.lateTicks));
  }
  text += summaryLine("refresh",
                      fmt::format("{} searches ahead, {}", r.refreshTime.count(), timesText(r.refreshTime)));
  text += summaryLine("wrench", timesText(r.wrenchTime));
  text += summaryLine("query", timesText(r.queryTime));
  text += summaryLine("tick", timesText(r.tickTime));
  if (!r.schedulingNote.empty()) {
    text += summaryLine("lateness", timesText(r.lateness));
    text += summaryLine("overruns", overrunsText(r.overruns));
    text += summaryLine("scheduling", r.schedulingNote);
  }
  if (!s.record.empty()) {
    text += summaryLine(
        "record", fmt::format("{} ({} rows, {} lost)", oneLine(s.record), r.ticks - r.lostRows, r.lostRows));
  }
  if (!s.exportFile.empty()) text += summaryLine("export", oneLine(s.exportFile));
  return text;
}

std::string summaryJson(const PlaceSummary& s) {
  const PlaceResult& r = s.result;
  const bool isGroup = !s.members.empty();
  nlohmann::ordered_json json{{"part", isGroup ? s.members.front() : s.part},
                              {"others", s.others},
                              {"poses", nullptr},
                              {"device", nullptr},
                              {"ticks", r.ticks},
                              {"mode", modeName(s.parameters.haptics)},
                              {"max_lmds", r.maxLmds},
                              {"least_distance", nullptr},
                              {"peak_force", r.force.value},
                              {"peak_torque", r.torque.value},
                              {"max_energy_to_hand", r.maxEnergyToHand},
                              {"proxy", nullptr},
                              {"springs", nullptr},
                              {"clamped_ticks", r.clampedTicks},
                              {"truncated_ticks", r.truncatedTicks},
                              {"late_ticks", r.lateTicks},
                              {"refreshes", r.refreshTime.count()},
                              {"refresh_us", timesJson(r.refreshTime)},
                              {"wrench_us", timesJson(r.wrenchTime)},
                              {"query_us", timesJson(r.queryTime)},
                              {"tick_us", timesJson(r.tickTime)}};
  if (isGroup) json["group"] = {{"name", s.part}, {"parts", s.members}};
  if (r.device)
    json["device"] = deviceJson(*r.device);
  else
    json["poses"] = s.poses;
  if (std::isfinite(r.leastDistance)) json["least_distance"] = r.leastDistance;
  json["least_distance_is_bound"] = r.isLeastDistanceBound;
  if (s.parameters.haptics.mode == HapticMode::Proxy) json["proxy"] = proxyJson(s);
  if (s.parameters.haptics.mode == HapticMode::Springs) json["springs"] = springsJson(s);
  if (!r.schedulingNote.empty()) {
    json["lateness_us"] = timesJson(r.lateness);
    json["overruns"] = r.overruns;
    json["scheduling"] = r.schedulingNote;
  }
  json["lost_rows"] = r.lostRows;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace nearfit::cli
