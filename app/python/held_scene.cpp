#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"

namespace nearfit::python {

void HeldScene::set(Scene scene) {
  scene_ = std::move(scene);
  queries_.clear();
}

void HeldScene::setPose(const std::string& name, const RigidTransform& worldFromPart) {
  Part moved = part(name);
  moved.worldFromPart = worldFromPart;
  scene_.replace(std::move(moved));
  // A part's own pose does not affect queries about it.
  std::erase_if(queries_, [&name](const auto& kept) { return kept.first != name; });
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
  if (const auto kept = queries_.find(name); kept != queries_.end()) return kept->second;
  const PartId id = part(name).id;
  // A copy: the scene may change while the lock is not held.
  const Scene scene = scene_;
  const auto made = withoutLock(
      [&](const ProgressCallback& progress) { return std::make_shared<PartQueries>(scene, id, progress); });
  const Part* const now = scene_.findByName(name);
  // Not kept if the scene has changed meanwhile.
  if (now != nullptr && scene_.parts() == scene.parts()) queries_[name] = made;
  return made;
}

}  // namespace nearfit::python
