#include "core/files/gunzip.h"

#include <algorithm>
#include <limits>
#include <new>

#include <zlib.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

/// Unpacked at once, between two looks at the limit [bytes].
constexpr std::size_t kUnpackedAtOnce = std::size_t{1} << 20;
/// For inflateInit2(): the largest window, in the format of gzip alone.
constexpr int kGzipWindow = 15 + 16;

/// A running decompression of zlib.
class Inflater {
 public:
  Inflater() {
    if (::inflateInit2(&stream, kGzipWindow) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { ::inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  ::z_stream stream{};
};

[[noreturn]] void throwDamagedGzip(const std::string& name) {
  throw FileError(name, "its gzip compression is damaged or cut off", "copy or compress it again");
}

/// Room to make besides that for a block [bytes]: as much as is there, as vectors grow. From a quarter of what may be
/// unpacked on, all of it at once: the last doublings would take three times as much for a moment.
std::size_t growthAfter(std::size_t done, std::uint64_t maxBytes) {
  return static_cast<std::size_t>(done > maxBytes / 4 ? maxBytes - done : done);
}

/// Unpacks one member to the end of `to`, and returns the bytes of `from` that it takes.
std::size_t unpackMember(std::span<const char> from, const std::string& name, std::uint64_t maxBytes,
                         std::vector<char>& to, const std::function<void(std::size_t taken)>& onBlock) {
  Inflater inflater;
  ::z_stream& z = inflater.stream;
  std::size_t taken = 0;
  for (;;) {
    const std::size_t given = std::min<std::size_t>(from.size() - taken, std::numeric_limits<::uInt>::max());
    // zlib takes pointers to what it does not change.
    z.next_in = reinterpret_cast<::Bytef*>(const_cast<char*>(from.data() + taken));
    z.avail_in = static_cast<::uInt>(given);
    const std::size_t done = to.size();
    if (to.capacity() < done + kUnpackedAtOnce)
      to.reserve(done + kUnpackedAtOnce + growthAfter(done, maxBytes));
    to.resize(done + kUnpackedAtOnce);
    z.next_out = reinterpret_cast<::Bytef*>(to.data() + done);
    z.avail_out = static_cast<::uInt>(kUnpackedAtOnce);
    const int result = ::inflate(&z, Z_NO_FLUSH);
    taken += given - z.avail_in;
    to.resize(done + kUnpackedAtOnce - z.avail_out);
    if (to.size() > maxBytes) {
      throw FileError(name, "it is too large when unpacked",
                      "unpack it with gunzip first, if it is what you expect");
    }
    onBlock(taken);
    if (result == Z_STREAM_END) return taken;
    // Z_BUF_ERROR: neither input is left nor output made.
    if (result != Z_OK || (taken == from.size() && z.avail_out != 0)) throwDamagedGzip(name);
  }
}

}  // namespace

bool isGzip(std::span<const char> bytes) noexcept {
  return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

std::vector<char> gunzip(std::span<const char> bytes, const std::string& name, std::uint64_t maxBytes,
                         const std::function<void(double fraction)>& onBlock) {
  std::vector<char> unpacked;
  std::size_t at = 0;
  do {
    if (!isGzip(bytes.subspan(at))) throwDamagedGzip(name);
    at += unpackMember(bytes.subspan(at), name, maxBytes, unpacked, [&](std::size_t taken) {
      if (onBlock) onBlock(static_cast<double>(at + taken) / static_cast<double>(bytes.size()));
    });
  } while (at < bytes.size());
  return unpacked;
}

}  // namespace nearfit
