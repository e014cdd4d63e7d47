// Bodies that others drew, at poses for which it is documented whether they meet; generated stand-ins that
// stand to each other in the same way where those models are not there.
#include <filesystem>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/import/mesh_import.h"
#include "core/math/euler_angles.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/overlap/interference.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"

namespace nearfit::interference_models_test {
namespace {

using Kind = InterferenceKind;

constexpr double kQuarter = std::numbers::pi / 2;
const std::filesystem::path kModels = test::sharedFolder() / "models/public";

struct Built {
  Built(const std::string& file, const TriangleMesh& standIn)
      : mesh(std::filesystem::exists(kModels / file) ? importMesh(kModels / file, {}).mesh : standIn),
        tree(mesh) {}
  TriangleMesh mesh;
  NormalConeTree tree;
};

Kind between(const Built& scene, const Built& part, const RigidTransform& pose) {
  return findInterference(scene.tree, part.tree, pose).kind;
}

RigidTransform posed(const glm::dvec3& translation, const glm::dvec3& angles) {
  return {rotationFromEulerAngles(angles), translation};
}

/// What single precision leaves of coordinates of some decimetres [m].
constexpr double kRounding = 1e-7;

TEST(InterferenceModels, PumpClearsItsTrayAndTheBatteryCutsIn) {
  const Built tray("ariac/insert_collision.stl", test::boxMesh({1, 1, 0.06}));
  const Built pump("ariac/pump_base.stl", test::boxMesh({0.1, 0.1, 0.1}, {0, 0, 0.066}));
  const Built battery("ariac/battery_collision.stl", test::boxMesh({0.13, 0.05, 0.04}));
  const RigidTransform seated = posed({0.14, 0, 0.02}, {0, 0, -kQuarter});
  EXPECT_EQ(between(tray, pump, seated), Kind::Disjoint);
  EXPECT_EQ(between(tray, pump, posed({0.14, 0, 0.01}, {0, 0, -kQuarter})), Kind::SurfacesMeet);
  EXPECT_EQ(between(tray, battery, posed({-0.15, 0.035, 0.043}, {0, 0, kQuarter})), Kind::SurfacesMeet);
}

TEST(InterferenceModels, SensorAndRegulatorTouchTheirTray) {
  // Boxes against the sides that the approaches lead to: y = 0.345 for the sensor, z = 0.18 for the
  // regulator.
  const Built tray("ariac/insert_collision.stl", test::boxMesh({2, 0.345, 0.36}, {0, 0.1725, 0}));
  const Built sensor("ariac/sensor_collision.stl", test::boxMesh({0.1, 0.1, 0.1}));
  for (const double off : {kRounding, 1e-5}) {
    EXPECT_EQ(between(tray, sensor, posed({-0.1, 0.395 + off, 0.045}, {0, 0, -kQuarter})), Kind::Disjoint);
    EXPECT_EQ(between(tray, sensor, posed({-0.1, 0.395 - off, 0.045}, {0, 0, -kQuarter})),
              Kind::SurfacesMeet);
  }
  const Built plate("ariac/insert_collision.stl", test::boxMesh({2, 2, 0.36}));
  const Built regulator("ariac/regulator_collision.stl", test::boxMesh({0.1, 0.07, 0.1}));
  const glm::dvec3 angles(kQuarter, 0, -kQuarter);
  for (const double off : {kRounding, 1e-5}) {
    EXPECT_EQ(between(plate, regulator, posed({0.175, -0.223, 0.215 + off}, angles)), Kind::Disjoint);
    EXPECT_EQ(between(plate, regulator, posed({0.175, -0.223, 0.215 - off}, angles)), Kind::SurfacesMeet);
  }
}

TEST(InterferenceModels, NutCutsIntoTheBoltAsDrawnAndIsFreeWhenWoundOn) {
  // The stand-in bolt has a collar up to z = 17.5 mm.
  const Built bolt("nutbolt/factory_bolt_m16_loose.obj",
                   test::joined(test::cylinderMesh(0.008, 0.082, 40), test::cylinderMesh(0.009, 0.035, 40)));
  const Built nut(
      "nutbolt/factory_nut_m16_loose_subdiv_3x.obj",
      test::transformed(test::tubeMesh(0.0083, 0.012, 0.013, 40), 1.0, {{1, 0, 0, 0}, {0, 0, 0.0225}}));
  const auto wound = [](double mm) { return posed({0, 0, 1e-3 * mm}, {0, 0, std::numbers::pi * mm}); };
  EXPECT_EQ(between(bolt, nut, wound(0.0)), Kind::SurfacesMeet);
  EXPECT_EQ(between(bolt, nut, posed({0, 0, 1e-3}, {0, 0, 0})), Kind::SurfacesMeet);
  for (const double mm : {2.0, 4.0, 6.0, 8.0, 10.0, 28.0})
    EXPECT_EQ(between(bolt, nut, wound(mm)), Kind::Disjoint) << mm;
}

TEST(InterferenceModels, PegDrawnInItsHoleIsFree) {
  const Built hole("peghole/factory_round_hole_16mm_subdiv_3x.obj",
                   test::tubeMesh(0.0083, 0.0125, 0.009, 48));
  const Built peg("peghole/factory_round_peg_16mm_loose.obj", test::cylinderMesh(0.008, 0.05, 48));
  EXPECT_EQ(between(hole, peg, {}), Kind::Disjoint);
  EXPECT_EQ(between(hole, peg, posed({0.0004, 0, 0}, {0, 0, 0})), Kind::SurfacesMeet);
}

}  // namespace
}  // namespace nearfit::interference_models_test
