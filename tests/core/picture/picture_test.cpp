#include "core/picture/picture.h"

#include <functional>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/png_picture.h"
#include "tests/support/random_values.h"

namespace nearfit::picture_test {
namespace {

Picture pictureOf(int width, int height, const std::function<double(int x, int y, int channel)>& value) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int channel = 0; channel < 3; ++channel)
        picture.rgb.push_back(static_cast<std::uint8_t>(value(x, y, channel)));
    }
  }
  return picture;
}

void expectReadsBack(const Picture& picture) {
  const test::PngPicture read = test::pngPicture(pngOf(picture));
  ASSERT_EQ(read.width, picture.width);
  ASSERT_EQ(read.height, picture.height);
  ASSERT_EQ(3 * read.pixels.size(), picture.rgb.size());
  for (std::size_t i = 0; i < picture.rgb.size(); ++i)
    ASSERT_EQ(read.pixels[i / 3][i % 3], picture.rgb[i]) << "byte " << i;
}

TEST(PngPicture, NoiseSlopesAndSinglePixelsReadBack) {
  test::RandomValues random(7);
  expectReadsBack(pictureOf(37, 23, [&](int, int, int) { return random.in(0.0, 255.9); }));
  expectReadsBack(
      pictureOf(64, 5, [](int x, int y, int channel) { return (3 * x + 40 * y + channel) % 256; }));
  expectReadsBack(pictureOf(5, 64, [](int x, int y, int channel) { return (200 * x + y + channel) % 256; }));
  expectReadsBack(pictureOf(1, 1, [](int, int, int channel) { return 100 * channel; }));
  expectReadsBack(pictureOf(1, 700, [](int, int y, int) { return y % 251; }));
}

TEST(PngPicture, ASmoothPictureIsMuchSmallerThanItsPixels) {
  const Picture slope =
      pictureOf(300, 200, [](int x, int y, int channel) { return (x + y + 9 * channel) % 256; });
  EXPECT_LT(pngOf(slope).size(), slope.rgb.size() / 20);
  EXPECT_EQ(pngOf(slope), pngOf(slope));
}

TEST(PngPicture, ASizeThatIsNoneIsRefused) {
  EXPECT_THROW(pngOf({0, 1, {}}), UsageError);
  EXPECT_THROW(pngOf({1, -1, {}}), UsageError);
  constexpr std::size_t kTooHigh = kMaxPictureSize + 1;
  EXPECT_THROW(pngOf({1, static_cast<int>(kTooHigh), std::vector<std::uint8_t>(3 * kTooHigh)}), UsageError);
  EXPECT_THROW(pngOf({2, 1, std::vector<std::uint8_t>(5)}), UsageError);
}

}  // namespace
}  // namespace nearfit::picture_test
