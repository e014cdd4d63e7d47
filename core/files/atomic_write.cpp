#include "core/files/atomic_write.h"

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& what, int error) {
  const bool isPathFault = error == ENOENT || error == ENOTDIR;
  const bool isRefused = error == EACCES || error == EPERM || error == EROFS;
  const bool isFull = error == ENOSPC || error == EDQUOT;
  throw FileError(file.string(), what + ": " + std::system_category().message(error),
                  isPathFault ? "check that its folder exists"
                  : isRefused ? "choose a folder that you can write to"
                  : isFull    ? "free some space or choose another disk"
                              : "check the disk and try again");
}

void flushFolder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // The folder is writable but not readable; the file itself is safe on disk.
  ::fsync(descriptor);         // Some file systems refuse this for folders; the rename stands anyway.
  ::close(descriptor);
}

/// Absolute target of a chain of symbolic links; the last link may dangle.
fs::path followLinks(const fs::path& file) {
  constexpr int kMaxLinks = 40;  // The kernel's own limit.
  fs::path target = fs::absolute(file);
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(target, error)); ++i) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

fs::path hiddenName(const fs::path& target, unsigned serial) {
  return target.parent_path() / (".nearfit-" + std::to_string(::getpid()) + "-" + std::to_string(serial));
}

/// Several unfinished files of one target get different numbers.
fs::path visibleName(const fs::path& target, unsigned number) {
  fs::path name = target.stem();
  name += number == 1 ? ".unfinished" : ".unfinished-" + std::to_string(number);
  name += target.extension();
  return target.parent_path() / name;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& file, FileAccess access, Unfinished unfinished) {
  if (file.filename().empty())
    throw FileError(file.string(), "the path has no file name", "add a file name to the path");
  target_ = followLinks(file);
  open(access == FileAccess::Private ? S_IRUSR | S_IWUSR : 0666, unfinished);
  if (access == FileAccess::Private) return;
  try {
    keepPermissionsOfTarget();
  } catch (...) {
    discard();
    throw;
  }
}

void AtomicFile::open(unsigned mode, Unfinished unfinished) {
  static std::atomic<unsigned> serial{0};
  unsigned number = 0;
  do {
    path_ =
        unfinished == Unfinished::Visible ? visibleName(target_, ++number) : hiddenName(target_, serial++);
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    // The target's name may already have the max length.
    if (descriptor_ < 0 && errno == ENAMETOOLONG && unfinished == Unfinished::Visible)
      return open(mode, Unfinished::Hidden);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) fail(target_, "it cannot be written", errno);
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!path_.empty()) ::unlink(path_.c_str());
  path_.clear();
}

void AtomicFile::keepPermissionsOfTarget() {
  struct stat status = {};
  if (::stat(target_.c_str(), &status) != 0) return;
  if (S_ISDIR(status.st_mode)) throw FileError(target_.string(), "it is a folder", "choose another name");
  if (::fchmod(descriptor_, status.st_mode & 07777) != 0)
    fail(target_, "its permissions cannot be preserved", errno);
}

void AtomicFile::write(std::string_view content) {
  while (!content.empty()) {
    const ::ssize_t count = ::write(descriptor_, content.data(), content.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(target_, "writing it failed", errno);
    content.remove_prefix(static_cast<std::size_t>(count));
    size_ += static_cast<std::uint64_t>(count);
  }
}

void AtomicFile::cut(std::uint64_t size) {
  const auto offset = static_cast<::off_t>(size);
  if (::ftruncate(descriptor_, offset) != 0 || ::lseek(descriptor_, offset, SEEK_SET) != offset)
    fail(target_, "it cannot be truncated", errno);
  size_ = size;
}

void AtomicFile::commit(Flush flush) {
  if (flush == Flush::ToDisk && ::fsync(descriptor_) != 0) fail(target_, "writing it to disk failed", errno);
  // Network file systems report late write errors here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(target_, "writing it failed", errno);
  if (::rename(path_.c_str(), target_.c_str()) != 0) fail(target_, "it cannot be replaced", errno);
  path_.clear();
  if (flush == Flush::ToDisk) flushFolder(target_.parent_path());
}

void atomicWrite(const fs::path& file, std::string_view content, FileAccess access) {
  AtomicFile replacement(file, access);
  replacement.write(content);
  replacement.commit();
}

}  // namespace nearfit
