#include "core/files/ownership.h"

#include <cerrno>
#include <system_error>

#include <unistd.h>

#include "core/base/error.h"

namespace nearfit {

std::string distrustOf(const struct ::stat& status) {
  if (status.st_uid != ::geteuid()) return "it belongs to another user";
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) return "other users can write to it";
  return {};
}

std::string distrustOfFolder(const std::filesystem::path& folder) {
  struct stat status = {};
  return ::stat(folder.c_str(), &status) == 0 ? distrustOf(status) : std::string();
}

void createPrivateFolder(const std::filesystem::path& folder) {
  // "a/b/" names "a/b", whose parent is "a".
  const std::filesystem::path named = folder.has_filename() ? folder : folder.parent_path();
  std::error_code failure;
  if (named.has_parent_path()) std::filesystem::create_directories(named.parent_path(), failure);
  if (::mkdir(named.c_str(), S_IRWXU) == 0) return;
  const int error = errno;
  if (std::filesystem::is_directory(named, failure)) return;
  throw FileError(named.string(), "the folder cannot be created: " + std::system_category().message(error),
                  "choose a place that you can write to");
}

}  // namespace nearfit
