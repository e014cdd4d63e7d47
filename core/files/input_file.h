#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace nearfit {

/// Whose files are opened.
enum class FileOwner {
  Anyone,
  /// The user's alone: no symbolic link, no file of another user, none that others can write to.
  User,
};

/// A regular file open for reading. Throws FileErrors that name path, cause and remedy.
class InputFile {
 public:
  /// Throws FileError if the file does not exist, is not readable, is not the owner's, or is a folder, pipe
  /// or device (which would block or never end).
  explicit InputFile(const std::filesystem::path& file, FileOwner owner = FileOwner::Anyone);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Size when the file was opened [bytes].
  std::uint64_t size() const noexcept { return size_; }
  /// Bytes of the file without the holes of a sparse one, which read as zeros and take no room on disk; its
  /// size if the file system does not tell. To be called before read().
  std::uint64_t writtenBytes() const noexcept;
  /// Fills `buffer` until it is full or the file ends; returns the bytes read, 0 at the end.
  /// Throws FileError.
  std::size_t read(std::span<char> buffer);
  /// Reads all of it, as large as it was when it was opened; to be called before read(). `onBlock` gets the fraction
  /// read (0 to 1) after each block and may throw to stop. Throws FileError, also if the file shrank meanwhile.
  std::vector<char> readAll(const std::function<void(double fraction)>& onBlock = {});
  /// Fills `buffer` from byte `offset` on; false if the file ends before, as one that was truncated does.
  /// Independent of read(); thread-safe. Throws FileError.
  bool readAt(std::uint64_t offset, std::span<std::byte> buffer) const;
  /// Sets the file's time of last change to now, where that is permitted.
  void touch() const noexcept;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// InputFile::readAll() of a file whose size nobody limits.
std::vector<char> readWholeFile(const std::filesystem::path& file,
                                const std::function<void(double fraction)>& onBlock = {});

}  // namespace nearfit
