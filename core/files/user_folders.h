#pragma once

#include <cstdint>
#include <filesystem>

namespace nearfit {

/// Kinds of a user's files in the XDG Base Directory Specification.
enum class UserFiles : std::uint8_t { Cache, Config, Data, State };

/// Returns Nearfit's folder for files of this kind: `nearfit` in XDG_CACHE_HOME, XDG_CONFIG_HOME,
/// XDG_DATA_HOME or XDG_STATE_HOME, else in the usual folder below HOME. Relative paths are ignored, as the
/// specification demands. Empty if neither variable holds an absolute path. The folder need not exist.
std::filesystem::path userFolder(UserFiles kind);

}  // namespace nearfit
