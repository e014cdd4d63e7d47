#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace nearfit {

/// 64-bit XXH3 of the bytes. Detects damage, at memory speed; no protection against intentional changes.
std::uint64_t checksumOf(std::span<const std::byte> bytes) noexcept;

}  // namespace nearfit
