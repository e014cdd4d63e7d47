#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace nearfit {

/// A regular file open for reading. Throws FileErrors that name path, cause and remedy.
class InputFile {
 public:
  /// Throws FileError if the file does not exist, is not readable, or is a folder, pipe or device (which
  /// would block or never end).
  explicit InputFile(const std::filesystem::path& file);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Size when the file was opened [bytes].
  std::uint64_t size() const noexcept { return size_; }
  /// File descriptor, for system calls; this object keeps owning it.
  int descriptor() const noexcept { return descriptor_; }
  /// Fills `buffer` until it is full or the file ends; returns the bytes read, 0 at the end.
  /// Throws FileError.
  std::size_t read(std::span<char> buffer);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Reads the whole file. `onBlock` gets the fraction read (0 to 1) after each block and may throw to stop.
/// Throws FileError, also if the file shrinks meanwhile.
std::vector<char> readWholeFile(const std::filesystem::path& file,
                                const std::function<void(double fraction)>& onBlock = {});

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
