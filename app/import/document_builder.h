#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "app/import/import_job.h"

namespace nearfit::importer {

/// A text of a file as a name: UTF-8 on one line, without spaces around it, not too long. Bytes that are no UTF-8 are
/// taken as Latin-1, which older programs write.
std::string cleanName(std::string_view text);

/// Collects a document within the limits of core/import/document_file.h.
class DocumentBuilder {
 public:
  /// @param job  Kept by reference.
  explicit DocumentBuilder(const ImportJob& job) : job_(job) { document_.sha256 = job.sha256; }

  /// Adds a node whose parent is there already, and returns its index. An empty name becomes the file's with a number.
  /// Throws FileError if there are too many, or they are nested too deep.
  std::int32_t addNode(CadNode node);
  /// A place for a shape that comes later, with a key made from `name`; returns its index. A name repeats where two
  /// products have the same one: later ones get a number, in the order of the file.
  std::int32_t addShape(const std::string& name);
  const std::string& keyOf(std::int32_t shape) const {
    return document_.shapes[static_cast<std::size_t>(shape)].key;
  }
  bool isWanted(std::int32_t shape) const { return job_.wants(keyOf(shape)); }
  /// Sets the shape of a place; the key stays. Without triangles it is left out, with its nodes.
  void setShape(std::int32_t shape, CadShape content);
  void setHasUnit(bool hasUnit) { document_.hasUnit = hasUnit; }
  void setStatedUnit(double metresPerUnit) { document_.statedUnit = metresPerUnit; }
  /// The document holds triangles instead of exact surfaces, which decides what can be done about an empty one.
  void setHasTrianglesOnly() { hasTrianglesOnly_ = true; }
  /// A warning, as a sentence.
  void warn(const std::string& text);

  /// The document without shapes that have no triangles, and groups of nothing else. Throws FileError if nothing is left.
  CadDocument take();

 private:
  [[noreturn]] void failTooLarge(const std::string& problem) const;
  void dropEmpty();

  const ImportJob& job_;
  CadDocument document_;
  std::vector<std::size_t> levels_;  ///< Of each node; 1 at the top.
  std::size_t unnamed_ = 0;
  bool hasTrianglesOnly_ = false;
  std::unordered_set<std::string> keys_;
  std::unordered_map<std::string, std::size_t> nextNumber_;  ///< For keys that repeat.
};

/// A sentence as a part of another one: without its full stop.
std::string withoutFullStop(std::string sentence);

/// Adds a warning to a list that may be full, cut to its limit.
void addWarning(std::vector<std::string>& warnings, const std::string& text);

}  // namespace nearfit::importer
