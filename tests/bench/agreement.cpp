#include "tests/bench/agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nearfit::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double difference(double distance, double reference, double cutoff, double tolerance) {
  if (distance == reference) return 0.0;
  const bool isBeyond = distance > cutoff, isReferenceBeyond = reference > cutoff;
  if (std::isfinite(distance) && std::isfinite(reference)) return std::abs(distance - reference);
  if (isBeyond && isReferenceBeyond) return 0.0;
  // One is infinite, the other within the cutoff: allowed at the cutoff itself.
  const double finite = std::min(distance, reference);
  return finite > cutoff - tolerance ? 0.0 : kInfinity;
}

const Answer& answerAt(const MethodRun& run, std::size_t pose) {
  const auto at = std::lower_bound(run.poses.begin(), run.poses.end(), pose);
  return run.answers[static_cast<std::size_t>(at - run.poses.begin())];
}

/// The first run of a kind; the first of all when there is none.
const MethodRun& firstOf(AnswerKind kind, std::span<const MethodRun> runs) {
  const auto found =
      std::find_if(runs.begin(), runs.end(), [=](const MethodRun& run) { return run.method->kind == kind; });
  return found != runs.end() ? *found : runs.front();
}

Agreement compare(const MethodRun& run, const MethodRun& reference, const MethodRun& firstSet, double cutoff,
                  double tolerance) {
  Agreement agreement;
  for (std::size_t i = 0; i < run.poses.size(); ++i) {
    const std::size_t pose = run.poses[i];
    const Answer& answer = run.answers[i];
    const double expected = answerAt(reference, pose).distance;
    const double d = difference(answer.distance, expected, cutoff, tolerance);
    if (d > agreement.worstDistance) {
      agreement.worstDistance = d;
      agreement.worstPose = pose;
    }
    if (!(expected > 0.0)) ++agreement.touching;
    if (!answer.isComplete) ++agreement.incomplete;
    if (run.method->kind == AnswerKind::FullSet && answer.count != answerAt(firstSet, pose).count)
      ++agreement.differentCounts;
  }
  agreement.holds = agreement.worstDistance <= tolerance && agreement.touching == 0 &&
                    agreement.incomplete == 0 && agreement.differentCounts == 0;
  return agreement;
}

}  // namespace

const MethodRun& referenceOf(std::span<const MethodRun> runs) {
  return firstOf(AnswerKind::Distance, runs);
}

std::vector<Agreement> compareRuns(std::span<const MethodRun> runs, double cutoff, double size) {
  if (runs.empty()) return {};
  const MethodRun& reference = referenceOf(runs);
  const MethodRun& firstSet = firstOf(AnswerKind::FullSet, runs);
  std::vector<Agreement> agreements;
  for (const MethodRun& run : runs)
    agreements.push_back(compare(run, reference, firstSet, cutoff, run.method->tolerance * size));
  return agreements;
}

}  // namespace nearfit::bench
