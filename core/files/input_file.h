#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace nearfit {

/// A regular file open for reading. Its errors are FileErrors that name the path, the cause and the remedy.
class InputFile {
 public:
  /// Throws FileError when there is no such file, it may not be read, or it is a folder, pipe or device
  /// (which would block or never end).
  explicit InputFile(const std::filesystem::path& file);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Bytes in the file when it was opened.
  std::uint64_t size() const noexcept { return size_; }
  /// For system calls that take one; stays this object's.
  int descriptor() const noexcept { return descriptor_; }
  /// Fills `buffer` as far as the file goes; returns the bytes read, 0 at the end. Throws FileError.
  std::size_t read(std::span<char> buffer);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// All bytes of a file. `onBlock` gets the fraction read after each block and may throw to stop. Throws
/// FileError.
std::vector<char> readWholeFile(const std::filesystem::path& file,
                                const std::function<void(double fraction)>& onBlock = {});

}  // namespace nearfit
