#include "core/scene/document_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/scene/document_load.h"
#include "core/scene/part.h"
#include "core/text/json_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

using OutlineJson = nlohmann::json;

constexpr const char* kExportTree = "export it again from the CAD system";
/// Max length of a warning or problem that is read back [bytes].
constexpr std::size_t kMaxMessageBytes = 10'000;

std::string printable(const std::string& text) {
  return isPrintableUtf8(text) ? text : printableText(text);
}

void checkKeys(const std::vector<DocumentOutline::Shape>& shapes, const std::filesystem::path& file) {
  std::set<std::string> keys;
  for (const DocumentOutline::Shape& shape : shapes) {
    const bool isFine = !shape.key.empty() && shape.key.size() <= kMaxShapeKeyBytes &&
                        isPrintableUtf8(shape.key) && keys.insert(shape.key).second;
    if (!isFine)
      throw FileError(file.string(),
                      fmt::format("its shape \"{}\" has no name of its own", printable(shape.key)),
                      kExportTree);
  }
}

void checkNode(const CadNode& node, std::size_t index, std::size_t shapes,
               const std::filesystem::path& file) {
  const auto fail = [&](const std::string& problem) {
    throw FileError(file.string(),
                    fmt::format("item {} of its tree, \"{}\", {}", index + 1, node.name, problem),
                    kExportTree);
  };
  if (node.parent < -1 || node.parent >= static_cast<std::int64_t>(index))
    fail("is in none that comes before it");
  if (node.shape < -1 || node.shape >= static_cast<std::int64_t>(shapes))
    fail("is of a shape that does not exist");
  if (node.colour && !std::ranges::all_of(*node.colour, [](float c) { return c >= 0.0F && c <= 1.0F; }))
    fail("has a colour that is none");
}

OutlineJson arrayOf(const CadNode& node) {
  const glm::dquat& q = node.parentFromNode.rotation;
  const glm::dvec3& t = node.parentFromNode.translation;
  OutlineJson colour;
  if (node.colour) {
    for (const float channel : *node.colour)
      colour.push_back(static_cast<double>(channel));
  }
  return OutlineJson::array({node.parent, node.name, OutlineJson::array({q.w, q.x, q.y, q.z}),
                             OutlineJson::array({t.x, t.y, t.z}), node.shape, colour});
}

std::int32_t indexIn(const JsonField& field) {
  const double index = field.numberWithin(-1.0, std::numeric_limits<std::int32_t>::max());
  if (index != std::floor(index)) field.fail("it is not a whole number");
  return static_cast<std::int32_t>(index);
}

CadNode nodeIn(const JsonField& field) {
  field.requireSize(6);
  CadNode node;
  node.parent = indexIn(field.at(0));
  node.name = field.at(1).text(kMaxPartNameBytes);
  const JsonField q = field.at(2), t = field.at(3), colour = field.at(5);
  q.requireSize(4);
  t.requireSize(3);
  node.parentFromNode = {{q.at(0).number(), q.at(1).number(), q.at(2).number(), q.at(3).number()},
                         {t.at(0).number(), t.at(1).number(), t.at(2).number()}};
  node.shape = indexIn(field.at(4));
  if (colour.isNull()) return node;
  colour.requireSize(3);
  const auto channel = [&](std::size_t i) { return static_cast<float>(colour.at(i).numberWithin(0.0, 1.0)); };
  node.colour = {channel(0), channel(1), channel(2)};
  return node;
}

}  // namespace

DocumentOutline checkedOutline(DocumentOutline outline, const std::filesystem::path& file) {
  checkKeys(outline.shapes, file);
  for (std::size_t i = 0; i < outline.nodes.size(); ++i) {
    CadNode& node = outline.nodes[i];
    node.name = truncatedUtf8(printable(node.name), kMaxPartNameBytes);
    checkNode(node, i, outline.shapes.size(), file);
    try {
      node.parentFromNode = checkedPose(node.parentFromNode);
    } catch (const UsageError& e) {
      throw FileError(file.string(),
                      fmt::format("item {} of its tree, \"{}\": {}", i + 1, node.name, e.problem()),
                      kExportTree);
    }
  }
  for (std::string& warning : outline.warnings)
    warning = printable(warning);
  for (DocumentOutline::Shape& shape : outline.shapes)
    shape.problem = printable(shape.problem);
  return outline;
}

std::string outlineText(const DocumentOutline& outline) {
  OutlineJson nodes = OutlineJson::array(), shapes = OutlineJson::array();
  for (const CadNode& node : outline.nodes)
    nodes.push_back(arrayOf(node));
  for (const DocumentOutline::Shape& shape : outline.shapes)
    shapes.push_back(OutlineJson::array({shape.key, shape.problem}));
  return OutlineJson(
             {{"nodes", std::move(nodes)}, {"shapes", std::move(shapes)}, {"warnings", outline.warnings}})
      .dump();
}

std::optional<DocumentOutline> readOutline(std::string_view text, const std::filesystem::path& file) {
  try {
    JsonLimits limits;
    limits.maxBytes = kMaxCachedTextBytes;
    // Twenty for each node.
    limits.maxValues = 4'000'000;
    const OutlineJson json = readJsonText(text, file, limits);
    const JsonField root(json, file);
    const JsonField nodes = root.at("nodes"), shapes = root.at("shapes"), warnings = root.at("warnings");
    DocumentOutline outline;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      outline.nodes.push_back(nodeIn(nodes.at(i)));
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      shapes.at(i).requireSize(2);
      outline.shapes.push_back(
          {shapes.at(i).at(0).text(kMaxShapeKeyBytes), shapes.at(i).at(1).text(kMaxMessageBytes)});
    }
    for (std::size_t i = 0; i < warnings.size(); ++i)
      outline.warnings.push_back(warnings.at(i).text(kMaxMessageBytes));
    return checkedOutline(std::move(outline), file);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

}  // namespace nearfit
