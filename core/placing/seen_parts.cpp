#include "core/placing/seen_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Nearest depth that is shown, as a fraction of the farthest.
constexpr double kNearest = 1e-9;
constexpr std::uint32_t kNobody = 0xffffffff;

/// A corner in eye coordinates: right, down and away [m], and its height above the cut plane [m].
struct Corner {
  glm::dvec3 at;
  double height = 0.0;
};

/// A triangle clipped by two planes.
struct Polygon {
  std::array<Corner, 5> corners;
  std::size_t count = 0;
};

/// The part of a polygon where `value` is at most zero.
template <typename Value>
Polygon below(const Polygon& whole, const Value& value) {
  Polygon piece;
  for (std::size_t i = 0; i < whole.count; ++i) {
    const Corner &from = whole.corners[i], &to = whole.corners[(i + 1) % whole.count];
    const double begin = value(from), end = value(to);
    if (begin <= 0.0) piece.corners[piece.count++] = from;
    if ((begin <= 0.0) == (end <= 0.0)) continue;
    const double share = begin / (begin - end);
    piece.corners[piece.count++] = {from.at + share * (to.at - from.at),
                                    from.height + share * (to.height - from.height)};
  }
  return piece;
}

/// An image of the nearest part at each pixel.
class Picture {
 public:
  Picture(const ViewProjection& view, const PixelBox& pixels)
      : view_(view),
        eye_(view.rayThrough(view.middle()).origin),
        // At depth 1; in parallel projection at any depth.
        scale_(view.metresPerPixel(eye_ + view.away())),
        lower_(glm::min(pixels.lower, pixels.upper)),
        size_(glm::max(pixels.lower, pixels.upper) - lower_ + 1),
        nearness_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y),
                  -std::numeric_limits<double>::infinity()),
        owner_(nearness_.size(), kNobody) {}

  Corner cornerOf(const glm::dvec3& point) const {
    const glm::dvec3 way = point - eye_;
    return {{glm::dot(way, view_.right()), -glm::dot(way, view_.up()), glm::dot(way, view_.away())}, 0.0};
  }

  /// False if the box is certainly outside the pixels.
  bool mayShow(std::span<const Corner> box) const {
    glm::dvec2 least(std::numeric_limits<double>::infinity()), most(-least);
    for (const Corner& corner : box) {
      // Pixels of corners behind the eye are meaningless.
      if (!view_.isParallel() && corner.at.z <= 0.0) return true;
      const glm::dvec3 pixel = pixelOf(corner.at);
      least = glm::min(least, glm::dvec2(pixel));
      most = glm::max(most, glm::dvec2(pixel));
    }
    const glm::dvec2 upper(lower_ + size_ - 1), lower(lower_);
    return least.x <= upper.x && least.y <= upper.y && most.x >= lower.x && most.y >= lower.y;
  }

  /// Adds a triangle; true if any of it is visible now.
  /// @param farthest  Farthest depth of all that is shown [m].
  /// @param isDrawn   If true, it hides what is behind it from now on.
  bool add(std::uint32_t owner, const std::array<Corner, 3>& triangle, bool isCut, double farthest,
           bool isDrawn) {
    Polygon piece{{triangle[0], triangle[1], triangle[2]}, 3};
    if (!view_.isParallel()) {
      const double nearest = kNearest * farthest;
      piece = below(piece, [nearest](const Corner& c) { return nearest - c.at.z; });
    }
    if (isCut) piece = below(piece, [](const Corner& c) { return c.height; });
    if (piece.count < 3) return false;
    std::array<glm::dvec3, 5> pixels;
    for (std::size_t i = 0; i < piece.count; ++i)
      pixels[i] = pixelOf(piece.corners[i].at);
    bool isSeen = false;
    for (std::size_t i = 2; i < piece.count; ++i) {
      if (fill(owner, {pixels[0], pixels[i - 1], pixels[i]}, isDrawn)) {
        isSeen = true;
        if (!isDrawn) break;
      }
    }
    return isSeen;
  }

  /// Marks the owners of all pixels.
  void markOwners(std::vector<char>& isSeen) const {
    for (const std::uint32_t owner : owner_) {
      if (owner != kNobody) isSeen[owner] = 1;
    }
  }

 private:
  /// Pixel and nearness. Nearness is linear in the image and greater for nearer points.
  glm::dvec3 pixelOf(const glm::dvec3& at) const {
    const double scale = view_.isParallel() ? scale_ : scale_ * at.z;
    return {view_.middle() + glm::dvec2(at) / scale, view_.isParallel() ? -at.z : 1.0 / at.z};
  }

  bool fill(std::uint32_t owner, const std::array<glm::dvec3, 3>& p, bool isDrawn) {
    const glm::dvec3 first = p[1] - p[0], second = p[2] - p[0];
    const double area = first.x * second.y - first.y * second.x;
    if (area == 0.0) return false;
    const glm::dvec3 least = glm::min(glm::min(p[0], p[1]), p[2]),
                     most = glm::max(glm::max(p[0], p[1]), p[2]);
    const auto begin = [](double from, int lower) {
      return static_cast<int>(std::ceil(std::max(from, static_cast<double>(lower))));
    };
    const auto end = [](double to, int lower, int size) {
      return static_cast<int>(std::floor(std::min(to, static_cast<double>(lower + size - 1))));
    };
    const int fromX = begin(least.x, lower_.x), toX = end(most.x, lower_.x, size_.x);
    const int fromY = begin(least.y, lower_.y), toY = end(most.y, lower_.y, size_.y);
    bool isSeen = false;
    for (int y = fromY; y <= toY; ++y) {
      for (int x = fromX; x <= toX; ++x) {
        const double offX = x - p[0].x, offY = y - p[0].y;
        const double u = (offX * second.y - offY * second.x) / area;
        const double v = (first.x * offY - first.y * offX) / area;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        const std::size_t pixel = static_cast<std::size_t>(y - lower_.y) * static_cast<std::size_t>(size_.x) +
                                  static_cast<std::size_t>(x - lower_.x);
        const double nearness = p[0].z + u * first.z + v * second.z;
        if (nearness <= nearness_[pixel]) continue;
        isSeen = true;
        if (!isDrawn) return true;
        nearness_[pixel] = nearness;
        owner_[pixel] = owner;
      }
    }
    return isSeen;
  }

  const ViewProjection& view_;
  const glm::dvec3 eye_;
  const double scale_;
  const glm::ivec2 lower_, size_;
  std::vector<double> nearness_;
  std::vector<std::uint32_t> owner_;
};

std::array<Corner, 8> cornersOf(const Picture& picture, const ShownPart& part) {
  const Aabb& box = part.placed.part->geometry->mesh.bounds();
  std::array<Corner, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? box.upper.x : box.lower.x,
                            (i & 2) != 0 ? box.upper.y : box.lower.y,
                            (i & 4) != 0 ? box.upper.z : box.lower.z);
    corners[i] = picture.cornerOf(part.placed.worldFromPart.applyToPoint(corner));
  }
  return corners;
}

}  // namespace

std::vector<PartId> partsSeenIn(std::span<const ShownPart> parts, const ViewProjection& view,
                                const PixelBox& pixels, const std::optional<CutPlane>& cut) {
  Picture picture(view, pixels);
  std::vector<char> isReached(parts.size(), 0), isSeen(parts.size(), 0);
  double farthest = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].placed.part->geometry->mesh.triangles().empty()) continue;
    const std::array<Corner, 8> box = cornersOf(picture, parts[i]);
    for (const Corner& corner : box)
      farthest = std::max(farthest, corner.at.z);
    isReached[i] = picture.mayShow(box) ? 1 : 0;
  }
  std::vector<Corner> corners;
  const auto show = [&](std::size_t i) {
    const ShownPart& part = parts[i];
    const TriangleMesh& mesh = part.placed.part->geometry->mesh;
    const bool isCut = part.isCut && cut.has_value();
    corners.clear();
    for (const glm::dvec3& vertex : mesh.vertices()) {
      const glm::dvec3 point = part.placed.worldFromPart.applyToPoint(vertex);
      corners.push_back(picture.cornerOf(point));
      if (isCut) corners.back().height = cut->heightOf(point);
    }
    for (const Triangle& t : mesh.triangles()) {
      const bool isMet =
          picture.add(static_cast<std::uint32_t>(i), {corners[t[0]], corners[t[1]], corners[t[2]]}, isCut,
                      farthest, part.isOpaque);
      // For a part that hides nothing, one visible triangle is enough.
      if (!isMet || part.isOpaque) continue;
      isSeen[i] = 1;
      return;
    }
  };
  for (const bool isOpaque : {true, false}) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (isReached[i] != 0 && parts[i].isOpaque == isOpaque) show(i);
    }
  }
  picture.markOwners(isSeen);
  std::vector<PartId> seen;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (isSeen[i] != 0) seen.push_back(parts[i].placed.part->id);
  }
  return seen;
}

}  // namespace nearfit
