#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nearfit {

/// Max width and height of a picture [pixels].
constexpr int kMaxPictureSize = 8192;

/// An opaque picture, sRGB.
struct Picture {
  int width = 0, height = 0;      ///< [pixels]
  std::vector<std::uint8_t> rgb;  ///< Red, green and blue of each pixel, by rows from the top.
};

/// The picture as PNG file: 8 bits a channel, not interlaced. The same bytes for the same picture and zlib. Throws
/// UsageError if width or height is not from 1 to kMaxPictureSize, or does not agree with the number of bytes.
std::string pngOf(const Picture& picture);

}  // namespace nearfit
