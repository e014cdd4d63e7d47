#include "core/files/user_folders.h"

#include <cstdlib>

namespace nearfit {
namespace {

namespace fs = std::filesystem;

struct Place {
  const char* variable;
  const char* inHome;
};

Place placeOf(UserFiles kind) {
  switch (kind) {
    case UserFiles::Cache:
      return {"XDG_CACHE_HOME", ".cache"};
    case UserFiles::Config:
      return {"XDG_CONFIG_HOME", ".config"};
    case UserFiles::Data:
      return {"XDG_DATA_HOME", ".local/share"};
    case UserFiles::State:
      break;
  }
  return {"XDG_STATE_HOME", ".local/state"};
}

/// Empty if the variable holds no absolute path.
fs::path absolutePathIn(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path path = value != nullptr ? value : "";
  return path.is_absolute() ? path : fs::path();
}

}  // namespace

fs::path userFolder(UserFiles kind) {
  const Place place = placeOf(kind);
  if (const fs::path base = absolutePathIn(place.variable); !base.empty()) return base / "nearfit";
  if (const fs::path home = absolutePathIn("HOME"); !home.empty()) return home / place.inHome / "nearfit";
  return {};
}

}  // namespace nearfit
