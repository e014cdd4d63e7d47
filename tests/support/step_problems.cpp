#include "tests/support/step_problems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

namespace nearfit::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Makes the rows of one problem.
class Maker {
 public:
  Maker(std::uint64_t seed, std::size_t rows) : random_(seed), count_(rows) {}

  StepProblem make(StepProblemKind kind) {
    chooseBody(kind == StepProblemKind::ExtremeScales);
    chooseGoal();
    switch (kind) {
      case StepProblemKind::Random:
      case StepProblemKind::ExtremeScales:
        addRandom();
        break;
      case StepProblemKind::NearParallel:
        addClusters();
        break;
      case StepProblemKind::Opposing:
        addOpposing();
        break;
      case StepProblemKind::Wedge:
        addWedge();
        break;
      case StepProblemKind::Duplicates:
        addDuplicates();
        break;
      case StepProblemKind::NoRotation:
        addWithoutRotation();
        break;
      case StepProblemKind::Ring:
        addRing();
        break;
      case StepProblemKind::Floor:
        addFloor();
        break;
    }
    const double least = problem_.rows.size() > 0 ? problem_.rows.leastClearance({}).clearance : margin_;
    problem_.goal.cost.floor = choose({0.0, 0.5, 1.0}) * std::min(least, margin_);
    return std::move(problem_);
  }

 private:
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double uniform(double from, double to) { return from + (to - from) * uniform(); }
  double decade(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
  double choose(std::array<double, 3> of) { return of[random_() % of.size()]; }
  glm::dvec3 direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, kTurn), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  glm::dvec3 nearly(const glm::dvec3& u, double angle) { return glm::normalize(u + angle * direction()); }

  void chooseBody(bool isExtreme) {
    StepGoal& goal = problem_.goal;
    radius_ = isExtreme ? decade(1e-6, 1e3) : decade(0.01, 1.0);
    const double least = isExtreme ? 1e-3 : 0.2;
    goal.radius = radius_;
    goal.gyration = radius_ * glm::dvec3(uniform(least, 0.6), uniform(least, 0.6), uniform(least, 0.6));
    margin_ = radius_ * decade(1e-4, 1e-2);
    goal.cost.margin = margin_;
    goal.cost.weight = decade(50.0, 1e6);
  }

  void chooseGoal() {
    // A hand that is with the part, or far away as after a jump.
    const double length = margin_ * decade(0.1, 1e4);
    const glm::dvec3 v = direction(), w = direction();
    const double share = uniform();
    for (int k = 0; k < 3; ++k) {
      problem_.goal.wanted[static_cast<std::size_t>(k)] = length * share * v[k];
      problem_.goal.wanted[static_cast<std::size_t>(k) + 3] = length * (1.0 - share) * w[k];
    }
  }

  void add(const glm::dvec3& u, const glm::dvec3& arm, double distance) {
    const glm::dvec3 turn = glm::cross(arm, u) / problem_.goal.gyration;
    problem_.rows.add({u.x, u.y, u.z, turn.x, turn.y, turn.z}, distance);
    problem_.arms.push_back(arm);
  }
  glm::dvec3 arm() { return radius_ * uniform() * direction(); }
  double distance() { return margin_ * uniform(0.0, 4.0); }

  void addRandom() {
    while (problem_.rows.size() < count_)
      add(direction(), arm(), distance());
  }

  void addClusters() {
    const std::size_t clusters = 1 + random_() % 5;
    while (problem_.rows.size() < count_) {
      const glm::dvec3 u = direction(), at = arm();
      const double angle = decade(1e-12, 1e-3), d = distance();
      const std::size_t end = std::min(count_, problem_.rows.size() + (count_ + clusters - 1) / clusters);
      while (problem_.rows.size() < end)
        add(nearly(u, angle), at + radius_ * angle * direction(), d * (1.0 + angle * uniform()));
    }
  }

  void addOpposing() {
    while (problem_.rows.size() < count_) {
      const glm::dvec3 u = direction();
      const double gap = margin_ * choose({0.0, 0.3, 1.9}), angle = choose({0.0, 1e-9, 1e-4});
      const double share = uniform();
      add(u, arm(), share * gap);
      if (problem_.rows.size() < count_) add(-nearly(u, angle), arm(), (1.0 - share) * gap);
    }
  }

  void addWedge() {
    const glm::dvec3 u = direction(), in = glm::normalize(glm::cross(u, direction()));
    const double angle = decade(1e-4, 1.0);
    const glm::dvec3 walls[2] = {glm::normalize(u - angle * in), glm::normalize(-u - angle * in)};
    for (int k = 0; k < 3; ++k)
      problem_.goal.wanted[static_cast<std::size_t>(k)] += 100.0 * margin_ * in[k];
    while (problem_.rows.size() < count_)
      add(walls[random_() % 2], arm(), margin_ * uniform(0.5, 1.5));
  }

  void addDuplicates() {
    while (problem_.rows.size() < count_) {
      const glm::dvec3 u = direction(), at = arm();
      const double d = distance();
      const std::size_t end = std::min(count_, problem_.rows.size() + 1 + random_() % 40);
      while (problem_.rows.size() < end)
        add(u, at, d);
    }
  }

  void addWithoutRotation() {
    while (problem_.rows.size() < count_)
      add(direction(), glm::dvec3(0.0), distance());
  }

  void addRing() {
    const double bore = 0.4 * radius_, facet = decade(1e-8, 1e-2);
    const double tilt = uniform(0.0, kTurn);
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t pair = i / 2;
      const double angle = kTurn * static_cast<double>(pair) / static_cast<double>(count_) * 2.0;
      const glm::dvec3 out(std::cos(angle), std::sin(angle), 0.0);
      const glm::dvec3 at = bore * out + glm::dvec3(0.0, 0.0, (i % 2 ? 0.8 : -0.8) * radius_);
      add(nearly(-out, facet), at, margin_ * (1.0 + 0.3 * std::cos(angle - tilt) + facet * uniform()));
    }
  }

  void addFloor() {
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count_))));
    const double rounding = choose({0.0, 1e-9, 1e-6});
    problem_.goal.wanted[2] -= 10.0 * margin_;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t row = i / side, column = i % side;
      const double x = side < 2 ? 0.0 : static_cast<double>(column) / static_cast<double>(side - 1) - 0.5;
      const double y = side < 2 ? 0.0 : static_cast<double>(row) / static_cast<double>(side - 1) - 0.5;
      add(nearly({0.0, 0.0, 1.0}, rounding), radius_ * glm::dvec3(x, y, -0.5),
          margin_ * (1.0 + rounding * uniform()));
    }
  }

  std::mt19937_64 random_;
  std::size_t count_;
  double radius_ = 1.0, margin_ = 1.0;
  StepProblem problem_;
};

}  // namespace

std::string nameOf(StepProblemKind kind) {
  static constexpr std::array<const char*, 9> kNames{"random",         "near-parallel", "opposing",
                                                     "wedge",          "duplicates",    "no rotation",
                                                     "extreme scales", "ring",          "floor"};
  return kNames[static_cast<std::size_t>(kind)];
}

StepProblem makeStepProblem(StepProblemKind kind, std::uint64_t seed, std::size_t rows) {
  return Maker(seed, rows).make(kind);
}

double lengthOf(const StepProblem& problem) {
  double squared = 0.0;
  for (const double y : problem.goal.wanted)
    squared += y * y;
  const double margin = problem.goal.cost.margin;
  const double least = problem.rows.leastClearance({}).clearance;
  return problem.rows.largestNorm() *
         (std::sqrt(squared) + std::abs(margin) + std::abs(std::min(margin, least)));
}

}  // namespace nearfit::test
