#include "core/exact/mesh_intersection.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <utility>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Object.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>
#include <glm/geometric.hpp>

#include "core/exact/triangle_predicates.h"
#include "core/math/aabb.h"
#include "core/math/box_pairs.h"

namespace nearfit {
namespace {

using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = ExactKernel::Point_3;
/// Coordinates of a point; equal exact points have equal ones.
using PointKey = std::array<double, 3>;
using NodePair = std::array<std::uint32_t, 2>;

/// Planes whose unit normals differ by less are one, as seen from a side that two shared polygons have in common. Far
/// above rounding; planes that meet in a sharper angle are hardly two.
constexpr double kOnePlane = 1e-9;

/// Pairs of triangles, or steps of the corefinement, between two questions if the work goes on: some milliseconds.
constexpr std::size_t kBetweenQuestions = 256;

TriangleCorners cornersAt(const MeshArrays& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

Aabb boxAround(const MeshArrays& mesh) {
  Aabb box;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t)
      box.add(mesh.vertices[corner]);
  }
  return box;
}

/// Triangles that reach into a box.
std::vector<std::uint32_t> trianglesWithin(const MeshArrays& mesh, const Aabb& box) {
  std::vector<std::uint32_t> within;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (doOverlap(boxOf(cornersAt(mesh, i)), box)) within.push_back(i);
  }
  return within;
}

ExactPoint exactPoint(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

/// Segments of intersection, joined into polylines at their common ends.
class CurveBuilder {
 public:
  /// Adds what two triangles share, each with an area.
  void add(const TriangleCorners& a, const TriangleCorners& b) {
    const ExactKernel::Triangle_3 first(exactPoint(a[0]), exactPoint(a[1]), exactPoint(a[2])),
        second(exactPoint(b[0]), exactPoint(b[1]), exactPoint(b[2]));
    // Versions of CGAL differ in the variant that they return; an object takes each.
    const CGAL::Object shared = CGAL::intersection(first, second);
    if (const auto* segment = CGAL::object_cast<ExactKernel::Segment_3>(&shared)) {
      segmentAt(nodeAt(segment->source()), nodeAt(segment->target()));
    } else if (const auto* triangle = CGAL::object_cast<ExactKernel::Triangle_3>(&shared)) {
      addOutline({triangle->vertex(0), triangle->vertex(1), triangle->vertex(2)}, unitNormal(a));
    } else if (const auto* polygon = CGAL::object_cast<std::vector<ExactPoint>>(&shared)) {
      addOutline(*polygon, unitNormal(a));
    }
  }

  std::vector<std::vector<glm::dvec3>> polylines() {
    for (const auto& [ends, planes] : segments_) {
      if (!isWithinPlanes(planes)) ends_.push_back(ends);
    }
    segmentsAt_.resize(points_.size());
    for (std::uint32_t i = 0; i < ends_.size(); ++i) {
      for (const std::uint32_t node : ends_[i])
        segmentsAt_[node].push_back(i);
    }
    isUsed_.assign(ends_.size(), false);
    // Open curves, and those between branches, begin where no single curve passes through.
    for (std::uint32_t node = 0; node < points_.size(); ++node) {
      if (segmentsAt_[node].size() != 2) walkAllFrom(node);
    }
    for (std::uint32_t node = 0; node < points_.size(); ++node)
      walkAllFrom(node);
    return std::move(polylines_);
  }

 private:
  /// A plane in which polygons that both meshes share have a side.
  struct Plane {
    glm::dvec3 normal;
    std::uint32_t polygons;
  };

  static glm::dvec3 unitNormal(const TriangleCorners& t) {
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    return normal / std::max(glm::length(normal), std::numeric_limits<double>::min());
  }
  /// True if a side lies within what the meshes share of each of its planes: polygons on either side have it.
  static bool isWithinPlanes(const std::vector<Plane>& planes) {
    return !planes.empty() &&
           std::ranges::all_of(planes, [](const Plane& plane) { return plane.polygons % 2 == 0; });
  }

  std::uint32_t nodeAt(const ExactPoint& p) {
    // From the exact numbers: the intervals of two equal ones may differ.
    const PointKey key{CGAL::to_double(CGAL::exact(p.x())), CGAL::to_double(CGAL::exact(p.y())),
                       CGAL::to_double(CGAL::exact(p.z()))};
    const auto [at, isNew] = nodes_.emplace(key, static_cast<std::uint32_t>(points_.size()));
    if (isNew) points_.emplace_back(key[0], key[1], key[2]);
    return at->second;
  }

  /// The segment's planes; null if it is shorter than rounding.
  std::vector<Plane>* segmentAt(std::uint32_t a, std::uint32_t b) {
    return a == b ? nullptr : &segments_[{std::min(a, b), std::max(a, b)}];
  }

  void addOutline(const std::vector<ExactPoint>& corners, const glm::dvec3& normal) {
    std::vector<std::uint32_t> nodes;
    for (const ExactPoint& corner : corners)
      nodes.push_back(nodeAt(corner));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::vector<Plane>* planes = segmentAt(nodes[i], nodes[(i + 1) % nodes.size()]);
      if (planes == nullptr) continue;
      const auto same = std::ranges::find_if(*planes, [&](const Plane& plane) {
        return std::abs(glm::dot(plane.normal, normal)) > 1.0 - kOnePlane;
      });
      same == planes->end() ? planes->push_back({normal, 1}) : void(++same->polygons);
    }
  }

  void walkAllFrom(std::uint32_t node) {
    for (const std::uint32_t segment : segmentsAt_[node]) {
      if (!isUsed_[segment]) walk(node, segment);
    }
  }

  /// Follows a curve until it ends, branches or closes.
  void walk(std::uint32_t node, std::uint32_t segment) {
    std::vector<glm::dvec3>& line = polylines_.emplace_back();
    line.push_back(points_[node]);
    for (;;) {
      isUsed_[segment] = true;
      node = ends_[segment][0] == node ? ends_[segment][1] : ends_[segment][0];
      line.push_back(points_[node]);
      if (segmentsAt_[node].size() != 2) return;
      const std::uint32_t next = segmentsAt_[node][segmentsAt_[node][0] == segment ? 1 : 0];
      if (isUsed_[next]) return;
      segment = next;
    }
  }

  std::map<PointKey, std::uint32_t> nodes_;
  std::vector<glm::dvec3> points_;
  std::map<NodePair, std::vector<Plane>> segments_;
  std::vector<NodePair> ends_;
  std::vector<std::vector<std::uint32_t>> segmentsAt_;
  std::vector<bool> isUsed_;
  std::vector<std::vector<glm::dvec3>> polylines_;
};

using SolidKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SolidMesh = CGAL::Surface_mesh<SolidKernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

/// Thrown out of the corefinement, which knows no other way to end it.
struct Stop {
  VolumeProblem reason;
};

/// Progress of the corefinement, which ends it where the caller wants.
class StoppingVisitor : public pmp::Corefinement::Default_visitor<SolidMesh> {
 public:
  StoppingVisitor(const GoOn& goOn, std::size_t maxPairs, std::size_t& steps)
      : goOn_(&goOn), maxPairs_(maxPairs), steps_(&steps) {}

  // The names are CGAL's.
  void progress_filtering_intersections(double) const { step(); }
  void triangulating_faces_step() const { step(); }
  void intersection_of_coplanar_faces_step() const { step(); }
  void edge_face_intersections_step() const { step(); }
  void start_handling_edge_face_intersections(std::size_t pairs) const { limit(pairs); }
  void start_handling_intersection_of_coplanar_faces(std::size_t pairs) const { limit(pairs); }
  void start_building_output() const { ask(); }
  void classify_patches() const { ask(); }

 private:
  void limit(std::size_t pairs) const {
    if (pairs > maxPairs_) throw Stop{VolumeProblem::TooLarge};
    ask();
  }
  void step() const {
    if (++*steps_ % kBetweenQuestions == 0) ask();
  }
  void ask() const {
    if (*goOn_ && !(*goOn_)()) throw Stop{VolumeProblem::Stopped};
  }

  const GoOn* goOn_;
  std::size_t maxPairs_;
  std::size_t* steps_;
};

glm::dvec3 positionOf(const SolidMesh& mesh, SolidMesh::Vertex_index vertex) {
  const auto& p = mesh.point(vertex);
  return {p.x(), p.y(), p.z()};
}

/// Sum of the tetrahedra between the faces and a vertex, so that a mesh far from the origin loses no precision.
double volumeOf(const SolidMesh& mesh) {
  if (mesh.number_of_faces() == 0) return 0.0;
  const glm::dvec3 origin = positionOf(mesh, *mesh.vertices().begin());
  double six = 0.0;
  for (const SolidMesh::Face_index face : mesh.faces()) {
    const SolidMesh::Halfedge_index h = mesh.halfedge(face);
    const glm::dvec3 a = positionOf(mesh, mesh.target(h)) - origin,
                     b = positionOf(mesh, mesh.target(mesh.next(h))) - origin,
                     c = positionOf(mesh, mesh.source(h)) - origin;
    six += glm::dot(a, glm::cross(b, c));
  }
  return six / 6.0;
}

/// Builds CGAL's mesh of a solid; throws Stop if it is none.
SolidMesh solidOf(const MeshArrays& mesh) {
  std::vector<std::uint32_t> indexOf(mesh.vertices.size(), static_cast<std::uint32_t>(mesh.vertices.size()));
  std::vector<SolidKernel::Point_3> points;
  std::vector<std::array<std::size_t, 3>> polygons;
  polygons.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    // The corefinement takes it that each has a plane.
    if (hasNoArea(cornersAt(mesh, i))) throw Stop{VolumeProblem::NoArea};
    const auto& t = mesh.triangles[i];
    auto& polygon = polygons.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& index = indexOf[t[k]];
      if (index == mesh.vertices.size()) {
        index = static_cast<std::uint32_t>(points.size());
        const glm::dvec3& p = mesh.vertices[t[k]];
        points.emplace_back(p.x, p.y, p.z);
      }
      polygon[k] = index;
    }
  }
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) throw Stop{VolumeProblem::NotManifold};
  SolidMesh solid;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, solid);
  if (!CGAL::is_closed(solid)) throw Stop{VolumeProblem::Open};
  if (!(volumeOf(solid) > 0.0) || !pmp::does_bound_a_volume(solid)) throw Stop{VolumeProblem::InsideOut};
  return solid;
}

double sharedVolume(const MeshArrays& a, const MeshArrays& b, std::size_t maxPairs, const GoOn& goOn) {
  SolidMesh first = solidOf(a), second = solidOf(b), shared;
  if (goOn && !goOn()) throw Stop{VolumeProblem::Stopped};
  std::size_t steps = 0;
  const bool isWhole = pmp::corefine_and_compute_intersection(
      first, second, shared,
      CGAL::parameters::throw_on_self_intersection(true).visitor(StoppingVisitor(goOn, maxPairs, steps)));
  if (!isWhole) throw Stop{VolumeProblem::Failed};
  return std::max(0.0, volumeOf(shared));
}

}  // namespace

IntersectionCurves findIntersectionCurves(const MeshArrays& a, const MeshArrays& b, std::size_t maxPairs,
                                          const GoOn& goOn) {
  IntersectionCurves curves;
  const std::vector<std::uint32_t> ofA = trianglesWithin(a, boxAround(b));
  const std::vector<std::uint32_t> ofB = trianglesWithin(b, boxAround(a));
  if (ofA.empty() || ofB.empty()) return curves;
  BoxPairs boxes(ofB.size());
  for (const std::uint32_t i : ofB)
    boxes.add(boxOf(cornersAt(b, i)));
  boxes.build();
  CurveBuilder builder;
  std::size_t pairs = 0;
  std::vector<std::uint32_t> near;
  near.reserve(ofB.size());
  for (std::size_t i = 0; i < ofA.size() && curves.isComplete; ++i) {
    const TriangleCorners first = cornersAt(a, ofA[i]);
    if (hasNoArea(first)) continue;
    near.clear();
    boxes.forEachAt(boxOf(first), [&](std::uint32_t k) { near.push_back(ofB[k]); });
    for (const std::uint32_t k : near) {
      const bool isStopped = ++pairs % kBetweenQuestions == 0 && goOn && !goOn();
      curves.isComplete = pairs <= maxPairs && !isStopped;
      if (!curves.isComplete) break;
      const TriangleCorners second = cornersAt(b, k);
      if (!hasNoArea(second) && doTrianglesMeet(first, second)) builder.add(first, second);
    }
  }
  curves.polylines = builder.polylines();
  return curves;
}

IntersectionVolume findIntersectionVolume(const MeshArrays& a, const MeshArrays& b, std::size_t maxTriangles,
                                          std::size_t maxPairs, const GoOn& goOn) {
  if (a.triangles.size() + b.triangles.size() > maxTriangles) return {{}, VolumeProblem::TooLarge};
  try {
    return {sharedVolume(a, b, maxPairs, goOn), VolumeProblem::None};
  } catch (const Stop& stop) {
    return {{}, stop.reason};
  } catch (const pmp::Corefinement::Self_intersection_exception&) {
    return {{}, VolumeProblem::CrossesItself};
  } catch (const std::exception&) {
    return {{}, VolumeProblem::Failed};  // Its checks of conditions, and memory that it does not get.
  }
}

}  // namespace nearfit
