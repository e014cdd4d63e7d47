#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/bench/bench_shapes.h"
#include "tests/bench/portable_random.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

/// A unit sphere of 20 * frequency^2 triangles: each of an icosahedron's faces as a triangular grid.
class GeodesicSphere {
 public:
  explicit GeodesicSphere(std::uint32_t frequency)
      : frequency_(frequency), base_(test::icosphereMesh(1.0, 0)) {
    for (const glm::dvec3& p : base_.vertices())
      vertices.push_back(p);
    firstOnEdges_ = static_cast<std::uint32_t>(vertices.size());
    for (const MeshEdge& edge : base_.edges()) {
      for (std::uint32_t i = 1; i < frequency; ++i)
        addPoint(base_.vertices()[edge.v0], base_.vertices()[edge.v1], base_.vertices()[edge.v1], i, 0);
    }
    for (std::uint32_t face = 0; face < base_.triangles().size(); ++face)
      addFace(face);
  }

  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;

 private:
  /// On the face's grid, i steps from a to b and j from a to c.
  std::uint32_t addPoint(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, std::uint32_t i,
                         std::uint32_t j) {
    const double n = frequency_;
    vertices.push_back(glm::normalize(a + (b - a) * (i / n) + (c - a) * (j / n)));
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }

  /// The `step`-th point (0 to frequency) on side k of a face, counted from corner k.
  std::uint32_t onSide(std::uint32_t face, std::uint32_t k, std::uint32_t step) const {
    const Triangle& corners = base_.triangles()[face];
    if (step == 0) return corners[k];
    if (step == frequency_) return corners[(k + 1) % 3];
    const std::uint32_t edge = base_.edgesOfTriangle(face)[k];
    const std::uint32_t fromStart = base_.edges()[edge].v0 == corners[k] ? step : frequency_ - step;
    return firstOnEdges_ + edge * (frequency_ - 1) + fromStart - 1;
  }

  void addFace(std::uint32_t face) {
    const Triangle& t = base_.triangles()[face];
    const auto points = base_.vertices();
    std::vector<std::uint32_t> previous, row;
    for (std::uint32_t j = 0; j <= frequency_; ++j) {
      row.clear();
      const std::uint32_t length = frequency_ - j;
      for (std::uint32_t i = 0; i <= length; ++i) {
        if (j == 0) {
          row.push_back(onSide(face, 0, i));
        } else if (i == 0) {
          row.push_back(onSide(face, 2, length));
        } else if (i == length) {
          row.push_back(onSide(face, 1, j));
        } else {
          row.push_back(addPoint(points[t[0]], points[t[1]], points[t[2]], i, j));
        }
      }
      for (std::uint32_t i = 0; j > 0 && i <= length; ++i) {
        triangles.push_back({previous[i], previous[i + 1], row[i]});
        if (i < length) triangles.push_back({previous[i + 1], row[i + 1], row[i]});
      }
      previous.swap(row);
    }
  }

  std::uint32_t frequency_, firstOnEdges_ = 0;
  TriangleMesh base_;
};

/// A smooth factor on directions: a few broad lobes, and waves that grow finer and lower.
class Relief {
 public:
  explicit Relief(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (Lobe& lobe : lobes_)
      lobe = {randomDirection(random), 0.3 + 0.5 * uniform(random), 6.0 + 10.0 * uniform(random)};
    double waveNumber = 3.0;
    for (Wave& wave : waves_) {
      wave = {waveNumber * randomDirection(random), 0.12 / waveNumber,
              2.0 * std::numbers::pi * uniform(random)};
      waveNumber *= 1.18;
    }
  }

  double operator()(const glm::dvec3& direction) const {
    double factor = 1.0;
    for (const Lobe& lobe : lobes_)
      factor += lobe.height * std::exp(lobe.sharpness * (glm::dot(direction, lobe.axis) - 1.0));
    for (const Wave& wave : waves_)
      factor += wave.height * std::sin(glm::dot(direction, wave.vector) + wave.phase);
    return factor;
  }

 private:
  struct Lobe {
    glm::dvec3 axis;
    double height, sharpness;
  };
  struct Wave {
    glm::dvec3 vector;
    double height, phase;
  };
  std::array<Lobe, 7> lobes_;
  std::array<Wave, 24> waves_;
};

}  // namespace

TriangleMesh geodesicSphereMesh(double radius, std::uint32_t frequency) {
  GeodesicSphere sphere(frequency);
  for (glm::dvec3& p : sphere.vertices)
    p *= radius;
  return {std::move(sphere.vertices), std::move(sphere.triangles)};
}

TriangleMesh organicMesh(std::uint32_t frequency, std::uint64_t seed) {
  GeodesicSphere sphere(frequency);
  const Relief relief(seed);
  for (glm::dvec3& p : sphere.vertices)
    p *= relief(p);
  return {std::move(sphere.vertices), std::move(sphere.triangles)};
}

}  // namespace nearfit::bench
