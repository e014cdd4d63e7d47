#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace nearfit {

/// A ZIP file in memory, its entries compressed by deflate. All have the same date, so that equal contents make equal
/// files. Source: PKWARE, .ZIP File Format Specification 6.3, without ZIP64.
class ZipFile {
 public:
  /// Max size of the file, and of an entry unpacked [bytes].
  static constexpr std::uint64_t kMaxBytes = 0xFFFF'FFFE;

  ZipFile();
  ~ZipFile();
  ZipFile(const ZipFile&) = delete;
  ZipFile& operator=(const ZipFile&) = delete;

  /// Begins an entry, and ends the one before.
  /// @param name  Path with slashes, in ASCII; at most 1,000 bytes.
  void begin(const std::string& name);
  /// Appends to the entry. Throws UsageError if it or the file exceeds kMaxBytes, std::bad_alloc.
  void write(std::string_view text);
  /// Ends the last entry and returns the whole file; to be called once, last. Throws like write().
  std::string finish();

 private:
  class Deflater;
  struct Entry {
    std::string name;
    std::uint64_t offset = 0, packedBytes = 0, bytes = 0;
    std::uint32_t checksum = 0;
  };

  void end();
  void checkSize(std::uint64_t bytes) const;

  std::string file_;
  std::vector<Entry> entries_;
  std::unique_ptr<Deflater> deflater_;  ///< Of the entry that is open; null if none is.
};

}  // namespace nearfit
