#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace nearfit {

/// The bytes of a file, mapped into memory to be read where they are. For files that are only ever replaced
/// as a whole (see AtomicFile): what is mapped then stays as it was, even when the file is gone. One that is
/// cut short in place takes the process down when it is read.
class MappedFile {
 public:
  /// Throws FileError as InputFile does, and when the file cannot be mapped.
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// Begins at a page.
  std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace nearfit
