#include "app/import/meshing_plan.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <TopAbs_ShapeEnum.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Shape.hxx>

namespace nearfit::importer {
namespace {

/// Joins bodies that share a face or an edge.
class BodyJoiner {
 public:
  explicit BodyJoiner(std::span<const Body* const> bodies) : parents_(bodies.size()), faces_(bodies.size()) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
    for (std::size_t i = 0; i < bodies.size(); ++i)
      for (const TopoDS_Shape& shell : bodies[i]->shells)
        add(i, shell);
  }

  struct Group {
    BodyGroup bodies;
    std::size_t faces = 0;
  };

  /// In the order of their first bodies.
  std::vector<Group> groups() {
    std::vector<Group> groups;
    std::unordered_map<std::size_t, std::size_t> groupOf;
    for (std::size_t i = 0; i < parents_.size(); ++i) {
      const auto [at, isNew] = groupOf.try_emplace(find(i), groups.size());
      if (isNew) groups.emplace_back();
      groups[at->second].bodies.push_back(i);
      groups[at->second].faces += faces_[i];
    }
    return groups;
  }

 private:
  void add(std::size_t body, const TopoDS_Shape& shell) {
    for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
      for (TopExp_Explorer each(shell, kind); each.More(); each.Next()) {
        const auto [at, isNew] = ownerOf_.try_emplace(each.Current().TShape().get(), body);
        if (!isNew) parents_[find(body)] = find(at->second);
        if (kind == TopAbs_FACE) ++faces_[body];
      }
    }
  }

  std::size_t find(std::size_t body) {
    while (parents_[body] != body)
      body = parents_[body] = parents_[parents_[body]];
    return body;
  }

  std::vector<std::size_t> parents_, faces_;
  std::unordered_map<const void*, std::size_t> ownerOf_;
};

}  // namespace

MeshingPlan planMeshing(std::span<const Body* const> bodies, std::size_t threads) {
  std::vector<BodyJoiner::Group> groups = BodyJoiner(bodies).groups();
  std::ranges::stable_sort(groups, std::ranges::greater{}, &BodyJoiner::Group::faces);
  std::size_t left = 0;
  for (const BodyJoiner::Group& group : groups)
    left += group.faces;
  MeshingPlan plan;
  for (BodyJoiner::Group& group : groups) {
    // The others would be done long before it.
    const bool isLarge = plan.small.empty() && group.faces * threads > left;
    (isLarge ? plan.large : plan.small).push_back(std::move(group.bodies));
    left -= group.faces;
  }
  return plan;
}

}  // namespace nearfit::importer
