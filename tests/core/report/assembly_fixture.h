#pragma once

#include <memory>
#include <string>

#include <glm/mat4x4.hpp>

#include "core/scene/scene.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/random_values.h"

/// A scene for exports of assemblies, and what they are compared with.
namespace nearfit::test {

/// Names that formats might stumble over.
inline const char* const kHostileName =
    "a<b>&\"c\" 'd' \\X2\\00E9\\X0\\ \xC3\xA9\xE2\x82\xAC \xF0\x9F\x94\xA9 ]]> %41/../x";

/// A scene with two instances of a ring, one of them in two groups within each other, a box with two coloured faces, an
/// open square, and a hidden part.
struct AssemblyScene {
  AssemblyScene() {
    const GroupId outer = scene.addGroup({{}, "Outer <1>", std::nullopt, false});
    const GroupId inner = scene.addGroup({{}, "Inner", outer, false});
    scene.addGroup({{}, "Empty", std::nullopt, false});
    RandomValues random(22);
    const auto pose = [&] { return random.pose().normalized(); };
    const PartGeometryPtr ring = solidGeometryOf(torusMesh(0.05, 0.02, 24, 12));
    Part first = partOf(ring, "Ring", pose());
    first.colour = {0.25F, 0.5F, 0.75F};
    first.density = 7850.0;
    first.group = inner;
    firstRing = scene.add(first);
    Part second = partOf(ring, kHostileName, pose());
    second.colour = first.colour;
    secondRing = scene.add(second);
    Part third = partOf(ring, "Third ring", pose());
    third.colour = {1.0F, 0.0F, 0.0F};
    third.opacity = 0.5;
    third.group = outer;
    thirdRing = scene.add(third);
    Part boxPart = partOf(colouredBox(), "Box", pose());
    boxPart.colour = {0.5F, 0.5F, 0.5F};
    boxPart.group = inner;
    box = scene.add(boxPart);
    square = scene.add(partOf(solidGeometryOf(squareMesh(0.1, 3)), "Square", pose()));
    Part hidden = partOf(geometryOf(boxMesh(glm::dvec3(1.0))), "Hidden");
    hidden.isVisible = false;
    scene.add(hidden);
  }

  /// A box whose first four triangles are green and whose next two are blue.
  static PartGeometryPtr colouredBox() {
    PartGeometry geometry = *solidGeometryOf(boxMesh({0.1, 0.2, 0.3}));
    auto surfaces = std::make_shared<SurfaceFaces>();
    surfaces->faces.resize(3);
    for (std::size_t i = 0; i < geometry.mesh.triangles().size(); ++i)
      surfaces->faceOfTriangle.push_back(i < 4 ? 0 : i < 6 ? 1 : 2);
    geometry.surfaces = surfaces;
    geometry.faceColours = {CadColour{0.0F, 1.0F, 0.0F}, CadColour{0.0F, 0.0F, 1.0F}, std::nullopt};
    return std::make_shared<const PartGeometry>(geometry);
  }

  Scene scene;
  PartId firstRing{}, secondRing{}, thirdRing{}, box{}, square{};
};

/// Largest difference between the entries of two matrices.
inline double differenceOf(const glm::dmat4& a, const glm::dmat4& b) {
  double worst = 0.0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      worst = std::max(worst, std::abs(a[column][row] - b[column][row]));
  return worst;
}

/// The matrix of a pose by the textbook's formula, of which no code under test is a part.
inline glm::dmat4 matrixOf(const RigidTransform& pose) {
  const double w = pose.rotation.w, x = pose.rotation.x, y = pose.rotation.y, z = pose.rotation.z;
  const glm::dvec3& t = pose.translation;
  return {1 - 2 * (y * y + z * z),
          2 * (x * y + z * w),
          2 * (x * z - y * w),
          0,
          2 * (x * y - z * w),
          1 - 2 * (x * x + z * z),
          2 * (y * z + x * w),
          0,
          2 * (x * z + y * w),
          2 * (y * z - x * w),
          1 - 2 * (x * x + y * y),
          0,
          t.x,
          t.y,
          t.z,
          1};
}

}  // namespace nearfit::test
