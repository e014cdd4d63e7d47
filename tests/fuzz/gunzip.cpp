// Files compressed by gzip: any bytes, or bytes that are compressed here in some members, and then damaged or not. What
// was compressed comes back, and nothing takes more than the limit.
#include "core/files/gunzip.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <zlib.h>

#include "core/base/error.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/fuzz_target.h"

namespace nearfit::fuzz {
namespace {

/// Far more than short inputs hold, and little to unpack many times a second.
constexpr std::uint64_t kMaxUnpacked = std::uint64_t{1} << 22;

/// Unpacks, and checks how far it says that it is.
std::vector<char> unpacked(std::span<const char> bytes, std::uint64_t maxBytes) {
  double last = 0.0;
  std::vector<char> content = gunzip(bytes, "a file", maxBytes, [&](double fraction) {
    require(fraction >= last && fraction <= 1.0, "the fraction done grows to 1");
    last = fraction;
  });
  require(content.size() <= maxBytes, "nothing is larger than the limit");
  require(last == 1.0, "all of the file is taken in");
  return content;
}

bool isRefused(std::span<const char> bytes, std::uint64_t maxBytes) {
  try {
    unpacked(bytes, maxBytes);
    return false;
  } catch (const FileError& error) {
    require(!error.problem().empty() && !error.remedy().empty(),
            "an error says what is wrong and what to do");
    return true;
  }
}

/// A member of a gzip file, by zlib itself.
void appendMember(std::span<const std::uint8_t> content, int level, std::vector<char>& file) {
  // The largest window, in the format of gzip.
  constexpr int kGzipWindow = 15 + 16, kMemoryLevel = 8;
  ::z_stream z{};
  require(::deflateInit2(&z, level, Z_DEFLATED, kGzipWindow, kMemoryLevel, Z_DEFAULT_STRATEGY) == Z_OK,
          "zlib can compress");
  std::vector<::Bytef> packed(::deflateBound(&z, static_cast<::uLong>(content.size())));
  std::vector<::Bytef> from(content.begin(), content.end());
  z.next_in = from.data();
  z.avail_in = static_cast<::uInt>(from.size());
  z.next_out = packed.data();
  z.avail_out = static_cast<::uInt>(packed.size());
  require(::deflate(&z, Z_FINISH) == Z_STREAM_END, "zlib compresses all of it");
  file.insert(file.end(), packed.begin(), packed.end() - static_cast<std::ptrdiff_t>(z.avail_out));
  ::deflateEnd(&z);
}

void checkCompressed(ByteSource& bytes) {
  const std::size_t members = 1 + bytes.below(3);
  const int level = static_cast<int>(bytes.below(10));
  const std::size_t repeats = bytes.byte(), cut = bytes.raw<std::uint16_t>();
  std::vector<std::uint8_t> content;
  for (std::size_t i = 0; i <= repeats; ++i)
    content.insert(content.end(), bytes.rest().begin(), bytes.rest().end());
  std::vector<char> file;
  for (std::size_t i = 0; i < members; ++i) {
    const std::size_t from = content.size() * i / members, to = content.size() * (i + 1) / members;
    appendMember(std::span(content).subspan(from, to - from), level, file);
  }
  require(isGzip(file), "a gzip file is recognised");
  const std::vector<char> back = unpacked(file, content.size());
  require(std::equal(back.begin(), back.end(), content.begin(), content.end(),
                     [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }),
          "what was compressed comes back");
  if (!content.empty())
    require(isRefused(file, content.size() - 1), "what is larger than the limit is refused");
  const std::size_t left = cut % file.size();
  // A file that ends with a member is whole.
  if (members == 1)
    require(isRefused(std::span(file).first(left), kMaxUnpacked), "what is cut off is refused");
}

void run(ByteSource& bytes) {
  if (bytes.flag()) return checkCompressed(bytes);
  const std::span<const std::uint8_t> rest = bytes.rest();
  const std::vector<char> file(rest.begin(), rest.end());
  requireReadOrRefused<FileError>([&] { unpacked(file, kMaxUnpacked); });
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
