#include "tests/support/places.h"

namespace nearfit::test {

std::filesystem::path sourceFolder() {
  return NEARFIT_SOURCE_DIR;
}

std::filesystem::path sharedFolder() {
  return NEARFIT_SOURCE_DIR "/../shared";
}

std::string builtPath(const std::string& name) {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

}  // namespace nearfit::test
