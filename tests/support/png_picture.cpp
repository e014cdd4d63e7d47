#include "tests/support/png_picture.h"

#include <cstdlib>

#include <gtest/gtest.h>
#include <zlib.h>

namespace nearfit::test {
namespace {

std::uint32_t pngNumber(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
    value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// The CRC of the specification's annex D, bit by bit.
std::uint32_t pngChecksum(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc & 1U) != 0 ? 0xEDB88320U ^ (crc >> 1U) : crc >> 1U;
  }
  return ~crc;
}

std::uint8_t paeth(int left, int up, int corner) {
  const int p = left + up - corner;
  const int toLeft = std::abs(p - left), toUp = std::abs(p - up), toCorner = std::abs(p - corner);
  if (toLeft <= toUp && toLeft <= toCorner) return static_cast<std::uint8_t>(left);
  return static_cast<std::uint8_t>(toUp <= toCorner ? up : corner);
}

std::uint8_t predicted(int filter, int left, int up, int corner) {
  switch (filter) {
    case 0:
      return 0;
    case 1:
      return static_cast<std::uint8_t>(left);
    case 2:
      return static_cast<std::uint8_t>(up);
    case 3:
      return static_cast<std::uint8_t>((left + up) / 2);
    case 4:
      return paeth(left, up, corner);
    default:
      ADD_FAILURE() << "filter " << filter;
      return 0;
  }
}

}  // namespace

PngPicture pngPicture(const std::string& bytes) {
  PngPicture picture;
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1A\n");
  std::string packed, order;
  for (std::size_t at = 8; at < bytes.size();) {
    const std::size_t size = pngNumber(bytes, at);
    const std::string type = bytes.substr(at + 4, 4);
    if (at + 12 + size > bytes.size()) {
      ADD_FAILURE() << type << " is cut";
      return picture;
    }
    EXPECT_EQ(pngChecksum(bytes.substr(at + 4, 4 + size)), pngNumber(bytes, at + 8 + size)) << type;
    order += type + " ";
    if (type == "IHDR") {
      picture.width = static_cast<int>(pngNumber(bytes, at + 8));
      picture.height = static_cast<int>(pngNumber(bytes, at + 12));
      EXPECT_EQ(bytes.substr(at + 16, size - 8), std::string("\x08\x02\x00\x00\x00", 5));
    }
    if (type == "IDAT") packed += bytes.substr(at + 8, size);
    at += 12 + size;
  }
  EXPECT_EQ(order, "IHDR IDAT IEND ");
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  const std::size_t rowBytes = 3 * width;
  std::vector<std::uint8_t> rows((rowBytes + 1) * height);
  ::uLongf size = rows.size();
  EXPECT_EQ(::uncompress(rows.data(), &size, reinterpret_cast<const ::Bytef*>(packed.data()), packed.size()),
            Z_OK);
  EXPECT_EQ(size, rows.size());
  std::vector<std::uint8_t> above(rowBytes, 0), row(rowBytes, 0);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* coded = rows.data() + y * (rowBytes + 1);
    for (std::size_t i = 0; i < rowBytes; ++i) {
      const int left = i >= 3 ? row[i - 3] : 0, corner = i >= 3 ? above[i - 3] : 0;
      row[i] = static_cast<std::uint8_t>(coded[i + 1] + predicted(coded[0], left, above[i], corner));
    }
    for (std::size_t i = 0; i < rowBytes; i += 3)
      picture.pixels.push_back({row[i], row[i + 1], row[i + 2]});
    above = row;
  }
  return picture;
}

}  // namespace nearfit::test
