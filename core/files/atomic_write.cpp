#include "core/files/atomic_write.h"

#include <atomic>
#include <cerrno>
#include <charconv>
#include <ctime>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

/// A hidden temporary file is named by this, its process and a number.
constexpr std::string_view kHiddenPrefix = ".nearfit-";

/// Permissions of a new file before the umask.
constexpr unsigned kUserOnly = S_IRUSR | S_IWUSR, kUsual = 0666;

[[noreturn]] void fail(const fs::path& file, const std::string& what, int error) {
  const bool isPathFault = error == ENOENT || error == ENOTDIR;
  const bool isRefused = error == EACCES || error == EPERM || error == EROFS;
  const bool isFull = error == ENOSPC || error == EDQUOT;
  const bool isLimited = error == EFBIG;
  throw FileError(file.string(), what + ": " + std::system_category().message(error),
                  isPathFault ? "check that its folder exists"
                  : isRefused ? "choose a folder that you can write to"
                  : isFull    ? "free some space or choose another disk"
                  : isLimited ? "raise the limit on the size of files (ulimit -f)"
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
  return target.parent_path() /
         (std::string(kHiddenPrefix) + std::to_string(::getpid()) + "-" + std::to_string(serial));
}

/// Process in a name made by hiddenName(); std::nullopt for other names.
std::optional<int> writerOf(std::string_view name) {
  if (!name.starts_with(kHiddenPrefix)) return std::nullopt;
  name.remove_prefix(kHiddenPrefix.size());
  const char* const begin = name.data();
  const char* const end = begin + name.size();
  int process = 0;
  unsigned serial = 0;
  const auto [afterProcess, noProcess] = std::from_chars(begin, end, process);
  if (noProcess != std::errc() || process <= 0 || afterProcess == end || *afterProcess != '-')
    return std::nullopt;
  const auto [afterSerial, noSerial] = std::from_chars(afterProcess + 1, end, serial);
  if (noSerial != std::errc() || afterSerial != end) return std::nullopt;
  return process;
}

/// Several unfinished files of one target get different numbers.
fs::path visibleName(const fs::path& target, unsigned number) {
  fs::path name = target.stem();
  name += number == 1 ? ".unfinished" : ".unfinished-" + std::to_string(number);
  name += target.extension();
  return target.parent_path() / name;
}

/// True if another process of that number runs. Earlier ones of this process's number do not.
bool runsBesides(int process) {
  return process != ::getpid() && (::kill(process, 0) == 0 || errno != ESRCH);
}

/// True if a temporary file is the user's, was not changed for a minute, and no program has it open as an
/// AtomicFile, on this machine or another: each holds a lock on its file.
bool isLeft(const fs::path& file) {
  constexpr std::time_t kQuiet = 60;
  struct stat status = {};
  if (::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != ::geteuid() ||
      std::time(nullptr) - status.st_mtime < kQuiet) {
    return false;
  }
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool isFree = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  ::close(descriptor);
  return isFree;
}

/// Removes a visible temporary file that was left before anything was written to it. Others are kept: a user
/// may want what they hold.
void removeIfEmpty(const fs::path& file) {
  struct stat status = {};
  if (::lstat(file.c_str(), &status) == 0 && status.st_size == 0 && isLeft(file)) ::unlink(file.c_str());
}

/// Properties that a new file inherits from the one it replaces.
struct Permissions {
  unsigned mode = 0;
  ::gid_t group = 0;
};

/// Permissions of the file that a new one is to replace; std::nullopt if there is none. Throws FileError if
/// that cannot be replaced, or the path has no file name.
std::optional<Permissions> permissionsOfTarget(const fs::path& file, Links links) {
  if (file.filename().empty())
    throw FileError(file.string(), "the path has no file name", "add a file name to the path");
  struct stat status = {};
  const int result = links == Links::Follow ? ::stat(file.c_str(), &status) : ::lstat(file.c_str(), &status);
  if (result != 0 || S_ISLNK(status.st_mode)) return std::nullopt;
  if (S_ISDIR(status.st_mode)) throw FileError(file.string(), "it is a folder", "choose another name");
  if (!S_ISREG(status.st_mode))
    throw FileError(file.string(), "it is a device, a pipe or a socket, which no file may replace",
                    "choose another name");
  return Permissions{status.st_mode & 07777U, status.st_gid};
}

/// Sets errno and returns false if it fails.
bool setPermissions(int descriptor, const Permissions& permissions) {
  // Where the group cannot be kept, another one must not get what the mode grants to it.
  const bool isGroupKept = ::fchown(descriptor, static_cast<::uid_t>(-1), permissions.group) == 0;
  return ::fchmod(descriptor, isGroupKept ? permissions.mode : permissions.mode & ~02070U) == 0;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& file, FileAccess access, Unfinished unfinished, Links links) {
  const std::optional<Permissions> replaced = permissionsOfTarget(file, links);
  target_ = links == Links::Follow ? followLinks(file) : fs::absolute(file);
  removeAbandoned(target_.parent_path());
  // Closed from the start: who could open the temporary file now could read all that comes later.
  open(access == FileAccess::Private || replaced ? kUserOnly : kUsual, unfinished);
  if (access == FileAccess::Private || !replaced || setPermissions(descriptor_, *replaced)) return;
  const int error = errno;
  discard();
  fail(target_, "its permissions cannot be preserved", error);
}

void AtomicFile::open(unsigned mode, Unfinished unfinished) {
  static std::atomic<unsigned> serial{0};
  unsigned number = 0;
  do {
    path_ =
        unfinished == Unfinished::Visible ? visibleName(target_, ++number) : hiddenName(target_, serial++);
    if (unfinished == Unfinished::Visible) removeIfEmpty(path_);
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    // The target's name may already have the max length.
    if (descriptor_ < 0 && errno == ENAMETOOLONG && unfinished == Unfinished::Visible)
      return open(mode, Unfinished::Hidden);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) fail(target_, "it cannot be written", errno);
  ::flock(descriptor_, LOCK_EX | LOCK_NB);  // See isLeft(); some file systems have no locks.
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!path_.empty()) ::unlink(path_.c_str());
  path_.clear();
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

void checkReplaceable(const fs::path& file) {
  static_cast<void>(permissionsOfTarget(file, Links::Follow));
}

bool isSameTarget(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  if (fs::equivalent(a, b, missing)) return true;
  const auto resolved = [](const fs::path& file) {
    const fs::path target = followLinks(file);
    std::error_code unknown;
    const fs::path folder = fs::weakly_canonical(target.parent_path(), unknown);
    return unknown ? target.lexically_normal() : folder / target.filename();
  };
  return resolved(a) == resolved(b);
}

void checkTarget(const fs::path& target, std::span<const fs::path> inputs) {
  for (const fs::path& input : inputs) {
    std::error_code missing;
    if (fs::equivalent(target, input, missing)) {
      throw UsageError(target.string(), "it is an input of this command and would be overwritten",
                       "name another file to write");
    }
  }
}

void removeAbandoned(const fs::path& folder) noexcept {
  constexpr int kMaxEntries = 10'000;
  try {
    std::error_code failure;
    fs::directory_iterator entry(folder, failure);
    for (int i = 0; !failure && entry != fs::directory_iterator() && i < kMaxEntries; ++i) {
      const fs::path& file = entry->path();
      const std::optional<int> writer = writerOf(file.filename().string());
      if (writer && !runsBesides(*writer) && isLeft(file)) ::unlink(file.c_str());
      entry.increment(failure);
    }
  } catch (...) {
    // What is left takes room on the disk and does no other harm.
  }
}

}  // namespace nearfit
