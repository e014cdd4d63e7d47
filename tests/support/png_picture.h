#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace nearfit::test {

/// Picture of a PNG file.
struct PngPicture {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;  ///< By rows from the top.

  const std::array<std::uint8_t, 3>& at(int x, int y) const {
    return pixels.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x));
  }
};

/// Reads a PNG file of 8-bit RGB by the words of its specification. Fails the test where it does not keep to that:
/// signature, order and checksums of chunks, size of the content, numbers of filters, bytes behind the end.
PngPicture pngPicture(const std::string& bytes);

}  // namespace nearfit::test
