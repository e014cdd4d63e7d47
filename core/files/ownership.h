#pragma once

#include <filesystem>
#include <string>

#include <sys/stat.h>

namespace nearfit {

/// Why a file or folder of this status may hold what others wrote: it belongs to another user than the
/// effective one, or other users can write to it. Empty if neither is so.
std::string distrustOf(const struct ::stat& status);

/// The same for a folder, through symbolic links. Empty also if the folder does not exist.
std::string distrustOfFolder(const std::filesystem::path& folder);

/// Creates a folder that only the user can read, and the missing folders above it as the umask has them. An
/// existing folder keeps its permissions. Throws FileError.
void createPrivateFolder(const std::filesystem::path& folder);

}  // namespace nearfit
