#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace nearfit {

/// True if the bytes begin as a gzip file does.
bool isGzip(std::span<const char> bytes) noexcept;

/// Unpacks a gzip file of one member or several.
/// @param name      The file, for messages.
/// @param maxBytes  A file of a megabyte can hold a gigabyte of zeros: more than this is refused, and takes no memory.
/// @param onBlock   Gets the fraction of `bytes` taken in (0 to 1) now and then, and may throw to stop. May be empty.
/// Throws FileError if the file is damaged, cut off or too large.
std::vector<char> gunzip(std::span<const char> bytes, const std::string& name, std::uint64_t maxBytes,
                         const std::function<void(double fraction)>& onBlock = {});

}  // namespace nearfit
