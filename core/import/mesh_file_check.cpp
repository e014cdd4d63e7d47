#include "core/import/mesh_file_check.h"

#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/files/input_file.h"

namespace nearfit {
namespace {

/// Files up to this size are read whatever is written of them [bytes].
constexpr std::uint64_t kSmallFile = std::uint64_t{1} << 20;

/// Memory of this machine [bytes]; without a limit if that is unknown.
std::uint64_t machineMemory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || bytes <= 0) return std::numeric_limits<std::uint64_t>::max();
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(bytes);
}

}  // namespace

void checkMeshFile(const std::filesystem::path& file) {
  const InputFile input(file);
  const std::uint64_t size = input.size();
  if (size > machineMemory()) {
    throw FileError(file.string(), fmt::format("it has {} bytes, more than this machine has memory", size),
                    "reduce the mesh, or use a machine with more memory");
  }
  if (size <= kSmallFile) return;
  const std::uint64_t written = input.writtenBytes();
  if (written < size / 2) {
    throw FileError(file.string(), fmt::format("only {} of its {} bytes were ever written", written, size),
                    "it is cut off or no mesh: export or copy it again");
  }
}

}  // namespace nearfit
