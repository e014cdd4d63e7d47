#include "core/scene/scene.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::scene_test {
namespace {

Part named(const std::string& name) {
  Part part;
  part.name = name;
  return part;
}

Part posed(const RigidTransform& pose) {
  Part part = named("Peg");
  part.worldFromPart = pose;
  return part;
}

TEST(Scene, AddedPartsKeepTheirOrderAndGetIdsOfTheirOwn) {
  Scene scene;
  const PartId peg = scene.add(named("Peg")), hole = scene.add(named("Hole"));
  EXPECT_NE(peg, hole);
  ASSERT_EQ(scene.parts().size(), 2U);
  EXPECT_EQ(scene.parts()[0]->name, "Peg");
  EXPECT_EQ(scene.find(hole)->name, "Hole");
  EXPECT_EQ(scene.findByName("Peg")->id, peg);
  EXPECT_EQ(scene.findByName("peg"), nullptr);
}

TEST(Scene, TakenNameGetsTheNextFreeNumber) {
  Scene scene;
  for (int i = 0; i < 3; ++i)
    scene.add(named("Peg"));
  scene.add(named("Peg 2"));
  scene.add(named("M8"));
  scene.add(named("M8"));
  std::vector<std::string> names;
  for (const auto& part : scene.parts())
    names.push_back(part->name);
  EXPECT_EQ(names, (std::vector<std::string>{"Peg", "Peg 2", "Peg 3", "Peg 4", "M8", "M8 2"}));
}

TEST(Scene, NumberedLongNameKeepsWithinTheLimitAndCutsNoCharacter) {
  Scene scene;
  std::string longest(kMaxPartNameBytes - 2, 'a');
  longest += "\xC3\xA9";
  scene.add(named(longest));
  const PartId second = scene.add(named(longest));
  EXPECT_EQ(scene.find(second)->name, std::string(kMaxPartNameBytes - 2, 'a') + " 2");
}

TEST(Scene, NamesThatAreNoneAreRefused) {
  Scene scene;
  for (const std::string& name : {std::string(), std::string("a\nb"), std::string("a\0b", 3),
                                  std::string("\xFF"), std::string(kMaxPartNameBytes + 1, 'a')}) {
    EXPECT_THROW(scene.add(named(name)), UsageError);
  }
  EXPECT_TRUE(scene.parts().empty());
}

TEST(Scene, IdOfADeletedPartIsNotGivenAgain) {
  Scene scene;
  const PartId first = scene.add(named("Peg"));
  scene.remove(first);
  EXPECT_NE(scene.add(named("Peg")), first);
  EXPECT_EQ(scene.find(first), nullptr);
  EXPECT_THROW(scene.remove(first), UsageError);
}

TEST(Scene, DeletingTheMovingPartLeavesNone) {
  Scene scene;
  const PartId peg = scene.add(named("Peg")), hole = scene.add(named("Hole"));
  scene.setMovingPart(peg);
  scene.remove(hole);
  EXPECT_EQ(scene.movingPart(), peg);
  scene.remove(peg);
  EXPECT_EQ(scene.movingPart(), std::nullopt);
}

TEST(Scene, ReplacingRefusesTakenNamesAndUnknownParts) {
  Scene scene;
  const PartId peg = scene.add(named("Peg"));
  scene.add(named("Hole"));
  Part part = *scene.find(peg);
  part.name = "Hole";
  EXPECT_THROW(scene.replace(part), UsageError);
  part.name = "Pin";
  scene.replace(part);
  EXPECT_EQ(scene.find(peg)->name, "Pin");
  part.id = PartId{99};
  EXPECT_THROW(scene.replace(part), UsageError);
}

TEST(Scene, LockedPartAndMovingPartExcludeEachOther) {
  Scene scene;
  Part peg = named("Peg");
  peg.isLocked = true;
  peg.id = scene.add(peg);
  EXPECT_THROW(scene.setMovingPart(peg.id), UsageError);
  peg.isLocked = false;
  scene.replace(peg);
  scene.setMovingPart(peg.id);
  peg.isLocked = true;
  EXPECT_THROW(scene.replace(peg), UsageError);
  EXPECT_THROW(scene.setMovingPart(PartId{99}), UsageError);
  EXPECT_EQ(scene.movingPart(), peg.id);
}

TEST(Scene, PosesThatAreNoneAreRefused) {
  Scene scene;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const glm::dquat unit{1, 0, 0, 0};
  for (const RigidTransform& pose :
       {RigidTransform{unit, {0, nan, 0}}, RigidTransform{unit, {0, 0, infinity}},
        RigidTransform{unit, {2e9, 0, 0}}, RigidTransform{{nan, 0, 0, 0}, {}},
        RigidTransform{{0, 0, 0, 0}, {}}, RigidTransform{{1, 1, 0, 0}, {}},
        RigidTransform{{1.0021, 0, 0, 0}, {}}}) {
    EXPECT_THROW(scene.add(posed(pose)), UsageError);
  }
}

TEST(Scene, NearlyUnitQuaternionIsNormalised) {
  Scene scene;
  const PartId id = scene.add(posed({{0.7071, 0.7071, 0, 0}, {1, 2, 3}}));
  const RigidTransform& pose = scene.find(id)->worldFromPart;
  EXPECT_NEAR(pose.rotation.w, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(pose.rotation.x, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(pose.translation, glm::dvec3(1, 2, 3));
}

TEST(Scene, NormalisingAgainChangesNoDigit) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 100'000; ++i) {
    const RigidTransform raw{{uniform(random), uniform(random), uniform(random), uniform(random)}, {}};
    const RigidTransform once = checkedPose(raw.normalized());
    ASSERT_EQ(checkedPose(once).rotation, once.rotation) << "pose " << i;
  }
}

TEST(Scene, ColourOutOfRangeIsRefused) {
  Scene scene;
  Part part = named("Peg");
  part.colour.g = 1.5F;
  EXPECT_THROW(scene.add(part), UsageError);
  part.colour.g = std::nanf("");
  EXPECT_THROW(scene.add(part), UsageError);
}

TEST(Scene, DensityOutOfItsLimitsIsRefused) {
  Scene scene;
  Part part = named("Peg");
  part.id = scene.add(part);
  EXPECT_EQ(scene.find(part.id)->density, 1000.0);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double density : {0.0, -1.0, 9e-4, 1.1e6, infinity, std::nan("")}) {
    part.density = density;
    EXPECT_THROW(scene.add(part), UsageError) << density;
    EXPECT_THROW(scene.replace(part), UsageError) << density;
  }
  for (const double density : {kMinDensity, 7850.0, kMaxDensity}) {
    part.density = density;
    scene.replace(part);
    EXPECT_EQ(scene.find(part.id)->density, density);
  }
}

TEST(Scene, MassIsDensityTimesTheVolumeOfTheMesh) {
  const test::TemporaryFolder folder;
  Part part = named("Block");
  EXPECT_EQ(massOf(part), 0.0) << "nothing there to weigh";
  part.geometry =
      loadPartGeometry(folder.write("block.obj", test::objText(test::boxMesh({20, 30, 40}))), 1e-3);
  part.density = 7850.0;
  EXPECT_NEAR(massOf(part), 7850.0 * 0.02 * 0.03 * 0.04, 1e-12);
}

TEST(Scene, NewPartsGoThroughThePaletteAndReuseWhatIsFreed) {
  Scene scene;
  std::set<std::array<float, 3>> seen;
  for (std::size_t i = 0; i < kPartPalette.size(); ++i) {
    Part part = named("Part");
    part.colour = scene.nextColour();
    seen.insert({part.colour.r, part.colour.g, part.colour.b});
    scene.add(part);
  }
  EXPECT_EQ(seen.size(), kPartPalette.size());
  EXPECT_EQ(scene.nextColour(), kPartPalette[0]);
  scene.remove(scene.parts()[3]->id);
  EXPECT_EQ(scene.nextColour(), kPartPalette[3]);
}

TEST(Scene, PartsAddedTogetherAreThoseAddedOneByOne) {
  Scene one, all;
  for (Scene* scene : {&one, &all})
    scene->add(named("Peg 3"));
  const std::vector<Part> parts{named("Peg"), named("Hole"),   named("Peg"),
                                named("Peg"), named("Hole 2"), named("Hole")};
  std::vector<PartId> ids;
  for (const Part& part : parts)
    ids.push_back(one.add(part));
  EXPECT_EQ(all.addAll(parts), ids);
  for (const PartId id : ids)
    EXPECT_EQ(all.find(id)->name, one.find(id)->name);
  EXPECT_EQ(all.nextColours(3), (std::vector<Colour>{kPartPalette[0], kPartPalette[1], kPartPalette[2]}));
}

TEST(Scene, IfOneOfSeveralPartsCannotBeAddedNoneIs) {
  Scene scene;
  EXPECT_THROW(scene.addAll({named("Peg"), named("")}), UsageError);
  EXPECT_TRUE(scene.parts().empty());
  EXPECT_TRUE(scene.addAll({}).empty());
}

TEST(Scene, CopyIsIndependentButSharesItsParts) {
  Scene scene;
  const PartId peg = scene.add(named("Peg"));
  const Scene copy = scene;
  EXPECT_EQ(copy.parts()[0], scene.parts()[0]);
  Part pin = *scene.find(peg);
  pin.name = "Pin";
  scene.replace(pin);
  EXPECT_EQ(copy.find(peg)->name, "Peg");
}

}  // namespace
}  // namespace nearfit::scene_test
