#include "core/scene/hierarchy_on_demand.h"

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::hierarchy_on_demand_test {
namespace {

/// Large enough that subtrees are built apart.
TriangleMesh largeMesh() {
  return test::icosphereMesh(1.0, 5);
}

TEST(HierarchyOnDemand, IsBuiltWhenItIsFirstNeededAndKeptOnce) {
  const TriangleMesh mesh = largeMesh();
  int asked = 0, kept = 0;
  HierarchyOnDemand hierarchy(
      [&]() -> std::optional<NormalConeTree> {
        ++asked;
        return std::nullopt;
      },
      [&](const NormalConeTree&) { ++kept; });
  EXPECT_FALSE(hierarchy.isReady());
  EXPECT_FALSE(hierarchy.origin());
  EXPECT_EQ(asked, 0);
  const NormalConeTree& tree = hierarchy.get(mesh);
  EXPECT_EQ(&hierarchy.get(mesh), &tree);
  EXPECT_TRUE(test::areSame(tree, NormalConeTree(mesh)));
  EXPECT_TRUE(hierarchy.isReady());
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(kept, 1);
  EXPECT_FALSE(hierarchy.origin()->isFromCache);
  EXPECT_GT(hierarchy.origin()->seconds, 0.0);
}

TEST(HierarchyOnDemand, WhatIsFoundIsNeitherBuiltNorKeptAgain) {
  const TriangleMesh mesh = test::boxMesh({1, 1, 1});
  // Of another mesh, so that it shows that nothing was built.
  HierarchyOnDemand hierarchy([] { return NormalConeTree(test::tetrahedronMesh()); },
                              [](const NormalConeTree&) { FAIL(); });
  EXPECT_EQ(hierarchy.get(mesh).keptFeatures().vertices, 4U);
  EXPECT_TRUE(hierarchy.origin()->isFromCache);
}

TEST(HierarchyOnDemand, ManyThreadsGetOne) {
  const TriangleMesh mesh = largeMesh();
  std::atomic<int> kept{0};
  HierarchyOnDemand hierarchy({}, [&](const NormalConeTree&) { ++kept; });
  std::vector<const NormalConeTree*> got(6);
  std::vector<std::thread> threads;
  for (auto& tree : got)
    threads.emplace_back([&] { tree = &hierarchy.get(mesh); });
  for (std::thread& thread : threads)
    thread.join();
  for (const NormalConeTree* tree : got)
    EXPECT_EQ(tree, got.front());
  EXPECT_EQ(kept, 1);
}

TEST(HierarchyOnDemand, ProgressRisesToOne) {
  const TriangleMesh mesh = largeMesh();
  HierarchyOnDemand hierarchy;
  double last = 0.0;
  int reports = 0;
  hierarchy.get(mesh, [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    ++reports;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_GT(reports, 20);
}

TEST(HierarchyOnDemand, StoppedAnywhereItIsBuiltAnewWhenNeeded) {
  const TriangleMesh mesh = largeMesh();
  const NormalConeTree expected(mesh);
  for (const double limit : {0.0, 0.1, 0.35, 0.6, 0.9}) {
    HierarchyOnDemand hierarchy;
    bool wasStopped = false;
    const ProgressCallback stop = [&](double fraction) {
      EXPECT_FALSE(wasStopped) << "asked again after it said stop";
      wasStopped = fraction >= limit;
      return !wasStopped;
    };
    EXPECT_THROW(hierarchy.get(mesh, stop), Cancelled) << limit;
    EXPECT_FALSE(hierarchy.isReady());
    EXPECT_TRUE(test::areSame(hierarchy.get(mesh), expected));
  }
}

TEST(HierarchyOnDemand, OneThatWaitsCanBeStoppedWithoutHarmToTheOther) {
  const TriangleMesh mesh = largeMesh();
  HierarchyOnDemand hierarchy;
  std::atomic<bool> isBuilding{false}, hasOtherStopped{false};
  std::thread builder([&] {
    hierarchy.get(mesh, [&](double) {
      isBuilding = true;
      // Only once the other was seen to stop while this one was at work.
      while (!hasOtherStopped)
        std::this_thread::yield();
      return true;
    });
  });
  while (!isBuilding)
    std::this_thread::yield();
  EXPECT_THROW(hierarchy.get(mesh, [](double) { return false; }), Cancelled);
  hasOtherStopped = true;
  builder.join();
  EXPECT_TRUE(hierarchy.isReady());
}

TEST(HierarchyOnDemand, WhoWaitsTakesOverFromOneThatWasStopped) {
  const TriangleMesh mesh = largeMesh();
  HierarchyOnDemand hierarchy;
  std::atomic<bool> isBuilding{false}, mayStop{false};
  std::thread first([&] {
    EXPECT_THROW(hierarchy.get(mesh,
                               [&](double) {
                                 isBuilding = true;
                                 while (!mayStop)
                                   std::this_thread::yield();
                                 return false;
                               }),
                 Cancelled);
  });
  while (!isBuilding)
    std::this_thread::yield();
  std::thread second([&] { hierarchy.get(mesh); });
  mayStop = true;
  first.join();
  second.join();
  EXPECT_TRUE(hierarchy.isReady());
}

}  // namespace
}  // namespace nearfit::hierarchy_on_demand_test
