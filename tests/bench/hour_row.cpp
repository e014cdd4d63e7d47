#include "tests/bench/hour_row.h"

#include <vector>

#include <fmt/format.h>

#include "tests/bench/statistics.h"

namespace nearfit::bench {
namespace {

constexpr double kBytesOfMegabyte = 1e6;

double medianOf(std::span<const std::uint64_t> resident) {
  return SampleSummary(std::vector<double>(resident.begin(), resident.end())).percentile(0.5);
}

}  // namespace

std::string hourCsvHeader() {
  return "minute,memory_MB,ticks,overruns,late_p50_us,late_p99_us,late_p99_9_us,late_max_us,tick_p50_us,tick_"
         "p99_us,"
         "tick_max_us,in_contact,pictures\n";
}

std::string hourCsvLine(const HourRow& r) {
  const auto micro = [](double seconds) { return 1e6 * seconds; };
  return fmt::format("{:.3f},{:.3f},{},{},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.3f},{}\n",
                     r.minute, static_cast<double>(r.resident) / kBytesOfMegabyte, r.ticks, r.overruns,
                     micro(r.lateness.percentile(0.5)), micro(r.lateness.percentile(0.99)),
                     micro(r.lateness.percentile(0.999)), micro(r.lateness.max()),
                     micro(r.tickTime.percentile(0.5)), micro(r.tickTime.percentile(0.99)),
                     micro(r.tickTime.max()), r.contactShare, r.pictures);
}

std::int64_t growthOf(std::span<const std::uint64_t> resident) {
  if (resident.size() < kMinRowsOfGrowth) return 0;
  const std::size_t tenth = resident.size() / 10;
  return static_cast<std::int64_t>(medianOf(resident.last(tenth)) - medianOf(resident.subspan(tenth, tenth)));
}

}  // namespace nearfit::bench
