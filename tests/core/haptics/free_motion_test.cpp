#include "core/haptics/free_motion.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"

namespace nearfit::free_motion_test {
namespace {

const CouplingState kCoupling{500.0, 2.0, 0.3, 1e-3, false};
const MassMetric kMetric{rotationOf({0.4, 0.9, -1.2}), {0.01, 0.02, 0.03}, 0.05};
const glm::dvec3 kCentre(0.02, -0.01, 0.03);

/// x'' m + x' B + x K = 0 from x(0) = 1, x'(0) = 0.
double dampedOscillation(double mass, double stiffness, double damping, double time) {
  const double decay = damping / (2.0 * mass);
  const double frequency = std::sqrt(stiffness / mass - decay * decay);
  return std::exp(-decay * time) *
         (std::cos(frequency * time) + decay / frequency * std::sin(frequency * time));
}

/// Where a part ends that starts at rest, shifted by `shift` and turned by `turn` from a handle that stays at
/// the origin: shift of the centre and rotation vector.
std::array<glm::dvec3, 2> letGo(const FeltMass& felt, const glm::dvec3& shift, const glm::dvec3& turn,
                                double time, int steps) {
  const BodyMotion handle;
  BodyMotion part;
  part.pose.rotation = rotationOf(turn);
  part.pose.translation = kCentre + shift - part.pose.rotation * kCentre;
  for (int i = 0; i < steps; ++i)
    part = freeStep(felt, kCoupling, kMetric, kCentre, handle, part, time / steps);
  return {part.pose.applyToPoint(kCentre) - kCentre, rotationVector(part.pose.rotation)};
}

TEST(FreeStep, ConvergesToTheDampedOscillationInTheFirstOrderOfTheStep) {
  const double mass = 0.2, time = 0.05, inertia = mass * 0.03 * 0.03;
  const glm::dvec3 shift(0.006, -0.002, 0.003), turn(0.1, 0.2, -0.05);
  const glm::dvec3 endShift = shift * dampedOscillation(mass, 500.0, 2.0, time);
  const glm::dvec3 endTurn = turn * dampedOscillation(inertia, 0.3, 1e-3, time);
  std::array<double, 2> last{};
  for (const int steps : {400, 800, 1600, 3200}) {
    const auto [end, endRotation] = letGo({mass, {}}, shift, turn, time, steps);
    const std::array errors{glm::distance(end, endShift), glm::distance(endRotation, endTurn)};
    for (std::size_t i = 0; i < 2; ++i) {
      if (last[i] > 0.0) {
        EXPECT_NEAR(last[i] / errors[i], 2.0, 0.1) << steps;
      }
      last[i] = errors[i];
    }
  }
  EXPECT_LT(last[0], 0.01 * glm::length(shift));
  EXPECT_LT(last[1], 0.01 * glm::length(turn));
}

TEST(FreeStep, WithoutMassAndWeightTheTargetIsTheHandleItself) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<> random(-1.0, 1.0);
  const auto vector = [&] { return glm::dvec3{random(engine), random(engine), random(engine)}; };
  for (int i = 0; i < 1000; ++i) {
    const BodyMotion handle{{rotationOf(3.0 * vector()), vector()}, {vector(), vector()}};
    const BodyMotion part{{rotationOf(3.0 * vector()), vector()}, {vector(), vector()}};
    const BodyMotion next = freeStep({}, kCoupling, kMetric, kCentre, handle, part, 1e-3);
    EXPECT_EQ(next.pose.rotation, handle.pose.rotation);
    EXPECT_EQ(next.pose.translation, handle.pose.translation);
    EXPECT_EQ(next.twist.linear, handle.twist.linear);
    EXPECT_EQ(next.twist.angular, handle.twist.angular);
  }
}

TEST(FreeStep, WeightWithoutMassSagsUntilTheHandCarriesIt) {
  const BodyMotion handle{{rotationOf({0.1, 0.2, 0.3}), {1, 2, 3}}, {}};
  const FeltMass felt{0.0, {0, 0, -2.0}};
  const BodyMotion next = freeStep(felt, kCoupling, kMetric, kCentre, handle, {}, 1e-3);
  EXPECT_NEAR(glm::distance(next.pose.translation, {1, 2, 3 - 2.0 / 500.0}), 0.0, 1e-15);
  EXPECT_EQ(next.pose.rotation, handle.pose.rotation);
  const Wrench w = couplingWrench(kCoupling, kMetric, kCentre, handle, next);
  EXPECT_NEAR(glm::distance(w.force, felt.weight), 0.0, 1e-12);
}

TEST(FreeStep, WeightOnNoStiffnessDoesNotSag) {
  const BodyMotion handle{{{1, 0, 0, 0}, {1, 2, 3}}, {}};
  for (const double stiffness : {0.0, 1e-320}) {
    const CouplingState soft{stiffness, 0.0, 0.0, 0.0, false};
    EXPECT_EQ(freeStep({0.0, {0, 0, -2}}, soft, kMetric, {}, handle, {}, 1e-3).pose.translation,
              handle.pose.translation);
  }
}

TEST(FreeStep, WithMassAndWeightItComesToRestAtTheSameSag) {
  const auto [end, turn] = letGo({0.1, {0, 0, -2.0}}, {}, {}, 5.0, 5000);
  EXPECT_NEAR(glm::distance(end, {0, 0, -2.0 / 500.0}), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(turn), 0.0, 1e-15);
}

TEST(FreeStep, WithoutCouplingItFallsFreelyAndTurnsOn) {
  BodyMotion part;
  part.twist = {{0.1, 0, 0}, {0, 0, 0.5}};
  const FeltMass felt{0.5, {0, 0, -5.0}};
  const double dt = 1e-3;
  const int steps = 200;
  for (int i = 0; i < steps; ++i)
    part = freeStep(felt, {}, kMetric, {}, {}, part, dt);
  // Backward Euler falls by a t (t + dt) / 2.
  const double time = steps * dt;
  EXPECT_NEAR(glm::distance(part.pose.translation, {0.1 * time, 0, -10.0 * time * (time + dt) / 2.0}), 0.0,
              1e-12);
  EXPECT_NEAR(glm::distance(rotationVector(part.pose.rotation), {0, 0, 0.5 * time}), 0.0, 1e-12);
}

TEST(FreeStep, FollowsAHandleOfConstantVelocityWithoutLag) {
  const glm::dvec3 velocity(0.2, -0.1, 0.05);
  BodyMotion handle, part;
  handle.twist.linear = part.twist.linear = velocity;
  for (int i = 0; i < 100; ++i) {
    handle.pose.translation += 1e-3 * velocity;
    part = freeStep({0.3, {}}, kCoupling, kMetric, kCentre, handle, part, 1e-3);
  }
  EXPECT_NEAR(glm::distance(part.pose.translation, handle.pose.translation), 0.0, 1e-14);
}

TEST(FreeStep, NeverGainsEnergyWhateverTheNumbers) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<> exponent(-6.0, 6.0), place(-1.0, 1.0);
  const auto positive = [&] { return std::pow(10.0, exponent(engine)); };
  for (int run = 0; run < 300; ++run) {
    const CouplingState c{positive(), positive(), positive(), positive(), false};
    const FeltMass felt{positive(), {}};
    const double dt = 1e-3 * positive();
    const MassMetric metric{{1, 0, 0, 0}, glm::dvec3(0.1), 0.1};
    BodyMotion part;
    part.pose = {rotationOf({place(engine), place(engine), 0.0}), {place(engine), place(engine), 0.0}};
    const auto energy = [&] {
      const glm::dvec3 v = part.twist.linear, w = part.twist.angular,
                       turn = rotationVector(part.pose.rotation);
      return 0.5 * (felt.mass * (glm::dot(v, v) + 0.01 * glm::dot(w, w)) +
                    c.stiffness * glm::dot(part.pose.translation, part.pose.translation) +
                    c.rotationalStiffness * glm::dot(turn, turn));
    };
    for (int i = 0; i < 30; ++i) {
      const double before = energy();
      part = freeStep(felt, c, metric, {}, {}, part, dt);
      EXPECT_LE(energy(), before * (1.0 + 1e-9)) << run << " " << i;
    }
  }
}

TEST(KineticEnergy, IsThatOfTranslationAndOfTheSpinAboutThePrincipalAxes) {
  const glm::dquat worldFromPart = rotationOf({1.0, 0.2, -0.4});
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 principal(0.0);
    principal[axis] = 1.0;
    const glm::dvec3 spin = worldFromPart * (kMetric.partFromPrincipal * principal);
    const BodyMotion part{{worldFromPart, {}}, {{3, 0, 4}, 10.0 * spin}};
    const double k = kMetric.gyration[axis];
    EXPECT_NEAR(kineticEnergy({2.0, {}}, kMetric, part), 25.0 + 100.0 * k * k, 1e-12);
    EXPECT_EQ(kineticEnergy({}, kMetric, part), 0.0);
  }
}

TEST(FeltBody, IsNothingUnlessAskedFor) {
  const FeltMass felt = feltBody({}, 3.0, 10.0);
  EXPECT_EQ(felt.mass, 0.0);
  EXPECT_EQ(felt.weight, glm::dvec3(0.0));
}

TEST(FeltBody, WeighsMassTimesGravityUpToItsShareOfTheDevice) {
  WeightSettings settings{true, true, {0, 0, -10.0}};
  const FeltMass light = feltBody(settings, 0.2, 10.0);
  EXPECT_EQ(light.mass, 0.2);
  EXPECT_NEAR(glm::distance(light.weight, {0, 0, -2}), 0.0, 1e-15);
  EXPECT_FALSE(light.isLightened);
  const FeltMass heavy = feltBody(settings, 50.0, 10.0);
  EXPECT_EQ(heavy.mass, 50.0);
  EXPECT_NEAR(glm::distance(heavy.weight, {0, 0, -kMaxWeightShare * 10.0}), 0.0, 1e-14);
  EXPECT_TRUE(heavy.isLightened);
}

TEST(FeltBody, SenselessMassIsNone) {
  const WeightSettings settings{true, true, {0, 0, -10.0}};
  for (const double mass :
       {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(feltBody(settings, mass, 10.0).mass, 0.0);
    EXPECT_EQ(feltBody(settings, mass, 10.0).weight, glm::dvec3(0.0));
  }
}

}  // namespace
}  // namespace nearfit::free_motion_test
