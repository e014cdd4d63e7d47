#pragma once

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

}  // namespace nearfit
