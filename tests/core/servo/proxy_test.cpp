#include "core/servo/proxy.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/proxy_walk.h"
#include "tests/support/trial_share.h"

namespace nearfit::proxy_test {
namespace {

using test::ProxyWalk;

constexpr double kMargin = 1e-3;
/// How far the proxy's clearance may be off the margin (kMarginWeight in proxy.cpp: a hundredth
/// for each direction).
constexpr double kSag = 0.03 * kMargin;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// A cube of side 0.2 about its origin, over a floor whose top is z = 0.
ProxyWalk cubeOverFloor(double height, double margin = kMargin, double friction = 0.0) {
  return ProxyWalk({{test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), {}}}, test::boxMesh({0.2, 0.2, 0.2}),
                   at({0.0, 0.0, 0.1 + height}), {margin, friction});
}

double lowestCorner(const ProxyWalk& walk) {
  double lowest = 1e9;
  for (const glm::dvec3& v : walk.scene().moving.geometry->mesh.vertices())
    lowest = std::min(lowest, walk.pose().applyToPoint(v).z);
  return lowest;
}

TEST(Proxy, IsWhereTheHandIsToTheLastBitWhereNothingIsNear) {
  ProxyWalk walk = cubeOverFloor(1.0);
  for (int i = 0; i < 400; ++i) {
    const RigidTransform hand{glm::angleAxis(0.02 * i, glm::normalize(glm::dvec3(1, 2, 3))),
                              {0.2 * std::sin(0.05 * i), 0.3 * (1.0 - std::cos(0.05 * i)), 1.1}};
    walk.lead(hand);
    EXPECT_EQ(walk.pose().translation, hand.translation);
    EXPECT_EQ(walk.pose().rotation, hand.rotation);
    EXPECT_TRUE(walk.proxy().contacts().empty());
  }
}

TEST(Proxy, RestsAMarginAboveTheFloorThatItIsPressedInto) {
  ProxyWalk walk = cubeOverFloor(0.05);
  walk.hold(at({0.0, 0.0, -0.4}), 40);
  EXPECT_NEAR(lowestCorner(walk), kMargin, kSag);
  EXPECT_LT(glm::length(rotationVector(walk.pose().rotation)), 1e-9);
  EXPECT_NEAR(walk.pose().translation.x, 0.0, 1e-9);
  // What holds it pushes up, and in all as far as it was pressed.
  double push = 0.0;
  for (const ProxyContact& contact : walk.proxy().contacts()) {
    EXPECT_NEAR(contact.contact.pair.direction.z, 1.0, 1e-12);
    push += contact.push;
  }
  EXPECT_NEAR(push, 0.1 + kMargin + 0.4, 1e-3);
}

TEST(Proxy, AtRestItStaysToTheLastBit) {
  ProxyWalk walk = cubeOverFloor(0.05);
  const RigidTransform hand{glm::normalize(glm::dquat(1.0, 0.02, 0.01, 0.3)), {0.01, 0.02, 0.02}};
  walk.hold(hand, 100);
  const RigidTransform rest = walk.pose();
  walk.hold(hand, 50);
  EXPECT_EQ(walk.pose().translation, rest.translation);
  EXPECT_EQ(walk.pose().rotation, rest.rotation);
}

TEST(Proxy, NeverRestsShortOfAPlaceThatItCanReach) {
  // A step at the end of a tick's way is as short as one at rest.
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-8.0, -3.0), way(-0.05, 0.05);
  for (std::size_t i = 0; i < 200 / test::kTrialShare; ++i) {
    ProxyWalk walk = cubeOverFloor(std::pow(10.0, exponent(random)));
    const glm::dvec3 wanted{way(random), way(random), 0.1};
    walk.hold(at(wanted), 60);
    EXPECT_NEAR(walk.pose().translation.x, wanted.x, 2e-3 * kMargin) << i;
    EXPECT_NEAR(walk.pose().translation.y, wanted.y, 2e-3 * kMargin) << i;
  }
}

TEST(Proxy, TiltedCubePressedDownComesToLieFlat) {
  ProxyWalk walk = cubeOverFloor(0.05);
  const RigidTransform tilted{glm::angleAxis(0.2, glm::normalize(glm::dvec3(1, 2, 0))), {0.0, 0.0, 0.17}};
  walk.hold(tilted, 20);
  walk.hold(at({0.0, 0.0, 0.0}), 60);
  EXPECT_NEAR(lowestCorner(walk), kMargin, kSag);
  EXPECT_LT(glm::length(rotationVector(walk.pose().rotation)), 1e-4);
}

TEST(Proxy, NeverGainsEnergyOfTheCouplingThatPullsIt) {
  // With turns ten times as stiff as the metric has them, a proxy that was nearest in the metric gave way by
  // a turn to gain a little of a shift, and so stored a hundred times the energy that it took.
  for (const double scale : {0.1, 1.0, 10.0}) {
    ProxyWalk walk = cubeOverFloor(0.02);
    const glm::dvec3 gyration = scale * walk.scene().metric.gyration;
    const RigidTransform hand{glm::angleAxis(0.5, glm::normalize(glm::dvec3(1, 2, 0))), {0.05, 0.0, 0.06}};
    const auto energy = [&] {
      const glm::dvec3 shift = walk.pose().translation - hand.translation;
      // A cube's are all the same.
      const glm::dvec3 turn =
          gyration.x * rotationVector(walk.pose().rotation * glm::conjugate(hand.rotation));
      return glm::dot(shift, shift) + glm::dot(turn, turn);
    };
    walk.hold(at({0.0, 0.0, 0.12}), 3);
    double before = energy();
    const double first = before;
    for (int i = 0; i < 100; ++i) {
      walk.proxy().follow(walk.tracked(), hand, walk.settings(), scale);
      ASSERT_LE(energy(), before * (1.0 + 1e-9)) << scale << ", tick " << i;
      before = energy();
    }
    EXPECT_LT(before, first);
    EXPECT_FALSE(walk.proxy().contacts().empty()) << scale;
  }
}

TEST(Proxy, PressedOffItsCentreOfMassItBalancesTheHandsTurnAgainstIt) {
  // The hand is turned by 0.3 rad about y and pressed 0.02 into the floor: the cube rests on an edge with the
  // turn that is nearest in its mass metric. By hand: z = h(a) + margin, with h(a) = 0.1 (cos a + sin a) the
  // height of the centre over the low edge; least of (z - z0)^2 + k^2 (a - 0.3)^2 with k^2 = 0.2^2 / 6.
  ProxyWalk walk = cubeOverFloor(0.05);
  constexpr double kTurn = 0.3, kSquare = 0.2 * 0.2 / 6.0;
  const double handHeight = 0.1 * (std::cos(kTurn) + std::sin(kTurn)) - 0.02;
  walk.hold({glm::angleAxis(kTurn, glm::dvec3(0, 1, 0)), {0.0, 0.0, handHeight}}, 200);
  const auto cost = [&](double a) {
    const double z = 0.1 * (std::cos(a) + std::sin(a)) + kMargin;
    return (z - handHeight) * (z - handHeight) + kSquare * (a - kTurn) * (a - kTurn);
  };
  double best = 0.0;
  for (double a = 0.0; a < kTurn; a += 1e-5)
    best = cost(a) < cost(best) ? a : best;
  const glm::dvec3 turn = rotationVector(walk.pose().rotation);
  EXPECT_NEAR(turn.y, best, 2e-3);
  EXPECT_NEAR(turn.x, 0.0, 1e-6);
  EXPECT_NEAR(turn.z, 0.0, 1e-6);
  EXPECT_NEAR(lowestCorner(walk), kMargin, kSag);
}

TEST(Proxy, SlidesWithAFastHandThatPressesDeep) {
  // 0.5 m/s along the floor, 20 mm deep, at a margin of 0.05 mm: ten margins a tick.
  ProxyWalk walk = cubeOverFloor(0.01, 5e-5);
  walk.hold(at({0.0, 0.0, 0.08}), 50);
  double lag = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.5e-3 * i;
    walk.lead(at({x, 0.0, 0.08}));
    lag = std::max(lag, std::abs(walk.pose().translation.x - x));
  }
  EXPECT_LT(lag, 1e-6);
  EXPECT_NEAR(lowestCorner(walk), 5e-5, 0.03 * 5e-5);
}

TEST(Proxy, CornerOfThreeWallsHoldsItAMarginFromEach) {
  ProxyWalk walk({{test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), {}},
                  {test::boxMesh({1.0, 4.0, 4.0}, {1.5, 0.0, 0.0}), {}},
                  {test::boxMesh({4.0, 1.0, 4.0}, {0.0, 1.5, 0.0}), {}}},
                 test::boxMesh({0.2, 0.2, 0.2}), at({0.5, 0.5, 0.5}), {kMargin, 0.0});
  walk.hold(at({1.5, 1.3, -0.4}), 60);
  EXPECT_NEAR(walk.pose().translation.x, 0.9 - kMargin, kSag);
  EXPECT_NEAR(walk.pose().translation.y, 0.9 - kMargin, kSag);
  EXPECT_NEAR(walk.pose().translation.z, 0.1 + kMargin, kSag);
  walk.hold(at({0.2, 0.3, 0.6}), 60);
  EXPECT_EQ(walk.pose().translation, glm::dvec3(0.2, 0.3, 0.6)) << "and lets it go";
}

TEST(Proxy, StaysOnItsSideOfAThinPlateWhereverTheHandJumps) {
  // A micrometre thick.
  ProxyWalk walk({{test::boxMesh({2.0, 2.0, 1e-6}), {}}}, test::boxMesh({0.1, 0.1, 0.1}), at({0.0, 0.0, 0.2}),
                 {kMargin, 0.0});
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    RigidTransform hand = test::randomRotation(random);
    hand.translation = {0.5 * unit(random), 0.5 * unit(random), unit(random)};
    walk.lead(hand);
    ASSERT_GT(lowestCorner(walk), 0.0) << i;
  }
}

TEST(Proxy, SlidesFreelyInAGapNarrowerThanTwoMargins) {
  // Plates 0.2 + 1 um apart around the cube: each side has half a micrometre, and the margin is a millimetre.
  constexpr double kGap = 1e-6;
  ProxyWalk walk({{test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.6 - 0.5 * kGap}), {}},
                  {test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, 0.6 + 0.5 * kGap}), {}}},
                 test::boxMesh({0.2, 0.2, 0.2}), at({0.0, 0.0, 0.0}), {kMargin, 0.0});
  // A step is no longer than the gap: 24 of them a tick.
  for (int i = 0; i < 400; ++i)
    walk.lead(at({1e-5 * i, 0.0, 0.05 * std::sin(0.1 * i)}));
  EXPECT_NEAR(walk.pose().translation.x, 1e-5 * 399, 1e-5);
  EXPECT_LT(std::abs(walk.pose().translation.z), 0.5 * kGap);
  const RigidTransform spun{glm::angleAxis(0.002, glm::dvec3(0, 0, 1)), walk.pose().translation};
  walk.hold(spun, 300);
  EXPECT_NEAR(rotationVector(walk.pose().rotation).z, 0.002, 1e-6) << "turns in the plane";
}

TEST(Proxy, WedgeHoldsItAndLetsItGo) {
  // A groove of two walls at 60 degrees to the floor, and a cylinder along it.
  const glm::dquat left = glm::angleAxis(std::numbers::pi / 3.0, glm::dvec3(0, 1, 0));
  const glm::dquat right = glm::angleAxis(-std::numbers::pi / 3.0, glm::dvec3(0, 1, 0));
  const TriangleMesh wall = test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5});
  const glm::dquat lying = glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(1, 0, 0));
  ProxyWalk walk({{wall, {left, {}}}, {wall, {right, {}}}}, test::cylinderMesh(0.1, 0.5, 64),
                 {lying, {0.0, 0.0, 1.0}}, {kMargin, 0.0});
  walk.hold({lying, {0.0, 0.0, 0.0}}, 100);
  // Both walls touch it at the radius: the axis is at height (r + margin) / cos 60.
  EXPECT_NEAR(walk.pose().translation.z, (0.1 + kMargin) / 0.5, 0.0005);
  EXPECT_NEAR(walk.pose().translation.x, 0.0, 2e-3);
  walk.hold({lying, {0.0, 0.0, 1.0}}, 100);
  EXPECT_EQ(walk.pose().translation, glm::dvec3(0.0, 0.0, 1.0));
}

TEST(Proxy, FrictionHoldsWithinItsConeAndDragsOutsideOfIt) {
  constexpr double kCoefficient = 0.5, kDepth = 0.02;
  ProxyWalk walk = cubeOverFloor(0.01, kMargin, kCoefficient);
  const double low = 0.1 + kMargin - kDepth;
  walk.hold(at({0.0, 0.0, low}), 60);
  walk.hold(at({0.4 * kDepth, 0.0, low}), 60);
  EXPECT_NEAR(walk.pose().translation.x, 0.0, 1e-5) << "inside of the cone";
  walk.hold(at({3.0 * kDepth, 0.0, low}), 100);
  // How the corners share the load is not unique, and with it how much of the friction turns the cube.
  EXPECT_NEAR(walk.pose().translation.x, 3.0 * kDepth - kCoefficient * kDepth, 0.1 * kCoefficient * kDepth);
}

TEST(Proxy, APartThatStartsInAnotherIsNotHeldUntilTheyAreApart) {
  ProxyWalk walk = cubeOverFloor(-0.05);
  walk.lead(at({0.0, 0.0, 0.05}));
  ASSERT_EQ(walk.tracked().clearance.overlapping->size(), 1U);
  walk.hold(at({0.3, 0.0, 0.06}), 5);
  EXPECT_EQ(walk.pose().translation, glm::dvec3(0.3, 0.0, 0.06)) << "free to leave anywhere";
  walk.hold(at({0.3, 0.0, 0.3}), 3);
  EXPECT_TRUE(walk.tracked().clearance.overlapping->empty());
  walk.hold(at({0.3, 0.0, -0.3}), 40);
  EXPECT_NEAR(lowestCorner(walk), kMargin, kSag) << "and is held from then on";
}

// They met again for a tick or two while the part was still released: the search ahead had yet to tell that they were
// apart. It tells of the tick before it began.
TEST(Proxy, PartsThatWereApartForLongerThanTheSearchTakesDoNotMeetAgain) {
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> paces(0.1, 2.5);
  for (const int searchTicks : {0, 1, 2, 5}) {
    int meetings = 0, held = 0;
    for (int i = 0; i < 30; ++i) {
      const double pace = paces(random);  // [rad] per tick.
      const auto hand = [pace](int tick) { return at({0.0, 0.0, 0.1 - 0.03 * std::cos(pace * tick)}); };
      ProxyWalk walk = cubeOverFloor(-0.03);
      walk.lead(hand(0));
      walk.setSearchTicks(static_cast<std::size_t>(searchTicks));
      int apart = 0;
      for (int tick = 1; tick < 80; ++tick) {
        walk.lead(hand(tick));
        if (lowestCorner(walk) > 0.0) {
          ++apart;
          continue;
        }
        if (apart > 0) ++meetings;
        ASSERT_LE(apart, searchTicks) << "pace " << pace << ", tick " << tick;
        apart = 0;
      }
      if (apart > searchTicks) ++held;
    }
    EXPECT_EQ(meetings > 0, searchTicks > 0) << "the hand is fast enough to lead it back in time";
    EXPECT_GT(held, 0) << "and slow enough not to";
  }
}

TEST(Proxy, ABodyThatIsMovedIntoItLetsGoAndHoldsAgainOnceItIsAway) {
  ProxyWalk walk = cubeOverFloor(0.05);
  walk.hold(at({0.0, 0.0, 0.05}), 30);
  walk.moveBody(0, at({0.0, 0.0, 0.05}));
  walk.hold(at({0.0, 0.0, 0.05}), 40);
  EXPECT_EQ(walk.tracked().clearance.overlapping->size(), 1U);
  EXPECT_EQ(walk.pose().translation, glm::dvec3(0.0, 0.0, 0.05));
  walk.moveBody(0, at({0.0, 0.0, -0.1}));
  walk.hold(at({0.0, 0.0, -0.5}), 60);
  EXPECT_TRUE(walk.tracked().clearance.overlapping->empty());
  EXPECT_NEAR(lowestCorner(walk), -0.1 + kMargin, kSag);
}

TEST(Proxy, ABodyThatIsAddedHoldsItFromTheFirstTick) {
  ProxyWalk walk = cubeOverFloor(0.5);
  walk.lead(at({0.0, 0.0, 0.6}));
  walk.addBody({test::boxMesh({4.0, 4.0, 0.1}), at({0.0, 0.0, 0.44})});
  walk.hold(at({0.0, 0.0, 0.2}), 60);
  EXPECT_NEAR(lowestCorner(walk), 0.49 + kMargin, kSag);
}

TEST(Proxy, AnOpenSheetIsPassedFromNeitherSide) {
  for (const double side : {1.0, -1.0}) {
    ProxyWalk walk({{test::squareMesh(2.0, 4), {}}}, test::boxMesh({0.2, 0.2, 0.2}),
                   at({0.0, 0.0, side * 0.3}), {kMargin, 0.0});
    walk.hold(at({0.0, 0.0, -side * 0.3}), 60);
    EXPECT_NEAR(side * walk.pose().translation.z, 0.1 + kMargin, kSag) << side;
    for (int i = 0; i < 100; ++i)
      walk.lead(at({0.002 * i, 0.001 * i, -side * 0.3}));
    EXPECT_NEAR(walk.pose().translation.x, 0.2, 0.01) << "slides along it, " << side;
    EXPECT_NEAR(side * walk.pose().translation.z, 0.1 + kMargin, kSag) << side;
  }
}

TEST(Proxy, ALobeThatCameOutInsideOutIsPassedFromNeitherSide) {
  // A closed mesh that passes through itself went for solid since its volume is positive; but no face of the
  // lobe that is inside out looks outwards, no minimum was found there, and the part went through. The lobe's
  // far side is the plane x = -1/2.
  const TriangleMesh eight = test::figureOfEightMesh(0.5), box = test::boxMesh({0.2, 0.2, 0.2});
  for (const bool isEightInHand : {false, true}) {
    const TriangleMesh &fixed = isEightInHand ? box : eight, &part = isEightInHand ? eight : box;
    const double towards = isEightInHand ? -1.0 : 1.0;
    const test::PoseCertifier certifier(fixed, part);
    ProxyWalk walk({{fixed, {}}}, part, at({-towards, 0.0, 0.0}), {kMargin, 0.0});
    for (int i = 0; i <= 200; ++i) {
      walk.lead(at({towards * (-1.0 + 0.006 * i), 0.0, 0.0}));
      ASSERT_FALSE(certifier.doMeet(walk.pose())) << isEightInHand << ", tick " << i;
    }
    EXPECT_NEAR(towards * walk.pose().translation.x, -0.6 - kMargin, kSag) << isEightInHand;
  }
}

TEST(Proxy, NeverMeetsJaggedBodiesUnderAHandThatJumpsShakesAndSpins) {
  const TriangleMesh a = test::starMesh(31, 0.5, 3, 0.3), b = test::starMesh(32, 0.4, 3, 0.3);
  const TriangleMesh part = test::starMesh(33, 0.3, 3, 0.3);
  const RigidTransform worldFromB = at({0.8, 0.0, 0.1});
  ProxyWalk walk({{a, {}}, {b, worldFromB}}, part, at({0.4, 0.9, 0.0}), {kMargin, 0.0});
  const test::PoseCertifier withA(a, part), withB(b, part);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  RigidTransform hand = walk.pose();
  std::vector<RigidTransform> poses, inB;
  const std::size_t ticks = 6000 / test::kTrialShare;
  std::size_t touched = 0, moved = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    if (i % 200 == 0) {
      hand = test::randomRotation(random);
      hand.translation = {0.4 + 0.5 * unit(random), 0.5 * unit(random), 0.5 * unit(random)};
    }
    const double phase = 0.12566 * static_cast<double>(i);
    RigidTransform now = hand;
    now.translation += 0.02 * std::sin(phase) * glm::dvec3(1.0, 0.4, -0.7);
    now.rotation = glm::normalize(glm::angleAxis(0.01 * static_cast<double>(i % 200), glm::dvec3(0, 0, 1)) *
                                  hand.rotation);
    const RigidTransform before = walk.pose();
    walk.lead(now);
    touched += walk.proxy().contacts().empty() ? 0 : 1;
    moved += before.translation != walk.pose().translation ? 1 : 0;
    EXPECT_NEAR(glm::length(walk.pose().rotation), 1.0, 1e-12);
    poses.push_back(walk.pose());
    inB.push_back(worldFromB.inverse() * walk.pose());
  }
  EXPECT_GT(touched, ticks / 2);
  EXPECT_GT(moved, ticks / 2);
  const std::vector<char> meetsA = withA.meetings(poses), meetsB = withB.meetings(inB);
  EXPECT_EQ(std::count(meetsA.begin(), meetsA.end(), 1), 0);
  EXPECT_EQ(std::count(meetsB.begin(), meetsB.end(), 1), 0);
}

TEST(Proxy, ARodDoesNotLeaveABoreThatIsCurvedAsTightlyAsTheMargin) {
  // Beyond the wall's middle the nearest minimum is one of its outside: that a pose has none proves nothing.
  for (const double rodRadius : {0.02, 0.1, 0.3}) {
    const double boreRadius = rodRadius + 1.3;
    ProxyWalk walk({{test::tubeMesh(boreRadius * kMargin, 7.5 * kMargin, 400.0 * kMargin, 180), {}}},
                   test::boxMesh({rodRadius * kMargin, rodRadius * kMargin, 200.0 * kMargin}),
                   at({0.5 * kMargin, 1e-6, 0.0}), {kMargin, 0.0});
    walk.lead(walk.pose());
    for (const double angle : {1.57, 0.4, 2.9, 4.4}) {
      for (int i = 0; i < 20; ++i) {
        walk.lead(at(40.0 * kMargin * glm::dvec3(std::cos(angle), std::sin(angle), 0.0)));
        ASSERT_LT(std::hypot(walk.pose().translation.x, walk.pose().translation.y), boreRadius * kMargin)
            << rodRadius << " towards " << angle;
      }
    }
  }
}

TEST(Proxy, APieceThatIsInsideOutIsNotWalkedThrough) {
  const TriangleMesh tube = test::tubeMesh(0.1, 0.2, 1.0, 32);
  const TriangleMesh inner = test::turned(test::boxMesh({0.04, 0.04, 0.04}));
  const TriangleMesh scene = test::joined(tube, inner), part = test::boxMesh({0.02, 0.02, 0.02});
  ProxyWalk walk({{scene, {}}}, part, at({0.0, 0.0, 0.3}), {kMargin, 0.0});
  for (int i = 0; i < 120; ++i) {
    walk.lead(at({0.0, 0.0, 0.3 - 0.005 * i}));
    ASSERT_GT(walk.pose().translation.z, 0.03) << i;
  }
}

TEST(Proxy, AGapBelowRoundingIsLetGoLikeAnOverlap) {
  for (const double gap : {1.4e-17, 1e-15, 1e-13}) {
    ProxyWalk walk({{test::boxMesh({0.4, 0.4, 0.2}), {}}}, test::boxMesh({0.2, 0.2, 0.2}),
                   at({0.0, 0.0, 0.2 + gap}), {kMargin, 0.0});
    walk.hold(at({0.0, 0.0, 0.4}), 60);
    EXPECT_NEAR(walk.pose().translation.z, 0.4, 1e-12) << gap;
  }
}

TEST(Proxy, ManyBodiesInContactAtOnceHoldItAndLetItGo) {
  std::vector<ProxyWalk::Fixed> pins;
  const TriangleMesh pin = test::boxMesh({0.01, 0.01, 0.1}, {0.0, 0.0, -0.05});
  for (int i = 0; i < 100; ++i) {
    const int row = i / 10, column = i % 10;
    pins.push_back({pin, at({0.02 * column, 0.02 * row, 0.0})});
  }
  ProxyWalk walk(std::move(pins), test::boxMesh({0.3, 0.3, 0.02}, {0.09, 0.09, 0.01}), at({0.0, 0.0, 0.01}),
                 {kMargin, 0.0});
  walk.hold(at({0.0, 0.0, -0.02}), 60);
  EXPECT_NEAR(walk.pose().translation.z, kMargin, kSag);
  walk.hold(at({0.0, 0.0, 0.1}), 60);
  EXPECT_NEAR(walk.pose().translation.z, 0.1, 1e-12);
}

TEST(Proxy, FollowingAllocatesNothing) {
  ProxyWalk walk = cubeOverFloor(0.05, kMargin, 0.3);
  walk.hold(at({0.0, 0.0, 0.0}), 20);
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int i = 0; i < 20; ++i)
    walk.proxy().follow(walk.tracked(), at({0.01 * i, 0.0, -0.01 * i}), walk.settings());
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::proxy_test
