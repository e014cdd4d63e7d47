#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace nearfit {

/// SHA-256 of a file's bytes as 64 lower-case hexadecimal digits. Reads in blocks: constant memory.
/// Throws FileError when the file cannot be read or is no regular file.
std::string sha256OfFile(const std::filesystem::path& file);

/// SHA-256 of bytes in memory as 64 lower-case hexadecimal digits.
std::string sha256OfBytes(std::span<const char> bytes);

}  // namespace nearfit
