#include "app/import/companion_list.h"

#include <utility>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/mesh_file_check.h"

namespace nearfit::importer {

void CompanionList::add(const std::string& name, const FoundFile& found) {
  if (!found.problem.empty() || !isCompanionName(name)) isComplete_ = false;
  if (!isComplete_) return;
  try {
    checkMeshFile(found.path);
    const std::string sha256 = sha256OfFile(found.path);
    const auto [at, isNew] = indexOf_.try_emplace(name, companions_.size());
    if (isNew) {
      isComplete_ = companions_.size() < kMaxCompanions;
      companions_.push_back({name, sha256});
    } else {
      isComplete_ = companions_[at->second].sha256 == sha256;
    }
  } catch (const FileError&) {
    isComplete_ = false;
  }
}

void CompanionList::giveTo(CadDocument& document) && {
  document.areCompanionsKnown = isComplete_;
  document.companions = isComplete_ ? std::move(companions_) : std::vector<CadCompanion>();
}

}  // namespace nearfit::importer
