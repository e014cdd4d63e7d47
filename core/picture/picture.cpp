#include "core/picture/picture.h"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1A\n";
constexpr std::size_t kChannels = 3;
/// For IHDR: 8 bits a channel, colour type RGB; then deflate, adaptive filters, not interlaced.
constexpr std::string_view kPngFormat("\x08\x02\x00\x00\x00", 5);
/// Filters of a row that are tried: none, difference to the left, difference to above.
constexpr int kFilters = 3;

/// Appends a number, the most significant byte first.
void appendBig32(std::string& to, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U})
    to += static_cast<char>((value >> shift) & 0xFFU);
}

void appendChunk(std::string& to, std::string_view type, std::string_view content) {
  appendBig32(to, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = to.size();
  to += type;
  to += content;
  const auto* bytes = reinterpret_cast<const ::Bytef*>(to.data() + begin);
  appendBig32(to, static_cast<std::uint32_t>(::crc32_z(0, bytes, to.size() - begin)));
}

/// A row as differences by a filter, the filter's number first.
/// @param above  The row above; empty for the first.
std::string filtered(int filter, std::span<const std::uint8_t> row, std::span<const std::uint8_t> above) {
  std::string result(1, static_cast<char>(filter));
  result.reserve(row.size() + 1);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int left = i >= kChannels ? row[i - kChannels] : 0, up = above.empty() ? 0 : above[i];
    const int base = filter == 0 ? 0 : filter == 1 ? left : up;
    result += static_cast<char>(static_cast<std::uint8_t>(row[i] - base));
  }
  return result;
}

/// Sum of the magnitudes of differences: rows with a small one compress well.
/// Source: PNG specification, third edition, 12.7.
std::size_t magnitudeOf(const std::string& differences) {
  std::size_t sum = 0;
  for (const char c : differences)
    sum += static_cast<std::size_t>(std::abs(static_cast<signed char>(c)));
  return sum;
}

std::string bestFiltered(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above) {
  std::string best = filtered(0, row, above);
  for (int filter = 1; filter < kFilters; ++filter) {
    std::string other = filtered(filter, row, above);
    if (magnitudeOf(other) < magnitudeOf(best)) best = std::move(other);
  }
  return best;
}

std::string deflated(const std::string& content) {
  ::uLongf size = ::compressBound(content.size());
  std::string packed(size, '\0');
  const int status =
      ::compress2(reinterpret_cast<::Bytef*>(packed.data()), &size,
                  reinterpret_cast<const ::Bytef*>(content.data()), content.size(), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

}  // namespace

std::string pngOf(const Picture& picture) {
  const auto isSize = [](int size) { return size >= 1 && size <= kMaxPictureSize; };
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  if (!isSize(picture.width) || !isSize(picture.height) || picture.rgb.size() != kChannels * width * height)
    throw UsageError(
        "picture",
        fmt::format("{} x {} pixels of {} bytes are none", picture.width, picture.height, picture.rgb.size()),
        fmt::format("give up to {0} x {0} pixels of 3 bytes", kMaxPictureSize));
  std::string rows;
  rows.reserve((kChannels * width + 1) * height);
  std::span<const std::uint8_t> above;
  for (std::size_t y = 0; y < height; ++y) {
    const std::span row(picture.rgb.data() + y * kChannels * width, kChannels * width);
    rows += bestFiltered(row, above);
    above = row;
  }
  std::string header;
  appendBig32(header, static_cast<std::uint32_t>(picture.width));
  appendBig32(header, static_cast<std::uint32_t>(picture.height));
  header += kPngFormat;
  std::string file(kPngSignature);
  appendChunk(file, "IHDR", header);
  appendChunk(file, "IDAT", deflated(rows));
  appendChunk(file, "IEND", {});
  return file;
}

}  // namespace nearfit
