#include "app/import/memory_file.h"

#include <cerrno>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/base/error.h"

namespace nearfit::importer {

MemoryFile::MemoryFile(std::span<const char> bytes)
    : descriptor_(::memfd_create("nearfit-file", MFD_CLOEXEC)) {
  while (descriptor_ >= 0 && !bytes.empty()) {
    const ::ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      ::close(descriptor_);
      descriptor_ = -1;
      break;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  if (descriptor_ < 0) throw Error("", "there is not enough memory for it", "close other programs");
}

MemoryFile::~MemoryFile() {
  ::close(descriptor_);
}

std::string MemoryFile::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

}  // namespace nearfit::importer
