#include "app/import/document_builder.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/import/document_file.h"
#include "core/text/utf8.h"

namespace nearfit::importer {
namespace {

std::string fromLatin1(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xC0U | (code >> 6));
      utf8 += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  return utf8;
}

bool isSpace(char c) {
  const auto code = static_cast<unsigned char>(c);
  return code <= ' ' || code == 0x7F;
}

std::string trimmed(const std::string& text) {
  const auto begin = std::ranges::find_if_not(text, isSpace);
  const auto end = std::find_if_not(text.rbegin(), text.rend(), isSpace).base();
  return begin < end ? std::string(begin, end) : std::string();
}

}  // namespace

std::string cleanName(std::string_view text) {
  // Longer ones are cut before any work goes into them; Latin-1 grows to twice its size.
  std::string name = isUtf8(text) ? truncatedUtf8(text, 4 * kMaxNodeNameBytes)
                                  : fromLatin1(text.substr(0, 2 * kMaxNodeNameBytes));
  std::ranges::replace_if(name, isSpace, ' ');
  if (!isPrintableUtf8(name)) name = printableText(name);
  return trimmed(truncatedUtf8(trimmed(name), kMaxNodeNameBytes));
}

std::string withoutFullStop(std::string sentence) {
  if (sentence.ends_with('.')) sentence.pop_back();
  return sentence;
}

void addWarning(std::vector<std::string>& warnings, const std::string& text) {
  if (warnings.size() + 1 == kMaxWarnings)
    warnings.emplace_back("There are more warnings, which are left out.");
  if (warnings.size() >= kMaxWarnings) return;
  warnings.push_back(truncatedUtf8(printableText(text), kMaxWarningBytes));
}

void DocumentBuilder::failTooLarge(const std::string& problem) const {
  throw FileError(job_.file.string(), problem, "open a part of the assembly, or export it flatter");
}

std::int32_t DocumentBuilder::addNode(CadNode node) {
  if (document_.nodes.size() >= kMaxDocumentNodes)
    failTooLarge(fmt::format("its assembly has more than {} nodes", kMaxDocumentNodes));
  const std::size_t level = node.parent < 0 ? 1 : levels_[static_cast<std::size_t>(node.parent)] + 1;
  if (level > kMaxDocumentDepth)
    failTooLarge(fmt::format("its assemblies are nested more than {} levels deep", kMaxDocumentDepth));
  levels_.push_back(level);
  if (node.name.empty()) node.name = cleanName(fmt::format("{} {}", cleanName(job_.stem), ++unnamed_));
  document_.nodes.push_back(std::move(node));
  return static_cast<std::int32_t>(document_.nodes.size()) - 1;
}

std::int32_t DocumentBuilder::addShape(const std::string& name) {
  if (document_.shapes.size() >= kMaxDocumentNodes)
    failTooLarge(fmt::format("it has more than {} shapes", kMaxDocumentNodes));
  const std::string stem =
      name.empty() ? "shape" : truncatedUtf8(printableText(name), kMaxDocumentKeyBytes - 32);
  std::string key = stem;
  while (!keys_.insert(key).second)
    key = fmt::format("{} ({})", stem, ++nextNumber_.try_emplace(stem, 1).first->second);
  document_.shapes.emplace_back().key = std::move(key);
  return static_cast<std::int32_t>(document_.shapes.size()) - 1;
}

void DocumentBuilder::setShape(std::int32_t shape, CadShape content) {
  CadShape& place = document_.shapes[static_cast<std::size_t>(shape)];
  content.key = std::move(place.key);
  place = std::move(content);
}

void DocumentBuilder::warn(const std::string& text) {
  addWarning(document_.warnings, text);
}

void DocumentBuilder::dropEmpty() {
  constexpr std::int32_t kDropped = -1;
  std::vector<std::int32_t> shapeAt(document_.shapes.size(), kDropped);
  std::vector<CadShape> shapes;
  for (std::size_t i = 0; i < document_.shapes.size(); ++i) {
    if (document_.shapes[i].triangles.empty()) continue;
    shapeAt[i] = static_cast<std::int32_t>(shapes.size());
    shapes.push_back(std::move(document_.shapes[i]));
  }
  document_.shapes = std::move(shapes);
  // Children come after their parents: from the back, each node knows by then if it holds something.
  std::vector<CadNode>& nodes = document_.nodes;
  std::vector<bool> holdsShape(nodes.size(), false);
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (nodes[i].shape >= 0 && shapeAt[static_cast<std::size_t>(nodes[i].shape)] != kDropped)
      holdsShape[i] = true;
    if (holdsShape[i] && nodes[i].parent >= 0) holdsShape[static_cast<std::size_t>(nodes[i].parent)] = true;
  }
  std::vector<std::int32_t> nodeAt(nodes.size(), kDropped);
  std::vector<CadNode> kept;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!holdsShape[i]) continue;
    nodeAt[i] = static_cast<std::int32_t>(kept.size());
    CadNode node = std::move(nodes[i]);
    if (node.parent >= 0) node.parent = nodeAt[static_cast<std::size_t>(node.parent)];
    if (node.shape >= 0) node.shape = shapeAt[static_cast<std::size_t>(node.shape)];
    kept.push_back(std::move(node));
  }
  nodes = std::move(kept);
}

CadDocument DocumentBuilder::take() {
  dropEmpty();
  if (document_.shapes.empty()) {
    if (!job_.onlyShapes.empty()) {
      throw FileError(job_.file.string(), "it does not hold the shapes that were asked for any more",
                      "import the whole file again");
    }
    const std::string reason =
        document_.warnings.empty() ? std::string() : " (" + withoutFullStop(document_.warnings.front()) + ")";
    throw FileError(job_.file.string(), "it holds no solids, shells or meshes that can be read" + reason,
                    hasTrianglesOnly_ ? "export it again, with meshes whose coordinates are all finite"
                                      : "export the parts as solids");
  }
  return std::move(document_);
}

}  // namespace nearfit::importer
