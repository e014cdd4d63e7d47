#include "core/path/path_bodies.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

/// Roundings of a pose that is interpolated, inverted and multiplied, of the lengths involved: a few dozen.
constexpr double kPlaceRounding = 1e-14;
/// Travel is rounded up by this share: a hundred roundings.
constexpr double kTravelRounding = 1.0 + 1e-13;

PathPart movingPartOf(const Scene::PartPtr& part, const RigidTransform& leadFromWorld,
                      const glm::dvec3& centre) {
  PathPart moving;
  moving.part = part;
  moving.leadFromPart = (leadFromWorld * part->worldFromPart).normalized();
  const TriangleMesh& mesh = part->geometry->mesh;
  moving.corners = mesh.bounds().corners();
  for (glm::dvec3& corner : moving.corners)
    corner = moving.leadFromPart.applyToPoint(corner) - centre;
  double squared = 0.0;
  const glm::dvec3 centreInPart = moving.leadFromPart.inverse().applyToPoint(centre);
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) {
      const glm::dvec3 arm = mesh.vertices()[v] - centreInPart;
      squared = std::max(squared, glm::dot(arm, arm));
    }
  }
  moving.radius = kTravelRounding * std::sqrt(squared) +
                  kPlaceRounding * (mesh.bounds().largestCoordinate() + glm::length(centreInPart));
  return moving;
}

/// Upper bound on the length of the way of each point of a part from one pose to the next [m].
double segmentTravel(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centre,
                     const PathPart& part) noexcept {
  const double shift = glm::distance(from.applyToPoint(centre), to.applyToPoint(centre));
  const glm::dvec3 turn = rotationVector(glm::conjugate(from.rotation) * to.rotation);
  const double angle = glm::length(turn);
  // Points of a body turn about the axis through the centre, which a box around them may be nearer to.
  double arm = 0.0;
  for (const glm::dvec3& corner : part.corners)
    arm = std::max(arm, angle > 0.0 ? glm::length(glm::cross(turn / angle, corner)) : 0.0);
  arm = std::min(arm, part.radius);
  // Differences of poses are of no use below their rounding.
  const double least =
      4e-16 * (glm::length(from.translation) + glm::length(to.translation) + 2.0 * glm::length(centre));
  const bool isStill = from == to;
  return isStill ? 0.0 : kTravelRounding * (shift + angle * arm) + least + 1e-15 * part.radius;
}

/// Half extents of a box as another frame sees it.
glm::dvec3 extentIn(const glm::dmat3& turn, const glm::dvec3& half) noexcept {
  return glm::abs(turn[0]) * half.x + glm::abs(turn[1]) * half.y + glm::abs(turn[2]) * half.z;
}

}  // namespace

PathBodies pathBodies(const Scene& scene, const AssemblyPath& path) {
  PathBodies bodies;
  std::map<std::string_view, Scene::PartPtr> partOf;
  for (const Scene::PartPtr& part : scene.parts())
    partOf.emplace(part->name, part);
  std::set<PartId> own;
  std::vector<Scene::PartPtr> named;
  for (const std::string& name : path.parts) {
    const auto found = partOf.find(name);
    if (found == partOf.end())
      throw UsageError("path", fmt::format("the scene has no part \"{}\", which the path moves", name),
                       "take the scene that the path was made for");
    named.push_back(found->second);
    own.insert(found->second->id);
  }
  if (!named.empty()) bodies.worldFromLead = named.front()->worldFromPart;
  const RigidTransform leadFromWorld = bodies.worldFromLead.inverse();
  for (const Scene::PartPtr& part : named) {
    // A part alone counts, seen or not.
    if (!hasTriangles(*part) || (named.size() > 1 && !part->isVisible)) continue;
    bodies.moving.push_back(movingPartOf(part, leadFromWorld, path.centre));
    bodies.radius = std::max(bodies.radius, bodies.moving.back().radius);
  }
  if (bodies.moving.empty())
    throw UsageError("path", "no part that it moves is visible and has triangles",
                     "show the part, or give it a mesh");
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!own.contains(part->id) && part->isVisible && hasTriangles(*part)) bodies.others.push_back(part);
  }
  return bodies;
}

double boxGap(const Aabb& other, const Aabb& part, const RigidTransform& pose) noexcept {
  const glm::dmat3 turn = glm::mat3_cast(pose.rotation);
  const glm::dvec3 otherHalf = 0.5 * (other.upper - other.lower), partHalf = 0.5 * (part.upper - part.lower);
  const glm::dvec3 between = pose.applyToPoint(part.centre()) - other.centre();
  const glm::dvec3 zero(0.0);
  const glm::dvec3 inOther = glm::max(glm::abs(between) - otherHalf - extentIn(turn, partHalf), zero);
  const glm::dmat3 back = glm::transpose(turn);
  const glm::dvec3 inPart = glm::max(glm::abs(back * between) - partHalf - extentIn(back, otherHalf), zero);
  const double reach = other.largestCoordinate() + part.largestCoordinate() + glm::length(pose.translation);
  const double gap = std::max(glm::length(inOther), glm::length(inPart)) - kPlaceRounding * reach;
  // Not a number, for poses that are none, counts as no gap.
  return gap > 0.0 ? gap : 0.0;
}

PathTravel::PathTravel(const AssemblyPath& path, const PathPart& part) {
  sums_.reserve(path.poses.size());
  sums_.push_back(0.0);
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const double added =
        segmentTravel(path.poses[i - 1].worldFromLead, path.poses[i].worldFromLead, path.centre, part);
    sums_.push_back(sums_.back() + added);
  }
}

double PathTravel::at(double place) const noexcept {
  const double last = static_cast<double>(sums_.size() - 1);
  if (!(place > 0.0)) return 0.0;
  if (place >= last) return sums_.back();
  const double whole = std::floor(place);
  const auto i = static_cast<std::size_t>(whole);
  return std::min(sums_[i] + (place - whole) * (sums_[i + 1] - sums_[i]), sums_[i + 1]);
}

double PathTravel::placeAt(double travel, double from, double to) const noexcept {
  if (travel <= at(from)) return from;
  if (travel >= at(to)) return to;
  const auto after = std::ranges::upper_bound(sums_, travel);
  if (after == sums_.begin() || after == sums_.end()) return to;
  const auto i = static_cast<std::size_t>(after - sums_.begin() - 1);
  const double share = (travel - sums_[i]) / (sums_[i + 1] - sums_[i]);
  return std::clamp(static_cast<double>(i) + share, from, to);
}

RigidTransform otherFromPart(const Part& other, const RigidTransform& worldFromLead,
                             const PathPart& moving) noexcept {
  return (other.worldFromPart.inverse() * (worldFromLead * moving.leadFromPart)).normalized();
}

double placeRounding(const Part& other, const RigidTransform& worldFromLead,
                     const PathPart& moving) noexcept {
  return kPlaceRounding *
         (glm::length(other.worldFromPart.translation) + glm::length(worldFromLead.translation) +
          glm::length(moving.leadFromPart.translation) +
          3.0 * moving.part->geometry->mesh.bounds().largestCoordinate() +
          3.0 * other.geometry->mesh.bounds().largestCoordinate());
}

}  // namespace nearfit
