#include "tests/bench/step_run.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/haptics/friction_program.h"
#include "core/haptics/step_program.h"
#include "tests/bench/gauss_seidel.h"
#include "tests/bench/statistics.h"
#include "tests/exact/exact_step.h"

namespace nearfit::bench {
namespace {

using test::StepProblem;
using test::StepProblemKind;

constexpr StepProblemKind kKinds[] = {StepProblemKind::Ring, StepProblemKind::Floor, StepProblemKind::Wedge};

/// At which Gauss and Seidel's method may stop, as a fraction of the margin: coarse beside what the others
/// give.
constexpr double kGaussSeidelTolerance = 1e-6;
constexpr unsigned kMaxSweeps = 2000;

constexpr double kFriction = 0.2;

/// What one method did on one kind of problems.
class Record {
 public:
  void add(double seconds, double solves, double changes, bool isSettled, double differs) {
    times_.push_back(1e6 * seconds);
    solves_ += solves;
    changes_ += changes;
    settled_ += isSettled ? 1.0 : 0.0;
    differs_ = std::max(differs_, differs);
  }

  StepRunRow row(const std::string& kind, const std::string& method, std::size_t rows) const {
    const SampleSummary s(times_);
    const auto count = static_cast<double>(times_.size());
    return {kind,
            method,
            rows,
            times_.size(),
            s.percentile(0.5),
            s.percentile(0.99),
            s.percentile(0.999),
            s.max(),
            solves_ / count,
            changes_ / count,
            settled_ / count,
            differs_};
  }

 private:
  std::vector<double> times_;
  double solves_ = 0.0, changes_ = 0.0, settled_ = 0.0, differs_ = 0.0;
};

/// All methods on the problems of one kind with one number of rows.
class Measurement {
 public:
  Measurement(const StepRunOptions& options, StepProblemKind kind, std::size_t rows)
      : options_(options), kind_(kind), rows_(rows) {}

  void run() {
    for (std::size_t round = 0; round < options_.rounds; ++round)
      for (std::size_t i = 0; i < options_.problems; ++i)
        measure(test::makeStepProblem(kind_, options_.seed + i, rows_), i, round == 0);
  }

  void appendRows(std::vector<StepRunRow>& out) const {
    const std::string kind = test::nameOf(kind_);
    out.push_back(program_.row(kind, "nearfit", rows_));
    out.push_back(friction_.row(kind, "nearfit-friction", rows_));
    out.push_back(once_.row(kind, "nearfit-once", rows_));
    out.push_back(gaussSeidel_.row(kind, "gauss-seidel", rows_));
    out.push_back(exact_.row(kind, "cgal-exact", rows_));
  }

 private:
  double now() const { return secondsBy(options_.clock); }

  void measure(StepProblem problem, std::size_t index, bool isFirstRound) {
    problem.goal.reach = options_.reachMargins * problem.goal.cost.margin;
    written_.clear();
    for (std::size_t i = 0; i < problem.rows.size(); ++i)
      written_.add(problem.rows.row(i), problem.rows.distance(i));
    const double start = now();
    const StepSolution step = stepProgram_.solve(written_, problem.goal);
    program_.add(now() - start, step.solves, step.changes, step.isExact, 0.0);

    const double startFriction = now();
    const FrictionSolution rubbed =
        frictionProgram_.solve(written_, {problem.goal, kFriction, problem.arms, glm::dmat3(1.0)});
    friction_.add(now() - startFriction, rubbed.sweeps, rubbed.step.changes, rubbed.isSettled, 0.0);

    // The others get the goal that the search ended with, and no bound.
    for (double& y : problem.goal.wanted)
      y *= step.scale;
    const double startOnce = now();
    solver_.begin(written_, problem.goal.cost, StepProgram::kMaxChanges);
    const DualStepSolver::Point point = solver_.solve(problem.goal.wanted);
    const double once = now() - startOnce;
    const auto differs = [&](StepVector y) {
      for (double& value : y)
        value *= step.share;
      return difference(y, step.y) / test::lengthOf(problem);
    };
    once_.add(once, 1.0, solver_.changes(), point.isExact, differs(point.y));
    if (isFirstRound) measurePeers(problem, index, differs);
  }

  template <typename Differs>
  void measurePeers(const StepProblem& problem, std::size_t index, Differs differs) {
    if (index % options_.gaussSeidelStride == 0) {
      const double start = now();
      const GaussSeidelStep step =
          gaussSeidelStep(written_, problem.goal.cost, problem.goal.wanted,
                          kGaussSeidelTolerance * problem.goal.cost.margin, kMaxSweeps);
      gaussSeidel_.add(now() - start, 1.0, step.sweeps, step.isSettled, differs(step.y));
    }
    if (index % options_.exactStride == 0) {
      const double start = now();
      const test::ExactStep step = test::exactStep(written_, problem.goal.cost, problem.goal.wanted);
      exact_.add(now() - start, 1.0, 0.0, step.isSolved, differs(step.y));
    }
  }

  static double difference(const StepVector& a, const StepVector& b) {
    double squared = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
      squared += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(squared);
  }

  const StepRunOptions& options_;
  StepProblemKind kind_;
  std::size_t rows_;
  StepRows written_;
  StepProgram stepProgram_;
  FrictionProgram frictionProgram_;
  DualStepSolver solver_;
  Record program_, friction_, once_, gaussSeidel_, exact_;
};

}  // namespace

std::vector<StepRunRow> runSteps(const StepRunOptions& options) {
  std::vector<StepRunRow> out;
  for (const StepProblemKind kind : kKinds)
    for (const std::size_t rows : options.rows) {
      Measurement measurement(options, kind, rows);
      measurement.run();
      measurement.appendRows(out);
    }
  return out;
}

std::string stepRunTable(const std::vector<StepRunRow>& rows) {
  std::string out = fmt::format("{:<7}{:>5}  {:<17}{:>9}{:>10}{:>10}{:>10}{:>11}{:>8}{:>9}{:>9}{:>10}\n",
                                "kind", "rows", "method", "problems", "p50", "p99", "p99.9", "max", "solves",
                                "changes", "settled", "differs");
  for (const StepRunRow& r : rows)
    out += fmt::format(
        "{:<7}{:>5}  {:<17}{:>9}{:>10.2f}{:>10.2f}{:>10.2f}{:>11.2f}{:>8.2f}{:>9.1f}{:>9.4f}{:>10.1e}\n",
        r.kind, r.rows, r.method, r.solved, r.p50, r.p99, r.p999, r.max, r.solves, r.changes, r.settled,
        r.differs);
  return out;
}

std::string stepRunCsv(const std::vector<StepRunRow>& rows) {
  std::string out =
      "kind,rows,method,problems,p50_us,p99_us,p99_9_us,max_us,mean_solves,mean_changes,settled,differs\n";
  for (const StepRunRow& r : rows)
    out += fmt::format("{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.2e}\n", r.kind,
                       r.rows, r.method, r.solved, r.p50, r.p99, r.p999, r.max, r.solves, r.changes,
                       r.settled, r.differs);
  return out;
}

}  // namespace nearfit::bench
