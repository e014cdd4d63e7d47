#include "core/files/mapped_file.h"

#include <cerrno>
#include <system_error>

#include <sys/mman.h>

#include "core/base/error.h"
#include "core/files/input_file.h"

namespace nearfit {

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
