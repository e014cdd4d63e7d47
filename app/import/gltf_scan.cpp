#include "app/import/gltf_scan.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/import/document_file.h"
#include "core/text/utf8.h"

namespace nearfit::importer {
namespace {

using Json = nlohmann::json;

constexpr const char* kExportAgain = "it is damaged: export it again";

[[noreturn]] void failGltf(const ImportJob& job, const std::string& problem,
                           const char* remedy = kExportAgain) {
  throw FileError(job.file.string(), problem, remedy);
}

std::uint32_t wordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return word;
}

/// The JSON of a glTF file: all of it, or the first chunk of a binary one.
std::string_view jsonOf(const ImportJob& job) {
  const std::string_view bytes(job.bytes.data(), job.bytes.size());
  if (!bytes.starts_with("glTF")) return bytes;
  constexpr std::size_t kHead = 20;
  constexpr std::uint32_t kJson = 0x4E4F534A;
  if (bytes.size() < kHead) failGltf(job, "it is cut off");
  if (wordAt(bytes, 4) != 2)
    failGltf(job, fmt::format("it is of version {}, not 2", wordAt(bytes, 4)), "export it as glTF 2.0");
  const std::uint32_t size = wordAt(bytes, 12);
  if (wordAt(bytes, 16) != kJson || size > bytes.size() - kHead) failGltf(job, "it is cut off");
  return bytes.substr(kHead, size);
}

/// An array of the file's top level; empty if it has none.
const Json& listOf(const Json& root, const char* name) {
  static const Json kNone = Json::array();
  const auto at = root.find(name);
  return at == root.end() || !at->is_array() ? kNone : *at;
}

/// True if a path stays within the folder that it starts from.
bool staysInside(const std::filesystem::path& relative) {
  const std::filesystem::path normal = relative.lexically_normal();
  return !normal.is_absolute() && (normal.empty() || *normal.begin() != "..");
}

/// Names of the files in a list, which are beside the file or below.
std::vector<std::string> checkedFiles(const ImportJob& job, const Json& root, const char* list) {
  std::vector<std::string> names;
  for (const Json& entry : listOf(root, list)) {
    const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
    if (!entry.is_object() || uri == entry.end() || !uri->is_string()) continue;
    const std::string& text = uri->get_ref<const std::string&>();
    if (text.starts_with("data:")) continue;
    if (text.find("://") != std::string::npos || !staysInside(text)) {
      failGltf(
          job,
          fmt::format("it names a file outside of its folder: {}", printableText(truncatedUtf8(text, 200))),
          "put its buffers beside it, or export it as .glb");
    }
    if (job.wasPacked)
      failGltf(job, "its buffers are files of their own", "unpack it first, or export it as .glb");
    names.push_back(text);
  }
  return names;
}

/// Counts what nodes stand for, each once.
class NodeCounter {
 public:
  NodeCounter(const ImportJob& job, const Json& nodes)
      : job_(job), nodes_(nodes), counts_(nodes.size(), kUnknown) {}

  std::uint64_t countBelow(const Json& index, std::size_t depth) {
    if (depth > kMaxDepth) failGltf(job_, fmt::format("its nodes are nested more than {} deep", kMaxDepth));
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= nodes_.size())
      failGltf(job_, "it names a node that does not exist");
    std::uint64_t& count = counts_[index.get<std::size_t>()];
    if (count == kOpen) failGltf(job_, "a node of it contains itself");
    if (count != kUnknown) return count;
    count = kOpen;
    std::uint64_t sum = 1;
    const Json& node = nodes_[index.get<std::size_t>()];
    if (node.is_object())
      for (const Json& child : listOf(node, "children"))
        sum = std::min<std::uint64_t>(kMaxDocumentNodes + 1, sum + countBelow(child, depth + 1));
    return count = sum;
  }

 private:
  static constexpr std::uint64_t kUnknown = 0, kOpen = ~std::uint64_t{0};
  static constexpr std::size_t kMaxDepth = 100;

  const ImportJob& job_;
  const Json& nodes_;
  std::vector<std::uint64_t> counts_;
};

void checkNodes(const ImportJob& job, const Json& root) {
  const Json& nodes = listOf(root, "nodes");
  NodeCounter counter(job, nodes);
  std::uint64_t count = 0;
  // Every node, since a reader may follow any.
  for (std::size_t i = 0; i < nodes.size(); ++i)
    counter.countBelow(Json(i), 0);
  for (const Json& scene : listOf(root, "scenes"))
    if (scene.is_object())
      for (const Json& node : listOf(scene, "nodes"))
        count += counter.countBelow(node, 0);
  if (count > kMaxDocumentNodes)
    failGltf(job, fmt::format("its nodes stand for more than {} instances", kMaxDocumentNodes),
             "export a part of it");
}

void checkExtensions(const ImportJob& job, const Json& root) {
  for (const Json& extension : listOf(root, "extensionsRequired"))
    if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression")
      failGltf(job, "its meshes are compressed", "export it without compression of meshes");
}

/// Refuses JSON nested so deep that a recursive parser overflows its stack.
void checkNesting(const ImportJob& job, std::string_view json) {
  constexpr int kMaxJsonDepth = 256;
  int depth = 0;
  bool isText = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (isText) {
      if (c == '\\') ++i;
      isText = c != '"';
    } else if (c == '"') {
      isText = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth)
        failGltf(job, fmt::format("its JSON is nested more than {} deep", kMaxJsonDepth));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

}  // namespace

std::vector<std::string> scanGltf(const ImportJob& job) {
  const std::string_view json = jsonOf(job);
  checkNesting(job, json);
  const Json root = Json::parse(json, nullptr, false);
  if (!root.is_object()) failGltf(job, "its JSON is damaged");
  checkExtensions(job, root);
  std::vector<std::string> buffers = checkedFiles(job, root, "buffers");
  // Pictures change nothing of what is shown.
  checkedFiles(job, root, "images");
  checkNodes(job, root);
  return buffers;
}

}  // namespace nearfit::importer
