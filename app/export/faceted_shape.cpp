#include "app/export/faceted_shape.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <BRepBuilderAPI_Copy.hxx>
#include <BRep_Builder.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Precision.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <gp_Ax3.hxx>
#include <gp_Dir.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include "app/import/solid_bodies.h"
#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/mesh/coordinate_rounding.h"
#include "core/mesh/flat_groups.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit::exporter {
namespace {

/// Slack on the distance of vertices from their faces, beyond rounding to millimetres.
constexpr double kToleranceSlack = 1.01;

/// An edge as a triangle runs along it.
struct HalfEdge {
  std::uint32_t edge = 0, from = 0, to = 0;
};
using Loop = std::vector<HalfEdge>;

gp_Pnt pointOf(const glm::dvec3& p) {
  return {kMillimetresPerMetre * p.x, kMillimetresPerMetre * p.y, kMillimetresPerMetre * p.z};
}

bool isWithin(const Aabb& inner, const Aabb& outer) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
         glm::all(glm::lessThanEqual(inner.upper, outer.upper));
}

/// Sets that triangles are joined into.
class Components {
 public:
  explicit Components(const TriangleMesh& mesh) : parent_(mesh.triangles().size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    for (std::uint32_t edge = 0; edge < mesh.edges().size(); ++edge) {
      const std::span<const std::uint32_t> faces = mesh.facesOfEdge(edge);
      for (const std::uint32_t face : faces)
        parent_[find(face)] = find(faces.front());
    }
  }
  std::uint32_t find(std::uint32_t triangle) {
    while (parent_[triangle] != triangle) {
      parent_[triangle] = parent_[parent_[triangle]];
      triangle = parent_[triangle];
    }
    return triangle;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Shell made of one component.
struct ShellPart {
  TopoDS_Shell shell;
  bool isClosed = true;
  double sixVolumes = 0.0;
  Aabb box;
};

class FacetBuilder {
 public:
  FacetBuilder(const CadShape& shape, std::size_t& facets)
      : shape_(shape),
        facets_(facets),
        mesh_(shape.vertices, shape.triangles),
        flats_(findFlats(mesh_, flatTolerance(mesh_, coordinateRounding(mesh_.vertices())))),
        components_(mesh_),
        vertices_(mesh_.vertices().size()),
        edges_(mesh_.edges().size()) {
    findTolerance();
    findClosed();
  }

  ProductShape build() {
    for (const std::vector<std::uint32_t>& region : regions())
      if (!addPolygon(region))
        for (const std::uint32_t triangle : region)
          addTriangle(triangle);
    std::vector<TopoDS_Shape> pieces = solids();
    if (pieces.empty()) throw Error("", "none of its triangles has an area", "repair its mesh");
    result_.shape = pieces.size() == 1 ? pieces.front() : TopoDS_Shape(importer::compoundOf(pieces));
    return std::move(result_);
  }

 private:
  /// Flats are as flat as their coordinates' rounding: what lies on a face may be off it by as much.
  void findTolerance() {
    double worst = 0.0;
    for (std::uint32_t t = 0; t < mesh_.triangles().size(); ++t) {
      if (flats_.flatOf[t] == kNoFlat) continue;
      for (const std::uint32_t corner : mesh_.triangles()[t])
        worst = std::max(worst, std::abs(flats_.planes[flats_.flatOf[t]].height(mesh_.vertices()[corner])));
    }
    tolerance_ = std::max(Precision::Confusion(), kToleranceSlack * kMillimetresPerMetre * worst);
  }

  void findClosed() {
    for (std::uint32_t edge = 0; edge < mesh_.edges().size(); ++edge) {
      const std::span<const std::uint32_t> faces = mesh_.facesOfEdge(edge);
      if (faces.size() != 2 || !mesh_.isEdgeConsistent(edge))
        for (const std::uint32_t face : faces)
          partOf(face).isClosed = false;
    }
    for (std::uint32_t t = 0; t < mesh_.triangles().size(); ++t) {
      const auto [a, b, c] = corners(t);
      ShellPart& part = partOf(t);
      part.sixVolumes +=
          glm::dot(a - mesh_.vertices()[0], glm::cross(b - mesh_.vertices()[0], c - mesh_.vertices()[0]));
      for (const glm::dvec3& p : {a, b, c})
        part.box.add(p);
    }
  }

  struct Corners {
    glm::dvec3 a, b, c;
  };
  Corners corners(std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {mesh_.vertices()[t[0]], mesh_.vertices()[t[1]], mesh_.vertices()[t[2]]};
  }

  ShellPart& partOf(std::uint32_t triangle) { return parts_[components_.find(triangle)]; }

  std::optional<CadColour> colourOf(std::uint32_t triangle) const {
    if (shape_.faceColours.empty()) return std::nullopt;
    return shape_.faceColours[shape_.surfaces.faceOfTriangle[triangle]];
  }

  /// Triangles of one flat and colour together, others each by itself.
  std::vector<std::vector<std::uint32_t>> regions() {
    std::map<std::pair<std::uint32_t, std::optional<CadColour>>, std::size_t> known;
    std::vector<std::vector<std::uint32_t>> regions;
    regionOf_.resize(mesh_.triangles().size());
    for (std::uint32_t t = 0; t < mesh_.triangles().size(); ++t) {
      std::size_t region = regions.size();
      if (flats_.flatOf[t] != kNoFlat)
        region = known.try_emplace({flats_.flatOf[t], colourOf(t)}, region).first->second;
      if (region == regions.size()) regions.emplace_back();
      regions[region].push_back(t);
      regionOf_[t] = region;
    }
    return regions;
  }

  bool isInside(std::uint32_t edge) const {
    const std::span<const std::uint32_t> faces = mesh_.facesOfEdge(edge);
    return faces.size() == 2 && regionOf_[faces[0]] == regionOf_[faces[1]] && mesh_.isEdgeConsistent(edge);
  }

  /// Loops around a region, or none if they are not simple: where they touch themselves it is not known how they go on.
  std::vector<Loop> outlineOf(const std::vector<std::uint32_t>& region) const {
    std::map<std::uint32_t, HalfEdge> from;
    for (const std::uint32_t t : region) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t edge = mesh_.edgesOfTriangle(t)[k];
        const Triangle& corner = mesh_.triangles()[t];
        if (isInside(edge)) continue;
        if (!from.try_emplace(corner[k], HalfEdge{edge, corner[k], corner[(k + 1) % 3]}).second) return {};
      }
    }
    std::vector<Loop> loops;
    while (!from.empty()) {
      Loop loop;
      for (auto at = from.begin(); at != from.end(); at = from.find(loop.back().to)) {
        loop.push_back(at->second);
        from.erase(at);
      }
      if (loop.back().to != loop.front().from) return {};
      loops.push_back(std::move(loop));
    }
    return loops;
  }

  double sixAreaOf(const Loop& loop, const glm::dvec3& normal) const {
    const glm::dvec3& origin = mesh_.vertices()[loop.front().from];
    double area = 0.0;
    for (const HalfEdge& e : loop)
      area +=
          glm::dot(normal, glm::cross(mesh_.vertices()[e.from] - origin, mesh_.vertices()[e.to] - origin));
    return area;
  }

  /// False if the region is no polygon with holes.
  bool addPolygon(const std::vector<std::uint32_t>& region) {
    if (region.size() < 2) return false;
    const FlatPlane& plane = flats_.planes[flats_.flatOf[region.front()]];
    std::vector<Loop> loops = outlineOf(region);
    // The outline comes first; holes run the other way round.
    std::ranges::sort(loops, std::greater<>(),
                      [&](const Loop& loop) { return sixAreaOf(loop, plane.normal); });
    if (loops.empty() || !(sixAreaOf(loops.front(), plane.normal) > 0.0)) return false;
    for (std::size_t i = 1; i < loops.size(); ++i)
      if (!(sixAreaOf(loops[i], plane.normal) < 0.0)) return false;
    addFace(region.front(), plane.origin, plane.normal, loops);
    return true;
  }

  void addTriangle(std::uint32_t triangle) {
    const auto [a, b, c] = corners(triangle);
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    // Its plane would be that of rounding.
    if (!(length > std::numeric_limits<double>::min())) {
      partOf(triangle).isClosed = false;
      return;
    }
    Loop loop;
    const Triangle& corner = mesh_.triangles()[triangle];
    for (std::size_t k = 0; k < 3; ++k)
      loop.push_back({mesh_.edgesOfTriangle(triangle)[k], corner[k], corner[(k + 1) % 3]});
    addFace(triangle, a, across / length, {loop});
  }

  void addFace(std::uint32_t triangle, const glm::dvec3& origin, const glm::dvec3& normal,
               const std::vector<Loop>& loops) {
    if (++facets_ > kMaxFacets) {
      throw Error("", fmt::format("triangles of its meshes would become more than {} faces", kMaxFacets),
                  "export fewer parts, parts with coarser meshes, or another format, such as glTF");
    }
    const gp_Pln plane(gp_Ax3(pointOf(origin), gp_Dir(normal.x, normal.y, normal.z)));
    TopoDS_Face face;
    builder_.MakeFace(face, new Geom_Plane(plane), Precision::Confusion());
    for (const Loop& loop : loops) {
      TopoDS_Wire wire;
      builder_.MakeWire(wire);
      for (const HalfEdge& half : loop)
        builder_.Add(wire, edgeAt(half.edge).Oriented(
                               half.from == mesh_.edges()[half.edge].v0 ? TopAbs_FORWARD : TopAbs_REVERSED));
      wire.Closed(Standard_True);
      builder_.Add(face, wire);
    }
    ShellPart& part = partOf(triangle);
    if (part.shell.IsNull()) builder_.MakeShell(part.shell);
    builder_.Add(part.shell, face);
    if (const std::optional<CadColour> colour = colourOf(triangle))
      result_.faceColours.emplace_back(face, *colour);
  }

  const TopoDS_Vertex& vertexAt(std::uint32_t vertex) {
    if (vertices_[vertex].IsNull())
      builder_.MakeVertex(vertices_[vertex], pointOf(mesh_.vertices()[vertex]), tolerance_);
    return vertices_[vertex];
  }

  const TopoDS_Edge& edgeAt(std::uint32_t edge) {
    TopoDS_Edge& made = edges_[edge];
    if (!made.IsNull()) return made;
    const MeshEdge& ends = mesh_.edges()[edge];
    const gp_Pnt a = pointOf(mesh_.vertices()[ends.v0]), b = pointOf(mesh_.vertices()[ends.v1]);
    builder_.MakeEdge(made, new Geom_Line(a, gp_Dir(gp_Vec(a, b))), tolerance_);
    builder_.Add(made, vertexAt(ends.v0).Oriented(TopAbs_FORWARD));
    builder_.Add(made, vertexAt(ends.v1).Oriented(TopAbs_REVERSED));
    builder_.Range(made, 0.0, a.Distance(b));
    return made;
  }

  TopoDS_Solid solidOf(const TopoDS_Shell& shell) const {
    TopoDS_Solid solid;
    builder_.MakeSolid(solid);
    builder_.Add(solid, shell);
    return solid;
  }

  /// Solids with their cavities, and shells that enclose nothing.
  std::vector<TopoDS_Shape> solids() {
    std::vector<std::pair<const ShellPart*, TopoDS_Solid>> outer;
    std::vector<TopoDS_Shape> pieces;
    std::vector<const ShellPart*> cavities;
    for (auto& entry : parts_) {
      ShellPart& part = entry.second;
      if (part.shell.IsNull()) continue;
      part.shell.Closed(part.isClosed);
      if (!part.isClosed) {
        pieces.push_back(part.shell);
      } else if (part.sixVolumes > 0.0) {
        outer.emplace_back(&part, solidOf(part.shell));
      } else {
        cavities.push_back(&part);
      }
    }
    std::ranges::sort(outer, {}, [](const auto& entry) { return entry.first->sixVolumes; });
    for (const ShellPart* cavity : cavities) {
      const auto around = std::ranges::find_if(
          outer, [&](const auto& entry) { return isWithin(cavity->box, entry.first->box); });
      if (around == outer.end()) {
        pieces.push_back(cavity->shell);
      } else {
        builder_.Add(around->second, cavity->shell);
      }
    }
    for (const auto& entry : outer)
      pieces.push_back(entry.second);
    return pieces;
  }

  const CadShape& shape_;
  std::size_t& facets_;
  const TriangleMesh mesh_;
  const FlatGroups flats_;
  Components components_;
  std::map<std::uint32_t, ShellPart> parts_;  ///< By the first triangle of a component.
  std::vector<std::size_t> regionOf_;         ///< By triangle.
  std::vector<TopoDS_Vertex> vertices_;
  std::vector<TopoDS_Edge> edges_;
  BRep_Builder builder_;
  double tolerance_ = 0.0;  ///< [mm]
  ProductShape result_;
};

}  // namespace

ProductShape copyOf(const ProductShape& original) {
  BRepBuilderAPI_Copy copy(original.shape);
  ProductShape result{copy.Shape(), {}};
  for (const auto& [face, colour] : original.faceColours)
    result.faceColours.emplace_back(copy.ModifiedShape(face), colour);
  return result;
}

ProductShape facetedShape(const CadShape& shape, std::size_t& facets) {
  return FacetBuilder(shape, facets).build();
}

}  // namespace nearfit::exporter
