#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace nearfit {

/// Who may read a newly created file.
enum class FileAccess {
  Usual,    ///< Whom the user's umask allows.
  Private,  ///< The user only; also applies when an existing file is replaced.
};

/// Name of the temporary file until commit().
enum class Unfinished {
  Hidden,  ///< For short writes: a hidden name.
  /// For long writes, so that a killed program's file can be found: "felt.unfinished.csv" for "felt.csv".
  Visible,
};

/// Treatment of a symbolic link at the target's path.
enum class Links {
  Follow,   ///< It stays, and the file that it names is replaced.
  Replace,  ///< The new file takes its place, and what it names is left alone.
};

/// Replaces a file atomically: a crash, a full disk or an error leaves either the old file or the new one,
/// whole. Written in steps to a temporary file beside the target. An existing file keeps its permissions
/// (unless Private), and who cannot read it can read no temporary file either. Only ordinary files are
/// replaced: folders, devices, pipes and sockets are refused. Every call throws FileError naming the target.
/// Without a successful commit() the destructor deletes the temporary file. Not thread-safe.
class AtomicFile {
 public:
  /// Creates the temporary file, and removes those of killed programs (removeAbandoned) from its folder.
  /// Throws also as checkReplaceable() does.
  explicit AtomicFile(const std::filesystem::path& file, FileAccess access = FileAccess::Usual,
                      Unfinished unfinished = Unfinished::Hidden, Links links = Links::Follow);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends `content`, unbuffered.
  void write(std::string_view content);
  /// Bytes written; after a failed write(), those written before the failure.
  std::uint64_t size() const noexcept { return size_; }
  /// Truncates the content to `size` bytes; writing goes on from there.
  void cut(std::uint64_t size);
  /// When the content must be on disk.
  enum class Flush {
    /// Before commit() returns, content and then folder: it survives a crash of the machine.
    ToDisk,
    /// When the system decides: after a crash of the machine the file may hold anything.
    Later,
  };
  /// Puts the new content in place of the target. To be called once, last.
  void commit(Flush flush = Flush::ToDisk);

 private:
  void open(unsigned mode, Unfinished unfinished);
  void discard() noexcept;

  std::filesystem::path target_, path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Replaces the content of `file` as AtomicFile does, and flushes it to disk. Throws FileError.
void atomicWrite(const std::filesystem::path& file, std::string_view content,
                 FileAccess access = FileAccess::Usual);

/// Throws FileError if `file` names no file, or what AtomicFile does not replace: a folder, device, pipe or
/// socket. It need not exist.
void checkReplaceable(const std::filesystem::path& file);

/// True if AtomicFiles for the two paths would replace one file: they are one existing file, by device and
/// inode, or name the same new one, whatever their spelling and links.
bool isSameTarget(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws UsageError if `target` is one of the files that the command reads, by whatever path or link.
void checkTarget(const std::filesystem::path& target, std::span<const std::filesystem::path> inputs);

/// Removes hidden temporary files from a folder that programs left there when they were killed: the user's
/// own, without a change for a minute, whose process does not run and that no program anywhere holds open.
/// Looks at the first ten thousand entries.
void removeAbandoned(const std::filesystem::path& folder) noexcept;

}  // namespace nearfit
