#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/import/cad_document.h"
#include "core/import/companion_files.h"

namespace nearfit::importer {

/// Collects the companions of a document, by which the program knows again what it has imported.
class CompanionList {
 public:
  /// Adds a file, before it is read and once more afterwards: if it changes meanwhile, or cannot be hashed, or there are
  /// too many, the list is incomplete.
  void add(const std::string& name, const FoundFile& found);
  void setIncomplete() noexcept { isComplete_ = false; }
  void giveTo(CadDocument& document) &&;

 private:
  std::vector<CadCompanion> companions_;
  std::unordered_map<std::string, std::size_t> indexOf_;
  bool isComplete_ = true;
};

}  // namespace nearfit::importer
