// The importer's own look at glTF files before OpenCASCADE reads them: any bytes, text or binary. What passes can be
// followed node by node to an end, and names no file outside of its folder.
#include "app/import/gltf_scan.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/import/document_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace nearfit::fuzz {
namespace {

using Json = nlohmann::json;

std::string_view jsonIn(std::string_view file) {
  if (!file.starts_with("glTF")) return file;
  // Twelve bytes of the file's head, and eight of the first chunk's, which begin with its size.
  constexpr std::size_t kSizeAt = 12, kHead = 20;
  std::size_t size = 0;
  for (std::size_t i = 4; i-- > 0;)
    size = size * 256 + static_cast<unsigned char>(file[kSizeAt + i]);
  require(size <= file.size() - kHead, "the JSON of a binary file lies in it");
  return file.substr(kHead, size);
}

std::vector<const Json*> itemsOf(const Json& object, const char* name) {
  std::vector<const Json*> items;
  if (object.is_object() && object.contains(name) && object[name].is_array())
    for (const Json& item : object[name])
      items.push_back(&item);
  return items;
}

/// Goes down from the nodes of each scene, as a reader does that knows of no loops.
void requireFiniteTree(const Json& root) {
  const std::vector<const Json*> nodes = itemsOf(root, "nodes");
  std::size_t visited = 0;
  std::vector<std::size_t> open;
  const auto enter = [&](const std::vector<const Json*>& indices) {
    for (const Json* index : indices) {
      require(index->is_number_unsigned() && index->get<std::uint64_t>() < nodes.size(), "nodes exist");
      open.push_back(index->get<std::size_t>());
    }
  };
  for (const Json* scene : itemsOf(root, "scenes")) {
    enter(itemsOf(*scene, "nodes"));
    while (!open.empty()) {
      require(++visited <= kMaxDocumentNodes, "nodes are placed a limited number of times");
      const Json* node = nodes[open.back()];
      open.pop_back();
      enter(itemsOf(*node, "children"));
    }
  }
}

/// True if a path never leaves the folder that it starts from, name by name.
bool staysBelow(std::string_view path) {
  int depth = 0;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    const std::string_view name = path.substr(at, end - at);
    if (name == "..") --depth;
    if (!name.empty() && name != "." && name != "..") ++depth;
    if (depth < 0) return false;
    at = end + 1;
  }
  return !path.starts_with('/');
}

void requireOwnFiles(const Json& root) {
  for (const char* list : {"buffers", "images"}) {
    for (const Json* entry : itemsOf(root, list)) {
      if (!entry->is_object() || !entry->contains("uri") || !(*entry)["uri"].is_string()) continue;
      const auto uri = (*entry)["uri"].get<std::string>();
      if (uri.starts_with("data:")) continue;
      require(uri.find("://") == uri.npos, "no addresses are followed");
      require(staysBelow(uri), "no files outside of the folder are named");
    }
  }
}

std::optional<std::string> problemOf(const importer::ImportJob& job) {
  try {
    importer::scanGltf(job);
    return std::nullopt;
  } catch (const FileError& error) {
    require(!error.problem().empty() && !error.remedy().empty(),
            "an error says what is wrong and what to do");
    return error.problem();
  }
}

void run(std::string_view file) {
  importer::ImportJob job;
  job.file = "part.gltf";
  job.format = importer::DocumentFormat::Gltf;
  job.bytes.assign(file.begin(), file.end());
  const std::optional<std::string> problem = problemOf(job);
  require(problem == problemOf(job), "the same file is judged the same");
  if (problem) return;
  const Json root = Json::parse(jsonIn(file), nullptr, false);
  require(root.is_object(), "what passes is JSON");
  requireFiniteTree(root);
  requireOwnFiles(root);
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
