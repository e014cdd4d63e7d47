#include "ui/view3d/parts/detail_choice.h"

#include <queue>
#include <utility>

namespace nearfit::ui {
namespace {

std::uint8_t coarsestThatLooksTheSame(const DetailCandidate& part, double cellPixels) {
  std::size_t level = part.levels.size() - 1;
  while (level > 0 && part.levels[level].cell * part.pixelsPerMetre > cellPixels)
    --level;
  return static_cast<std::uint8_t>(level);
}

std::size_t trianglesOf(std::span<const DetailCandidate> parts, const DetailChoice& choice) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].isSeen) sum += parts[i].levels[choice.levels[i]].triangles;
  }
  return sum;
}

void coarsen(std::span<const DetailCandidate> parts, std::size_t limit, DetailChoice& choice) {
  std::priority_queue<std::pair<std::size_t, std::size_t>> largest;  // Triangles, part.
  const auto add = [&](std::size_t i) {
    const DetailCandidate& part = parts[i];
    if (part.isSeen && choice.levels[i] + 1U < part.levels.size())
      largest.emplace(part.levels[choice.levels[i]].triangles, i);
  };
  for (std::size_t i = 0; i < parts.size(); ++i)
    add(i);
  while (choice.triangles > limit && !largest.empty()) {
    const auto [triangles, i] = largest.top();
    largest.pop();
    choice.triangles -= triangles - parts[i].levels[++choice.levels[i]].triangles;
    add(i);
  }
}

}  // namespace

DetailChoice chooseDetail(std::span<const DetailCandidate> candidates, const DetailLimits& limits) {
  DetailChoice choice;
  choice.levels.assign(candidates.size(), 0);
  choice.triangles = trianglesOf(candidates, choice);
  if (choice.triangles <= limits.triangles) return choice;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    choice.levels[i] = coarsestThatLooksTheSame(candidates[i], limits.cellPixels);
  choice.triangles = trianglesOf(candidates, choice);
  coarsen(candidates, limits.triangles, choice);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    choice.isExact = choice.isExact && (!candidates[i].isSeen || choice.levels[i] == 0);
  return choice;
}

}  // namespace nearfit::ui
