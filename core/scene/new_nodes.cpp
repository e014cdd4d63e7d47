#include "core/scene/new_nodes.h"

#include <map>
#include <utility>

namespace nearfit {
namespace {

/// A colour for each part, the same for all of a geometry.
std::vector<Colour> coloursOf(const Scene& scene, const std::vector<NewNodes::NewPart>& parts) {
  std::map<PartGeometryPtr, std::size_t> indexOf;
  std::vector<std::size_t> indices;
  for (const NewNodes::NewPart& part : parts)
    indices.push_back(part.colour ? 0 : indexOf.emplace(part.geometry, indexOf.size()).first->second);
  const std::vector<Colour> palette = scene.nextColours(indexOf.size());
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < parts.size(); ++i)
    colours.push_back(parts[i].colour ? *parts[i].colour : palette[indices[i]]);
  return colours;
}

}  // namespace

void NewNodes::append(NewNodes others) {
  const std::size_t before = groups.size();
  for (NewGroup& group : others.groups) {
    if (group.parent) *group.parent += before;
    groups.push_back(std::move(group));
  }
  for (NewPart& part : others.parts) {
    if (part.group) *part.group += before;
    parts.push_back(std::move(part));
  }
}

SceneNodes addTo(Scene& scene, const NewNodes& nodes) {
  SceneNodes top;
  TakenNames names(kMaxGroupNameBytes);
  for (const Scene::GroupPtr& group : scene.groups())
    names.add(group->name);
  std::vector<GroupId> ids;
  for (const NewNodes::NewGroup& each : nodes.groups) {
    Group group;
    group.name = each.parent ? each.name : names.takeFree(each.name);
    if (each.parent) group.parent = ids.at(*each.parent);
    ids.push_back(scene.addGroup(std::move(group)));
    if (!each.parent) top.groups.push_back(ids.back());
  }
  const std::vector<Colour> colours = coloursOf(scene, nodes.parts);
  std::vector<Part> parts(nodes.parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const NewNodes::NewPart& each = nodes.parts[i];
    parts[i].name = each.name;
    parts[i].geometry = each.geometry;
    parts[i].worldFromPart = each.worldFromPart;
    parts[i].colour = colours[i];
    if (each.group) parts[i].group = ids.at(*each.group);
  }
  const std::vector<PartId> added = scene.addAll(std::move(parts));
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (!nodes.parts[i].group) top.parts.push_back(added[i]);
  }
  return top;
}

}  // namespace nearfit
