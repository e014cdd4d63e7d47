#include "core/proximity/hierarchy/feature_set_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/math/symmetric_eigen.h"

namespace nearfit {
namespace {

/// Padding of each half extent over the mesh's size: twenty single-precision roundings of a coordinate.
constexpr double kExtentPadding = 1.2e-6;

/// Padding of each limit of direction: some roundings of single-precision axes and rays.
constexpr double kDirectionPadding = 3e-6;

/// Max stretch at which rays suffice to bound a feature's directions; above it, the exact support is used.
constexpr double kLittleStretch = 1.01;

/// Turns about n, tried on the axes of a set's moments: cosine and sine of quarters of a right angle.
constexpr std::array<std::array<double, 2>, 4> kTurnsTried{{{1.0, 0.0},
                                                            {0.92387953251128674, 0.38268343236508978},
                                                            {0.70710678118654752, 0.70710678118654752},
                                                            {0.38268343236508978, 0.92387953251128674}}};

/// Number of features sampled to choose the axes of a large set.
constexpr std::size_t kSample = 1024;

/// Beyond any coordinate of a mesh in single precision.
constexpr float kFar = std::numeric_limits<float>::max();

constexpr std::size_t kLanes = 8;

std::array<float, 3> toSingle(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

Extents Extents::none() noexcept {
  Extents out;
  out.most.fill(-kFar);
  return out;
}

void FeatureSetBounds::Vectors::clear() noexcept {
  for (std::vector<float>& coordinate : c)
    coordinate.clear();
  count = 0;
}

void FeatureSetBounds::Vectors::add(const glm::dvec3& v) {
  for (std::size_t k = 0; k < 3; ++k)
    c[k].push_back(static_cast<float>(v[static_cast<int>(k)]));
  ++count;
}

void FeatureSetBounds::Vectors::close() {
  for (std::vector<float>& coordinate : c)
    coordinate.resize((count + kLanes - 1) / kLanes * kLanes, coordinate.empty() ? 0.0F : coordinate.back());
}

void FeatureSetBounds::Vectors::add(const Vectors& from, std::size_t first, std::size_t end) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = first; i < end; ++i)
      c[k].push_back(from.c[k][i]);
  }
  count += end - first;
}

void FeatureSetBounds::load(std::span<const std::uint32_t> features) {
  loaded_.points.clear();
  loaded_.rays.clear();
  features_.clear();
  for (const std::uint32_t feature : features) {
    Loaded at{feature,
              static_cast<std::uint32_t>(loaded_.points.count),
              static_cast<std::uint32_t>(loaded_.rays.count),
              0,
              0,
              0.0F};
    const FeatureGeometry::Corners c = geometry_.corners(feature);
    for (std::size_t k = 0; k < c.count; ++k)
      loaded_.points.add(c.points[k]);
    geometry_.rays(feature, raysOfFeature_);
    for (std::size_t k = 0; k < raysOfFeature_.count; ++k)
      loaded_.rays.add(raysOfFeature_.rays[k]);
    at.endPoint = static_cast<std::uint32_t>(loaded_.points.count);
    at.endRay = static_cast<std::uint32_t>(loaded_.rays.count);
    at.stretch = static_cast<float>(std::min<double>(raysOfFeature_.stretch, kFar));
    features_.push_back(at);
  }
  extents_.resize(features.size());
}

void FeatureSetBounds::gather(std::span<const std::uint32_t> part) {
  part_.points.clear();
  part_.rays.clear();
  for (const std::uint32_t i : part) {
    part_.points.add(loaded_.points, features_[i].firstPoint, features_[i].endPoint);
    part_.rays.add(loaded_.rays, features_[i].firstRay, features_[i].endRay);
  }
  part_.points.close();
  part_.rays.close();
}

FeatureSetBounds::Range FeatureSetBounds::range(const Vectors& vectors, const glm::dvec3& along) noexcept {
  const std::array<float, 3> w = toSingle(along);
  std::array<float, kLanes> low, high;
  low.fill(kFar);
  high.fill(-kFar);
  const float *x = vectors.c[0].data(), *y = vectors.c[1].data(), *z = vectors.c[2].data();
  for (std::size_t i = 0; i < vectors.c[0].size(); i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float t = x[i + k] * w[0] + y[i + k] * w[1] + z[i + k] * w[2];
      low[k] = t < low[k] ? t : low[k];
      high[k] = t > high[k] ? t : high[k];
    }
  }
  return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

/// Axes of one feature: n along the axis of its cone, u along its longest side.
FeatureSetBounds::Frame FeatureSetBounds::axesOfOne(const Loaded& f) const {
  const glm::dvec3 n = geometry_.cone(f.feature).axis;
  glm::dvec3 side(0.0);
  for (std::size_t i = f.firstPoint; i < f.endPoint; ++i) {
    const glm::dvec3 s = loaded_.points.at(i + 1 < f.endPoint ? i + 1 : f.firstPoint) - loaded_.points.at(i);
    if (glm::dot(s, s) > glm::dot(side, side)) side = s;
  }
  side -= glm::dot(side, n) * n;
  const double length = glm::length(side);
  if (!(length > 0.0)) side = std::abs(n.x) < 0.5 ? glm::dvec3(0.0, n.z, -n.y) : glm::dvec3(-n.z, 0.0, n.x);
  const glm::dvec3 u = glm::normalize(side);
  return {n, u, glm::cross(n, u)};
}

/// Axes of the gathered set: u where features are long and their normals are not, n along the mean normal, v
/// perpendicular to both.
FeatureSetBounds::Frame FeatureSetBounds::axes() const {
  glm::dmat3 positions(0.0), normals(0.0);
  glm::dvec3 mean(0.0), meanNormal(0.0);
  const glm::dvec3 origin = part_.points.at(0);
  for (std::size_t i = 0; i < part_.points.count; ++i) {
    const glm::dvec3 p = part_.points.at(i) - origin;
    mean += p;
    positions += glm::outerProduct(p, p);
  }
  for (std::size_t i = 0; i < part_.rays.count; ++i) {
    const glm::dvec3 r = part_.rays.at(i);
    meanNormal += r;
    normals += glm::outerProduct(r, r);
  }
  const auto points = static_cast<double>(part_.points.count);
  mean /= points;
  positions = positions / points - glm::outerProduct(mean, mean);
  const auto trace = [](const glm::dmat3& m) { return m[0][0] + m[1][1] + m[2][2]; };
  const double spread = trace(positions), least = 1e-30 * size_ * size_;
  glm::dmat3 shape = normals / -trace(normals);
  if (spread > least) shape += positions / spread;
  const SymmetricEigen eigen = symmetricEigen(shape);
  const glm::dvec3 u = eigen.vectors[2];
  glm::dvec3 n = meanNormal - glm::dot(meanNormal, u) * u;
  const double length = glm::length(n);
  constexpr double kNoMean = 1e-3;
  n = length > kNoMean * static_cast<double>(part_.rays.count) ? n / length : eigen.vectors[0];
  return {n, u, glm::cross(n, u)};
}

/// Turns the axes until directions reach about equally far to both sides of n.
void FeatureSetBounds::centreDirections(Frame& frame) const noexcept {
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (const std::size_t side : {std::size_t{1}, std::size_t{2}}) {
      const Range r = range(part_.rays, frame[side]);
      // Bisects two angles given by their sines.
      const double low = std::clamp<double>(r.low, -1.0, 1.0), high = std::clamp<double>(r.high, -1.0, 1.0);
      double sine = low + high, cosine = std::sqrt(1.0 - low * low) + std::sqrt(1.0 - high * high);
      const double length = std::sqrt(sine * sine + cosine * cosine);
      if (!(length > 0.0)) continue;
      sine /= length;
      cosine /= length;
      const glm::dvec3 n = frame[0];
      frame[0] = cosine * n + sine * frame[side];
      frame[side] = cosine * frame[side] - sine * n;
    }
  }
}

/// Approximate share of another body's poses at which these axes cannot rule out a minimum: within a short
/// reach of the box, in directions within the limits.
double FeatureSetBounds::cost(const Frame& frame) const noexcept {
  constexpr double kReach = 0.005, kMinSide = 0.1 * kReach, kOtherSpread = 0.1;
  double product = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Range p = range(part_.points, frame[axis]);
    const double half = 0.5 * (static_cast<double>(p.high) - static_cast<double>(p.low));
    if (axis == 0) {
      product *= half + kReach * size_;
      continue;
    }
    const Range r = range(part_.rays, frame[axis]);
    const double most = std::max<double>(-r.low, r.high);
    product *= (half + (kReach * most + kMinSide) * size_) * (most + kOtherSpread);
  }
  return product;
}

FeatureSetBounds::Frame FeatureSetBounds::best(const Frame& start) const noexcept {
  Frame found = start;
  double least = std::numeric_limits<double>::max();
  for (const auto& [cosine, sine] : kTurnsTried) {
    Frame frame{start[0], cosine * start[1] + sine * start[2], cosine * start[2] - sine * start[1]};
    centreDirections(frame);
    const double c = cost(frame);
    if (c < least) {
      least = c;
      found = frame;
    }
  }
  const glm::dvec3 n = glm::normalize(found[0]);
  const glm::dvec3 u = glm::normalize(found[1] - glm::dot(found[1], n) * n);
  return {n, u, glm::cross(n, u)};
}

Extents FeatureSetBounds::extentsOf(const Loaded& f, const Frame& frame) const noexcept {
  Extents out = Extents::none();
  const auto add = [&out](std::size_t axis, double low, double high) {
    out.most[2 * axis] = std::max(out.most[2 * axis], static_cast<float>(-low));
    out.most[2 * axis + 1] = std::max(out.most[2 * axis + 1], static_cast<float>(high));
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = f.firstPoint; i < f.endPoint; ++i) {
      const double t = glm::dot(loaded_.points.at(i), frame[axis]);
      add(axis, t, t);
    }
    if (f.stretch > kLittleStretch) {
      add(3 + axis, -geometry_.support(f.feature, -frame[axis]), geometry_.support(f.feature, frame[axis]));
      continue;
    }
    // The weights sum to between 1 and the stretch: values that reach outward grow, the others do not shrink.
    const auto stretch = static_cast<double>(f.stretch);
    for (std::size_t i = f.firstRay; i < f.endRay; ++i) {
      const double t = glm::dot(loaded_.rays.at(i), frame[axis]);
      add(3 + axis, t < 0.0 ? stretch * t : t, t > 0.0 ? stretch * t : t);
    }
  }
  return out;
}

NormalConeTree::Bound FeatureSetBounds::boundOf(const Extents& all, const Frame& frame) const noexcept {
  NormalConeTree::Bound b{};
  glm::dvec3 centre(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    centre += static_cast<double>(all.middle(axis)) * frame[axis];
    b.half[axis] = static_cast<float>(static_cast<double>(all.half(axis)) + kExtentPadding * size_);
  }
  b.centre = toSingle(centre);
  b.n = toSingle(frame[0]);
  b.u = toSingle(frame[1]);
  b.v = toSingle(frame[2]);
  const auto padded = [](double x) { return static_cast<float>(x + kDirectionPadding); };
  b.leastN = -padded(all.most[6]);
  b.mostU = padded(std::max(all.most[8], all.most[9]));
  b.mostV = padded(std::max(all.most[10], all.most[11]));
  return b;
}

NormalConeTree::Bound FeatureSetBounds::bound(std::span<const std::uint32_t> part) {
  const bool isOne = part.size() == 1;
  Frame frame;
  if (isOne) frame = axesOfOne(features_[part[0]]);
  // For a face or an edge that frame is already the best.
  if (!isOne || features_[part[0]].feature < geometry_.edgeBase()) {
    gather(part);
    frame = best(isOne ? frame : axes());
  }
  Extents all = Extents::none();
  for (const std::uint32_t i : part) {
    extents_[i] = extentsOf(features_[i], frame);
    all.add(extents_[i]);
  }
  return boundOf(all, frame);
}

NormalConeTree::Bound FeatureSetBounds::boundOfMany(std::span<const std::uint32_t> features) {
  std::vector<std::uint32_t> sample, part;
  for (std::size_t i = 0; i < features.size(); i += (features.size() + kSample - 1) / kSample) {
    part.push_back(static_cast<std::uint32_t>(sample.size()));
    sample.push_back(features[i]);
  }
  load(sample);
  gather(part);
  const Frame frame = axes();
  Extents all = Extents::none();
  for (const std::uint32_t feature : features) {
    const FeatureGeometry::Corners c = geometry_.corners(feature);
    for (std::size_t k = 0; k < c.count; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto t = static_cast<float>(glm::dot(c.points[k], frame[axis]));
        all.most[2 * axis] = std::max(all.most[2 * axis], -t);
        all.most[2 * axis + 1] = std::max(all.most[2 * axis + 1], t);
      }
    }
  }
  std::fill(all.most.begin() + 6, all.most.end(), 1.0F);
  return boundOf(all, frame);
}

}  // namespace nearfit
