#include "core/import/companion_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/files/gunzip.h"
#include "core/files/input_file.h"
#include "core/import/document_import.h"
#include "core/import/mesh_import.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";
/// Folders above the package that are searched for others.
constexpr int kMaxAncestors = 4;
/// Max size of a URDF file that is searched for its meshes [bytes]: large robots take a megabyte.
constexpr std::uint64_t kMaxSearchedUrdf = std::uint64_t{16} << 20;
/// Max length of a companion's name in XML [bytes]: each character may be an entity of six.
constexpr std::size_t kMaxWrittenName = 6 * kMaxCompanionNameBytes;
constexpr std::string_view kXmlSpaces = " \t\r\n";

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

/// Finds what a relative path names, within a folder.
FoundFile findWithin(const fs::path& base, const fs::path& inside, const std::string& relative) {
  if (fs::path(relative).is_absolute()) return {{}, "it is an absolute path, which is not followed"};
  const fs::path path = (base / relative).lexically_normal();
  if (!isInside(path, inside)) return {{}, "it lies outside of the file's package"};
  std::error_code error;
  if (!fs::exists(path, error)) return {{}, "there is no such file"};
  return {path, {}};
}

fs::path folderOf(const fs::path& file) {
  std::error_code error;
  return fs::absolute(file, error).parent_path().lexically_normal();
}

bool isPackageName(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

/// Text of a file as it is, or unpacked; empty if it cannot be read or is too large.
std::vector<char> searchableText(const fs::path& file) {
  try {
    InputFile input(file);
    if (input.size() > kMaxSearchedUrdf) return {};
    std::vector<char> bytes = input.readAll();
    return isGzip(bytes) ? gunzip(bytes, file.string(), kMaxSearchedUrdf) : bytes;
  } catch (const FileError&) {
    return {};
  }
}

std::string withoutEntities(std::string text) {
  // The ampersand last: "&amp;lt;" stands for "&lt;", not for "<".
  constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};
  for (const auto& [entity, character] : kEntities)
    for (std::size_t at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1))
      text.replace(at, entity.size(), 1, character);
  return text;
}

/// Value of an attribute of an element, given without its angle brackets; empty if it has none, or one that is too long
/// for a name.
std::string attributeOf(std::string_view element, std::string_view name) {
  for (std::size_t at = element.find(name); at != std::string_view::npos; at = element.find(name, at + 1)) {
    if (at == 0 || kXmlSpaces.find(element[at - 1]) == std::string_view::npos) continue;
    std::size_t next = element.find_first_not_of(kXmlSpaces, at + name.size());
    if (next == std::string_view::npos || element[next] != '=') continue;
    next = element.find_first_not_of(kXmlSpaces, next + 1);
    if (next == std::string_view::npos || (element[next] != '"' && element[next] != '\'')) continue;
    const std::size_t end = element.find(element[next], next + 1);
    if (end == std::string_view::npos) return {};
    const std::string_view value = element.substr(next + 1, end - next - 1);
    // A value of megabytes would take minutes to rewrite.
    return value.size() <= kMaxWrittenName ? withoutEntities(std::string(value)) : std::string();
  }
  return {};
}

/// Names that the mesh elements of a URDF file give, without those in comments.
std::vector<std::string> meshNamesIn(std::string_view text) {
  constexpr std::string_view kComment = "<!--", kCommentEnd = "-->", kMesh = "<mesh";
  std::vector<std::string> names;
  std::size_t at = text.find('<');
  while (at != std::string_view::npos && names.size() < kMaxCompanions) {
    const bool isComment = text.substr(at).starts_with(kComment);
    const std::size_t end = isComment ? text.find(kCommentEnd, at + kComment.size()) : text.find('>', at);
    if (end == std::string_view::npos) break;
    const std::string_view element = text.substr(at, end - at);
    const bool isMesh = !isComment && element.starts_with(kMesh) &&
                        element.find_first_of(kXmlSpaces, kMesh.size()) == kMesh.size();
    if (isMesh) {
      std::string name = attributeOf(element.substr(kMesh.size()), "filename");
      if (isCompanionName(name)) names.push_back(std::move(name));
    }
    at = text.find('<', end);
  }
  return names;
}

}  // namespace

bool isCompanionName(std::string_view name) {
  return !name.empty() && name.size() <= kMaxCompanionNameBytes && isPrintableUtf8(name) &&
         !fs::path(name).is_absolute();
}

bool mayHaveCompanions(const fs::path& document) {
  constexpr std::array<std::string_view, 3> kFormats{"gltf", "glb", "urdf"};
  return std::ranges::find(kFormats, documentFormat(document)) != kFormats.end();
}

bool isMeshForUrdf(const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".gltf" || extension == ".glb") return true;
  return std::ranges::any_of(importableExtensions(),
                             [&](const std::string& known) { return extension == '.' + known; });
}

std::vector<fs::path> meshFilesNamedIn(const fs::path& document) {
  if (documentFormat(document) != "urdf") return {};
  const std::vector<char> text = searchableText(document);
  const std::vector<std::string> names = meshNamesIn({text.data(), text.size()});
  const CompanionFinder finder(document, names);
  std::vector<fs::path> files;
  for (const std::string& name : names) {
    FoundFile found = finder.find(name);
    if (found.problem.empty() && isMeshForUrdf(found.path)) files.push_back(std::move(found.path));
  }
  return files;
}

UrdfFiles::UrdfFiles(const fs::path& file, std::string_view text)
    : folder_(folderOf(file)), root_(rootOf(folder_)) {
  for (std::size_t at = text.find(kPackage); at != std::string_view::npos; at = text.find(kPackage, at + 1)) {
    const std::string_view rest = text.substr(at + kPackage.size());
    const std::string name(rest.substr(0, rest.find_first_of("/\"'<>&")));
    if (isPackageName(name) && !packages_.contains(name)) packages_[name] = packageOf(name);
  }
}

fs::path UrdfFiles::packageOf(const std::string& name) const {
  fs::path at = root_;
  for (int i = 0; i <= kMaxAncestors && !at.empty(); ++i, at = above(at)) {
    if (at.filename() == name) return at;
    if (isFolder(at / name)) return at / name;
  }
  // A package by another name than its folder: the file's own, as a rule.
  return root_;
}

std::vector<fs::path> UrdfFiles::folders() const {
  std::vector<fs::path> folders{root_};
  for (const auto& package : packages_)
    folders.push_back(package.second);
  return folders;
}

FoundFile UrdfFiles::find(const std::string& name) const {
  if (name.starts_with(kPackage)) {
    std::string relative = name.substr(kPackage.size());
    const std::string package = relative.substr(0, relative.find('/'));
    const auto known = packages_.find(package);
    if (known == packages_.end()) return {{}, "its package is not found"};
    relative.erase(0, std::min(relative.size(), package.size() + 1));
    return findWithin(known->second, known->second, relative);
  }
  if (name.find("://") != std::string::npos) return {{}, "it is an address, which is not followed"};
  return findWithin(folder_, root_, name);
}

CompanionFinder::CompanionFinder(const fs::path& document, std::span<const std::string> names)
    : folder_(folderOf(document)) {
  if (documentFormat(document) != "urdf") return;
  std::string text;
  for (const std::string& name : names)
    text += name + '"';
  urdf_.emplace(document, text);
}

FoundFile CompanionFinder::find(const std::string& name) const {
  return urdf_ ? urdf_->find(name) : findWithin(folder_, folder_, name);
}

}  // namespace nearfit
