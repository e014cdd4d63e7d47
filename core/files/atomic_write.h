#pragma once

#include <filesystem>
#include <string_view>

namespace nearfit {

/// Replaces a file's content as one step: a crash, a full disk or an error leaves either the old file whole
/// or the new one whole. The content goes to a temporary file beside the target, is flushed to disk and
/// renamed; then the folder is flushed. A symbolic link is followed, so that it stays a link; an existing
/// file keeps its permissions. Throws FileError naming the target, with nothing left behind.
void atomicWrite(const std::filesystem::path& file, std::string_view content);

}  // namespace nearfit
