#include "tests/bench/bench_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/bench/swept_mesh.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;

/// Rings across `points`, each at right angles to the curve there.
/// @param side  Never along the curve.
std::vector<SweptRing> ringsAlong(const std::vector<glm::dvec3>& points, const std::vector<double>& radii,
                                  const glm::dvec3& side) {
  std::vector<SweptRing> rings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3& before = points[i == 0 ? 0 : i - 1];
    const glm::dvec3& after = points[i + 1 == points.size() ? i : i + 1];
    const glm::dvec3 along = glm::normalize(after - before);
    const glm::dvec3 v = glm::normalize(glm::cross(along, side));
    rings.push_back({points[i], radii[i] * glm::cross(v, along), radii[i] * v});
  }
  return rings;
}

SweptRing levelRing(double z, double radius, double offset = 0.0) {
  return {{offset, 0.0, z}, {radius, 0.0, 0.0}, {0.0, radius, 0.0}};
}

/// Radius of a gear's outline at the fraction [0, 1) of a tooth: root, flank, tip, flank.
double toothRadius(double fraction) {
  constexpr double kRoot = 1.7, kTip = 2.0;
  const double fromMiddle = 2.0 * std::abs(fraction - 0.5);
  const double rise = std::clamp((0.7 - fromMiddle) / 0.4, 0.0, 1.0);
  return kRoot + (kTip - kRoot) * rise;
}

}  // namespace

TriangleMesh gearMesh(std::uint32_t teeth) {
  constexpr std::uint32_t kCornersOfTooth = 9, kLayers = 6;
  const std::uint32_t around = teeth * kCornersOfTooth;
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  // Closed profile in a half plane, swept round the axis: up the outside, down the bore.
  const std::uint32_t profile = 2 * (kLayers + 1);
  for (std::uint32_t i = 0; i < around; ++i) {
    const double angle = 2.0 * pi * i / around;
    const double tip = toothRadius(static_cast<double>(i % kCornersOfTooth) / kCornersOfTooth);
    for (std::uint32_t k = 0; k < profile; ++k) {
      const bool isOutside = k <= kLayers;
      const std::uint32_t layer = isOutside ? k : profile - 1 - k;
      const double r = isOutside ? tip : kGearBoreRadius;
      vertices.emplace_back(r * std::cos(angle), r * std::sin(angle),
                            static_cast<double>(layer) / kLayers - 0.5);
    }
  }
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t here = i * profile, next = (i + 1) % around * profile;
    for (std::uint32_t k = 0; k < profile; ++k) {
      const std::uint32_t up = (k + 1) % profile;
      triangles.push_back({here + k, next + k, next + up});
      triangles.push_back({here + k, next + up, here + up});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

TriangleMesh springMesh(std::uint32_t along, std::uint32_t around) {
  constexpr double kTurns = 7.0, kPitch = 0.9, kWire = 0.2;
  std::vector<glm::dvec3> points;
  for (std::uint32_t i = 0; i <= along; ++i) {
    const double turn = kTurns * i / along;
    points.emplace_back(std::cos(2.0 * pi * turn), std::sin(2.0 * pi * turn), kPitch * (turn - kTurns / 2));
  }
  return sweptMesh(ringsAlong(points, std::vector<double>(points.size(), kWire), {0.0, 0.0, 1.0}), around);
}

TriangleMesh teapotMesh() {
  std::vector<SweptRing> body;
  constexpr int kRings = 40;
  for (int i = 0; i < kRings; ++i) {
    const double s = static_cast<double>(i) / (kRings - 1);
    const double belly = 0.35 + 0.65 * std::sin(pi * std::min(1.0, 0.15 + 0.95 * s));
    const double knob = 0.12 * std::exp(-std::pow((s - 0.95) / 0.03, 2));
    body.push_back(levelRing(1.4 * s - 0.6, belly * std::sqrt(std::max(1.0 - std::pow(s, 6), 0.01)) + knob));
  }
  std::vector<glm::dvec3> handle, spout;
  std::vector<double> handleRadii, spoutRadii;
  for (int i = 0; i <= 24; ++i) {
    const double angle = pi * (i / 24.0 - 0.5);
    handle.emplace_back(-0.8 - 0.55 * std::cos(angle), 0.0, 0.4 * std::sin(angle));
    handleRadii.push_back(0.08);
  }
  for (int i = 0; i <= 30; ++i) {
    const double s = i / 30.0;
    spout.emplace_back(0.7 + 0.8 * s, 0.0, -0.2 + 0.8 * s * s);
    spoutRadii.push_back(0.25 - 0.15 * s);
  }
  const glm::dvec3 side(0.0, 1.0, 0.0);
  return test::joined(sweptMesh(body, 48), test::joined(sweptMesh(ringsAlong(handle, handleRadii, side), 16),
                                                        sweptMesh(ringsAlong(spout, spoutRadii, side), 16)));
}

TriangleMesh crankshaftMesh(std::uint32_t around) {
  constexpr double kJournal = 0.5, kWeb = 1.2, kPin = 0.4, kThrow = 0.7;
  std::vector<SweptRing> rings;
  double z = -4.0;
  /// A cylinder of several bands; where radii or offsets change, its end ring and the next one's first make a
  /// flat annulus, since the web's circle contains the others'.
  const auto addCylinder = [&](double radius, double offset, double length) {
    constexpr int kBands = 5;
    for (int i = 0; i <= kBands; ++i)
      rings.push_back(levelRing(z + length * i / kBands, radius, offset));
    z += length;
  };
  for (int cylinder = 0; cylinder < 4; ++cylinder) {
    const double side = cylinder == 0 || cylinder == 3 ? 1.0 : -1.0;
    addCylinder(kJournal, 0.0, 0.6);
    addCylinder(kWeb, 0.5 * side * kThrow, 0.3);
    addCylinder(kPin, side * kThrow, 0.6);
    addCylinder(kWeb, 0.5 * side * kThrow, 0.3);
  }
  addCylinder(kJournal, 0.0, 0.8);
  return sweptMesh(rings, around);
}

}  // namespace nearfit::bench
