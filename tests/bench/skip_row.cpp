#include "tests/bench/skip_row.h"

#include <algorithm>
#include <istream>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tests/bench/statistics.h"
#include "tests/bench/units.h"

namespace nearfit::bench {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SkipSide, seconds, bytes, answers)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SkipRow, skip, where, measure, remark, with, without)

namespace {

struct Figures {
  double p50, p99;  ///< [us]
};

Figures figuresOf(const SkipSide& side) {
  const SampleSummary summary(side.seconds);
  return {kMicro * summary.percentile(0.5), kMicro * summary.percentile(0.99)};
}

struct Turn {
  std::size_t begin, end;
  bool isFirstRound;
};

void take(SkipSide& side, const SkipWay& way, const Turn& turn, const RunOptions& options) {
  // The questions just before warm the caches.
  for (std::size_t i = turn.begin - std::min(turn.begin, options.warmUp); i < turn.begin; ++i)
    way.ask(i);
  for (std::size_t i = turn.begin; i < turn.end; ++i) {
    const double start = secondsBy(options.clock);
    way.ask(i);
    side.seconds.push_back(secondsBy(options.clock) - start);
    if (turn.isFirstRound) side.answers.push_back(way.answer());
  }
}

}  // namespace

void takeTurns(SkipRow& row, std::size_t questions, const SkipWay& with, const SkipWay& without,
               const RunOptions& options) {
  bool isWithFirst = true;
  for (std::size_t round = 0; round < options.rounds; ++round) {
    for (std::size_t begin = 0; begin < questions; begin += options.block) {
      const Turn turn{begin, std::min(begin + options.block, questions), round == 0};
      if (isWithFirst) take(row.with, with, turn, options);
      take(row.without, without, turn, options);
      if (!isWithFirst) take(row.with, with, turn, options);
      isWithFirst = !isWithFirst;
    }
  }
}

std::string skipTableHeader() {
  return fmt::format("{:<12}{:<25}{:<17}{:>8}{:>13}{:>13}{:>13}{:>13}{:>11}{:>11}{:>10}{:>10}{:>6}  {}\n",
                     "skip", "where", "of", "times", "p50 us", "without", "p99 us", "without", "p50 x",
                     "p99 x", "MB", "without", "same", "not computed");
}

std::string skipTableLine(const SkipRow& r) {
  const Figures with = figuresOf(r.with), without = figuresOf(r.without);
  const auto megabytes = [](std::size_t bytes) {
    return bytes == 0 ? std::string() : fmt::format("{:.3f}", static_cast<double>(bytes) / kMegabyte);
  };
  return fmt::format(
      "{:<12}{:<25}{:<17}{:>8}{:>13.2f}{:>13.2f}{:>13.2f}{:>13.2f}{:>11.2f}{:>11.2f}{:>10}{:>10}{:>6}  {}\n",
      r.skip, r.where, r.measure, r.with.seconds.size(), with.p50, without.p50, with.p99, without.p99,
      without.p50 / with.p50, without.p99 / with.p99, megabytes(r.with.bytes), megabytes(r.without.bytes),
      r.isSame() ? "yes" : "NO", r.remark);
}

std::string skipCsvHeader() {
  return "skip,where,of,times,with_p50_us,without_p50_us,with_p99_us,without_p99_us,p50_ratio,p99_ratio,"
         "with_bytes,without_bytes,same,not_computed\n";
}

std::string skipCsvLine(const SkipRow& r) {
  const Figures with = figuresOf(r.with), without = figuresOf(r.without);
  return fmt::format("{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},{},{},{},{}\n", r.skip, r.where,
                     r.measure, r.with.seconds.size(), with.p50, without.p50, with.p99, without.p99,
                     without.p50 / with.p50, without.p99 / with.p99, r.with.bytes, r.without.bytes,
                     r.isSame() ? 1 : 0, r.remark);
}

void writeSkipRows(std::ostream& out, std::span<const SkipRow> rows) {
  out << nlohmann::json(std::vector<SkipRow>(rows.begin(), rows.end()));
}

std::vector<SkipRow> readSkipRows(std::istream& in) {
  try {
    return nlohmann::json::parse(in).get<std::vector<SkipRow>>();
  } catch (const nlohmann::json::exception& e) {
    throw Error("rows of another program", e.what(), "run it by itself to see what it says");
  }
}

void checkSame(std::span<const SkipRow> rows) {
  for (const SkipRow& row : rows) {
    if (row.isSame()) continue;
    throw Error(row.where, fmt::format("\"{}\" gives other answers than are found without it", row.skip),
                "find the first that differs, for exactness is lost");
  }
}

}  // namespace nearfit::bench
