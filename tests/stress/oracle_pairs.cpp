#include "tests/stress/oracle_pairs.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "core/import/mesh_import.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"

namespace nearfit::stress {
namespace {

using test::BodyPair;

/// A disc whose rim stands back by a fifth on every other pair of its corners: reflex edges, many directions
/// that repeat.
TriangleMesh gearMesh(std::uint32_t teeth) {
  const std::uint32_t corners = 4 * teeth;
  const TriangleMesh disc = test::cylinderMesh(0.5, 0.2, corners);
  std::vector<glm::dvec3> vertices(disc.vertices().begin(), disc.vertices().end());
  for (glm::dvec3& x : vertices) {
    const double turn = std::atan2(x.y, x.x) / (2.0 * std::numbers::pi) * corners;
    const auto corner = static_cast<std::uint32_t>(std::lround(turn + corners)) % corners;
    if (corner / 2 % 2 == 1) x = {0.8 * x.x, 0.8 * x.y, x.z};
  }
  return TriangleMesh(std::move(vertices), {disc.triangles().begin(), disc.triangles().end()});
}

TriangleMesh movedMesh(const TriangleMesh& mesh, const glm::dvec3& by) {
  return test::transformed(mesh, 1.0, {{1, 0, 0, 0}, by});
}

std::vector<BodyPair> generatedPairs() {
  using namespace test;
  const TriangleMesh box = boxMesh({0.6, 0.4, 0.5}), tetra = tetrahedronMesh(0.3);
  const glm::dvec3 far{3e4, -2e5, 1e5};
  return {
      {"boxes", box, boxMesh({0.3, 0.3, 0.3})},
      {"sphere-torus", icosphereMesh(0.5, 1), torusMesh(0.5, 0.2, 10, 6)},
      {"bore-peg", tubeMesh(0.3, 0.5, 0.4, 10), cylinderMesh(0.28, 0.6, 10)},
      {"gears-1e-6", transformed(gearMesh(6), 1e-6), transformed(gearMesh(4), 1e-6)},
      {"plates", boxMesh({1.0, 1.0, 1e-6}), boxMesh({0.5, 0.7, 1e-6})},
      {"needles", withNeedles(box, 1e6, 0.0), tetra},
      {"slivers", withSlivers(starMesh(3, 0.5, 0, 0.3), 1e6, 1e-8), tetra},
      {"sheets", squareMesh(1.0, 3), squareMesh(0.6, 2)},
      {"fins", finsMesh(13, 9, 6.0), box},
      {"duplicates", withDuplicates(box), boxMesh({0.25, 0.5, 0.125})},
      {"no-area", withFacesWithoutArea(starMesh(6, 0.5, 1, 0.3)), box},
      {"soup-1e6", transformed(looseTriangles(10, 40), 1e6), transformed(looseTriangles(11, 30), 1e6)},
      {"fan", jaggedFan(7, 60, 1e-6), tetra},
      {"coplanar", coplanarFans(8, 4), squareMesh(0.5, 1)},
      {"far", movedMesh(box, far), movedMesh(boxMesh({0.5, 0.25, 0.25}), -2.0 * far)},
      {"knives", wedgeMesh(1e-3), wedgeMesh(std::numbers::pi / 2 - 1e-6)},
  };
}

TriangleMesh fileMesh(const std::filesystem::path& file) {
  return importMesh(file, {}).mesh;
}

/// At the size of their probes.
BodyPair filePair(const std::string& name, const std::filesystem::path& file, const TriangleMesh& probe) {
  const TriangleMesh mesh = fileMesh(file);
  double reach = 0.0;
  for (const glm::dvec3& x : mesh.vertices())
    reach = std::max(reach, glm::length(x - mesh.vertices()[0]));
  return {name, mesh, test::transformed(probe, reach)};
}

}  // namespace

std::vector<BodyPair> oraclePairs() {
  using namespace test;
  std::vector<BodyPair> pairs = generatedPairs();
  const TriangleMesh tetra = tetrahedronMesh(0.3), block = boxMesh({0.25, 0.5, 0.125});
  const std::array<BodyPair, 4> standIns{
      {{"stars", starMesh(3, 0.5, 1, 0.4), starMesh(3, 0.5, 1, 0.4)},
       {"cones", coneMesh(0.5, 0.5, 24), coneMesh(0.5, 1e-8, 7)},
       {"two-boxes", joined(boxMesh({0.5, 0.5, 0.5}, {0.25, 0.25, 0.0}), boxMesh({0.5, 0.5, 0.5})), tetra},
       {"inside-out", turned(starMesh(5, 0.5, 1, 0.3)), block}}};
  const std::filesystem::path files = test::sharedFolder() / "models/nasty";
  const std::array<std::pair<const char*, const TriangleMesh*>, 4> names{
      {{"obj_nonmanifold_vierbein.obj", &tetra},
       {"obj_wallhole.obj", &block},
       {"stl_multibody_inverted.stl", &tetra},
       {"obj_moebius.obj", &block}}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::filesystem::path file = files / names[i].first;
    pairs.push_back(std::filesystem::exists(file) ? filePair(file.stem().string(), file, *names[i].second)
                                                  : standIns[i]);
  }
  return pairs;
}

}  // namespace nearfit::stress
