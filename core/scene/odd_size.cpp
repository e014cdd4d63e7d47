#include "core/scene/odd_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace nearfit {
namespace {

/// By far the most common units of mesh files [m]: micrometre, millimetre, centimetre, inch, metre. Adding
/// rarer ones would cause wrong guesses.
constexpr std::array<double, 5> kCadUnits{1e-6, 1e-3, 1e-2, 0.0254, 1.0};

/// Range of bounding box diagonals [m].
struct Sizes {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  void add(double size) {
    least = std::min(least, size);
    most = std::max(most, size);
  }
  bool isEmpty() const { return most <= 0.0; }
};

/// Factor to a common unit that comes nearest to `wanted`.
double nearestFactor(double metresPerUnit, double wanted) {
  double best = 1.0;
  for (const double unit : kCadUnits) {
    const double factor = unit / metresPerUnit;
    if (std::abs(std::log(factor / wanted)) < std::abs(std::log(best / wanted))) best = factor;
  }
  return best;
}

/// Diagonal of the bounding box [m]; 0 without geometry.
double sizeOf(const Part& part) {
  return part.geometry != nullptr ? part.geometry->mesh.bounds().diagonal() : 0.0;
}

std::optional<OddSize> judged(const Sizes& own, const Sizes& others, double metresPerUnit) {
  if (own.isEmpty() || others.isEmpty()) return std::nullopt;
  const bool isLarge = own.least >= kOddSizeRatio * others.most;
  const bool isSmall = own.most * kOddSizeRatio <= others.least;
  if (!isLarge && !isSmall) return std::nullopt;
  const double ratio = isLarge ? own.least / others.most : own.most / others.least;
  const double factor = nearestFactor(metresPerUnit, 1.0 / ratio);
  if (std::abs(std::log(factor * ratio)) >= std::abs(std::log(ratio))) return std::nullopt;
  return OddSize{ratio, factor};
}

}  // namespace

std::optional<OddSize> oddSizeOf(const Scene& scene, std::span<const PartId> parts) {
  const std::set<PartId> chosen(parts.begin(), parts.end());
  Sizes own, others;
  double metresPerUnit = 1.0;
  for (const Scene::PartPtr& part : scene.parts()) {
    const double size = sizeOf(*part);
    if (size <= 0.0) continue;
    const bool isOwn = chosen.contains(part->id);
    (isOwn ? own : others).add(size);
    if (isOwn) metresPerUnit = part->geometry->unitOfNumbers();
  }
  return judged(own, others, metresPerUnit);
}

std::optional<OddPart> firstOddPart(const Scene& scene, std::span<const PartId> parts) {
  std::vector<double> sizes;
  for (const Scene::PartPtr& part : scene.parts()) {
    const double size = sizeOf(*part);
    if (size > 0.0) sizes.push_back(size);
  }
  if (sizes.size() < 2) return std::nullopt;
  std::ranges::sort(sizes);
  const double least = sizes.front(), most = sizes.back();
  for (const PartId id : parts) {
    const Part* part = scene.find(id);
    const double size = part != nullptr ? sizeOf(*part) : 0.0;
    if (size <= 0.0) continue;
    Sizes own, others;
    own.add(size);
    others.add(size == least ? sizes[1] : least);
    others.add(size == most ? sizes[sizes.size() - 2] : most);
    if (const auto odd = judged(own, others, part->geometry->unitOfNumbers())) return OddPart{id, *odd};
  }
  return std::nullopt;
}

}  // namespace nearfit
