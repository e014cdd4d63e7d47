#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace nearfit {

/// XXH3 of the bytes (64 bits): finds damage, at the speed of memory; no defence against who means it.
std::uint64_t checksumOf(std::span<const std::byte> bytes) noexcept;

}  // namespace nearfit
