#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace nearfit {

/// Who may read a file that is made anew.
enum class FileAccess {
  Usual,    ///< Those that the user lets, by the umask.
  Private,  ///< The user alone; so does one that stood there before become.
};

/// What a file is called until it is whole, for as long as that takes.
enum class Unfinished {
  Hidden,  ///< A moment: nobody shall see it.
  /// Long enough to be looked for when the program was killed meanwhile: "felt.csv" is "felt.unfinished.csv".
  Visible,
};

/// A file's new content, written piece by piece, that replaces the old one as one step: a crash, a full disk
/// or an error leaves either the old file whole or the new one whole. The content goes to a temporary file
/// beside the target; a symbolic link is followed, so that it stays a link; an existing file keeps its
/// permissions. Each call throws FileError naming the target; nothing is left behind unless commit() has
/// returned.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file, FileAccess access = FileAccess::Usual,
                      Unfinished unfinished = Unfinished::Hidden);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends; unbuffered.
  void write(std::string_view content);
  /// Bytes that are written; after a failure those before it.
  std::uint64_t size() const noexcept { return size_; }
  /// Takes back what was written after so many bytes.
  void cut(std::uint64_t size);
  enum class Flush {
    ToDisk,  ///< Content, then folder: from then on it survives a crash of the machine.
    Later,   ///< When the system likes; after a crash the file may hold anything.
  };
  /// Flushes the content and puts it in place.
  void commit(Flush flush = Flush::ToDisk);

 private:
  void open(unsigned mode, Unfinished unfinished);
  void keepPermissionsOfTarget();
  void discard() noexcept;

  std::filesystem::path target_, path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Replaces a file's content by `content`, as AtomicFile does.
void atomicWrite(const std::filesystem::path& file, std::string_view content,
                 FileAccess access = FileAccess::Usual);

}  // namespace nearfit
