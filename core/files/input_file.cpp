#include "core/files/input_file.h"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/files/ownership.h"

namespace nearfit {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{4} << 20;

[[noreturn]] void throwOpenError(const std::filesystem::path& file, int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      throw FileError(file.string(), "there is no such file", "check the path");
    case EACCES:
    case EPERM:
      throw FileError(file.string(), "you have no permission to read it",
                      "change its permissions or open a copy");
    default:
      throw FileError(file.string(), "it cannot be opened: " + std::system_category().message(error),
                      "check the path and the disk");
  }
}

[[noreturn]] void throwReadError(const std::filesystem::path& file, int error) {
  throw FileError(file.string(), "reading it failed: " + std::system_category().message(error),
                  "check the disk and try again");
}

/// Size of an open file. Throws FileError if it is not of the kind and the owner that are asked for.
std::uint64_t checkedSize(const std::filesystem::path& file, int descriptor, FileOwner owner) {
  struct stat status = {};
  const bool isKnown = ::fstat(descriptor, &status) == 0;
  if (isKnown && S_ISDIR(status.st_mode))
    throw FileError(file.string(), "it is a folder", "name a file inside it");
  if (!isKnown || !S_ISREG(status.st_mode))
    throw FileError(file.string(), "it is not a regular file", "copy its content to a file on disk first");
  const std::string distrust = owner == FileOwner::User ? distrustOf(status) : std::string();
  if (!distrust.empty()) throw FileError(file.string(), distrust, "delete it, or take its ownership");
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& file, FileOwner owner) : file_(file) {
  // O_NONBLOCK keeps open() from waiting for the writer of a pipe; it has no effect on regular files.
  const int flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | (owner == FileOwner::User ? O_NOFOLLOW : 0);
  descriptor_ = ::open(file.c_str(), flags);
  if (descriptor_ < 0) throwOpenError(file, errno);
  try {
    size_ = checkedSize(file, descriptor_, owner);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

InputFile::~InputFile() {
  ::close(descriptor_);
}

std::size_t InputFile::read(std::span<char> buffer) {
  std::size_t filled = 0;
  while (filled < buffer.size()) {
    const ::ssize_t count = ::read(descriptor_, buffer.data() + filled, buffer.size() - filled);
    if (count == 0) break;
    if (count < 0) {
      if (errno == EINTR) continue;
      throwReadError(file_, errno);
    }
    filled += static_cast<std::size_t>(count);
  }
  return filled;
}

bool InputFile::readAt(std::uint64_t offset, std::span<std::byte> buffer) const {
  std::size_t filled = 0;
  while (filled < buffer.size()) {
    const ::ssize_t count = ::pread(descriptor_, buffer.data() + filled, buffer.size() - filled,
                                    static_cast<::off_t>(offset + filled));
    if (count == 0) return false;
    if (count < 0) {
      if (errno == EINTR) continue;
      throwReadError(file_, errno);
    }
    filled += static_cast<std::size_t>(count);
  }
  return true;
}

std::uint64_t InputFile::writtenBytes() const noexcept {
  const auto size = static_cast<::off_t>(size_);
  ::off_t written = 0;
  for (::off_t end = 0; end < size;) {
    const ::off_t begin = ::lseek(descriptor_, end, SEEK_DATA);
    if (begin < 0 && errno == ENXIO) break;  // The rest is a hole.
    end = begin < 0 ? -1 : ::lseek(descriptor_, begin, SEEK_HOLE);
    if (end < 0) {
      written = size;
      break;
    }
    written += end - begin;
  }
  ::lseek(descriptor_, 0, SEEK_SET);
  return static_cast<std::uint64_t>(std::min(written, size));
}

void InputFile::touch() const noexcept {
  const ::timespec times[2] = {{0, UTIME_OMIT}, {0, UTIME_NOW}};
  ::futimens(descriptor_, times);
}

std::vector<char> InputFile::readAll(const std::function<void(double fraction)>& onBlock) {
  // The size at opening bounds the memory, even if the file grows.
  std::vector<char> bytes(size_);
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const std::size_t wanted = std::min(kBlockBytes, bytes.size() - filled);
    const std::size_t count = read(std::span(bytes).subspan(filled, wanted));
    filled += count;
    if (count < wanted) break;
    if (onBlock) onBlock(static_cast<double>(filled) / static_cast<double>(bytes.size()));
  }
  if (filled < bytes.size()) {
    throw FileError(file_.string(), "it shrank while it was being read",
                    "try again when no program writes to it");
  }
  return bytes;
}

std::vector<char> readWholeFile(const std::filesystem::path& file,
                                const std::function<void(double fraction)>& onBlock) {
  return InputFile(file).readAll(onBlock);
}

}  // namespace nearfit
