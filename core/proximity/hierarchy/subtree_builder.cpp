#include "core/proximity/hierarchy/subtree_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nearfit {
namespace {

float sizeOf(const NormalConeTree::Bound& b) {
  return std::sqrt(b.half[0] * b.half[0] + b.half[1] * b.half[1] + b.half[2] * b.half[2]);
}

}  // namespace

NormalConeTree::Node emptyNode() noexcept {
  NormalConeTree::Node node{};
  for (auto& coordinate : node.centre)
    coordinate.fill(NormalConeTree::kOutOfReach);
  node.n[0].fill(1.0F);
  node.u[1].fill(1.0F);
  node.child.fill(NormalConeTree::kNoChild);
  return node;
}

void setLane(NormalConeTree::Node& node, std::size_t lane, const NormalConeTree::Bound& b) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    node.centre[k][lane] = b.centre[k];
    node.n[k][lane] = b.n[k];
    node.u[k][lane] = b.u[k];
    node.half[k][lane] = b.half[k];
  }
  node.leastN[lane] = b.leastN;
  node.mostU[lane] = b.mostU;
  node.mostV[lane] = b.mostV;
}

void SubtreeBuilder::add(std::uint32_t feature, const std::array<float, 3>& centre, std::uint32_t leaf) {
  features_.push_back(feature);
  centres_.push_back(centre);
  leaves_.push_back(leaf);
}

void SubtreeBuilder::build(NormalConeTree::Bound& bound, std::vector<NormalConeTree::Node>& nodes) {
  bounds_.load(features_);
  splitter_.load(centres_, bounds_.extents());
  std::vector<std::uint32_t> all(features_.size());
  std::iota(all.begin(), all.end(), 0U);
  bound = bounds_.bound(all);
  if (all.size() > 1) buildNode(all, bound, nodes);
}

/// Adds a node over a set that has just been bounded, and returns its index.
std::uint32_t SubtreeBuilder::buildNode(std::span<std::uint32_t> part, const NormalConeTree::Bound& bound,
                                        std::vector<NormalConeTree::Node>& nodes) {
  splitter_.begin(sizeOf(bound), std::max(bound.mostU, bound.mostV));
  const auto parts =
      pieces(part, [this](std::span<std::uint32_t> whole, std::size_t cut) { splitter_.split(whole, cut); });
  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.push_back(emptyNode());
  for (std::size_t lane = 0; lane < parts.size(); ++lane) {
    const NormalConeTree::Bound b = bounds_.bound(parts[lane]);
    setLane(nodes[index], lane, b);
    const std::uint32_t child =
        parts[lane].size() == 1 ? leaves_[parts[lane][0]] : buildNode(parts[lane], b, nodes);
    nodes[index].child[lane] = child;
  }
  return index;
}

}  // namespace nearfit
