// Parts that touch at the start are felt: dropped ones, and those typed to be flush. Pressed on, they do not get through.
#include "core/servo/start_apart.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/placing/drop.h"
#include "core/placing/solid_move.h"
#include "core/proximity/overlap/interference.h"
#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::start_apart_test {
namespace {

using test::boxMesh;

constexpr double kMargin = 1e-4;  // [m]
/// No start is shifted farther where flats do not deviate [m].
constexpr double kMostShift = 4e-6;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

ServoScene sceneOf(PartGeometryPtr part, const RigidTransform& worldFromPart,
                   std::vector<std::pair<PartGeometryPtr, RigidTransform>> bodies) {
  ServoScene scene;
  scene.setMoving({PartId{1}, std::move(part), worldFromPart});
  std::uint32_t id = 2;
  for (auto& [geometry, pose] : bodies)
    scene.bodies.push_back({PartId{id++}, std::move(geometry), pose});
  scene.moving.geometry->tree();
  for (const ServoScene::Body& body : scene.bodies)
    body.geometry->tree();
  scene.prepareSurfaces();
  return scene;
}

/// A block of 20 x 20 x 20 mm in hand, and a plate whose top is z = 0, both placed by `world`.
ServoScene blockOnPlate(double height, const RigidTransform& world = {}) {
  return sceneOf(test::solidGeometryOf(boxMesh(glm::dvec3(0.02))), world * at({0.003, 0.002, 0.01 + height}),
                 {{test::solidGeometryOf(boxMesh({0.1, 0.1, 0.01}, {0.0, 0.0, -0.005})), world}});
}

/// A servo with the scene's part in hand, and its surroundings searched before each tick.
class Hand {
 public:
  explicit Hand(const ServoScene& scene) : scene_(std::make_shared<const ServoScene>(scene)) {
    parameters_.haptics.proxy.margin = kMargin;
    tracker_.setScene(scene_);
  }
  const ServoSnapshot& lead(const RigidTransform& hand) {
    const SearchReach reach = searchReach(parameters_.haptics);
    if (ticks_ > 0) tracker_.update(observationOf(*snapshot_), 1.0);
    if (tracker_.isDue(reach)) tracker_.refresh(reach, tracked_);
    tick_.run(tracked_, parameters_, {.pose = hand}, 1e-3, *snapshot_);
    snapshot_->tick = ++ticks_;
    return *snapshot_;
  }
  /// Presses along a way in so many ticks, and stays there as long. No pose may meet a body, or be released.
  const ServoSnapshot& press(const glm::dvec3& way, int ticks) {
    const RigidTransform start = scene_->moving.worldFromPart;
    for (int i = 1; i <= 2 * ticks; ++i) {
      RigidTransform hand = start;
      hand.translation += std::min(1.0, static_cast<double>(i) / ticks) * way;
      const ServoSnapshot& now = lead(hand);
      EXPECT_EQ(now.overlappingCount, 0U) << "tick " << i;
      EXPECT_FALSE(meets(now.proxy)) << "tick " << i;
      if (testing::Test::HasFailure()) break;
    }
    return *snapshot_;
  }
  bool meets(const RigidTransform& pose) const {
    for (const ServoScene::Body& body : scene_->bodies) {
      const RigidTransform bodyFromPart = (body.worldFromPart.inverse() * pose).normalized();
      if (findInterference(body.geometry->tree(), scene_->moving.geometry->tree(), bodyFromPart).kind !=
          InterferenceKind::Disjoint)
        return true;
    }
    return false;
  }

 private:
  std::shared_ptr<const ServoScene> scene_;
  SceneTracker tracker_;
  TrackedScene tracked_;
  ServoTick tick_;
  ServoParameters parameters_;
  std::uint64_t ticks_ = 0;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

/// A mesh as a file with few digits stores it: turned, its coordinates rounded to this grid [m].
PartGeometryPtr roundedGeometryOf(const TriangleMesh& mesh, const glm::dquat& rotation, double grid) {
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec3& v : mesh.vertices())
    vertices.push_back(grid * glm::round(rotation * v / grid));
  PartGeometry geometry = *test::solidGeometryOf(
      TriangleMesh(std::move(vertices), {mesh.triangles().begin(), mesh.triangles().end()}));
  geometry.hierarchy =
      std::make_shared<HierarchyOnDemand>(HierarchyOnDemand::Find{}, HierarchyOnDemand::Keep{}, 0.5 * grid);
  geometry.surfaceOnDemand = std::make_shared<SurfaceOnDemand>();
  return std::make_shared<const PartGeometry>(std::move(geometry));
}

TEST(StartApart, AFlushBlockIsHeldByThePlate) {
  ServoScene scene = blockOnPlate(0.0);
  const double before = scene.moving.worldFromPart.translation.z;
  EXPECT_TRUE(startApart(scene));
  const double height = scene.moving.worldFromPart.translation.z - before;
  EXPECT_GT(height, 0.0);
  EXPECT_LT(height, kMostShift);

  Hand hand(scene);
  const ServoSnapshot& end = hand.press({0.0, 0.0, -2e-3}, 300);
  EXPECT_GT(end.contactCount, 0U);
  EXPECT_GT(end.unclampedWrench.force.z, 0.0);
  // Its bottom is above the plate.
  EXPECT_GT(end.proxy.translation.z, 0.01);
}

TEST(StartApart, WithoutItAFlushBlockSinksIn) {
  // If this fails, touching bodies are felt anyway, and what is tested here is not needed any more.
  const ServoScene scene = blockOnPlate(0.0);
  Hand hand(scene);
  hand.lead(scene.moving.worldFromPart);
  EXPECT_EQ(hand.lead(scene.moving.worldFromPart).overlappingCount, 1U);
}

TEST(StartApart, AFlushBlockIsHeldWhereverThePlateIsTurned) {
  std::mt19937_64 random(11);
  const auto uniform = [&random] { return 2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0; };
  for (int i = 0; i < 12; ++i) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(uniform(), uniform(), uniform()));
    const RigidTransform world{glm::angleAxis(std::numbers::pi * uniform(), axis),
                               glm::dvec3(uniform(), uniform(), uniform())};
    // Rounding alone decides if the faces meet.
    ServoScene scene = blockOnPlate(0.0, world);
    const glm::dvec3 before = scene.moving.worldFromPart.translation;
    EXPECT_TRUE(startApart(scene)) << i;
    EXPECT_LT(glm::distance(scene.moving.worldFromPart.translation, before), kMostShift) << i;
    Hand hand(scene);
    const ServoSnapshot& end = hand.press(world.applyToVector({0.0, 0.0, -1e-3}), 60);
    EXPECT_GT(end.contactCount, 0U) << i;
    EXPECT_GT((world.inverse() * end.proxy).translation.z, 0.01) << i;
  }
}

TEST(StartApart, InACornerThePartLeavesBothWalls) {
  ServoScene scene = sceneOf(test::solidGeometryOf(boxMesh(glm::dvec3(0.02))), at({0.01, 0.0, 0.01}),
                             {{test::solidGeometryOf(boxMesh({0.2, 0.2, 0.01}, {0.0, 0.0, -0.005})), {}},
                              {test::solidGeometryOf(boxMesh({0.01, 0.2, 0.2}, {-0.005, 0.0, 0.1})), {}}});
  EXPECT_TRUE(startApart(scene));
  EXPECT_GT(scene.moving.worldFromPart.translation.x, 0.01);
  EXPECT_GT(scene.moving.worldFromPart.translation.z, 0.01);
  Hand hand(scene);
  const ServoSnapshot& end = hand.press({-1e-3, 0.0, -1e-3}, 200);
  EXPECT_GT(end.proxy.translation.x, 0.01);
  EXPECT_GT(end.proxy.translation.z, 0.01);
}

TEST(StartApart, WhatIsEnteredDeeperOrIsClearStaysWhereItIs) {
  for (const double height : {-1e-8, -1e-6, -2e-6, -1e-3, -0.015, 3e-6, 1e-3}) {
    ServoScene scene = blockOnPlate(height);
    const RigidTransform before = scene.moving.worldFromPart;
    EXPECT_FALSE(startApart(scene)) << height;
    EXPECT_EQ(scene.moving.worldFromPart.translation, before.translation) << height;
  }
}

TEST(StartApart, BetweenTwoFlushWallsItStaysAndThinWallsAreNotCrossed) {
  const auto wall = [](double from, double to) {
    const glm::dvec3 size(to - from, 0.2, 0.2), centre(0.5 * (from + to), 0.0, 0.0);
    return std::pair(test::solidGeometryOf(boxMesh(size, centre)), RigidTransform{});
  };
  ServoScene between =
      sceneOf(test::solidGeometryOf(boxMesh(glm::dvec3(0.02))), {}, {wall(0.01, 0.02), wall(-0.02, -0.01)});
  EXPECT_FALSE(startApart(between));
  // Beyond a foil of 0.1 um there is room within reach, and it is free.
  constexpr double kHalf = 1e-7, kFoil = 1e-7;
  ServoScene foils = sceneOf(test::solidGeometryOf(boxMesh({2.0 * kHalf, 0.02, 0.02})), {},
                             {wall(kHalf, kHalf + kFoil), wall(-0.01, -kHalf)});
  EXPECT_FALSE(startApart(foils));
  foils.bodies.pop_back();
  EXPECT_TRUE(startApart(foils));
  EXPECT_LT(foils.moving.worldFromPart.translation.x, 0.0);
}

TEST(StartApart, ANeighbourThatWasClearStaysClear) {
  // Above the flush block is a lid, nearer than the usual gap.
  ServoScene scene = blockOnPlate(0.0);
  scene.bodies.push_back(
      {PartId{9}, test::solidGeometryOf(boxMesh({0.1, 0.1, 0.01})), at({0.0, 0.0, 0.0250005})});
  scene.bodies.back().geometry->tree();
  startApart(scene);
  const double top = scene.moving.worldFromPart.translation.z + 0.01;
  EXPECT_LT(top, 0.0200005);
}

/// A pose that is typed with *Solid* on: where the block starts above the plate, and how it is moved [m].
struct TypedSolidly {
  double height;
  glm::dvec3 motion;
};
class StartApartAfterASolidMove : public testing::TestWithParam<TypedSolidly> {};

TEST_P(StartApartAfterASolidMove, IsFeltAndCanBeLifted) {
  Scene scene;
  scene.add(test::partOf(test::solidGeometryOf(boxMesh({0.1, 0.1, 0.01}, {0.0, 0.0, -0.005})), "plate", {}));
  const PartId block = scene.add(test::partOf(test::solidGeometryOf(boxMesh(glm::dvec3(0.02))), "block",
                                              at({0.003, 0.002, 0.01 + GetParam().height})));
  scene.setMovingPart(block);
  const PartId moved[] = {block};
  Part part = scene.get(block);
  part.worldFromPart = movedSolidly(scene, moved, at(GetParam().motion)).front();
  scene.replace(part);
  const auto inHand = makeServoScene(scene);
  startApart(*inHand);
  const double start = inHand->moving.worldFromPart.translation.z;
  EXPECT_NEAR(start, part.worldFromPart.translation.z, kMostShift);
  Hand pressing(*inHand);
  const ServoSnapshot& pressed = pressing.press({0.0, 0.0, -1e-3}, 100);
  EXPECT_GT(pressed.contactCount, 0U);
  EXPECT_GT(pressed.proxy.translation.z, 0.01);
  Hand lifting(*inHand);
  const ServoSnapshot& lifted = lifting.press({0.0, 0.0, 5e-3}, 200);
  EXPECT_GT(lifted.proxy.translation.z, start + 4.9e-3);
}

// To the plate; 5 mm into it, where contact stops it; and along it where it lies flush.
INSTANTIATE_TEST_SUITE_P(Typed, StartApartAfterASolidMove,
                         testing::Values(TypedSolidly{0.02, {0.0, 0.0, -0.02}},
                                         TypedSolidly{0.02, {0.0, 0.0, -0.025}},
                                         TypedSolidly{0.0, {0.004, 0.0, 0.0}}));

/// Meshes with many flats whose corners are rounded, so that the surface that is searched deviates from the file's by more
/// than a drop leaves.
class StartApartOfRoundedMeshes : public testing::Test {
 protected:
  StartApartOfRoundedMeshes() {
    // Of metres: the finest digits of a large part's file are those that deviate by more than a drop's micrometre.
    const double grid = 3e-6;
    const glm::dquat askew = glm::normalize(glm::dquat(0.8, 0.3, -0.2, 0.4));
    const auto shaft = test::subdivided(test::cylinderMesh(1.2, 6.0, 48), 3);
    const auto ring = test::subdivided(test::tubeMesh(1.17, 2.0, 0.8, 48), 3);
    fixed_ =
        scene_.add(test::partOf(roundedGeometryOf(shaft, askew, grid), "shaft", {glm::inverse(askew), {}}));
    moving_ = scene_.add(test::partOf(roundedGeometryOf(ring, askew, grid), "ring",
                                      {glm::inverse(askew), {0.01, 0.005, 5.0}}));
    deviation_ =
        scene_.get(fixed_).geometry->tree().deviation() + scene_.get(moving_).geometry->tree().deviation();
  }
  void drop() {
    const PartId moved[] = {moving_};
    const DropResult result = dropParts(scene_, moved, {{0.0, 0.0, -1.0}, 0.0});
    ASSERT_EQ(result.outcome, DropResult::Outcome::Contact);
    Part part = scene_.get(moving_);
    part.worldFromPart.translation += result.shift;
    scene_.replace(part);
    gap_ = result.gap;
  }
  ServoScene inHand() const {
    const Part &fixed = scene_.get(fixed_), &moving = scene_.get(moving_);
    return sceneOf(moving.geometry, moving.worldFromPart, {{fixed.geometry, fixed.worldFromPart}});
  }

  Scene scene_;
  PartId fixed_{}, moving_{};
  double deviation_ = 0.0;  ///< Of both [m].
  double gap_ = 0.0;        ///< That the drop left [m].
};

TEST_F(StartApartOfRoundedMeshes, WhatWasDroppedIsHeldAsItIs) {
  ASSERT_GT(deviation_, dropGap(scene_.get(moving_).geometry->mesh.bounds().diagonal()));
  drop();
  ServoScene scene = inHand();
  EXPECT_FALSE(startApart(scene)) << "the drop left enough";
  const double start = scene.moving.worldFromPart.translation.z;
  Hand hand(scene);
  const ServoSnapshot& end = hand.press({0.0, 0.0, -2e-3}, 200);
  EXPECT_GT(end.contactCount, 0U);
  EXPECT_GT(end.proxy.translation.z, start - 2e-5);
}

TEST_F(StartApartOfRoundedMeshes, DroppedAgainItStays) {
  drop();
  const PartId moved[] = {moving_};
  const DropResult again = dropParts(scene_, moved, {{0.0, 0.0, -1.0}, 0.0});
  EXPECT_EQ(again.travel, 0.0);
}

TEST_F(StartApartOfRoundedMeshes, ApartByLessThanTheDeviationItIsHeldToo) {
  drop();
  // As near as drops left it before.
  ServoScene near = inHand();
  near.moving.worldFromPart.translation.z -= gap_ - 0.5 * deviation_;
  const Hand before(near);
  ASSERT_FALSE(before.meets(near.moving.worldFromPart));
  const double start = near.moving.worldFromPart.translation.z;
  EXPECT_TRUE(startApart(near));
  Hand hand(near);
  const ServoSnapshot& end = hand.press({0.0, 0.0, -2e-3}, 200);
  EXPECT_GT(end.contactCount, 0U);
  EXPECT_GT(end.proxy.translation.z, start - 2e-5);
}

}  // namespace
}  // namespace nearfit::start_apart_test
