#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/picture/picture.h"
#include "core/scene/part.h"

namespace nearfit {

/// Draws triangles and lines into a picture, by software, with a depth buffer. Each pixel is the mean of 3 x 3 samples.
///
/// Places are in pixels: x to the right and y down from the upper left corner of the picture, z away from the viewer,
/// in parallel projection. They may be anywhere; what is outside the picture is left out. Drawing is deterministic: in the
/// same order it gives the same picture on every machine.
///
/// Instead of blending, what is translucent or hidden is drawn at one or two of three samples, in diagonals: in any order,
/// and a pixel has exactly that share.
class Raster {
 public:
  static constexpr int kSamples = 3;  ///< By pixel, across and down.

  /// Share of samples that are drawn, in thirds.
  enum class Cover : std::uint8_t { None, OneThird, TwoThirds, Full };

  struct Corner {
    glm::dvec3 place{0.0};
    double light = 1.0;  ///< Factor on the colour, 0 to 1; linear between corners.
  };

  /// How lines and dots are drawn.
  struct Pen {
    Colour colour;
    double width = 1.0;  ///< Of a line, or diameter of a dot [pixels].
    double toViewer =
        0.0;  ///< Drawn as if nearer by this [pixels], so that a line on a surface is in front of it.
    Cover hidden = Cover::None;  ///< How it is drawn where something is in front of it.
  };

  /// @param width, height  Of the picture [pixels]. Throws UsageError if one is not from 1 to kMaxPictureSize.
  Raster(int width, int height, const Colour& background);

  int width() const noexcept { return width_ / kSamples; }
  int height() const noexcept { return height_ / kSamples; }

  /// Draws a triangle, whichever way it faces; one without area is not drawn. Triangles with a common side leave no
  /// sample along it out.
  void drawTriangle(const std::array<Corner, 3>& corners, const Colour& colour, Cover cover = Cover::Full);
  void drawLine(const glm::dvec3& from, const glm::dvec3& to, const Pen& pen);
  void drawDot(const glm::dvec3& centre, const Pen& pen);

  /// True if nothing would be seen of what lies within a rectangle and no nearer than a depth [all pixels], lines of up to
  /// a pixel around it included.
  bool hides(const glm::dvec2& lower, const glm::dvec2& upper, double depth) const noexcept;

  Picture picture() const;

 private:
  using Pixel = std::array<std::uint8_t, 3>;

  /// Place in samples, whose centres are at whole numbers.
  static glm::dvec3 inSamples(const glm::dvec3& place) noexcept;
  bool isDrawn(int x, int y, Cover cover) const noexcept;
  void mark(int x, int y, double depth, const Pixel& colour, Cover hidden) noexcept;

  int width_, height_;        ///< In samples.
  std::vector<float> depth_;  ///< In samples.
  std::vector<Pixel> colour_;
};

}  // namespace nearfit
