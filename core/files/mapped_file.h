#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace nearfit {

/// Read-only memory mapping of a file. Only for files that are always replaced as a whole (AtomicFile): the
/// mapping then keeps the old content, even after the file is deleted. Reading a mapped file that was
/// truncated in place kills the process.
class MappedFile {
 public:
  /// Throws FileError as InputFile does, and if the file cannot be mapped.
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// The file's bytes, page-aligned, valid as long as this object; empty for an empty file.
  std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace nearfit
