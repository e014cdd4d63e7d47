#include "core/mesh/check/face_faults.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/mesh/flat_triangles.h"

namespace nearfit {
namespace {

/// A fan of more faces at an edge says nothing about one of them.
constexpr std::size_t kMaxFacesAtEdge = 16;

Triangle sortedCorners(Triangle t) {
  std::ranges::sort(t);
  return t;
}

/// True if the corners in ascending order run as the triangle does.
bool runsUpward(const Triangle& t) {
  const auto k = static_cast<std::size_t>(std::ranges::min_element(t) - t.begin());
  return t[(k + 1) % 3] < t[(k + 2) % 3];
}

/// Number of neighbours, other than copies, that run along its edges the other way.
int agreementOf(const TriangleMesh& mesh, std::uint32_t face,
                const std::unordered_set<std::uint32_t>& copies) {
  int agreeing = 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t edge = mesh.edgesOfTriangle(face)[k];
    const std::uint32_t from = mesh.triangles()[face][k];
    const auto faces = mesh.facesOfEdge(edge);
    if (faces.size() > kMaxFacesAtEdge) continue;
    agreeing += std::ranges::any_of(faces, [&](std::uint32_t other) {
      if (copies.contains(other)) return false;
      const Triangle& t = mesh.triangles()[other];
      const auto j = static_cast<std::size_t>(std::ranges::find(mesh.edgesOfTriangle(other), edge) -
                                              mesh.edgesOfTriangle(other).begin());
      return t[j] != from;
    });
  }
  return agreeing;
}

bool areOpposite(const TriangleMesh& mesh, const std::vector<std::uint32_t>& copies) {
  return std::ranges::any_of(copies, [&](std::uint32_t face) {
    return runsUpward(mesh.triangles()[face]) != runsUpward(mesh.triangles()[copies.front()]);
  });
}

/// Tells walls between two solids from sheets of two sides: which of the sets of connected opposite copies are
/// joined to faces that have no copy.
class OppositeSheets {
 public:
  OppositeSheets(const TriangleMesh& mesh, const std::vector<FaceCopies>& groups)
      : parent_(groups.size()), isJoined_(groups.size(), false) {
    std::unordered_map<std::uint32_t, std::uint32_t> groupOf;
    for (std::uint32_t i = 0; i < groups.size(); ++i) {
      parent_[i] = i;
      if (!groups[i].areOpposite) continue;
      for (const std::uint32_t face : groups[i].faces)
        groupOf.emplace(face, i);
    }
    for (std::uint32_t i = 0; i < groups.size(); ++i) {
      if (groups[i].areOpposite) join(mesh, groups[i].faces.front(), i, groupOf);
    }
    for (std::uint32_t i = 0; i < groups.size(); ++i)
      isJoined_[rootOf(i)] = isJoined_[rootOf(i)] || isJoined_[i];
  }

  bool isWall(std::uint32_t group) { return isJoined_[rootOf(group)]; }

 private:
  void join(const TriangleMesh& mesh, std::uint32_t face, std::uint32_t group,
            const std::unordered_map<std::uint32_t, std::uint32_t>& groupOf) {
    for (const std::uint32_t edge : mesh.edgesOfTriangle(face)) {
      const auto faces = mesh.facesOfEdge(edge);
      for (const std::uint32_t other : faces.first(std::min(faces.size(), kMaxFacesAtEdge))) {
        const auto found = groupOf.find(other);
        if (found == groupOf.end())
          isJoined_[group] = true;
        else
          parent_[rootOf(found->second)] = rootOf(group);
      }
    }
  }
  std::uint32_t rootOf(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  std::vector<std::uint32_t> parent_;
  std::vector<bool> isJoined_;
};

void chooseSurplus(const TriangleMesh& mesh, FaceCopies& group, bool isWall) {
  std::vector<std::uint32_t> up, down;
  for (const std::uint32_t face : group.faces)
    (runsUpward(mesh.triangles()[face]) ? up : down).push_back(face);
  const auto drop = [&group](const std::vector<std::uint32_t>& faces, std::size_t keep) {
    const auto first = faces.begin() + static_cast<std::ptrdiff_t>(std::min(keep, faces.size()));
    group.surplus.insert(group.surplus.end(), first, faces.end());
  };
  if (!group.areOpposite) {
    drop(group.faces, 1);
  } else {
    const std::unordered_set<std::uint32_t> copies(group.faces.begin(), group.faces.end());
    const int upward = agreementOf(mesh, up.front(), copies),
              downward = agreementOf(mesh, down.front(), copies);
    const bool isUpKept = upward != downward ? upward > downward : !isWall;
    const bool isDownKept = upward < downward;
    drop(up, isUpKept ? 1 : 0);
    drop(down, isDownKept ? 1 : 0);
  }
  std::ranges::sort(group.surplus);
}

}  // namespace

std::vector<std::uint32_t> facesWithoutArea(const TriangleMesh& mesh) {
  const double height = kNoHeight * mesh.bounds().diagonal();
  std::vector<std::uint32_t> faces;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    if (leastHeight(mesh.vertices(), mesh.triangles()[i]) <= height) faces.push_back(i);
  }
  return faces;
}

std::vector<FaceCopies> copiesOfFaces(const TriangleMesh& mesh) {
  // Sorted rather than hashed: no mesh makes that slow.
  std::vector<std::uint32_t> suspects;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    // A copy has each edge in common with the other.
    const bool isAlone = std::ranges::any_of(
        mesh.edgesOfTriangle(i), [&](std::uint32_t edge) { return mesh.facesOfEdge(edge).size() < 2; });
    if (!isAlone) suspects.push_back(i);
  }
  std::vector<std::pair<Triangle, std::uint32_t>> keyed;
  keyed.reserve(suspects.size());
  for (const std::uint32_t i : suspects)
    keyed.emplace_back(sortedCorners(mesh.triangles()[i]), i);
  std::ranges::sort(keyed);
  std::vector<FaceCopies> groups;
  for (std::size_t begin = 0; begin < keyed.size();) {
    std::size_t end = begin + 1;
    while (end < keyed.size() && keyed[end].first == keyed[begin].first)
      ++end;
    if (end - begin > 1) {
      FaceCopies& group = groups.emplace_back();
      for (std::size_t i = begin; i < end; ++i)
        group.faces.push_back(keyed[i].second);
      group.areOpposite = areOpposite(mesh, group.faces);
    }
    begin = end;
  }
  std::ranges::sort(groups, {}, [](const FaceCopies& group) { return group.faces.front(); });
  OppositeSheets sheets(mesh, groups);
  for (std::uint32_t i = 0; i < groups.size(); ++i)
    chooseSurplus(mesh, groups[i], sheets.isWall(i));
  return groups;
}

}  // namespace nearfit
