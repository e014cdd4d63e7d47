#include "core/picture/raster.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

std::uint8_t byteOf(double channel) noexcept {
  // Rounds what is positive without the call of a function, which took a third of a picture's time.
  return static_cast<std::uint8_t>((static_cast<int>(2.0 * 255.0 * std::clamp(channel, 0.0, 1.0)) + 1) / 2);
}

/// A value that is linear over a triangle, and within those of its corners: what is seen nearly along its plane rounds
/// badly.
class Plane {
 public:
  /// @param p     Corners.
  /// @param v     Values at them.
  /// @param area  Twice the area of the corners, not 0; its sign is that of their order.
  Plane(const std::array<glm::dvec3, 3>& p, const std::array<double, 3>& v, double area) noexcept
      : origin_(p[0]),
        value_(v[0]),
        lower_(std::min({v[0], v[1], v[2]})),
        upper_(std::max({v[0], v[1], v[2]})) {
    const glm::dvec2 a(p[1] - p[0]), b(p[2] - p[0]);
    slopeX_ = ((v[1] - v[0]) * b.y - (v[2] - v[0]) * a.y) / area;
    slopeY_ = ((v[2] - v[0]) * a.x - (v[1] - v[0]) * b.x) / area;
  }
  double at(double x, double y) const noexcept {
    return std::clamp(value_ + slopeX_ * (x - origin_.x) + slopeY_ * (y - origin_.y), lower_, upper_);
  }

 private:
  glm::dvec2 origin_;
  double value_, lower_, upper_;
  double slopeX_ = 0.0, slopeY_ = 0.0;
};

/// Where a side of a triangle crosses a row. The same for the side of the triangle beside it, to the bit, so that both
/// together leave nothing out.
std::optional<double> crossingOf(glm::dvec2 a, glm::dvec2 b, double y) noexcept {
  if (a.y > b.y) std::swap(a, b);
  if (!(a.y < b.y) || y < a.y || y > b.y) return std::nullopt;
  return a.x + (y - a.y) * ((b.x - a.x) / (b.y - a.y));
}

/// Whole numbers from `lower` to `upper` that are also from 0 to `count` - 1; empty if first > last.
struct WholeRange {
  int first, last;
  WholeRange(double lower, double upper, int count) noexcept
      : first(static_cast<int>(std::clamp(std::ceil(lower), 0.0, static_cast<double>(count)))),
        last(static_cast<int>(std::clamp(std::floor(upper), -1.0, static_cast<double>(count - 1)))) {}
};

/// Cuts the range of shares of a line to where `start + share * change` is within `lower` and `upper`.
void cutShares(double start, double change, double lower, double upper, double& first,
               double& last) noexcept {
  if (change == 0.0) {
    if (start < lower || start > upper) last = -1.0;
    return;
  }
  const double a = (lower - start) / change, b = (upper - start) / change;
  first = std::max(first, std::min(a, b));
  last = std::min(last, std::max(a, b));
}

}  // namespace

Raster::Raster(int width, int height, const Colour& background)
    : width_(width * kSamples), height_(height * kSamples) {
  if (width < 1 || height < 1 || width > kMaxPictureSize || height > kMaxPictureSize)
    throw UsageError("picture", fmt::format("{} x {} pixels are no size", width, height),
                     fmt::format("give 1 to {} each", kMaxPictureSize));
  const auto samples = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  depth_.assign(samples, std::numeric_limits<float>::infinity());
  colour_.assign(samples, {byteOf(background.r), byteOf(background.g), byteOf(background.b)});
}

glm::dvec3 Raster::inSamples(const glm::dvec3& place) noexcept {
  return static_cast<double>(kSamples) * place - glm::dvec3(0.5, 0.5, 0.0);
}

bool Raster::isDrawn(int x, int y, Cover cover) const noexcept {
  return (x + y) % kSamples < static_cast<int>(cover);
}

void Raster::drawTriangle(const std::array<Corner, 3>& corners, const Colour& colour, Cover cover) {
  const std::array<glm::dvec3, 3> p{inSamples(corners[0].place), inSamples(corners[1].place),
                                    inSamples(corners[2].place)};
  const WholeRange rows(std::min({p[0].y, p[1].y, p[2].y}), std::max({p[0].y, p[1].y, p[2].y}), height_);
  const glm::dvec2 a(p[1] - p[0]), b(p[2] - p[0]);
  const double area = a.x * b.y - a.y * b.x;
  if (area == 0.0 || !std::isfinite(area)) return;
  const Plane depth(p, {p[0].z, p[1].z, p[2].z}, area);
  const Plane light(p, {corners[0].light, corners[1].light, corners[2].light}, area);
  for (int y = rows.first; y <= rows.last; ++y) {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t k = 0; k < 3; ++k) {
      if (const auto x = crossingOf(p[k], p[(k + 1) % 3], y)) {
        left = std::min(left, *x);
        right = std::max(right, *x);
      }
    }
    const WholeRange columns(left, right, width_);
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = columns.first; x <= columns.last; ++x) {
      const auto z = static_cast<float>(depth.at(x, y));
      const std::size_t at = row + static_cast<std::size_t>(x);
      if (!(z < depth_[at]) || !isDrawn(x, y, cover)) continue;
      const double factor = light.at(x, y);
      depth_[at] = z;
      colour_[at] = {byteOf(factor * colour.r), byteOf(factor * colour.g), byteOf(factor * colour.b)};
    }
  }
}

bool Raster::hides(const glm::dvec2& lower, const glm::dvec2& upper, double depth) const noexcept {
  const glm::dvec3 from = inSamples({lower - 1.0, depth}), to = inSamples({upper + 1.0, depth});
  const WholeRange rows(from.y, to.y, height_), columns(from.x, to.x, width_);
  const auto nearest = static_cast<float>(from.z);
  for (int y = rows.first; y <= rows.last; ++y) {
    const float* row = depth_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    if (std::any_of(row + columns.first, row + columns.last + 1, [&](float z) { return z >= nearest; }))
      return false;
  }
  return true;
}

void Raster::mark(int x, int y, double depth, const Pixel& colour, Cover hidden) noexcept {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  const std::size_t at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  const bool isHidden = depth > static_cast<double>(depth_[at]);
  if (isHidden && !isDrawn(x, y, hidden)) return;
  colour_[at] = colour;
  if (!isHidden) depth_[at] = static_cast<float>(depth);
}

void Raster::drawLine(const glm::dvec3& from, const glm::dvec3& to, const Pen& pen) {
  const glm::dvec3 a = inSamples(from), b = inSamples(to), way = b - a;
  const double width = pen.width * kSamples;
  double first = 0.0, last = 1.0;
  cutShares(a.x, way.x, -width, width_ + width, first, last);
  cutShares(a.y, way.y, -width, height_ + width, first, last);
  if (!(first <= last)) return;
  // A run of samples across the line's longer axis, at each sample along it.
  const bool isFlat = std::abs(way.x) >= std::abs(way.y);
  const double longer = std::max(std::abs(way.x), std::abs(way.y)), length = std::hypot(way.x, way.y);
  const double across = longer > 0.0 ? width * length / longer : width;
  // One more than are needed, so that rounding skips none.
  const int steps = 1 + static_cast<int>(std::ceil((last - first) * longer));
  const Pixel colour{byteOf(pen.colour.r), byteOf(pen.colour.g), byteOf(pen.colour.b)};
  for (int i = 0; i <= steps; ++i) {
    const glm::dvec3 p = a + (first + (last - first) * i / steps) * way;
    const double depth = p.z - pen.toViewer * kSamples;
    const double middle = isFlat ? p.y : p.x;
    const int along = static_cast<int>(std::lround(isFlat ? p.x : p.y));
    const int begin = static_cast<int>(std::lround(middle - 0.5 * (across - 1.0)));
    const int count = std::max(1, static_cast<int>(std::lround(across)));
    for (int k = begin; k < begin + count; ++k)
      isFlat ? mark(along, k, depth, colour, pen.hidden) : mark(k, along, depth, colour, pen.hidden);
  }
}

void Raster::drawDot(const glm::dvec3& centre, const Pen& pen) {
  const glm::dvec3 c = inSamples(centre);
  const double radius = 0.5 * pen.width * kSamples;
  const WholeRange rows(c.y - radius, c.y + radius, height_), columns(c.x - radius, c.x + radius, width_);
  const Pixel colour{byteOf(pen.colour.r), byteOf(pen.colour.g), byteOf(pen.colour.b)};
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      if (std::hypot(x - c.x, y - c.y) <= radius)
        mark(x, y, c.z - pen.toViewer * kSamples, colour, pen.hidden);
    }
  }
}

Picture Raster::picture() const {
  constexpr unsigned kCount = kSamples * kSamples;
  Picture picture{width(), height(), {}};
  picture.rgb.reserve(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()) * 3);
  for (int y = 0; y < height(); ++y) {
    for (int x = 0; x < width(); ++x) {
      std::array<unsigned, 3> sum{};
      for (int sample = 0; sample < kSamples * kSamples; ++sample) {
        const int row = y * kSamples + sample / kSamples, column = x * kSamples + sample % kSamples;
        const Pixel& pixel = colour_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                                     static_cast<std::size_t>(column)];
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] += pixel[k];
      }
      for (const unsigned channel : sum)
        picture.rgb.push_back(static_cast<std::uint8_t>((channel + kCount / 2) / kCount));
    }
  }
  return picture;
}

}  // namespace nearfit
