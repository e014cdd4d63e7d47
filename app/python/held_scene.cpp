#include <algorithm>
#include <cstddef>
#include <iterator>

#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"

namespace nearfit::python {
namespace {

/// Parts whose queries a scene keeps: as many as a script asks about by turns. Each keeps some 20 MB of work space for each
/// thread, and an entry for each part of the scene.
constexpr std::size_t kMaxKeptQueries = 4;

}  // namespace

void HeldScene::set(Scene scene) {
  scene_ = std::move(scene);
  kept_.clear();
}

// The scene is changed in place: a copy of it for each part that is added makes a scene of many parts slow. What is kept
// is forgotten first: it is made anew if the change is refused.

const Part& HeldScene::add(Part added) {
  kept_.clear();
  return scene_.get(scene_.add(std::move(added)));
}

void HeldScene::remove(const std::string& name) {
  const PartId id = part(name).id;
  kept_.clear();
  scene_.remove(id);
}

void HeldScene::show(const std::string& name, bool isVisible) {
  Part shown = part(name);
  shown.isVisible = isVisible;
  kept_.clear();
  scene_.replace(std::move(shown));
}

void HeldScene::setPose(const std::string& name, const RigidTransform& worldFromPart) {
  Part moved = part(name);
  moved.worldFromPart = worldFromPart;
  scene_.replace(std::move(moved));
  // A part's own pose does not affect queries about it.
  std::erase_if(kept_, [&name](const KeptQueries& kept) { return kept.part != name; });
}

const Part& HeldScene::part(const std::string& name) const {
  if (const Part* part = scene_.findByName(name)) return *part;
  std::string names;
  for (const Scene::PartPtr& part : scene_.parts())
    names += (names.empty() ? "" : ", ") + part->name;
  throw UsageError("scene", "there is no part \"" + name + "\"",
                   names.empty() ? "the scene has no parts" : "its parts are " + names);
}

std::shared_ptr<PartQueries> HeldScene::queries(const std::string& name) {
  if (const auto kept = std::ranges::find(kept_, name, &KeptQueries::part); kept != kept_.end()) {
    std::rotate(kept_.begin(), kept, std::next(kept));
    return kept_.front().queries;
  }
  const PartId id = part(name).id;
  // A copy: the scene may change while the lock is not held.
  const Scene scene = scene_;
  const auto made = withoutLock(
      [&](const ProgressCallback& progress) { return std::make_shared<PartQueries>(scene, id, progress); });
  // Not kept if the scene has changed meanwhile.
  if (scene_.parts() != scene.parts()) return made;
  // Another thread may have made them too.
  std::erase_if(kept_, [&name](const KeptQueries& kept) { return kept.part == name; });
  if (kept_.size() == kMaxKeptQueries) kept_.pop_back();
  kept_.insert(kept_.begin(), {.part = name, .queries = made});
  return made;
}

}  // namespace nearfit::python
