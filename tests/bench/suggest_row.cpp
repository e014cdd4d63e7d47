#include "tests/bench/suggest_row.h"

#include <cmath>

#include <fmt/format.h>

#include "tests/bench/statistics.h"

namespace nearfit::bench {
namespace {

/// Takes off a share of a whole number what rounding adds to it.
constexpr double kShareRounding = 1e-9;

}  // namespace

void SuggestRow::add(bool isFound, double time) {
  seconds.push_back(time);
  if (isFound && time <= limit) ++found;
}

std::size_t SuggestRow::wanted() const {
  return static_cast<std::size_t>(std::ceil(share * static_cast<double>(seeds()) - kShareRounding));
}

double SuggestRow::median() const {
  return SampleSummary(seconds).percentile(0.5);
}

double SuggestRow::max() const {
  return SampleSummary(seconds).max();
}

std::string suggestCsvHeader() {
  return "scene,seeds,found,p50_s,max_s,goal,met\n";
}

std::string suggestCsvLine(const SuggestRow& r) {
  return fmt::format("{},{},{},{:.4g},{:.4g},{} of {} within {:g} s,{}\n", r.scene, r.seeds(), r.found,
                     r.median(), r.max(), r.wanted(), r.seeds(), r.limit, r.isMet() ? "yes" : "no");
}

}  // namespace nearfit::bench
