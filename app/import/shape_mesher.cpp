#include "app/import/shape_mesher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp_Domain.hxx>
#include <BRepGProp_Face.hxx>
#include <BRepGProp_Vinert.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Message_ProgressRange.hxx>
#include <OSD_Parallel.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Elips.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include "app/import/default_tessellation.h"
#include "app/import/document_builder.h"
#include "app/import/placed_mesh.h"
#include "app/import/solid_bodies.h"

namespace nearfit::importer {
namespace {

/// Finest chord, as a fraction of the diagonal: doubles and meshing have no digits for more.
constexpr double kMinChordFraction = 1e-6;

/// Relative error of a face's share of the volume. Integrals without such a bound are off by 5e-5 for one of the files
/// tried here, which is more than the triangles are; a tenth of the time goes into this one.
constexpr double kVolumeError = 1e-6;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

glm::dvec3 vectorOf(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}

/// A face that bounds something: not one that only lies within a solid.
bool isBoundary(const TopoDS_Shape& face) {
  return face.Orientation() == TopAbs_FORWARD || face.Orientation() == TopAbs_REVERSED;
}

std::vector<TopoDS_Face> facesOf(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    if (isBoundary(face.Current())) faces.push_back(TopoDS::Face(face.Current()));
  return faces;
}

double diagonalOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, Standard_False);
  if (box.IsVoid() || box.IsOpen()) return 0.0;
  return std::sqrt(box.SquareExtent());
}

/// Joins points that turn out to be the same.
class PointIds {
 public:
  std::uint32_t add(const glm::dvec3& position) {
    positions_.push_back(position);
    parents_.push_back(static_cast<std::uint32_t>(parents_.size()));
    return parents_.back();
  }
  std::uint32_t find(std::uint32_t id) {
    while (parents_[id] != id)
      id = parents_[id] = parents_[parents_[id]];
    return id;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }
  const glm::dvec3& position(std::uint32_t id) const { return positions_[id]; }
  std::size_t size() const noexcept { return positions_.size(); }

 private:
  std::vector<glm::dvec3> positions_;
  std::vector<std::uint32_t> parents_;
};

/// Triangles of one face, in ids of points.
struct FaceMesh {
  TopoDS_Face face;
  std::size_t firstTriangle = 0, triangleCount = 0;
};

/// Triangles of meshed faces, joined along edges and at vertices.
class FaceJoiner {
 public:
  /// @param map  Applied to positions.
  explicit FaceJoiner(const glm::dmat3& map) : map_(map), mirrors_(glm::determinant(map) < 0.0) {}

  /// Adds a face; false if it has no triangles.
  bool add(const TopoDS_Face& face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull() || mesh->NbTriangles() == 0) return false;
    const gp_Trsf place = location.Transformation();
    std::vector<std::uint32_t> ids(static_cast<std::size_t>(mesh->NbNodes()) + 1, kNone);
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
      joinEdge(TopoDS::Edge(edge.Current()), mesh, location, place, ids);
    for (int i = 1; i <= mesh->NbNodes(); ++i)
      if (ids[static_cast<std::size_t>(i)] == kNone)
        ids[static_cast<std::size_t>(i)] = points_.add(positionOf(mesh, i, place));
    addTriangles(face, *mesh, place, ids);
    return true;
  }

  /// Edges whose faces have not the same points on them.
  std::size_t mismatchCount() const noexcept { return mismatches_; }

  /// Vertices and triangles without what has collapsed, and the range of each face.
  void finish(std::vector<glm::dvec3>& vertices, std::vector<Triangle>& triangles,
              std::vector<FaceMesh>& faces) {
    std::vector<std::uint32_t> vertexOf(points_.size(), kNone);
    const auto vertex = [&](std::uint32_t id) {
      std::uint32_t& v = vertexOf[points_.find(id)];
      if (v == kNone) {
        v = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(points_.position(points_.find(id)));
      }
      return v;
    };
    for (const FaceMesh& from : faces_) {
      FaceMesh face{from.face, triangles.size(), 0};
      for (std::size_t k = 0; k < from.triangleCount; ++k) {
        const Triangle& ids = triangles_[from.firstTriangle + k];
        const std::uint32_t a = points_.find(ids[0]), b = points_.find(ids[1]), c = points_.find(ids[2]);
        if (a == b || b == c || c == a) continue;
        triangles.push_back({vertex(a), vertex(b), vertex(c)});
      }
      face.triangleCount = triangles.size() - face.firstTriangle;
      faces.push_back(face);
    }
    for (const auto& [a, b] : borders_) {
      const std::uint32_t v = vertexOf[points_.find(a)], w = vertexOf[points_.find(b)];
      if (v != kNone && w != kNone) finalBorders_.push_back(pairOf(v, w));
    }
    std::ranges::sort(finalBorders_);
  }

  static std::uint64_t pairOf(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
  }
  /// After finish(): true if two vertices are neighbours on an edge that has one face only.
  bool isOnBorder(std::uint64_t pair) const { return std::ranges::binary_search(finalBorders_, pair); }

  /// To be called before the first add(): counts the uses of each edge, to know those of one face only.
  void countUses(const std::vector<TopoDS_Face>& faces) {
    for (const TopoDS_Face& face : faces)
      for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
        ++edges_[indexOf(edge.Current())].uses;
  }

 private:
  struct EdgePoints {
    std::uint32_t uses = 0;
    std::vector<std::uint32_t> ids;  ///< Along the edge; empty before its first face.
  };

  std::size_t indexOf(const TopoDS_Shape& edge) {
    const auto index = static_cast<std::size_t>(edgeIndex_.Add(edge));
    if (index > edges_.size()) edges_.resize(index);
    return index - 1;
  }

  glm::dvec3 positionOf(const Handle(Poly_Triangulation) & mesh, int node, const gp_Trsf& place) const {
    return map_ * vectorOf(mesh->Node(node).Transformed(place).XYZ());
  }

  /// The point of a vertex; if it is new, at the position of a node.
  std::uint32_t vertexId(const TopoDS_Vertex& vertex, const glm::dvec3& position) {
    const auto index = static_cast<std::size_t>(vertexIndex_.Add(vertex)) - 1;
    if (index == vertexIds_.size()) vertexIds_.push_back(points_.add(position));
    return vertexIds_[index];
  }

  void assign(std::uint32_t& at, std::uint32_t id) {
    if (at == kNone) {
      at = id;
    } else {
      points_.join(at, id);
    }
  }

  void joinEdge(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & mesh,
                const TopLoc_Location& location, const gp_Trsf& place, std::vector<std::uint32_t>& ids) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, mesh, location);
    if (polygon.IsNull() || polygon->NbNodes() < 2) return;
    const int count = polygon->NbNodes();
    const auto node = [&](int i) { return polygon->Nodes().Value(polygon->Nodes().Lower() + i); };
    for (int i = 0; i < count; ++i)
      if (node(i) < 1 || node(i) > mesh->NbNodes()) return;
    EdgePoints& points = edges_[indexOf(edge)];
    if (points.ids.empty()) {
      points.ids = newEdge(edge, count, [&](int i) { return positionOf(mesh, node(i), place); });
      if (points.uses == 1 && !BRep_Tool::Degenerated(edge))
        for (std::size_t i = 1; i < points.ids.size(); ++i)
          borders_.emplace_back(points.ids[i - 1], points.ids[i]);
    }
    if (points.ids.size() != static_cast<std::size_t>(count)) {
      ++mismatches_;
      assign(ids[static_cast<std::size_t>(node(0))], points.ids.front());
      assign(ids[static_cast<std::size_t>(node(count - 1))], points.ids.back());
      return;
    }
    for (int i = 0; i < count; ++i)
      assign(ids[static_cast<std::size_t>(node(i))], points.ids[static_cast<std::size_t>(i)]);
  }

  template <class Position>
  std::vector<std::uint32_t> newEdge(const TopoDS_Edge& edge, int count, Position position) {
    TopoDS_Vertex first, last;
    TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), first, last);
    std::vector<std::uint32_t> ids;
    for (int i = 0; i < count; ++i) {
      // All of a degenerated edge, as at the tip of a cone, is its vertex.
      const bool isFirst = i == 0 || BRep_Tool::Degenerated(edge), isLast = i == count - 1;
      if (isFirst && !first.IsNull()) {
        ids.push_back(vertexId(first, position(i)));
      } else if (isLast && !last.IsNull()) {
        ids.push_back(vertexId(last, position(i)));
      } else {
        ids.push_back(points_.add(position(i)));
      }
    }
    return ids;
  }

  void addTriangles(const TopoDS_Face& face, const Poly_Triangulation& mesh, const gp_Trsf& place,
                    const std::vector<std::uint32_t>& ids) {
    faces_.push_back({face, triangles_.size(), static_cast<std::size_t>(mesh.NbTriangles())});
    const bool isTurned = (face.Orientation() == TopAbs_REVERSED) != (place.IsNegative() != mirrors_);
    for (int i = 1; i <= mesh.NbTriangles(); ++i) {
      std::array<int, 3> n{};
      mesh.Triangle(i).Get(n[0], n[1], n[2]);
      if (isTurned) std::swap(n[1], n[2]);
      triangles_.push_back({ids[static_cast<std::size_t>(n[0])], ids[static_cast<std::size_t>(n[1])],
                            ids[static_cast<std::size_t>(n[2])]});
    }
  }

  glm::dmat3 map_;
  bool mirrors_;
  PointIds points_;
  TopTools_IndexedMapOfShape edgeIndex_, vertexIndex_;
  std::vector<EdgePoints> edges_;
  std::vector<std::uint32_t> vertexIds_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> borders_;  ///< Ids of points.
  std::vector<std::uint64_t> finalBorders_;
  std::vector<Triangle> triangles_;
  std::vector<FaceMesh> faces_;
  std::size_t mismatches_ = 0;
};

/// Edges of triangles with one triangle, besides those on borders of faces without a neighbour; and all with one.
struct OpenEdges {
  std::size_t gaps = 0, borders = 0;
};

OpenEdges openEdgesOf(const std::vector<Triangle>& triangles, const FaceJoiner& joiner) {
  std::vector<std::uint64_t> pairs;
  pairs.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      pairs.push_back(FaceJoiner::pairOf(t[k], t[(k + 1) % 3]));
  std::ranges::sort(pairs);
  OpenEdges open;
  for (std::size_t i = 0; i < pairs.size();) {
    std::size_t end = i + 1;
    while (end < pairs.size() && pairs[end] == pairs[i])
      ++end;
    if (end - i == 1) ++(joiner.isOnBorder(pairs[i]) ? open.borders : open.gaps);
    i = end;
  }
  return open;
}

/// Sum of the triangles' normals, each by twice its area, weighted by a direction at its centre.
template <class Direction>
double outwardness(const CadShape& shape, const FaceMesh& face, Direction direction) {
  double sum = 0.0;
  for (std::size_t k = 0; k < face.triangleCount; ++k) {
    const Triangle& t = shape.triangles[face.firstTriangle + k];
    const glm::dvec3 &a = shape.vertices[t[0]], &b = shape.vertices[t[1]], &c = shape.vertices[t[2]];
    sum += glm::dot(glm::cross(b - a, c - a), direction((a + b + c) / 3.0));
  }
  return sum;
}

glm::dvec3 acrossAxis(const glm::dvec3& p, const glm::dvec3& point, const glm::dvec3& axis) {
  const glm::dvec3 d = p - point;
  return d - glm::dot(d, axis) * axis;
}

/// Surface of a meshed face. Which side is outside is taken from the triangles, which have been turned the right way.
/// @param map  From OpenCASCADE's coordinates; a multiple of the identity.
ExactSurface surfaceOf(const CadShape& shape, const FaceMesh& face, const glm::dmat3& map) {
  const BRepAdaptor_Surface surface(face.face, Standard_False);
  const double scale = std::abs(map[0][0]);
  const auto pointAt = [&](const gp_Pnt& p) { return map * vectorOf(p.XYZ()); };
  const auto along = [&](const gp_Dir& d) { return glm::normalize(map * vectorOf(d.XYZ())); };
  ExactSurface s;
  switch (surface.GetType()) {
    case GeomAbs_Plane: {
      const gp_Pln plane = surface.Plane();
      s.kind = SurfaceKind::Plane;
      s.point = pointAt(plane.Location());
      s.direction = along(plane.Axis().Direction());
      if (outwardness(shape, face, [&](const glm::dvec3&) { return s.direction; }) < 0.0)
        s.direction = -s.direction;
      break;
    }
    case GeomAbs_Cylinder: {
      const gp_Cylinder cylinder = surface.Cylinder();
      s.kind = SurfaceKind::Cylinder;
      s.point = pointAt(cylinder.Location());
      s.direction = along(cylinder.Axis().Direction());
      s.radius = cylinder.Radius() * scale;
      s.isHollow = outwardness(shape, face, [&](const glm::dvec3& p) {
                     return acrossAxis(p, s.point, s.direction);
                   }) < 0.0;
      break;
    }
    case GeomAbs_Cone: {
      const gp_Cone cone = surface.Cone();
      s.kind = SurfaceKind::Cone;
      s.point = pointAt(cone.Apex());
      s.direction = along(cone.Axis().Direction());
      s.halfAngle = std::abs(cone.SemiAngle());
      double side = 0.0;
      for (std::size_t k = 0; k < face.triangleCount; ++k)
        for (const std::uint32_t v : shape.triangles[face.firstTriangle + k])
          side += glm::dot(shape.vertices[v] - s.point, s.direction);
      if (side < 0.0) s.direction = -s.direction;
      s.isHollow = outwardness(shape, face, [&](const glm::dvec3& p) {
                     return acrossAxis(p, s.point, s.direction);
                   }) < 0.0;
      break;
    }
    case GeomAbs_Sphere: {
      const gp_Sphere sphere = surface.Sphere();
      s.kind = SurfaceKind::Sphere;
      s.point = pointAt(sphere.Location());
      s.radius = sphere.Radius() * scale;
      s.isHollow = outwardness(shape, face, [&](const glm::dvec3& p) { return p - s.point; }) < 0.0;
      break;
    }
    case GeomAbs_Torus: {
      const gp_Torus torus = surface.Torus();
      s.kind = SurfaceKind::Torus;
      s.point = pointAt(torus.Location());
      s.direction = along(torus.Axis().Direction());
      s.radius = torus.MajorRadius() * scale;
      s.minorRadius = torus.MinorRadius() * scale;
      s.isHollow = outwardness(shape, face, [&](const glm::dvec3& p) {
                     const glm::dvec3 across = acrossAxis(p, s.point, s.direction);
                     const double length = glm::length(across);
                     return length > 0.0 ? p - (s.point + across * (s.radius / length)) : glm::dvec3(0.0);
                   }) < 0.0;
      break;
    }
    default:
      break;
  }
  return s;
}

bool isSoundSurface(const ExactSurface& s) {
  const auto isPositive = [](double x) { return x > 0.0 && std::isfinite(x); };
  const auto isFinitePoint = [](const glm::dvec3& p) { return std::isfinite(p.x + p.y + p.z); };
  switch (s.kind) {
    case SurfaceKind::Cylinder:
    case SurfaceKind::Sphere:
      return isFinitePoint(s.point) && isPositive(s.radius);
    case SurfaceKind::Cone:
      return isFinitePoint(s.point) && s.halfAngle > 0.0 && s.halfAngle < std::numbers::pi / 2;
    case SurfaceKind::Torus:
      return isFinitePoint(s.point) && isPositive(s.radius) && isPositive(s.minorRadius);
    default:
      return isFinitePoint(s.point);
  }
}

/// Tolerances of meshing, in OpenCASCADE's units.
struct OccTessellation {
  double chord = 0.0, angle = 0.0;
};

OccTessellation tessellationFor(const MeshRequest& request, double diagonal) {
  const double scale = std::abs(request.map[0][0]);
  double chord = request.wanted.chord / scale;
  if (!(chord > 0.0)) chord = defaultChord(diagonal, scale, request.hasUnit);
  return {std::max(chord, diagonal * kMinChordFraction),
          request.wanted.angle > 0.0 ? request.wanted.angle : kDefaultAngle};
}

/// Twice the vector area that an edge sweeps about a point, along the parameter; no value for curves without a formula.
std::optional<gp_XYZ> sweptBy(const BRepAdaptor_Curve& curve, const gp_XYZ& about) {
  const double first = curve.FirstParameter(), last = curve.LastParameter();
  const gp_XYZ a = curve.Value(first).XYZ(), b = curve.Value(last).XYZ();
  // Of the chord as seen from a centre, and of the sector between the two.
  const auto ofConic = [&](const gp_Ax2& place, double product) {
    return (place.Location().XYZ() - about).Crossed(b - a) +
           place.Direction().XYZ() * (product * (last - first));
  };
  switch (curve.GetType()) {
    case GeomAbs_Line:
      return (a - about).Crossed(b - about);
    case GeomAbs_Circle: {
      const gp_Circ circle = curve.Circle();
      return ofConic(circle.Position(), circle.Radius() * circle.Radius());
    }
    case GeomAbs_Ellipse: {
      const gp_Elips ellipse = curve.Ellipse();
      return ofConic(ellipse.Position(), ellipse.MajorRadius() * ellipse.MinorRadius());
    }
    default:
      return std::nullopt;
  }
}

/// volumeBelow() of a plane face that lines, circles and ellipses bound, by Stokes: adaptive integrals take a tenth of the
/// time of an import where plates have many holes. No value for other faces.
std::optional<double> volumeBelowPlane(const TopoDS_Face& face, const gp_Pnt& origin) {
  const BRepAdaptor_Surface surface(face, Standard_False);
  if (surface.GetType() != GeomAbs_Plane) return std::nullopt;
  const gp_XYZ about = surface.Plane().Location().XYZ();
  gp_XYZ twiceArea(0.0, 0.0, 0.0);
  for (TopExp_Explorer each(face, TopAbs_EDGE); each.More(); each.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(each.Current());
    if (!isBoundary(edge)) continue;
    if (BRep_Tool::Degenerated(edge) || !BRep_Tool::IsGeometric(edge)) return std::nullopt;
    const std::optional<gp_XYZ> swept = sweptBy(BRepAdaptor_Curve(edge), about);
    if (!swept) return std::nullopt;
    twiceArea += *swept * (edge.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0);
  }
  return (about - origin.XYZ()).Dot(twiceArea) / 6.0;
}

/// Volume between a face and a point, negative if the face looks towards it: those of a closed shell add up to the
/// volume within. BRepGProp computes the same, but chooses a point of its own for each shape.
double volumeBelow(const TopoDS_Face& face, const gp_Pnt& origin) {
  if (const std::optional<double> plane = volumeBelowPlane(face, origin)) return *plane;
  BRepGProp_Face surface;
  surface.Load(face);
  BRepGProp_Vinert volume;
  volume.SetLocation(origin);
  if (surface.NaturalRestriction()) {
    volume.Perform(surface, kVolumeError);
  } else {
    BRepGProp_Domain domain;
    domain.Init(face);
    volume.Perform(surface, domain, kVolumeError);
  }
  return volume.Mass();
}

/// Volume within a shell's faces, positive; 0 if it cannot be computed.
double exactVolumeOf(const TopoDS_Shape& shell, const gp_Pnt& origin, bool usesAllThreads) {
  const std::vector<TopoDS_Face> faces = facesOf(shell);
  std::vector<double> volumes(faces.size(), std::numeric_limits<double>::quiet_NaN());
  const auto measure = [&](int i) {
    try {
      volumes[static_cast<std::size_t>(i)] = volumeBelow(faces[static_cast<std::size_t>(i)], origin);
    } catch (const Standard_Failure&) {
    }
  };
  OSD_Parallel::For(0, static_cast<int>(faces.size()), measure, !usesAllThreads);
  double sum = 0.0;
  for (const double volume : volumes)
    sum += volume;
  return std::isfinite(sum) ? std::abs(sum) : 0.0;
}

/// Volume of a body in OpenCASCADE's units; 0 if unknown.
double exactVolumeOf(const Body& body, bool usesAllThreads) {
  Bnd_Box box;
  BRepBndLib::Add(body.shells.front(), box, Standard_False);
  if (box.IsVoid() || box.IsOpen()) return 0.0;
  // In the middle of the body, where the shares of its faces are small and so are their errors.
  const gp_Pnt origin((box.CornerMin().XYZ() + box.CornerMax().XYZ()) / 2.0);
  double volume = 0.0;
  for (std::size_t i = 0; i < body.shells.size(); ++i) {
    const double shell = exactVolumeOf(body.shells[i], origin, usesAllThreads);
    if (shell == 0.0) return 0.0;
    volume += i == 0 ? shell : -shell;
  }
  return std::max(volume, 0.0);
}

/// Triangles and faces of one shell.
struct ShellRange {
  std::size_t firstFace = 0, faceCount = 0;
};

/// Turns the triangles of a shell that looks the wrong way: inward if it is the outer one, outward around a cavity.
void orientShell(CadShape& shape, const std::vector<FaceMesh>& faces, const ShellRange& shell, bool isOuter) {
  if (shell.faceCount == 0) return;
  const std::size_t first = faces[shell.firstFace].firstTriangle;
  const FaceMesh& last = faces[shell.firstFace + shell.faceCount - 1];
  const std::span<Triangle> triangles(shape.triangles.data() + first,
                                      last.firstTriangle + last.triangleCount - first);
  if ((sixVolumes(shape.vertices, triangles) < 0.0) != isOuter) return;
  for (Triangle& t : triangles)
    std::swap(t[1], t[2]);
}

/// Faces of a body that were meshed, joined.
class BodyMesher {
 public:
  BodyMesher(const MeshRequest& request, CadShape& shape)
      : request_(request), shape_(shape), joiner_(request.map) {}

  void run() {
    std::vector<std::vector<TopoDS_Face>> shells;
    std::vector<TopoDS_Face> all;
    for (const TopoDS_Shape& shell : request_.body.shells) {
      shells.push_back(facesOf(shell));
      all.insert(all.end(), shells.back().begin(), shells.back().end());
    }
    joiner_.countUses(all);
    std::vector<ShellRange> ranges;
    std::size_t meshed = 0;
    for (const std::vector<TopoDS_Face>& shell : shells) {
      ranges.push_back({meshed, 0});
      for (const TopoDS_Face& face : shell)
        if (joiner_.add(face)) ++ranges.back().faceCount;
      meshed += ranges.back().faceCount;
    }
    joiner_.finish(shape_.vertices, shape_.triangles, faces_);
    if (request_.isSolid)
      for (std::size_t i = 0; i < ranges.size(); ++i)
        orientShell(shape_, faces_, ranges[i], i == 0);
    if (all.size() > meshed)
      addWarning(shape_.warnings,
                 fmt::format("{} of its {} faces could not be meshed.", all.size() - meshed, all.size()));
    tellGaps();
    takeSurfaces();
  }

 private:
  void tellGaps() {
    const OpenEdges open = openEdgesOf(shape_.triangles, joiner_);
    if (open.gaps > 0) {
      addWarning(shape_.warnings,
                 fmt::format("Its triangles have gaps along {} edges, where faces do not share their points.",
                             open.gaps));
    }
    if (request_.isSolid && open.borders > 0) {
      addWarning(
          shape_.warnings,
          fmt::format("It is not closed: {} edges of triangles belong to one face only.", open.borders));
      // The integrals over its faces depend on the point that they are about.
      shape_.exactVolume = 0.0;
    }
  }

  void takeSurfaces() {
    std::vector<const void*> identities;
    for (const FaceMesh& face : faces_) {
      ExactSurface surface;
      try {
        surface = surfaceOf(shape_, face, request_.map);
      } catch (const Standard_Failure&) {
        // Its triangles are there all the same.
      }
      shape_.surfaces.faces.push_back(isSoundSurface(surface) ? surface : ExactSurface{});
      shape_.surfaces.faceOfTriangle.insert(shape_.surfaces.faceOfTriangle.end(), face.triangleCount,
                                            static_cast<std::uint32_t>(shape_.surfaces.faces.size() - 1));
      identities.push_back(face.face.TShape().get());
    }
    if (request_.colours != nullptr) colourFaces(identities, *request_.colours, shape_);
    if (request_.faces != nullptr) *request_.faces = std::move(identities);
  }

  const MeshRequest& request_;
  CadShape& shape_;
  FaceJoiner joiner_;
  std::vector<FaceMesh> faces_;
};

}  // namespace

std::optional<CadColour> findColour(const ColourTable& colours, const void* identity) {
  const auto at = colours.find(identity);
  return at == colours.end() ? std::nullopt : std::optional(at->second);
}

void colourFaces(const std::vector<const void*>& faces, const ColourTable& colours, CadShape& shape) {
  std::vector<std::optional<CadColour>> found;
  found.reserve(faces.size());
  for (const void* face : faces)
    found.push_back(findColour(colours, face));
  const bool hasColours =
      std::ranges::any_of(found, [](const std::optional<CadColour>& colour) { return colour.has_value(); });
  if (!hasColours) found.clear();
  shape.faceColours = std::move(found);
}

CadShape meshBody(const MeshRequest& request, const Message_ProgressRange& progress) {
  CadShape shape;
  shape.isExact = true;
  const TopoDS_Compound all = compoundOf(request.body.shells);
  const double diagonal = diagonalOf(all);
  const OccTessellation tessellation = tessellationFor(request, diagonal);
  const double scale = std::abs(request.map[0][0]);
  if (!(diagonal > 0.0) || !(tessellation.chord > 0.0) || !std::isfinite(diagonal)) {
    addWarning(shape.warnings, "Its size cannot be told.");
    return shape;
  }
  shape.tessellation = {tessellation.chord * scale, tessellation.angle};
  if (request.isSolid)
    shape.exactVolume = exactVolumeOf(request.body, request.usesAllThreads) * scale * scale * scale;
  // Triangles that came with the file would be taken for fine enough.
  BRepTools::Clean(all);
  IMeshTools_Parameters parameters;
  parameters.Deflection = tessellation.chord;
  parameters.Angle = tessellation.angle;
  parameters.InParallel = request.usesAllThreads;
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(all);
  mesher.ChangeParameters() = parameters;
  mesher.Perform(progress);
  BodyMesher(request, shape).run();
  // Their memory is worth more for the shapes to come.
  BRepTools::Clean(all);
  return shape;
}

CadShape meshTriangulated(const TopoDS_Shape& shape, const glm::dmat3& map, const ColourTable& colours) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  TriangleColours triangleColours;
  for (const TopoDS_Face& face : facesOf(shape)) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull()) continue;
    const gp_Trsf place = location.Transformation();
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (int i = 1; i <= mesh->NbNodes(); ++i)
      vertices.push_back(vectorOf(mesh->Node(i).Transformed(place).XYZ()));
    const bool isTurned = (face.Orientation() == TopAbs_REVERSED) != place.IsNegative();
    const std::optional<CadColour> colour = findColour(colours, face.TShape().get());
    for (int i = 1; i <= mesh->NbTriangles(); ++i) {
      std::array<int, 3> n{};
      mesh->Triangle(i).Get(n[0], n[1], n[2]);
      if (isTurned) std::swap(n[1], n[2]);
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k)
        triangle[k] = first + static_cast<std::uint32_t>(n[k] - 1);
      triangles.push_back(triangle);
      triangleColours.add(colour);
    }
  }
  return triangleShape(vertices, triangles, map, triangleColours);
}

}  // namespace nearfit::importer
