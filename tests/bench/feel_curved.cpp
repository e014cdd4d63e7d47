#include "tests/bench/feel_curved.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "tests/bench/bench_shapes.h"
#include "tests/bench/feel_certified.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;

/// Radius of a body about z, in cylindrical coordinates [m].
using RadiusAt = std::function<double(double angle, double z)>;

/// Numbers of edges of a body about z.
struct RoundGrid {
  std::uint32_t around, along;
};

/// Vertices of a surface about z between two heights, ring by ring.
void addSurface(std::vector<glm::dvec3>& vertices, const RadiusAt& radius, double height,
                const RoundGrid& grid) {
  for (std::uint32_t k = 0; k <= grid.along; ++k) {
    const double z = height * (static_cast<double>(k) / grid.along - 0.5);
    for (std::uint32_t i = 0; i < grid.around; ++i) {
      const double angle = 2.0 * pi * i / grid.around, r = radius(angle, z);
      vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
}

/// The band between two rings, seen from outside if the upper one is `upper`.
void addBand(std::vector<Triangle>& triangles, std::uint32_t lower, std::uint32_t upper,
             std::uint32_t around) {
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around;
    triangles.push_back({lower + i, lower + j, upper + j});
    triangles.push_back({lower + i, upper + j, upper + i});
  }
}

/// A solid about z.
TriangleMesh roundedRod(const RadiusAt& radius, double height, const RoundGrid& grid) {
  std::vector<glm::dvec3> vertices;
  addSurface(vertices, radius, height, grid);
  std::vector<Triangle> triangles;
  for (std::uint32_t k = 0; k < grid.along; ++k)
    addBand(triangles, k * grid.around, (k + 1) * grid.around, grid.around);
  const auto low = static_cast<std::uint32_t>(vertices.size()), high = low + 1;
  vertices.emplace_back(0.0, 0.0, -0.5 * height);
  vertices.emplace_back(0.0, 0.0, 0.5 * height);
  for (std::uint32_t i = 0, last = grid.along * grid.around; i < grid.around; ++i) {
    const std::uint32_t j = (i + 1) % grid.around;
    triangles.push_back({low, j, i});
    triangles.push_back({high, last + i, last + j});
  }
  return {std::move(vertices), std::move(triangles)};
}

/// A tube about z with a shaped bore.
TriangleMesh roundedBore(const RadiusAt& bore, double outer, double height, const RoundGrid& grid) {
  std::vector<glm::dvec3> vertices;
  addSurface(vertices, bore, height, grid);
  const auto low = static_cast<std::uint32_t>(vertices.size()), high = low + grid.around;
  addSurface(vertices, [&](double, double) { return outer; }, height, {grid.around, 1});
  std::vector<Triangle> triangles;
  for (std::uint32_t k = 0; k < grid.along; ++k)
    addBand(triangles, (k + 1) * grid.around, k * grid.around, grid.around);
  addBand(triangles, low, high, grid.around);
  addBand(triangles, 0, low, grid.around);
  addBand(triangles, high, grid.along * grid.around, grid.around);
  return {std::move(vertices), std::move(triangles)};
}

PressedParts ballInBowl(std::uint32_t fineness) {
  constexpr double kBowl = 0.03, kBall = 0.02;
  PressedParts parts;
  parts.scene = test::bowlMesh(kBowl, 0.036, 32 * fineness, 12 * fineness);
  parts.part = geodesicSphereMesh(kBall, 8 * fineness);
  parts.motion.towards = {0.0, 0.0, -1.0};
  parts.motion.axis = {1.0, 0.0, 0.0};
  parts.motion.press = kBowl - kBall + 1e-3;
  parts.motion.swing = 0.4;
  parts.motion.turn = parts.motion.tilt = 0.3;
  return parts;
}

PressedParts wheelsInMesh(std::uint32_t fineness) {
  constexpr std::uint32_t kTeeth = 20;
  constexpr double kPitchRadius = 0.02, kTooth = 1.5e-3, kWidth = 8e-3, kGap = 0.4e-3;
  const auto wheel = [&](double phase) {
    return roundedRod(
        [=](double angle, double) { return kPitchRadius + kTooth * std::cos(kTeeth * angle + phase); },
        kWidth, {12 * kTeeth * fineness, 6 * fineness});
  };
  PressedParts parts;
  // A tooth on +x, into the gap on -x of the other, whose number of teeth is even.
  parts.scene = wheel(0.0);
  parts.part = wheel(pi);
  parts.motion.start.translation.x = 2.0 * kPitchRadius + kGap;
  parts.motion.towards = {-1.0, 0.0, 0.0};
  parts.motion.press = kGap + 1e-3;
  parts.motion.swing = 0.5;
  parts.motion.slide = 3e-3;
  parts.motion.turn = 0.1;
  parts.motion.tilt = 0.01;
  return parts;
}

PressedParts nutOnThread(std::uint32_t fineness) {
  constexpr double kRadius = 8e-3, kThread = 0.6e-3, kPitch = 2e-3, kPlay = 0.2e-3;
  const auto thread = [](double angle, double z) {
    return kRadius + kThread * std::cos(2.0 * pi * z / kPitch - angle);
  };
  PressedParts parts;
  parts.scene = roundedRod(thread, 0.024, {64 * fineness, 144 * fineness});
  parts.part = roundedBore([&](double angle, double z) { return thread(angle, z) + kPlay; }, 0.012, 8e-3,
                           {64 * fineness, 48 * fineness});
  parts.margin = 2e-5;
  parts.motion.press = kPlay + 5e-4;
  parts.motion.swing = pi;
  parts.motion.slide = 5e-4;
  parts.motion.turn = 2.0;
  parts.motion.lead = kPitch / (2.0 * pi);
  parts.motion.tilt = 0.01;
  return parts;
}

}  // namespace

std::vector<CurvedScene> curvedScenes() {
  return {{"ball-bowl", "a ball of 40 mm in a bowl of 60 mm", ballInBowl},
          {"wheels", "wheels of 40 mm with 20 rounded teeth, in mesh", wheelsInMesh},
          {"nut-thread", "a nut of 8 mm on a rounded thread, pitch 2 mm, 0.2 mm of play", nutOnThread}};
}

std::vector<FeelRow> curvedRows(const CurvedScene& scene, std::size_t ticks) {
  std::vector<FeelRow> rows;
  double coarsest = 0.0;
  for (const std::uint32_t fineness : {1U, 2U, 4U}) {
    const PressedWalk walk = walkPressed(scene.make(fineness), ticks);
    if (fineness == 1) coarsest = p99(walk);
    const std::string name = fmt::format("x{} ({} triangles)", fineness, walk.triangles);
    const auto row = [&](const char* quantity, const std::vector<double>& samples, double scale = 1.0) {
      rows.push_back(feelRow("curved", scene.name, name, quantity, samples, scale));
    };
    row("tick [us]", walk.times, 1e6);
    row("p99 over that of x1", {p99(walk) / coarsest});
    row("in contact", {static_cast<double>(walk.held) / static_cast<double>(ticks)});
    row("ticks truncated", {static_cast<double>(walk.truncated)});
    rows.push_back(certifiedRow("curved", scene.name, name, *walk.bodies, walk.poses));
  }
  return rows;
}

}  // namespace nearfit::bench
