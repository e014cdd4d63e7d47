#include "core/files/input_file.h"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

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

}  // namespace

InputFile::InputFile(const std::filesystem::path& file) : file_(file) {
  // O_NONBLOCK keeps open() from waiting for the writer of a pipe; it has no effect on regular files.
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) throwOpenError(file, errno);
  struct stat status = {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    if (known && S_ISDIR(status.st_mode)) {
      throw FileError(file.string(), "it is a folder", "name a file inside it");
    }
    throw FileError(file.string(), "it is not a regular file", "copy its content to a file on disk first");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
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
      throw FileError(file_.string(), "reading it failed: " + std::system_category().message(errno),
                      "check the disk and try again");
    }
    filled += static_cast<std::size_t>(count);
  }
  return filled;
}

std::vector<char> readWholeFile(const std::filesystem::path& file,
                                const std::function<void(double fraction)>& onBlock) {
  InputFile input(file);
  // The size at opening bounds the memory, even if the file grows.
  std::vector<char> bytes(input.size());
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const std::size_t wanted = std::min(kBlockBytes, bytes.size() - filled);
    const std::size_t count = input.read(std::span(bytes).subspan(filled, wanted));
    filled += count;
    if (count < wanted) break;
    if (onBlock) onBlock(static_cast<double>(filled) / static_cast<double>(bytes.size()));
  }
  if (filled < bytes.size()) {
    throw FileError(file.string(), "it shrank while it was being read",
                    "try again when no program writes to it");
  }
  return bytes;
}

MappedFile::MappedFile(const std::filesystem::path& file) {
  const InputFile input(file);
  const auto size = static_cast<std::size_t>(input.size());
  if (size == 0) return;
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, input.descriptor(), 0);
  if (address == MAP_FAILED) {
    throw FileError(file.string(),
                    "it cannot be mapped into memory: " + std::system_category().message(errno),
                    "close other programs and try again");
  }
  bytes_ = {static_cast<const std::byte*>(address), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace nearfit
