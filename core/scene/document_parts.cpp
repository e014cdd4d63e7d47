#include "core/scene/document_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

static_assert(kMaxGroupNameBytes <= kMaxPartNameBytes);
constexpr std::string_view kBetweenNames = " / ";

/// Two names as one; the first is cut to fit.
std::string joinedNames(const std::string& outer, const std::string& inner) {
  const std::size_t taken = inner.size() + kBetweenNames.size();
  if (outer.empty() || taken >= kMaxGroupNameBytes) return inner;
  return truncatedUtf8(outer, kMaxGroupNameBytes - taken) + std::string(kBetweenNames) + inner;
}

/// Name of the document's file, without its extensions.
std::string stemOf(const std::filesystem::path& file) {
  std::filesystem::path stem = file.stem();
  if (file.extension() == ".gz") stem = stem.stem();
  std::string text = stem.string();
  if (!isPrintableUtf8(text)) text = printableText(text);
  // Leaves room for a number.
  text = truncatedUtf8(text, kMaxGroupNameBytes - 20);
  return text.empty() ? "part" : text;
}

/// True for a name that programs give to what has none: a number, or a word for any product.
bool saysNothing(std::string_view name) {
  constexpr std::array<std::string_view, 6> kWords{"document", "part", "shape", "solid", "unnamed", "none"};
  const bool isNumber = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
  return isNumber || std::ranges::any_of(kWords, [name](std::string_view word) {
           return std::ranges::equal(name, word, [](char a, char b) {
             return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
           });
         });
}

class Placer {
 public:
  Placer(const LoadedDocument& document, const Scene& scene)
      : document_(document),
        stem_(stemOf(document.file)),
        freeGroups_(kMaxGroups - std::min(kMaxGroups, scene.groups().size())),
        places_(document.nodes.size()) {}

  NewNodes place() {
    countParts();
    const bool hasSeveral = std::ranges::count_if(document_.nodes, [this](const CadNode& node) {
                              return node.parent < 0 && parts_[indexOf(node)] > 0;
                            }) > 1;
    if (hasSeveral) top_.group = addGroup(stem_, {});
    top_.depth = top_.group ? 1 : 0;
    for (std::size_t i = 0; i < document_.nodes.size(); ++i) {
      if (parts_[i] > 0) placeNode(i);
    }
    return std::move(nodes_);
  }

 private:
  /// Where the children of a node go.
  struct Place {
    std::optional<std::size_t> group;  ///< Nearest group.
    std::size_t depth = 0;             ///< Groups around the children.
    std::string outerName;  ///< Of assemblies that have no group, between that group and the children.
    RigidTransform worldFromNode;
    std::optional<CadColour> colour;
  };

  std::size_t indexOf(const CadNode& node) const {
    return static_cast<std::size_t>(&node - document_.nodes.data());
  }
  bool hasPart(const CadNode& node) const {
    return node.shape >= 0 && document_.shapes[static_cast<std::size_t>(node.shape)] != nullptr;
  }

  /// Counts the parts of each node, its own included.
  void countParts() {
    const std::vector<CadNode>& nodes = document_.nodes;
    parts_.assign(nodes.size(), 0);
    isAssembly_.assign(nodes.size(), false);
    for (std::size_t i = nodes.size(); i-- > 0;) {
      if (hasPart(nodes[i])) {
        ++parts_[i];
        ++all_;
      }
      if (nodes[i].parent < 0 || parts_[i] == 0) continue;
      parts_[static_cast<std::size_t>(nodes[i].parent)] += parts_[i];
      isAssembly_[static_cast<std::size_t>(nodes[i].parent)] = true;
    }
    if (all_ <= kMaxSceneFileParts) return;
    throw FileError(
        document_.file.string(),
        fmt::format("it places {} parts, more than the {} that a scene can hold", all_, kMaxSceneFileParts),
        "export a part of the assembly, or leave out its fasteners");
  }

  std::optional<std::size_t> addGroup(const std::string& name, std::optional<std::size_t> parent) {
    if (freeGroups_ == 0) return std::nullopt;
    --freeGroups_;
    nodes_.groups.push_back({name, parent});
    return nodes_.groups.size() - 1;
  }

  std::string nameOf(const CadNode& node) {
    // Several parts are told apart by their numbers; the only one is better known by its file.
    const bool hasName = all_ == 1 && hasPart(node) ? !saysNothing(node.name) : !node.name.empty();
    if (hasName) return node.name;
    return all_ == 1 ? stem_ : fmt::format("{} {}", stem_, ++unnamed_);
  }

  void placeNode(std::size_t i) {
    const CadNode& node = document_.nodes[i];
    const Place& outer = node.parent < 0 ? top_ : places_[static_cast<std::size_t>(node.parent)];
    const std::string name = nameOf(node);
    Place place = outer;
    place.worldFromNode = outer.worldFromNode * node.parentFromNode;
    if (node.colour) place.colour = node.colour;
    if (isAssembly_[i]) {
      const std::optional<std::size_t> group = outer.depth < kMaxGroupDepth
                                                   ? addGroup(joinedNames(outer.outerName, name), outer.group)
                                                   : std::nullopt;
      if (group) {
        place.group = group;
        place.depth = outer.depth + 1;
        place.outerName.clear();
      } else {
        place.outerName = joinedNames(outer.outerName, name);
      }
    }
    if (hasPart(node)) addPart(node, place, isAssembly_[i] ? place.outerName : outer.outerName, name);
    places_[i] = std::move(place);
  }

  void addPart(const CadNode& node, const Place& place, const std::string& outerName,
               const std::string& name) {
    NewNodes::NewPart part;
    part.geometry = document_.shapes[static_cast<std::size_t>(node.shape)];
    part.name = joinedNames(outerName, name);
    part.group = place.group;
    if (place.colour) part.colour = Colour{(*place.colour)[0], (*place.colour)[1], (*place.colour)[2]};
    try {
      // Products of many rotations drift from unit length.
      part.worldFromPart = checkedPose(place.worldFromNode.normalized());
    } catch (const UsageError& e) {
      throw FileError(document_.file.string(), fmt::format("its part \"{}\": {}", name, e.problem()),
                      "check the unit and the placement in the CAD system");
    }
    nodes_.parts.push_back(std::move(part));
  }

  const LoadedDocument& document_;
  const std::string stem_;
  std::size_t freeGroups_;
  std::size_t all_ = 0, unnamed_ = 0;  ///< Parts; items that have got a number.
  std::vector<std::size_t> parts_;     ///< By node.
  std::vector<bool> isAssembly_;       ///< By node: others with parts are in it.
  std::vector<Place> places_;          ///< By node.
  Place top_;
  NewNodes nodes_;
};

}  // namespace

NewNodes partsOfDocument(const LoadedDocument& document, const Scene& scene) {
  return Placer(document, scene).place();
}

Aabb boundsOfDocument(const LoadedDocument& document) {
  Aabb box;
  std::vector<RigidTransform> worldFromNode(document.nodes.size());
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const CadNode& node = document.nodes[i];
    worldFromNode[i] = node.parent < 0
                           ? node.parentFromNode
                           : worldFromNode[static_cast<std::size_t>(node.parent)] * node.parentFromNode;
    const PartGeometryPtr shape =
        node.shape >= 0 ? document.shapes[static_cast<std::size_t>(node.shape)] : nullptr;
    if (shape == nullptr) continue;
    for (const glm::dvec3& vertex : shape->mesh.vertices())
      box.add(worldFromNode[i].applyToPoint(vertex));
  }
  return box;
}

}  // namespace nearfit
