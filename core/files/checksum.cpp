#include "core/files/checksum.h"

#include <xxhash.h>

namespace nearfit {

std::uint64_t checksumOf(std::span<const std::byte> bytes) noexcept {
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace nearfit
