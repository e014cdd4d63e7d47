#include "app/cli/document_info.h"

#include <cstddef>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/output.h"
#include "core/text/utf8.h"

namespace nearfit::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Number of instances of each shape.
std::vector<std::size_t> usesOf(const LoadedDocument& document) {
  std::vector<std::size_t> uses(document.shapes.size(), 0);
  for (const CadNode& node : document.nodes) {
    if (node.shape >= 0 && document.shapes[static_cast<std::size_t>(node.shape)] != nullptr)
      ++uses[static_cast<std::size_t>(node.shape)];
  }
  return uses;
}

struct Totals {
  std::size_t shapes = 0, parts = 0, triangles = 0, placedTriangles = 0;
};

Totals totalsOf(const LoadedDocument& document) {
  const std::vector<std::size_t> uses = usesOf(document);
  Totals totals;
  for (std::size_t i = 0; i < document.shapes.size(); ++i) {
    if (document.shapes[i] == nullptr) continue;
    const std::size_t triangles = document.shapes[i]->mesh.triangles().size();
    ++totals.shapes;
    totals.parts += uses[i];
    totals.triangles += triangles;
    totals.placedTriangles += uses[i] * triangles;
  }
  return totals;
}

/// A geometry that is there; there is one in each document that could be loaded.
const PartGeometry& anyShapeOf(const LoadedDocument& document) {
  for (const PartGeometryPtr& shape : document.shapes) {
    if (shape != nullptr) return *shape;
  }
  return *document.shapes.front();
}

std::string shapeText(const PartGeometry& shape, std::size_t uses, std::optional<double> density) {
  const glm::dvec3 size = shape.mesh.bounds().upper - shape.mesh.bounds().lower;
  std::string text =
      fmt::format("  shape       {}: placed {} time{}, {} triangles, {}, {:.6g} x {:.6g} x {:.6g} m",
                  oneLine(shape.shapeKey), uses, uses == 1 ? "" : "s", shape.mesh.triangles().size(),
                  shape.mesh.topology().isClosed() ? "closed" : "open", size.x, size.y, size.z);
  if (shape.surfaces != nullptr) text += fmt::format(", {} faces", shape.surfaces->faces.size());
  if (shape.isExact) {
    text += fmt::format(", chord {:.3g} m, angle {:.3g} degrees", shape.effectiveTessellation.chord,
                        shape.effectiveTessellation.angle * 180.0 / std::numbers::pi);
  }
  text += fmt::format(", volume {:.6g} m^3", shape.mass.volume);
  if (shape.exactVolume > 0.0) text += fmt::format(" (exact {:.6g})", shape.exactVolume);
  if (density) text += fmt::format(", {:.6g} kg", *density * shape.mass.volume);
  text += "\n";
  for (const std::string& warning : shape.report.warnings)
    text += fmt::format("  warning     {}: {}\n", oneLine(shape.shapeKey), oneLine(warning));
  return text;
}

std::string treeText(const LoadedDocument& document) {
  // Children come after their parents but need not follow them at once.
  std::vector<std::vector<std::size_t>> children(document.nodes.size());
  std::vector<std::size_t> open;
  for (std::size_t i = document.nodes.size(); i-- > 0;) {
    const std::int32_t parent = document.nodes[i].parent;
    (parent < 0 ? open : children[static_cast<std::size_t>(parent)]).push_back(i);
  }
  std::string text;
  std::vector<std::size_t> depths(document.nodes.size(), 0);
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    const CadNode& node = document.nodes[i];
    text +=
        fmt::format("  {}{}{}", text.empty() ? "tree        " : "            ",
                    std::string(2 * depths[i], ' '), node.name.empty() ? "(unnamed)" : oneLine(node.name));
    if (node.shape >= 0) {
      const PartGeometryPtr& shape = document.shapes[static_cast<std::size_t>(node.shape)];
      text += shape != nullptr ? "  = " + oneLine(shape->shapeKey) : std::string("  (left out)");
    }
    text += "\n";
    for (const std::size_t child : children[i]) {
      depths[child] = depths[i] + 1;
      open.push_back(child);
    }
  }
  return text;
}

Json pointOf(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

Json shapeJson(const PartGeometry& shape, std::size_t uses, std::optional<double> density) {
  Json json;
  json["key"] = shape.shapeKey;
  json["instances"] = uses;
  json["triangles"] = shape.mesh.triangles().size();
  json["vertices"] = shape.mesh.vertices().size();
  json["closed"] = shape.mesh.topology().isClosed();
  json["oriented"] = shape.mesh.topology().isOriented();
  json["components"] = shape.mesh.topology().components;
  json["faces"] = shape.surfaces != nullptr ? shape.surfaces->faces.size() : 0;
  json["exact"] = shape.isExact;
  json["chord"] = shape.effectiveTessellation.chord;
  json["angle"] = shape.effectiveTessellation.angle;
  json["bounds"] = {{"lower", pointOf(shape.mesh.bounds().lower)},
                    {"upper", pointOf(shape.mesh.bounds().upper)}};
  json["volume"] = shape.mass.volume;
  json["exactVolume"] = shape.exactVolume > 0.0 ? Json(shape.exactVolume) : Json();
  json["centre"] = pointOf(shape.mass.centre);
  if (density) json["mass"] = *density * shape.mass.volume;
  json["warnings"] = shape.report.warnings;
  return json;
}

Json nodeJson(const CadNode& node, const LoadedDocument& document) {
  const glm::dquat& q = node.parentFromNode.rotation;
  Json json;
  json["name"] = node.name;
  json["parent"] = node.parent >= 0 ? Json(node.parent) : Json();
  const PartGeometryPtr shape =
      node.shape >= 0 ? document.shapes[static_cast<std::size_t>(node.shape)] : nullptr;
  json["shape"] = shape != nullptr ? Json(shape->shapeKey) : Json();
  json["position"] = pointOf(node.parentFromNode.translation);
  json["quaternion"] = {q.w, q.x, q.y, q.z};
  json["colour"] = node.colour ? Json(*node.colour) : Json();
  return json;
}

}  // namespace

std::string documentText(const std::string& name, const LoadedDocument& document,
                         std::optional<double> density) {
  const PartGeometry& any = anyShapeOf(document);
  const Totals totals = totalsOf(document);
  std::string text = fmt::format(
      "{}\n"
      "  unit        {}\n"
      "  parts       {} of {} shape{}\n"
      "  triangles   {} of the shapes, {} with each instance\n",
      oneLine(name), any.hasOwnUnit ? "the file's own" : fmt::format("{} m, as given", any.metresPerUnit),
      totals.parts, totals.shapes, totals.shapes == 1 ? "" : "s", totals.triangles, totals.placedTriangles);
  const std::vector<std::size_t> uses = usesOf(document);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (document.shapes[i] != nullptr) text += shapeText(*document.shapes[i], uses[i], density);
  }
  text += treeText(document);
  text += fmt::format("  read        {}\n  SHA-256     {}\n",
                      document.isFromCache ? "from the cache" : "by nearfit-import", any.sha256);
  for (const std::string& warning : document.warnings)
    text += "  warning     " + oneLine(warning) + "\n";
  return text;
}

Json documentJson(const std::string& name, const LoadedDocument& document, std::optional<double> density) {
  const PartGeometry& any = anyShapeOf(document);
  const Totals totals = totalsOf(document);
  Json json;
  json["file"] = isUtf8(name) ? name : printableText(name);
  json["sha256"] = any.sha256;
  json["hasUnit"] = any.hasOwnUnit;
  json["metresPerUnit"] = any.metresPerUnit;
  json["parts"] = totals.parts;
  json["triangles"] = {{"shapes", totals.triangles}, {"placed", totals.placedTriangles}};
  json["shapes"] = Json::array();
  const std::vector<std::size_t> uses = usesOf(document);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (document.shapes[i] != nullptr)
      json["shapes"].push_back(shapeJson(*document.shapes[i], uses[i], density));
  }
  json["nodes"] = Json::array();
  for (const CadNode& node : document.nodes)
    json["nodes"].push_back(nodeJson(node, document));
  json["from"] = document.isFromCache ? "cache" : "importing";
  json["warnings"] = document.warnings;
  return json;
}

}  // namespace nearfit::cli
