#include "core/picture/raster.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/random_values.h"

namespace nearfit::raster_test {
namespace {

constexpr Colour kWhite{1.0F, 1.0F, 1.0F}, kRed{1.0F, 0.0F, 0.0F}, kBlue{0.0F, 0.0F, 1.0F},
    kBlack{0.0F, 0.0F, 0.0F};
using Rgb = std::array<int, 3>;
constexpr Rgb kWhitePixel{255, 255, 255}, kRedPixel{255, 0, 0}, kBluePixel{0, 0, 255};

Rgb pixelOf(const Picture& picture, int x, int y) {
  const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                       static_cast<std::size_t>(x));
  return {picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
}

std::array<Raster::Corner, 3> triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return {{{a}, {b}, {c}}};
}

/// Two triangles over a rectangle at a depth.
void drawRectangle(Raster& raster, const glm::dvec2& from, const glm::dvec2& to, double depth,
                   const Colour& colour, Raster::Cover cover = Raster::Cover::Full) {
  const glm::dvec3 a(from, depth), b(to.x, from.y, depth), c(to, depth), d(from.x, to.y, depth);
  raster.drawTriangle(triangle(a, b, c), colour, cover);
  raster.drawTriangle(triangle(a, c, d), colour, cover);
}

/// Share of a pixel's samples in red on white.
double redShare(const Picture& picture, int x, int y) {
  return 1.0 - pixelOf(picture, x, y)[1] / 255.0;
}

TEST(Raster, ATriangleCoversThePixelsInItAndNoOthers) {
  Raster raster(12, 12, kWhite);
  raster.drawTriangle(triangle({1, 1, 0}, {11, 1, 0}, {1, 11, 0}), kRed);
  const Picture picture = raster.picture();
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 12; ++x) {
      // It is what is right of 1, below 1 and above the diagonal x + y = 12.
      const bool isWhole = x >= 1 && y >= 1 && x + y + 2 <= 12;
      const bool isFree = x < 1 || y < 1 || x + y >= 12;
      if (isWhole || isFree) {
        EXPECT_EQ(pixelOf(picture, x, y), isWhole ? kRedPixel : kWhitePixel) << x << ' ' << y;
      } else {
        // Six of nine samples of a pixel that the diagonal halves are on it or above it.
        EXPECT_NEAR(redShare(picture, x, y), 6.0 / 9.0, 0.01) << x << ' ' << y;
      }
    }
  }
}

TEST(Raster, TheShareOfAPixelIsThatOfItsSamples) {
  Raster raster(4, 4, kWhite);
  drawRectangle(raster, {1.0, 1.0}, {1.0 + 2.0 / 3.0, 1.0 + 1.0 / 3.0}, 0.0, kRed);
  EXPECT_NEAR(redShare(raster.picture(), 1, 1), 2.0 / 9.0, 0.01);
}

TEST(Raster, TheNearerIsSeenInWhateverOrder) {
  for (const bool isNearFirst : {true, false}) {
    Raster raster(8, 8, kWhite);
    for (const bool isNear : {isNearFirst, !isNearFirst})
      drawRectangle(raster, isNear ? glm::dvec2(2.0) : glm::dvec2(0.0),
                    isNear ? glm::dvec2(4.0) : glm::dvec2(8.0), isNear ? 1.0 : 2.0, isNear ? kRed : kBlue);
    EXPECT_EQ(pixelOf(raster.picture(), 3, 3), kRedPixel);
    EXPECT_EQ(pixelOf(raster.picture(), 6, 6), kBluePixel);
  }
}

TEST(Raster, SurfacesThatCrossPartWhereTheirDepthsAreEqual) {
  Raster raster(30, 6, kWhite);
  drawRectangle(raster, {0, 0}, {30, 6}, 5.0, kBlue);
  // Depth from 0 to 10 over 30 pixels: 5 in the middle.
  raster.drawTriangle(triangle({0, -3, 0}, {30, -3, 10}, {0, 20, 0}), kRed);
  EXPECT_EQ(pixelOf(raster.picture(), 13, 1), kRedPixel);
  EXPECT_EQ(pixelOf(raster.picture(), 16, 1), kBluePixel);
}

TEST(Raster, LightIsLinearBetweenCorners) {
  Raster raster(101, 3, kWhite);
  raster.drawTriangle({{{{0.5, -200, 0}, 0.0}, {{0.5, 200, 0}, 0.0}, {{100.5, 1.5, 0}, 1.0}}}, kWhite);
  const Picture picture = raster.picture();
  for (int x = 2; x < 98; ++x)
    EXPECT_NEAR(pixelOf(picture, x, 1)[0], 255.0 * x / 100.0, 1.6) << x;
}

TEST(Raster, TrianglesThatShareSidesLeaveNothingOut) {
  test::RandomValues random(11);
  for (int round = 0; round < 200; ++round) {
    Raster raster(16, 16, kBlack);
    // Around a random place, a fan to the corners and to places on the rim: it covers the picture.
    const glm::dvec3 middle(random.in(2, 14), random.in(2, 14), 0);
    const double a = random.in(0, 16), b = round % 3 == 0 ? 8.0 : random.in(0, 16);
    const std::array<glm::dvec3, 7> rim{
        {{0, 0, 0}, {a, 0, 0}, {16, 0, 0}, {16, b, 0}, {16, 16, 0}, {0, 16, 0}, {0, 0, 0}}};
    for (std::size_t i = 0; i + 1 < rim.size(); ++i)
      raster.drawTriangle(triangle(middle, rim[i], rim[i + 1]), kWhite);
    for (const std::uint8_t byte : raster.picture().rgb)
      ASSERT_EQ(byte, 255) << "round " << round;
  }
}

TEST(Raster, EnormousTrianglesAndLinesAreCutToThePicture) {
  Raster raster(8, 8, kWhite);
  raster.drawTriangle(triangle({-1e12, -1e12, 1e9}, {1e12, -1e12, 1e9}, {0, 1e12, 1e9}), kBlue);
  raster.drawLine({-1e12, 4.5, 1}, {1e12, 4.5, 1}, {.colour = kRed});
  raster.drawLine({1e12, 1e12, 1}, {2e12, 1e12, 1}, {.colour = kBlack});
  raster.drawDot({1e12, -1e12, 1}, {.colour = kBlack, .width = 5.0});
  const Picture picture = raster.picture();
  for (int x = 0; x < 8; ++x) {
    EXPECT_EQ(pixelOf(picture, x, 4), kRedPixel);
    EXPECT_EQ(pixelOf(picture, x, 3), kBluePixel);
    EXPECT_EQ(pixelOf(picture, x, 5), kBluePixel);
  }
}

TEST(Raster, WhatIsSeenEdgeOnIsNotDrawn) {
  Raster raster(8, 8, kWhite);
  raster.drawTriangle(triangle({1, 4, 0}, {7, 4, 5}, {4, 4, 9}), kRed);
  raster.drawTriangle(triangle({2, 2, 0}, {2, 2, 0}, {2, 2, 0}), kRed);
  for (const std::uint8_t byte : raster.picture().rgb)
    ASSERT_EQ(byte, 255);
}

TEST(Raster, ATranslucentSurfaceHasItsShareOfEachPixelAndHidesNothingElse) {
  for (const auto& [cover, share] :
       {std::pair(Raster::Cover::None, 0.0), std::pair(Raster::Cover::OneThird, 1.0 / 3.0),
        std::pair(Raster::Cover::TwoThirds, 2.0 / 3.0), std::pair(Raster::Cover::Full, 1.0)}) {
    Raster raster(6, 6, kWhite);
    drawRectangle(raster, {0, 0}, {6, 6}, 1.0, kRed, cover);
    drawRectangle(raster, {0, 0}, {6, 6}, 2.0, kBlue);
    const Picture picture = raster.picture();
    for (int x = 0; x < 6; ++x) {
      EXPECT_NEAR(pixelOf(picture, x, 3)[0], 255.0 * share, 1.0);
      EXPECT_NEAR(pixelOf(picture, x, 3)[2], 255.0 * (1.0 - share), 1.0);
    }
  }
}

TEST(Raster, LinesAndDotsHaveTheirWidth) {
  Raster raster(40, 40, kWhite);
  raster.drawLine({5, 10.5, 0}, {35, 10.5, 0}, {.colour = kRed, .width = 3.0});
  raster.drawDot({20, 28, 0}, {.colour = kRed, .width = 10.0});
  const Picture picture = raster.picture();
  for (const int y : {9, 10, 11})
    EXPECT_EQ(pixelOf(picture, 20, y), kRedPixel) << y;
  for (const int y : {7, 13})
    EXPECT_EQ(pixelOf(picture, 20, y), kWhitePixel) << y;
  double area = 0.0;
  for (int y = 20; y < 40; ++y) {
    for (int x = 0; x < 40; ++x)
      area += redShare(picture, x, y);
  }
  // Of a disc of diameter 10.
  EXPECT_NEAR(area, 25.0 * 3.14159265, 2.0);
}

TEST(Raster, AMarkBehindASurfaceIsSeenThroughItAsThePenSays) {
  for (const auto& [hidden, share] :
       {std::pair(Raster::Cover::None, 0.0), std::pair(Raster::Cover::TwoThirds, 2.0 / 3.0)}) {
    Raster raster(9, 9, kWhite);
    drawRectangle(raster, {0, 0}, {9, 9}, 1.0, kBlue);
    raster.drawLine({0, 4.5, 5}, {9, 4.5, 5}, {.colour = kRed, .width = 1.0, .hidden = hidden});
    EXPECT_NEAR(pixelOf(raster.picture(), 4, 4)[0], 255.0 * share, 1.0);
  }
  Raster raster(9, 9, kWhite);
  drawRectangle(raster, {0, 0}, {9, 9}, 1.0, kBlue);
  raster.drawLine({0, 4.5, 1.5}, {9, 4.5, 1.5}, {.colour = kRed, .width = 1.0, .toViewer = 1.0});
  EXPECT_EQ(pixelOf(raster.picture(), 4, 4), kRedPixel) << "half a pixel in front of the surface";
}

TEST(Raster, ASizeThatIsNoneIsRefused) {
  EXPECT_THROW(Raster(0, 5, kWhite), UsageError);
  EXPECT_THROW(Raster(5, kMaxPictureSize + 1, kWhite), UsageError);
}

}  // namespace
}  // namespace nearfit::raster_test
