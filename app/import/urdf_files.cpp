#include "app/import/urdf_files.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <system_error>

namespace nearfit::importer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";
/// Folders above the package that are searched for others.
constexpr int kMaxAncestors = 4;

bool isFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/// The folder above; empty where that is the root of all files or directly below it, such as /home.
fs::path above(const fs::path& folder) {
  const fs::path parent = folder.parent_path();
  return std::distance(parent.begin(), parent.end()) <= 2 ? fs::path() : parent;
}

fs::path rootOf(const fs::path& folder) {
  std::error_code error;
  fs::path at = folder;
  for (int i = 0; i <= kMaxAncestors && !at.empty(); ++i, at = above(at))
    if (fs::exists(at / "package.xml", error)) return at;
  constexpr std::array kUsual{"urdf", "robots", "xacro"};
  const bool isUsual = std::ranges::find(kUsual, folder.filename().string()) != kUsual.end();
  return isUsual && !above(folder).empty() ? above(folder) : folder;
}

/// True if a path, links followed, lies in a folder.
bool isInside(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path full = fs::weakly_canonical(path, error), base = fs::weakly_canonical(folder, error);
  return !error && std::mismatch(base.begin(), base.end(), full.begin(), full.end()).first == base.end();
}

bool isPackageName(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

}  // namespace

UrdfFiles::UrdfFiles(const ImportJob& job) {
  std::error_code error;
  folder_ = fs::absolute(job.file, error).parent_path().lexically_normal();
  root_ = rootOf(folder_);
  const std::string_view text(job.bytes.data(), job.bytes.size());
  for (std::size_t at = text.find(kPackage); at != std::string_view::npos; at = text.find(kPackage, at + 1)) {
    const std::string_view rest = text.substr(at + kPackage.size());
    const std::string name(rest.substr(0, rest.find_first_of("/\"'<>&")));
    if (isPackageName(name) && !packages_.contains(name)) packages_[name] = packageOf(name);
  }
}

std::filesystem::path UrdfFiles::packageOf(const std::string& name) const {
  fs::path at = root_;
  for (int i = 0; i <= kMaxAncestors && !at.empty(); ++i, at = above(at)) {
    if (at.filename() == name) return at;
    if (isFolder(at / name)) return at / name;
  }
  // A package by another name than its folder: the file's own, as a rule.
  return root_;
}

std::vector<std::filesystem::path> UrdfFiles::folders() const {
  std::vector<fs::path> folders{root_};
  for (const auto& package : packages_)
    folders.push_back(package.second);
  return folders;
}

UrdfFiles::Found UrdfFiles::find(const std::string& name) const {
  fs::path base = folder_, inside = root_;
  std::string relative = name;
  if (relative.starts_with(kPackage)) {
    relative.erase(0, kPackage.size());
    const std::string package = relative.substr(0, relative.find('/'));
    const auto known = packages_.find(package);
    if (known == packages_.end()) return {{}, "its package is not found"};
    base = inside = known->second;
    relative.erase(0, std::min(relative.size(), package.size() + 1));
  } else if (relative.find("://") != std::string::npos) {
    return {{}, "it is an address, which is not followed"};
  }
  if (fs::path(relative).is_absolute()) return {{}, "it is an absolute path, which is not followed"};
  const fs::path path = (base / relative).lexically_normal();
  if (!isInside(path, inside)) return {{}, "it lies outside of the file's package"};
  std::error_code error;
  if (!fs::exists(path, error)) return {{}, "there is no such file"};
  return {path, {}};
}

}  // namespace nearfit::importer
