#include "tests/support/zip_entries.h"

#include <cstdint>

#include <gtest/gtest.h>
#include <zlib.h>

namespace nearfit::test {
namespace {

std::uint32_t zipNumber(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size && at + i < bytes.size(); ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

std::string inflated(const std::string& packed, std::size_t size) {
  std::string text(size + 1, '\0');  // One more than it may hold, so that more is seen.
  ::z_stream z{};
  EXPECT_EQ(::inflateInit2(&z, -15), Z_OK);
  z.next_in = reinterpret_cast<::Bytef*>(const_cast<char*>(packed.data()));
  z.avail_in = static_cast<::uInt>(packed.size());
  z.next_out = reinterpret_cast<::Bytef*>(text.data());
  z.avail_out = static_cast<::uInt>(text.size());
  EXPECT_EQ(::inflate(&z, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(z.avail_in, 0U);
  EXPECT_EQ(z.total_out, size);
  ::inflateEnd(&z);
  text.resize(size);
  return text;
}

}  // namespace

std::map<std::string, std::string> zipEntries(const std::string& bytes) {
  std::map<std::string, std::string> entries;
  constexpr std::size_t kEndBytes = 22;
  if (bytes.size() < kEndBytes || zipNumber(bytes, bytes.size() - kEndBytes, 4) != 0x06054B50) {
    ADD_FAILURE() << "it does not end as a ZIP file";
    return entries;
  }
  const std::size_t end = bytes.size() - kEndBytes, count = zipNumber(bytes, end + 10, 2);
  std::size_t at = zipNumber(bytes, end + 16, 4);
  EXPECT_EQ(at + zipNumber(bytes, end + 12, 4), end);
  for (std::size_t i = 0; i < count && at + 46 <= end; ++i) {
    EXPECT_EQ(zipNumber(bytes, at, 4), 0x02014B50U);
    const std::uint32_t checksum = zipNumber(bytes, at + 16, 4);
    const std::size_t packed = zipNumber(bytes, at + 20, 4), size = zipNumber(bytes, at + 24, 4),
                      nameBytes = zipNumber(bytes, at + 28, 2), local = zipNumber(bytes, at + 42, 4);
    const std::string name = bytes.substr(at + 46, nameBytes);
    EXPECT_EQ(zipNumber(bytes, local, 4), 0x04034B50U);
    EXPECT_EQ(zipNumber(bytes, local + 14, 4), checksum);
    EXPECT_EQ(zipNumber(bytes, local + 18, 4), packed);
    EXPECT_EQ(zipNumber(bytes, local + 22, 4), size);
    EXPECT_EQ(bytes.substr(local + 30, zipNumber(bytes, local + 26, 2)), name);
    const std::string text = inflated(bytes.substr(local + 30 + nameBytes, packed), size);
    EXPECT_EQ(::crc32(0, reinterpret_cast<const ::Bytef*>(text.data()), static_cast<::uInt>(text.size())),
              checksum);
    EXPECT_TRUE(entries.emplace(name, text).second) << "twice: " << name;
    at += 46 + nameBytes;
  }
  EXPECT_EQ(at, end);
  return entries;
}

}  // namespace nearfit::test
