#include "tests/bench/paper_judge.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>

#include "core/parallel/parallel_for.h"

namespace nearfit::bench {
namespace {

/// Margins of ExactMinimum: a sure minimum meets its conditions by so many times what is resolved, one that misses
/// them by more than the other is none. As ExactJudge has them.
constexpr double kSureMargin = 10.0, kLeastMargin = -2.0;
/// Features tilted against each other by no more than this may be reported as one flat region, at its centroid [rad].
/// A minimum there has no sure place.
constexpr double kFlatAngle = 2e-6;

bool isAtPlace(const Lmd& a, const glm::dvec3& scenePoint, const glm::dvec3& partPoint, double tolerance) {
  return glm::distance(a.scenePoint, scenePoint) <= tolerance &&
         glm::distance(a.partPoint, partPoint) <= tolerance;
}

/// False for a flat region, and for one so little tilted that it may be reported as such.
bool isPoint(const test::ExactMinimum& e) {
  return !e.isFlat && std::min(e.angle, e.tilt) > kFlatAngle;
}

bool isCloseCall(const Lmd& found, const test::ExactMinimum& e, double tolerance, double size) {
  // Anywhere in a flat region: at its distance and in its direction.
  if (e.isFlat || (found.isRegion && !isPoint(e))) {
    return std::abs(found.distance - e.distance) <= kFlatAngle * size &&
           glm::distance(found.direction, e.direction) <= kFlatAngle * size / e.distance;
  }
  return isAtPlace(found, e.scenePoint, e.partPoint, tolerance + e.place);
}

Lmd lmdOf(const test::ExactMinimum& e) {
  Lmd lmd;
  lmd.scenePoint = e.scenePoint;
  lmd.partPoint = e.partPoint;
  lmd.distance = e.distance;
  lmd.direction = e.direction;
  return lmd;
}

std::optional<double> relativeError(const glm::dvec3& value, const glm::dvec3& truth) {
  const double length = glm::length(truth);
  if (!(length > 0.0)) return std::nullopt;
  return glm::distance(value, truth) / length;
}

/// What one method did at all poses.
struct JudgedLane {
  std::vector<double> missed, spurious, force, torque, differs;

  void add(const Judgement& j) {
    missed.push_back(static_cast<double>(j.missed));
    spurious.push_back(static_cast<double>(j.spurious));
    differs.push_back(j.missed + j.spurious > 0 ? 1.0 : 0.0);
    if (j.force) force.push_back(*j.force);
    if (j.torque) torque.push_back(*j.torque);
  }
};

}  // namespace

JudgedPose judgedPose(const test::ExactOracle& oracle, const ErrorScene& scene,
                      const RigidTransform& sceneFromPart) {
  const double cutoff = scene.bodies.cutoff, tolerance = kSamePlaceShare * oracle.size();
  JudgedPose truth{sceneFromPart, {}, {}, {}};
  for (const test::ExactMinimum& e : oracle.minima(sceneFromPart, cutoff + tolerance, kLeastMargin)) {
    const bool isSure = e.margin > kSureMargin && e.isPromised && isPoint(e) &&
                        e.distance <= cutoff - tolerance && e.distance > tolerance;
    if (!isSure) {
      truth.closeCalls.push_back(e);
      continue;
    }
    const bool isThere = std::any_of(truth.minima.begin(), truth.minima.end(), [&](const Lmd& lmd) {
      return isAtPlace(lmd, e.scenePoint, e.partPoint, tolerance);
    });
    if (!isThere) truth.minima.push_back(lmdOf(e));
  }
  truth.wrench = scene.wrenchOf(truth.minima, sceneFromPart);
  return truth;
}

Judgement judge(const ContactAnswer& answer, const JudgedPose& truth, double size) {
  const double tolerance = kSamePlaceShare * size;
  Judgement judgement;
  std::vector<bool> isFound(truth.minima.size(), false);
  for (const Lmd& found : answer.minima) {
    bool isTrue = false;
    for (std::size_t i = 0; i < truth.minima.size() && !isTrue; ++i) {
      if (isFound[i] || !isAtPlace(found, truth.minima[i].scenePoint, truth.minima[i].partPoint, tolerance))
        continue;
      isFound[i] = isTrue = true;
    }
    if (isTrue) continue;
    const bool isClose = std::any_of(truth.closeCalls.begin(), truth.closeCalls.end(),
                                     [&](const auto& e) { return isCloseCall(found, e, tolerance, size); });
    judgement.spurious += isClose ? 0 : 1;
  }
  judgement.missed = static_cast<std::size_t>(std::count(isFound.begin(), isFound.end(), false));
  if (truth.isWrenchKnown()) {
    judgement.force = relativeError(answer.wrench.force, truth.wrench.force);
    judgement.torque = relativeError(answer.wrench.torque, truth.wrench.torque);
  }
  return judgement;
}

std::vector<PaperFigure> judgeFigures(const FigureHead& head, const ErrorScene& scene,
                                      std::span<const ErrorMethodEntry> methods,
                                      std::span<const RigidTransform> poses) {
  // The meshes that are searched: merging flats moves vertices by up to the rounding of the file's numbers, which says
  // nothing of how a method searches.
  const NormalConeTree &sceneTree = scene.bodies.sceneTree, &partTree = scene.bodies.partTree;
  const test::ExactOracle oracle(sceneTree.mesh(), partTree.mesh());
  std::vector<std::optional<JudgedPose>> truths(poses.size());
  parallelFor(poses.size(), [&](std::size_t i) { truths[i] = judgedPose(oracle, scene, poses[i]); });
  std::vector<double> minima, known;
  for (const auto& truth : truths) {
    minima.push_back(static_cast<double>(truth->minima.size()));
    known.push_back(truth->isWrenchKnown() ? 1.0 : 0.0);
  }
  std::vector<PaperFigure> figures{paperFigure(head, "oracle", "minima", minima),
                                   paperFigure(head, "oracle", "wrench known [share]", known),
                                   paperFigure(head, "oracle", "searched meshes off the files by up to [m]",
                                               std::max(sceneTree.deviation(), partTree.deviation()))};
  ContactAnswer answer;
  for (const ErrorMethodEntry& entry : methods) {
    const std::unique_ptr<ErrorMethod> method = entry.make(scene);
    JudgedLane lane;
    for (const auto& truth : truths) {
      answer.clear();
      method->answer(truth->sceneFromPart, answer);
      lane.add(judge(answer, *truth, oracle.size()));
      method->workAside(truth->sceneFromPart);
    }
    figures.push_back(paperFigure(head, entry.name, "minima missed", lane.missed));
    figures.push_back(paperFigure(head, entry.name, "minima that are none", lane.spurious));
    figures.push_back(paperFigure(head, entry.name, "poses with another set [share]", lane.differs));
    figures.push_back(paperFigure(head, entry.name, "force error [relative]", lane.force));
    figures.push_back(paperFigure(head, entry.name, "torque error [relative]", lane.torque));
  }
  return figures;
}

}  // namespace nearfit::bench
