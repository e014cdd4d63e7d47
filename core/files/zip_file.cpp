#include "core/files/zip_file.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>

#include <zlib.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034B50, kCentralHeader = 0x02014B50, kZipEnd = 0x06054B50;
/// Version 2.0 of the format, which has deflate.
constexpr std::uint16_t kZipVersion = 20, kDeflateMethod = 8;
/// 1 January 1980, the earliest date that the format knows.
constexpr std::uint16_t kZipTime = 0, kZipDate = 0x21;
/// Where checksum and sizes are in a local header.
constexpr std::size_t kChecksumOffset = 14;
/// For deflateInit2(): the largest window, without a header or trailer of zlib.
constexpr int kRawWindow = -15, kMemoryLevel = 8;
/// Compressed at once [bytes].
constexpr std::size_t kPackedAtOnce = std::size_t{1} << 18;

/// Appends numbers, the least significant byte first.
void append16(std::string& to, std::uint64_t value) {
  to += static_cast<char>(value & 0xFF);
  to += static_cast<char>((value >> 8) & 0xFF);
}
void append32(std::string& to, std::uint64_t value) {
  append16(to, value);
  append16(to, value >> 16);
}

}  // namespace

/// A running compression of zlib.
class ZipFile::Deflater {
 public:
  Deflater() {
    if (::deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kRawWindow, kMemoryLevel,
                       Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~Deflater() { ::deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  /// Compresses to the end of `to`.
  /// @param isLast  Nothing will follow.
  void pack(std::string_view from, bool isLast, std::string& to) {
    // zlib takes pointers to what it does not change.
    stream_.next_in = reinterpret_cast<::Bytef*>(const_cast<char*>(from.data()));
    stream_.avail_in = static_cast<::uInt>(from.size());
    do {
      const std::size_t done = to.size();
      to.resize(done + kPackedAtOnce);
      stream_.next_out = reinterpret_cast<::Bytef*>(to.data() + done);
      stream_.avail_out = static_cast<::uInt>(kPackedAtOnce);
      ::deflate(&stream_, isLast ? Z_FINISH : Z_NO_FLUSH);
      to.resize(done + kPackedAtOnce - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

 private:
  ::z_stream stream_{};
};

ZipFile::ZipFile() = default;
ZipFile::~ZipFile() = default;

void ZipFile::checkSize(std::uint64_t bytes) const {
  if (bytes > kMaxBytes)
    throw UsageError("ZIP file", "its content is more than a file of 4 GiB can hold", "write less at a time");
}

void ZipFile::begin(const std::string& name) {
  end();
  entries_.push_back({name, file_.size()});
  append32(file_, kLocalHeader);
  for (const std::uint16_t value : {kZipVersion, std::uint16_t{0}, kDeflateMethod, kZipTime, kZipDate})
    append16(file_, value);
  // Checksum and sizes are known at the entry's end.
  file_.append(3 * sizeof(std::uint32_t), '\0');
  append16(file_, name.size());
  append16(file_, 0);
  file_ += name;
  deflater_ = std::make_unique<Deflater>();
  entries_.back().checksum = static_cast<std::uint32_t>(::crc32(0, nullptr, 0));
}

void ZipFile::write(std::string_view text) {
  Entry& entry = entries_.back();
  while (!text.empty()) {
    const std::string_view some = text.substr(0, kPackedAtOnce);
    entry.checksum = static_cast<std::uint32_t>(::crc32(
        entry.checksum, reinterpret_cast<const ::Bytef*>(some.data()), static_cast<::uInt>(some.size())));
    entry.bytes += some.size();
    deflater_->pack(some, false, file_);
    checkSize(std::max<std::uint64_t>(entry.bytes, file_.size()));
    text.remove_prefix(some.size());
  }
}

void ZipFile::end() {
  if (!deflater_) return;
  Entry& entry = entries_.back();
  const std::size_t headerBytes = 30 + entry.name.size();
  deflater_->pack({}, true, file_);
  deflater_.reset();
  entry.packedBytes = file_.size() - entry.offset - headerBytes;
  checkSize(file_.size());
  std::string sizes;
  append32(sizes, entry.checksum);
  append32(sizes, entry.packedBytes);
  append32(sizes, entry.bytes);
  file_.replace(entry.offset + kChecksumOffset, sizes.size(), sizes);
}

std::string ZipFile::finish() {
  end();
  const std::size_t begin = file_.size();
  for (const Entry& entry : entries_) {
    append32(file_, kCentralHeader);
    for (const std::uint16_t value :
         {kZipVersion, kZipVersion, std::uint16_t{0}, kDeflateMethod, kZipTime, kZipDate})
      append16(file_, value);
    append32(file_, entry.checksum);
    append32(file_, entry.packedBytes);
    append32(file_, entry.bytes);
    append16(file_, entry.name.size());
    // No extra field, comment, number of a disk or attributes within; then those outside.
    for (int i = 0; i < 4; ++i)
      append16(file_, 0);
    append32(file_, 0);
    append32(file_, entry.offset);
    file_ += entry.name;
  }
  const std::size_t bytes = file_.size() - begin;
  append32(file_, kZipEnd);
  append32(file_, 0);
  append16(file_, entries_.size());
  append16(file_, entries_.size());
  append32(file_, bytes);
  append32(file_, begin);
  append16(file_, 0);
  checkSize(file_.size());
  return std::move(file_);
}

}  // namespace nearfit
