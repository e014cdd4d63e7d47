#include "tests/bench/suggest_row.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/bench/statistics.h"

namespace nearfit::bench {
namespace {

/// Takes off a share of a whole number what rounding adds to it.
constexpr double kShareRounding = 1e-9;

}  // namespace

void SuggestRow::add(const SuggestedPath& path) {
  seconds.push_back(path.seconds);
  if (!path.isSaidFound) return;
  ++said;
  ++methods.at(static_cast<std::size_t>(path.method));
  certified += path.proof.isCertified ? 1 : 0;
  verified += path.proof.isVerified ? 1 : 0;
  free += path.looks.meetings == 0 ? 1 : 0;
  places = std::max(places, path.looks.places);
  tested += path.looks.tested;
  meetings += path.looks.meetings;
  if (path.isConfirmed() && path.seconds <= limit) ++found;
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

const char* wordOf(PathSearchMethod method) {
  switch (method) {
    case PathSearchMethod::Straight:
      return "straight";
    case PathSearchMethod::Sliding:
      return "sliding";
    case PathSearchMethod::SlidingTrees:
      return "sliding_trees";
    case PathSearchMethod::ConnectedTrees:
      break;
  }
  return "connected_trees";
}

std::string suggestCsvHeader() {
  std::string header =
      "scene,seeds,found,p50_s,max_s,goal,met,said_found,certified,verified,free,places,tested,meetings";
  for (std::size_t i = 0; i < SuggestRow().methods.size(); ++i)
    header += fmt::format(",{}", wordOf(static_cast<PathSearchMethod>(i)));
  return header + "\n";
}

std::string suggestCsvLine(const SuggestRow& r) {
  return fmt::format("{},{},{},{:.4g},{:.4g},{} of {} within {:g} s,{},{},{},{},{},{},{},{},{}\n", r.scene,
                     r.seeds(), r.found, r.median(), r.max(), r.wanted(), r.seeds(), r.limit,
                     r.isMet() ? "yes" : "no", r.said, r.certified, r.verified, r.free, r.places, r.tested,
                     r.meetings, fmt::join(r.methods, ","));
}

}  // namespace nearfit::bench
