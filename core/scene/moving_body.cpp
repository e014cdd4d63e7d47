#include "core/scene/moving_body.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/mesh/flat_mesh.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/proximity/query/broad_phase.h"

namespace nearfit {
namespace {

using Piece = GroupBodies::Piece;

/// Steps that places within a group are rounded to [m], [1]: parts that were moved together are off their arrangement
/// by less, and must not make another body each time.
constexpr double kPlaceStep = 1e-12, kTurnStep = 1e-13;
/// Progress when the flats of all parts are merged; as for a hierarchy of one part.
constexpr double kFlatsMerged = 0.15;

double rounded(double value, double step) noexcept {
  return step * std::round(value / step);
}

RigidTransform roundedPlace(const RigidTransform& place) noexcept {
  const glm::dvec3& t = place.translation;
  // Two quaternions stand for one rotation: take one sense.
  const glm::dquat q = place.rotation.w < 0.0 ? -place.rotation : place.rotation;
  RigidTransform result;
  result.translation = {rounded(t.x, kPlaceStep), rounded(t.y, kPlaceStep), rounded(t.z, kPlaceStep)};
  result.rotation = glm::normalize(glm::dquat(rounded(q.w, kTurnStep), rounded(q.x, kTurnStep),
                                              rounded(q.y, kTurnStep), rounded(q.z, kTurnStep)));
  return result;
}

/// Meshes one after the other; their vertices stay apart.
class JoinedMesh {
 public:
  void add(const TriangleMesh& mesh, const RigidTransform& bodyFromPart) {
    if (vertices_.size() + mesh.vertices().size() > TriangleMesh::kMaxTriangles ||
        triangles_.size() + mesh.triangles().size() > TriangleMesh::kMaxTriangles) {
      throw Error("moving group", "its meshes are too large together", "take fewer parts in hand");
    }
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (const glm::dvec3& vertex : mesh.vertices())
      vertices_.push_back(bodyFromPart.applyToPoint(vertex));
    for (const Triangle& t : mesh.triangles())
      triangles_.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  std::uint32_t vertexCount() const noexcept { return static_cast<std::uint32_t>(vertices_.size()); }
  std::uint32_t triangleCount() const noexcept { return static_cast<std::uint32_t>(triangles_.size()); }
  TriangleMesh take() { return {std::move(vertices_), std::move(triangles_)}; }

 private:
  std::vector<glm::dvec3> vertices_;
  std::vector<Triangle> triangles_;
};

void appendEnd(GroupBody::Ends& ends, std::uint32_t vertices, std::uint32_t triangles) {
  ends.vertices.push_back(vertices);
  ends.triangles.push_back(triangles);
}

/// Merges the flats of each part by itself, as for the part alone, and joins the results.
FlatMesh joinedFlats(const std::vector<Piece>& pieces, GroupBody::Ends& ends,
                     const ProgressCallback& progress) {
  JoinedMesh joined;
  FlatMesh result;
  std::uint32_t flats = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PartGeometry& geometry = *pieces[i].geometry;
    const auto share = [&](std::size_t done) {
      return static_cast<double>(done) / static_cast<double>(pieces.size());
    };
    const FlatMesh flat = mergeFlats(geometry.mesh, geometry.report.coordinateRounding,
                                     stageOf(progress, share(i), share(i + 1)));
    joined.add(flat.mesh, pieces[i].bodyFromPart);
    appendEnd(ends, joined.vertexCount(), joined.triangleCount());
    result.deviation = std::max(result.deviation, flat.deviation);
    std::uint32_t own = 0;
    for (std::size_t t = 0; t < flat.mesh.triangles().size(); ++t) {
      const std::uint32_t of = flat.flatOf.empty() ? kNoFlat : flat.flatOf[t];
      result.flatOf.push_back(of == kNoFlat ? kNoFlat : of + flats);
      if (of != kNoFlat) own = std::max(own, of + 1);
    }
    flats += own;
  }
  result.mesh = joined.take();
  return result;
}

/// Key of a joined mesh in the cache, by its numbers: the same parts in another arrangement are another body.
TreeCacheKey keyOf(const TriangleMesh& mesh, const std::vector<Piece>& pieces) {
  const auto bytesOf = [](const auto& values) {
    const auto bytes = std::as_bytes(values);
    return sha256OfBytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  // The flats depend on the rounding of coordinates too. Change the first word when bodies are joined in another way.
  std::string text = "group 1 " + bytesOf(mesh.vertices()) + bytesOf(mesh.triangles());
  for (const Piece& piece : pieces) {
    text += fmt::format(" {} {}", piece.geometry->mesh.triangles().size(),
                        piece.geometry->report.coordinateRounding);
  }
  return {sha256OfBytes(text), 1.0};
}

/// Ends of the parts by their own searched meshes, if these make up the joined one.
bool findEnds(const std::vector<Piece>& pieces, const TriangleMesh& searched, GroupBody::Ends& ends) {
  GroupBody::Ends found;
  std::size_t vertices = 0, triangles = 0;
  for (const Piece& piece : pieces) {
    const TriangleMesh& mesh = piece.geometry->tree().mesh();
    vertices += mesh.vertices().size();
    triangles += mesh.triangles().size();
    appendEnd(found, static_cast<std::uint32_t>(vertices), static_cast<std::uint32_t>(triangles));
  }
  if (vertices != searched.vertices().size() || triangles != searched.triangles().size()) return false;
  ends = std::move(found);
  return true;
}

GroupBody makeBody(const std::vector<Piece>& pieces) {
  JoinedMesh joined;
  double rounding = 0.0;
  for (const Piece& piece : pieces) {
    joined.add(piece.geometry->mesh, piece.bodyFromPart);
    rounding = std::max(rounding, piece.geometry->report.coordinateRounding);
  }
  PartGeometry geometry;
  geometry.mesh = joined.take();
  geometry.report.coordinateRounding = rounding;
  const auto ends = std::make_shared<GroupBody::Ends>();
  const auto surface = geometry.surfaceOnDemand;
  const TreeCacheKey key = keyOf(geometry.mesh, pieces);
  const auto find = [key, pieces, ends, surface, mesh = geometry.mesh]() -> std::optional<NormalConeTree> {
    const std::optional<TreeCacheFile> file = TreeCache().find(key);
    std::optional<CachedTree> kept = file ? file->tree(mesh) : std::nullopt;
    if (!kept || !findEnds(pieces, kept->tree.mesh(), *ends)) return std::nullopt;
    surface->setSolid(kept->isSolid);
    return std::move(kept->tree);
  };
  const CachedMesh cached{geometry.mesh, geometry.report, massProperties(geometry.mesh)};
  const auto keep = [key, cached, surface](const NormalConeTree& tree) {
    const CachedTree kept{tree, surface->isSolid(tree)};
    TreeCache().store(key, cached, &kept);
  };
  const auto build = [pieces, ends](const ProgressCallback& progress) {
    *ends = {};
    const FlatMesh flats = joinedFlats(pieces, *ends, stageCallback(progress, 0.0, kFlatsMerged));
    return NormalConeTree(flats, stageCallback(progress, kFlatsMerged, 1.0));
  };
  geometry.hierarchy = std::make_shared<HierarchyOnDemand>(find, keep, HierarchyOnDemand::Build(build));
  return {std::make_shared<const PartGeometry>(std::move(geometry)), ends};
}

/// The parts of the body in hand that can be felt; the moving part if there are none.
std::vector<const Part*> feltParts(const Scene& scene) {
  std::vector<const Part*> felt;
  if (!scene.movingPart()) return felt;
  for (const PartId id : scene.movingParts()) {
    const Part& part = scene.get(id);
    if (part.isVisible && part.geometry != nullptr) felt.push_back(&part);
  }
  const Part& lead = scene.get(*scene.movingPart());
  if (felt.empty() && lead.geometry != nullptr) felt.push_back(&lead);
  return felt;
}

RigidTransform bodyFromPart(const Scene& scene, const Part& part) {
  if (part.id == *scene.movingPart()) return {};
  return roundedPlace(scene.get(*scene.movingPart()).worldFromPart.inverse() * part.worldFromPart);
}

std::vector<Piece> piecesInHand(const Scene& scene) {
  std::vector<Piece> pieces;
  for (const Part* part : feltParts(scene))
    pieces.push_back({part->geometry, bodyFromPart(scene, *part)});
  return pieces;
}

/// True if what is felt is the moving part itself, in its own frame.
bool isOnePart(const Scene& scene) {
  const std::vector<const Part*> felt = feltParts(scene);
  return felt.empty() || (felt.size() == 1 && felt.front()->id == *scene.movingPart());
}

/// Inertia of a unit of mass at a point, about the origin.
glm::dmat3 pointInertia(const glm::dvec3& at) {
  return glm::dmat3(glm::dot(at, at)) - glm::outerProduct(at, at);
}

}  // namespace

GroupBody GroupBodies::get(const std::vector<Piece>& pieces) {
  if (std::optional<GroupBody> known = find(pieces)) return *std::move(known);
  // Made without the lock: find() must not wait for it.
  GroupBody made = makeBody(pieces);
  if (std::optional<GroupBody> known = find(pieces)) return *std::move(known);
  const std::lock_guard lock(mutex_);
  kept_.push_front({pieces, made});
  if (kept_.size() > kMaxKept) kept_.pop_back();
  return made;
}

std::optional<GroupBody> GroupBodies::find(const std::vector<Piece>& pieces) {
  const std::lock_guard lock(mutex_);
  const auto known = std::ranges::find(kept_, pieces, &Kept::pieces);
  if (known == kept_.end()) return std::nullopt;
  std::rotate(kept_.begin(), known, std::next(known));
  return kept_.front().body;
}

MovingBody movingBody(const Scene& scene) {
  const Part* lead = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  if (lead == nullptr || lead->geometry == nullptr)
    throw UsageError("scene", "no part is in hand", "choose the moving part first");
  MovingBody body;
  body.id = lead->id;
  body.worldFromBody = lead->worldFromPart;
  if (!scene.movingGroup()) {
    body.geometry = lead->geometry;
    body.mass = massOf(*lead);
    body.isVisible = lead->isVisible;
    return body;
  }
  const std::vector<const Part*> felt = feltParts(scene);
  body.isVisible = felt.front()->isVisible;
  const MovingMass mass = massOfMoving(scene);
  body.mass = mass.mass;
  if (isOnePart(scene)) {
    body.geometry = felt.front()->geometry;
    return body;
  }
  const std::vector<Piece> pieces = piecesInHand(scene);
  const GroupBody joined = scene.groupBodies()->get(pieces);
  std::vector<PartGeometryPtr> needed{joined.geometry};
  for (const Piece& piece : pieces)
    needed.push_back(piece.geometry);
  prepareHierarchies(needed);
  // All that was made on demand is shared with the one that is kept.
  PartGeometry geometry = *joined.geometry;
  geometry.mass = mass.properties;
  body.geometry = std::make_shared<const PartGeometry>(std::move(geometry));
  for (std::size_t i = 0; i < felt.size(); ++i)
    body.members.push_back({felt[i]->id, joined.ends->vertices[i], joined.ends->triangles[i],
                            boundsOf(pieces[i].geometry->mesh.bounds(), pieces[i].bodyFromPart)});
  return body;
}

void prepareToFeel(const Scene& scene, const ProgressCallback& progress) {
  std::vector<PartGeometryPtr> geometries = scene.geometries();
  if (scene.movingGroup() && !isOnePart(scene))
    geometries.push_back(scene.groupBodies()->get(piecesInHand(scene)).geometry);
  prepareHierarchies(geometries, progress);
}

bool isReadyToFeel(const Scene& scene) {
  if (!areHierarchiesReady(scene.geometries())) return false;
  if (!scene.movingGroup() || isOnePart(scene)) return true;
  const std::optional<GroupBody> known = scene.groupBodies()->find(piecesInHand(scene));
  return known && known->geometry->hierarchy->isReady();
}

MovingMass massOfMoving(const Scene& scene) {
  const std::vector<const Part*> felt = feltParts(scene);
  MovingMass sum;
  if (felt.empty()) return sum;
  sum.mass = massOf(*felt.front());
  sum.properties = felt.front()->geometry->mass;
  if (isOnePart(scene)) return sum;
  sum = {};
  sum.properties.basis = MassBasis::VolumeIntegrals;
  for (const Part* part : felt) {
    const MassProperties& own = part->geometry->mass;
    sum.mass += massOf(*part);
    sum.properties.volume += own.volume;
    sum.properties.centre += massOf(*part) * bodyFromPart(scene, *part).applyToPoint(own.centre);
    if (own.basis == MassBasis::OrientedBox) sum.properties.basis = MassBasis::OrientedBox;
  }
  if (!(sum.mass > 0.0)) return sum;
  sum.properties.centre /= sum.mass;
  for (const Part* part : felt) {
    const MassProperties& own = part->geometry->mass;
    const RigidTransform place = bodyFromPart(scene, *part);
    const glm::dmat3 turn = glm::mat3_cast(place.rotation);
    sum.properties.inertia +=
        part->density * (turn * own.inertia * glm::transpose(turn)) +
        massOf(*part) * pointInertia(place.applyToPoint(own.centre) - sum.properties.centre);
  }
  sum.properties.inertia *= sum.properties.volume / sum.mass;
  return sum;
}

double sizeOfMoving(const Scene& scene) {
  Aabb box;
  for (const Part* part : feltParts(scene)) {
    const Aabb& own = part->geometry->mesh.bounds();
    const RigidTransform place = bodyFromPart(scene, *part);
    for (int corner = 0; corner < 8; ++corner) {
      box.add(place.applyToPoint({(corner & 1) != 0 ? own.upper.x : own.lower.x,
                                  (corner & 2) != 0 ? own.upper.y : own.lower.y,
                                  (corner & 4) != 0 ? own.upper.z : own.lower.z}));
    }
  }
  return box.diagonal();
}

MovingPoses movedPoses(const Scene& scene, const RigidTransform& worldFromMoving) {
  MovingPoses poses;
  if (!scene.movingPart()) return poses;
  const RigidTransform& was = scene.get(*scene.movingPart()).worldFromPart;
  const bool isThere = was == worldFromMoving;
  const RigidTransform motion = worldFromMoving * was.inverse();
  for (const PartId id : scene.movingParts()) {
    const RigidTransform& own = scene.get(id).worldFromPart;
    poses[id] = id == *scene.movingPart() ? worldFromMoving : isThere ? own : (motion * own).normalized();
  }
  return poses;
}

JointSet jointsOfMoving(const Scene& scene) {
  if (!scene.movingPart()) return {};
  if (!scene.movingGroup()) return jointsOf(scene, *scene.movingPart());
  std::vector<JointSet::Placed> placed;
  for (const Joint& joint : scene.joints()) {
    const bool isWithin = joint.base && scene.isMoving(*joint.base);
    if (!joint.isOn || isWithin || !scene.isMoving(joint.part)) continue;
    placed.push_back(placedInWorld(scene, joint));
    const RigidTransform place = bodyFromPart(scene, scene.get(joint.part));
    placed.back().onPart.point = place.applyToPoint(joint.onPart.point);
    placed.back().onPart.direction = place.applyToVector(joint.onPart.direction);
  }
  if (placed.size() > kMaxJointsPerPart) {
    throw UsageError(
        fmt::format("group \"{}\"", scene.findGroup(*scene.movingGroup())->name),
        fmt::format("{} joints keep its parts on others, and at most {} can hold what is in hand",
                    placed.size(), kMaxJointsPerPart),
        "turn some of them off");
  }
  return {placed, scene.get(*scene.movingPart()).worldFromPart};
}

}  // namespace nearfit
