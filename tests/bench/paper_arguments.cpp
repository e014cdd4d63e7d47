#include "tests/bench/paper_arguments.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/mesh/mass_properties.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/feel_motion.h"
#include "tests/bench/feel_scenes.h"
#include "tests/bench/feel_servo.h"
#include "tests/bench/paper_hierarchy.h"
#include "tests/bench/scene_path.h"
#include "tests/bench/selection.h"
#include "tests/bench/units.h"

namespace nearfit::bench {
namespace {

/// Of the cutoff: how far the hand presses beyond contact, and the proxy's margin. As the cost runs of `feel`.
constexpr double kPressShare = 0.2, kMarginShare = 0.01;
/// Springs on both sides of a halved motion are one where their points are this close [of the cutoff]: points slide by
/// what is left of the motion times a leverage that grows with how nearly surfaces conform.
constexpr double kSameSpring = 1e-2;
/// Added to how far a gap can have changed in what is left of the motion [of the cutoff]: rounding of the turn.
constexpr double kMotionRounding = 1e-4;
/// What halving leaves counts as a jump above this share of a spring's 1 N, and above what it leaves of a smooth
/// change: one part in 4,096, sixteen times that where all of the change is in a corner of the motion.
constexpr double kLeastJump = 0.01, kSmoothShare = 16.0 / (1 << kHalvings);

RigidTransform midway(const RigidTransform& a, const RigidTransform& b) {
  return {glm::normalize(glm::slerp(a.rotation, b.rotation, 0.5)), 0.5 * (a.translation + b.translation)};
}

double changeBetween(const ContactAnswer& a, const ContactAnswer& b) {
  return glm::distance(a.wrench.force, b.wrench.force);
}

/// Counts springs of one side that the other has not.
void countUnmatched(const ContactAnswer& from, const ContactAnswer& in, double cutoff, double motion,
                    Jump& jump) {
  for (const Lmd& lmd : from.minima) {
    const bool isThere = std::any_of(in.minima.begin(), in.minima.end(), [&](const Lmd& other) {
      return glm::distance(lmd.scenePoint, other.scenePoint) <= kSameSpring * cutoff &&
             glm::distance(lmd.partPoint, other.partPoint) <= kSameSpring * cutoff;
    });
    if (isThere) continue;
    ++(cutoff - lmd.distance <= motion ? jump.atCutoff : jump.within);
  }
}

/// Keeps one method and asks it at any pose.
SpringMode modeOf(const ErrorMethodEntry& entry, const ErrorScene& scene) {
  const std::shared_ptr<ErrorMethod> method = entry.make(scene);
  return [method](const RigidTransform& pose, ContactAnswer& answer) {
    answer.clear();
    method->answer(pose, answer);
  };
}

struct NamedMode {
  std::string name;
  SpringMode at;
};

/// All modes but the proxy.
std::vector<NamedMode> modesOf(const ErrorScene& scene) {
  const auto error = [](const char* name) { return chosen(allErrorMethods(), {name}, "mode").front(); };
  const SpringMode exact = modeOf(error("exact cold"), scene);
  std::vector<NamedMode> modes;
  modes.push_back({"global minimum", [exact, &scene](const RigidTransform& pose, ContactAnswer& answer) {
                     exact(pose, answer);
                     if (answer.minima.size() > 1) answer.minima.resize(1);
                     answer.wrench = scene.wrenchOf(answer.minima, pose);
                   }});
  modes.push_back({"all pairs", modeOf(allPairsErrorMethod(), scene)});
  modes.push_back({"paper spans", modeOf(error("paper spans"), scene)});
  modes.push_back({"paper cones", modeOf(error("paper cones"), scene)});
  modes.push_back({"exact", exact});
  modes.push_back({"grouped", modeOf(error("exact grouped"), scene)});
  modes.push_back({"exact printed law", [exact, &scene](const RigidTransform& pose, ContactAnswer& answer) {
                     exact(pose, answer);
                     SpringParameters printed = scene.springs;
                     printed.law = SpringLaw::Printed;
                     // Its push is largest, a quarter of k cutoff^2, at half the cutoff: 1 N there.
                     printed.stiffness = 4.0 / (printed.cutoff * printed.cutoff);
                     answer.wrench = springWrench(answer.minima, printed, pose.translation, {});
                   }});
  return modes;
}

/// The way that the proxy's part takes under the hand, and what it feels.
struct ProxyWalk {
  std::vector<RigidTransform> poses;
  std::vector<Wrench> wrenches;
  std::vector<double> times, contacts;
};

ProxyWalk walkProxy(const PreparedScene& scene, const ArgumentOptions& options) {
  SeekingPathOptions seeking;
  seeking.ticks = options.ticks;
  seeking.speed = options.speed;
  seeking.press = kPressShare * scene.cutoff;
  seeking.seed = options.seed;
  const std::vector<RigidTransform> hand = seekingPath(scene, seeking);
  ServoParameters parameters;
  parameters.haptics.springs.cutoff = scene.cutoff;
  parameters.haptics.proxy.margin = kMarginShare * scene.cutoff;
  FeelServo servo(solidScene(scene.meshes.scene, scene.meshes.part, hand.front()), parameters,
                  ListArrival::AtOnce, options.clock);
  ProxyWalk walk;
  for (const RigidTransform& pose : hand) {
    const ServoSnapshot& felt = servo.tick(pose, ServoLoop::kPeriod);
    walk.poses.push_back(felt.proxy);
    walk.wrenches.push_back(felt.unclampedWrench);
    walk.times.push_back(servo.tickTime());
    walk.contacts.push_back(felt.contactCount);
  }
  return walk;
}

std::vector<double> changesOf(std::span<const Wrench> wrenches) {
  std::vector<double> changes;
  for (std::size_t i = 1; i < wrenches.size(); ++i)
    changes.push_back(glm::distance(wrenches[i].force, wrenches[i - 1].force));
  return changes;
}

std::vector<double> forcesOf(std::span<const Wrench> wrenches) {
  std::vector<double> forces;
  for (const Wrench& wrench : wrenches)
    forces.push_back(glm::length(wrench.force));
  return forces;
}

double radiusAboutOrigin(const TriangleMesh& mesh) {
  double radius = 0.0;
  for (const glm::dvec3& p : mesh.vertices())
    radius = std::max(radius, glm::length(p));
  return radius;
}

/// The ticks with the largest changes that can hold a jump.
std::vector<std::size_t> ticksToExamine(const std::vector<double>& changes, std::size_t max) {
  std::vector<std::size_t> order(changes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return changes[i] < kLeastJump; });
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return changes[a] > changes[b]; });
  if (order.size() > max) order.resize(max);
  return order;
}

std::vector<PaperFigure> jumpFigures(const FigureHead& head, const NamedMode& mode,
                                     std::span<const RigidTransform> poses,
                                     const std::vector<double>& changes, const ErrorScene& scene,
                                     std::size_t maxExamined) {
  const double radius = radiusAboutOrigin(scene.bodies.meshes.part);
  const std::vector<std::size_t> examined = ticksToExamine(changes, maxExamined);
  std::vector<double> jumps;
  std::vector<bool> isJump(changes.size(), false);
  double births = 0.0, atCutoff = 0.0;
  for (const std::size_t i : examined) {
    const Jump jump = jumpBetween(mode.at, poses[i], poses[i + 1], scene.bodies.cutoff, radius);
    if (jump.size < std::max(kLeastJump, kSmoothShare * jump.change)) continue;
    jumps.push_back(jump.size);
    isJump[i] = true;
    births += jump.within > 0 ? 1.0 : 0.0;
    atCutoff += jump.within == 0 && jump.atCutoff > 0 ? 1.0 : 0.0;
  }
  double smooth = 0.0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!isJump[i]) smooth = std::max(smooth, changes[i]);
  }
  return {paperFigure(head, mode.name, "jump of force [N]", jumps),
          paperFigure(head, mode.name, "ticks with a jump", static_cast<double>(jumps.size())),
          paperFigure(head, mode.name, "ticks examined for one", static_cast<double>(examined.size())),
          paperFigure(head, mode.name, "jumps with a birth or death within the cutoff", births),
          paperFigure(head, mode.name, "jumps with one at the cutoff alone", atCutoff),
          paperFigure(head, mode.name, "largest change without a jump found [N]", smooth)};
}

void keepSamples(std::vector<ForceSample>* samples, const FigureHead& head, const std::string& mode,
                 std::span<const Wrench> wrenches, std::span<const double> springs) {
  if (samples == nullptr) return;
  for (std::size_t i = 0; i < wrenches.size(); ++i)
    samples->push_back({head.scene, mode, i, wrenches[i], static_cast<std::size_t>(springs[i])});
}

std::vector<PaperFigure> modeFigures(const FigureHead& head, const NamedMode& mode,
                                     std::span<const RigidTransform> poses, const ErrorScene& scene,
                                     const ArgumentOptions& options, std::vector<ForceSample>* samples) {
  std::vector<Wrench> wrenches;
  std::vector<double> times, counts;
  ContactAnswer answer;
  for (const RigidTransform& pose : poses) {
    const double start = secondsBy(options.clock);
    mode.at(pose, answer);
    times.push_back(secondsBy(options.clock) - start);
    wrenches.push_back(answer.wrench);
    counts.push_back(static_cast<double>(answer.minima.size()));
  }
  keepSamples(samples, head, mode.name, wrenches, counts);
  const std::vector<double> changes = changesOf(wrenches);
  std::vector<PaperFigure> figures{paperFigure(head, mode.name, "springs", counts),
                                   paperFigure(head, mode.name, "force [N]", forcesOf(wrenches)),
                                   paperFigure(head, mode.name, "change of force a tick [N]", changes),
                                   paperFigure(head, mode.name, "tick [us]", times, kMicro)};
  const std::vector<PaperFigure> jumps = jumpFigures(head, mode, poses, changes, scene, options.maxExamined);
  figures.insert(figures.end(), jumps.begin(), jumps.end());
  return figures;
}

/// One body of the two as the one that is held: its springs push the other way.
std::vector<Lmd> seenFromScene(std::vector<Lmd> lmds) {
  for (Lmd& lmd : lmds) {
    std::swap(lmd.scenePoint, lmd.partPoint);
    lmd.direction = -lmd.direction;
  }
  return lmds;
}

/// The paper's centre of mass, from the box, beside that of the volume; and what it makes of the torque about it, of
/// either body as the one that is held.
std::vector<PaperFigure> centreFigures(const FigureHead& head, const ErrorScene& scene,
                                       std::span<const RigidTransform> poses) {
  const SpringMode exact = modeOf(chosen(allErrorMethods(), {"exact cold"}, "mode").front(), scene);
  std::vector<PaperFigure> figures;
  for (const bool isPart : {true, false}) {
    const TriangleMesh& mesh = isPart ? scene.bodies.meshes.part : scene.bodies.meshes.scene;
    const MassProperties mass = massProperties(mesh);
    // An open mesh has no volume: ours is then from a box too, and there is nothing to compare with.
    if (mass.basis != MassBasis::VolumeIntegrals) continue;
    const glm::dvec3 box = PaperHierarchy(mesh, PaperRule::AllPairs).boxCentre();
    const std::string name = isPart ? "box of the part" : "box of the scene";
    figures.push_back(paperFigure(head, name, "centre of mass off [of the diagonal]",
                                  glm::distance(box, mass.centre) / mesh.bounds().diagonal()));
    std::vector<double> errors;
    ContactAnswer answer;
    for (const RigidTransform& pose : poses) {
      exact(pose, answer);
      const RigidTransform sceneFromBody = isPart ? pose : RigidTransform{};
      const std::vector<Lmd> lmds = isPart ? answer.minima : seenFromScene(answer.minima);
      const glm::dvec3 right = springWrench(lmds, scene.springs, sceneFromBody.applyToPoint(mass.centre), {})
                                   .torque,
                       boxed = springWrench(lmds, scene.springs, sceneFromBody.applyToPoint(box), {}).torque;
      if (glm::length(right) > 0.0) errors.push_back(glm::distance(boxed, right) / glm::length(right));
    }
    figures.push_back(paperFigure(head, name, "torque error [relative]", errors));
  }
  return figures;
}

/// No point of the part moves farther between two poses [m].
double motionOf(const RigidTransform& from, const RigidTransform& to, double partRadius) {
  const double turn = 2.0 * std::acos(std::min(std::abs(glm::dot(from.rotation, to.rotation)), 1.0));
  return glm::distance(from.translation, to.translation) + turn * partRadius;
}

/// Springs that begin at the cutoff, and with what push: the paper says with none.
std::vector<PaperFigure> onsetFigures(const FigureHead& head, const ErrorScene& scene,
                                      std::span<const RigidTransform> poses) {
  const SpringMode exact = modeOf(chosen(allErrorMethods(), {"exact cold"}, "mode").front(), scene);
  const double radius = radiusAboutOrigin(scene.bodies.meshes.part), cutoff = scene.bodies.cutoff;
  std::vector<double> pushes, motions;
  ContactAnswer before, after;
  exact(poses.front(), before);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    exact(poses[i], after);
    const double motion = motionOf(poses[i - 1], poses[i], radius);
    const std::vector<double> onsets = onsetsAtCutoff(before, after, cutoff, motion);
    pushes.insert(pushes.end(), onsets.begin(), onsets.end());
    motions.push_back(motion / cutoff);
    std::swap(before, after);
  }
  return {paperFigure(head, "exact", "springs born at the cutoff", static_cast<double>(pushes.size())),
          paperFigure(head, "exact", "their push in the tick of birth [N]", pushes),
          paperFigure(head, "exact", "motion of a tick [of the cutoff]", motions)};
}

/// The printed law beside ours of the same name: force the same, torque as the print has it.
std::vector<PaperFigure> printFigures(const FigureHead& head, const ErrorScene& scene,
                                      std::span<const RigidTransform> poses) {
  const SpringMode exact = modeOf(chosen(allErrorMethods(), {"exact cold"}, "mode").front(), scene);
  SpringParameters ours = scene.springs;
  ours.law = SpringLaw::Printed;
  ours.stiffness = 4.0 / (ours.cutoff * ours.cutoff);
  std::vector<double> forces, cosines, ratios;
  ContactAnswer answer;
  for (const RigidTransform& pose : poses) {
    exact(pose, answer);
    const Wrench mine = springWrench(answer.minima, ours, pose.translation, {});
    const Wrench printed = wrenchAsPrinted(answer.minima, ours.cutoff, ours.stiffness, pose.translation);
    const double force = glm::length(mine.force), torque = glm::length(mine.torque),
                 printedTorque = glm::length(printed.torque);
    if (force > 0.0) forces.push_back(glm::distance(printed.force, mine.force) / force);
    if (!(torque > 0.0) || !(printedTorque > 0.0)) continue;
    cosines.push_back(glm::dot(printed.torque, mine.torque) / (torque * printedTorque));
    ratios.push_back(torque / printedTorque / ours.stiffness);
  }
  return {paperFigure(head, "as printed", "force differs from ours [relative]", forces),
          paperFigure(head, "as printed", "cosine of torque to ours", cosines),
          paperFigure(head, "as printed", "our torque over k times the printed", ratios)};
}

}  // namespace

Wrench wrenchAsPrinted(std::span<const Lmd> lmds, double cutoff, double stiffness,
                       const glm::dvec3& centreOfMass) noexcept {
  Wrench sum;
  for (const Lmd& lmd : lmds) {
    if (lmd.distance >= cutoff) continue;
    const glm::dvec3 toScene = -lmd.distance * lmd.direction;
    const glm::dvec3 f = (cutoff - lmd.distance) * toScene;
    sum.force += -stiffness * f;
    sum.torque += glm::cross(lmd.partPoint - centreOfMass, f);
  }
  return sum;
}

Jump jumpBetween(const SpringMode& mode, const RigidTransform& from, const RigidTransform& to, double cutoff,
                 double partRadius) {
  RigidTransform low = from, high = to;
  ContactAnswer atLow, atHigh, between;
  mode(low, atLow);
  mode(high, atHigh);
  Jump jump;
  jump.change = changeBetween(atLow, atHigh);
  for (int i = 0; i < kHalvings; ++i) {
    const RigidTransform middle = midway(low, high);
    mode(middle, between);
    if (changeBetween(atLow, between) >= changeBetween(between, atHigh)) {
      high = middle;
      std::swap(atHigh, between);
    } else {
      low = middle;
      std::swap(atLow, between);
    }
  }
  jump.size = changeBetween(atLow, atHigh);
  // A gap changes by no more than points move; twice that, for the rounding of what is left.
  const double motion = 2.0 * motionOf(low, high, partRadius) + kMotionRounding * cutoff;
  countUnmatched(atHigh, atLow, cutoff, motion, jump);
  countUnmatched(atLow, atHigh, cutoff, motion, jump);
  return jump;
}

std::vector<double> onsetsAtCutoff(const ContactAnswer& before, const ContactAnswer& after, double cutoff,
                                   double motion) {
  std::vector<double> pushes;
  for (const Lmd& lmd : after.minima) {
    const bool isOld = std::any_of(before.minima.begin(), before.minima.end(), [&](const Lmd& other) {
      return lmd.sceneFeature == other.sceneFeature && lmd.sceneIndex == other.sceneIndex &&
             lmd.partFeature == other.partFeature && lmd.partIndex == other.partIndex;
    });
    const double depth = cutoff - lmd.distance;
    if (!isOld && depth >= 0.0 && depth <= motion) pushes.push_back(depth / cutoff);
  }
  return pushes;
}

std::vector<PaperFigure> argumentFigures(const PaperRow& row, const BenchScene& meshes,
                                         const ArgumentOptions& options, std::vector<ForceSample>* samples) {
  const FigureHead head{"arguments", meshes.name, ""};
  const PreparedScene prepared(meshes, row.cutoffFraction);
  const ErrorScene scene(meshes.scene, meshes.part, prepared.cutoff);
  const ProxyWalk walk = walkProxy(prepared, options);
  std::vector<PaperFigure> figures{
      paperFigure(head, "proxy", "springs", walk.contacts),
      paperFigure(head, "proxy", "force [N]", forcesOf(walk.wrenches)),
      paperFigure(head, "proxy", "change of force a tick [N]", changesOf(walk.wrenches)),
      paperFigure(head, "proxy", "tick [us]", walk.times, kMicro)};
  keepSamples(samples, head, "proxy", walk.wrenches, walk.contacts);
  const auto append = [&figures](std::vector<PaperFigure> more) {
    figures.insert(figures.end(), more.begin(), more.end());
  };
  for (const NamedMode& mode : modesOf(scene))
    append(modeFigures(head, mode, walk.poses, scene, options, samples));
  append(onsetFigures(head, scene, walk.poses));
  append(centreFigures(head, scene, walk.poses));
  append(printFigures(head, scene, walk.poses));
  return figures;
}

}  // namespace nearfit::bench
