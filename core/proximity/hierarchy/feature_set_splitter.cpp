#include "core/proximity/hierarchy/feature_set_splitter.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace nearfit {
namespace {

/// Typical subset of the other body: its half extent as a fraction of the size of the set that is split, and
/// the spread of its directions. Measured best on the bodies of the benchmark; not a sharp optimum.
constexpr float kOtherSize = 0.25F, kOtherSpread = 0.6F;

/// A spread of directions below this is small beside kOtherSpread and no reason to split by direction.
constexpr float kLittleSpread = 0.25F;

/// Number of features sampled to choose the key in a larger set.
constexpr std::size_t kSample = 256;

constexpr std::uint32_t kSign = 0x80000000U;

}  // namespace

void FeatureSetSplitter::load(std::span<const std::array<float, 3>> centres,
                              std::span<const Extents> extents) {
  centres_ = centres;
  extents_ = extents;
}

void FeatureSetSplitter::begin(float size, float spread) noexcept {
  reach_ = kOtherSize * size;
  keysTried_ = spread < kLittleSpread ? kPositionKeys : kKeys;
}

/// Orders by value, then by feature, in one integer comparison.
FeatureSetSplitter::Key FeatureSetSplitter::key(std::size_t kind, std::uint32_t feature) const noexcept {
  const float value = kind < 3 ? centres_[feature][kind] : extents_[feature].middle(kind - 3);
  const auto bits = std::bit_cast<std::uint32_t>(value);
  // Negative floats order in reverse, below the others.
  const std::uint32_t ordered = (bits & kSign) != 0 ? ~bits : bits | kSign;
  return Key{ordered} << 32 | feature;
}

/// Number of features, times a measure of the poses at which subsets of the other body are near and facing.
float FeatureSetSplitter::cost(std::span<const Key> features) const noexcept {
  Extents all = Extents::none();
  for (const Key k : features)
    all.add(extents_[featureOf(k)]);
  auto product = static_cast<float>(features.size());
  for (std::size_t axis = 0; axis < 3; ++axis)
    product *= (all.half(axis) + reach_) * (all.half(3 + axis) + kOtherSpread);
  return product;
}

/// Puts the `cut` lowest keys first.
void FeatureSetSplitter::sort(std::size_t kind, std::span<const std::uint32_t> features, std::size_t stride,
                              std::size_t cut) {
  keys_.clear();
  for (std::size_t i = 0; i < features.size(); i += stride)
    keys_.push_back(key(kind, features[i]));
  std::nth_element(keys_.begin(), keys_.begin() + static_cast<std::ptrdiff_t>(cut), keys_.end());
}

void FeatureSetSplitter::split(std::span<std::uint32_t> features, std::size_t cut) {
  if (features.size() <= 2) return;
  const std::size_t stride = 1 + (features.size() - 1) / kSample;
  const std::size_t sampled = (features.size() + stride - 1) / stride;
  const std::size_t sampledCut = std::clamp<std::size_t>(cut / stride, 1, sampled - 1);
  float least = 0.0F;
  std::size_t best = 0;
  for (std::size_t kind = 0; kind < keysTried_; ++kind) {
    sort(kind, features, stride, sampledCut);
    const float pieces =
        cost(std::span(keys_).first(sampledCut)) + cost(std::span(keys_).subspan(sampledCut));
    if (kind == 0 || pieces < least) {
      least = pieces;
      best = kind;
      if (stride == 1) std::swap(best_, keys_);
    }
  }
  if (stride > 1) {
    sort(best, features, 1, cut);
    std::swap(best_, keys_);
  }
  for (std::size_t i = 0; i < features.size(); ++i)
    features[i] = featureOf(best_[i]);
}

}  // namespace nearfit
