#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace nearfit {

/// SHA-256 of a file's bytes, as 64 lower-case hexadecimal digits. Reads in blocks: constant memory.
/// `onBlock` gets the fraction read (0 to 1) after each block and may throw to stop. Throws FileError if the
/// file cannot be read or is not a regular file.
std::string sha256OfFile(const std::filesystem::path& file,
                         const std::function<void(double fraction)>& onBlock = {});

/// SHA-256 of bytes in memory as 64 lower-case hexadecimal digits.
std::string sha256OfBytes(std::span<const char> bytes);

}  // namespace nearfit
