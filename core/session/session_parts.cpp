// Commands about parts.
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/rotation_vector.h"
#include "core/scene/document_load.h"
#include "core/session/session.h"
#include "core/session/session_labels.h"

namespace nearfit {
namespace {

/// `pose` after the motion from `from` to `to`. A pure translation keeps the rotation bit for bit.
RigidTransform moved(const RigidTransform& pose, const RigidTransform& from, const RigidTransform& to) {
  if (from.rotation == to.rotation)
    return {pose.rotation, pose.translation + (to.translation - from.translation)};
  const glm::dquat turn = to.rotation * glm::conjugate(from.rotation);
  return RigidTransform{turn * pose.rotation, turn * (pose.translation - from.translation) + to.translation}
      .normalized();
}

std::vector<PartId> partsOf(const std::vector<Session::NewGeometry>& renewed) {
  std::vector<PartId> ids;
  ids.reserve(renewed.size());
  for (const Session::NewGeometry& each : renewed)
    ids.push_back(each.part);
  return ids;
}

std::vector<PartId> partsOf(const std::vector<Session::NewPivot>& pivots) {
  std::vector<PartId> ids;
  ids.reserve(pivots.size());
  for (const Session::NewPivot& each : pivots)
    ids.push_back(each.part);
  return ids;
}

std::map<PartId, PartGeometryPtr> byPart(const std::vector<Session::NewGeometry>& renewed) {
  std::map<PartId, PartGeometryPtr> geometries;
  for (const Session::NewGeometry& each : renewed)
    geometries.try_emplace(each.part, each.geometry);
  return geometries;
}

}  // namespace

void Session::change(const std::vector<PartId>& ids, Step verb, SessionCommand command,
                     const std::function<void(Part&)>& change, const std::function<void(Scene&)>& finish) {
  // A script may name a part twice. It changes once: a second move would take it away from the others.
  std::vector<PartId> parts = ids;
  std::ranges::sort(parts);
  parts.erase(std::ranges::unique(parts).begin(), parts.end());
  Scene next = scene();
  SceneNodes changed;
  for (const PartId id : parts) {
    Part part = next.get(id);
    change(part);
    if (isSame(part, *next.find(id))) continue;
    next.replace(std::move(part));
    changed.parts.push_back(id);
  }
  if (changed.isEmpty()) return;
  if (finish) finish(next);
  const std::optional<GroupId> group = scene().movingGroup();
  const bool isWholeGroup =
      group && changed.parts.size() == scene().movingParts().size() &&
      std::ranges::all_of(changed.parts, [&](PartId id) { return scene().isMoving(id); });
  if (isWholeGroup) changed = {{}, {*group}};
  verb.label += " " + nameOf(scene(), changed);
  commit(std::move(next), std::move(verb), std::move(command));
}

void Session::changeUnlocked(const std::vector<PartId>& ids, Step verb, SessionCommand command,
                             const std::function<void(Part&)>& change,
                             const std::function<void(Scene&)>& finish) {
  for (const PartId id : ids)
    scene().requireUnlocked(scene().get(id));
  this->change(ids, std::move(verb), std::move(command), change, finish);
}

void Session::renamePart(PartId id, const std::string& name) {
  Part part = scene().get(id);
  scene().requireUnlocked(part);
  if (part.name == name) return;
  const std::string label = fmt::format("Rename {} to {}", part.name, name);
  part.name = name;
  Scene next = scene();
  next.replace(std::move(part));
  commit(std::move(next), label, steps::RenamePart{id, name});
}

void Session::moveParts(const std::vector<PartId>& ids, PartId lead, const RigidTransform& worldFromLead,
                        const std::string& verb) {
  const Part& before = scene().get(lead);
  const RigidTransform from = before.worldFromPart;
  const RigidTransform to = checkedPose(worldFromLead);
  steps::MoveParts command{ids, lead, worldFromLead, verb};
  if (from == to) {
    // Nothing moves, but locked parts must still be refused.
    return changeUnlocked(ids, verb.c_str(), std::move(command), [](Part&) {});
  }
  const glm::dvec3 centre = before.geometry != nullptr ? before.geometry->mass.centre : glm::dvec3(0.0);
  const double shift = glm::distance(from.applyToPoint(centre), to.applyToPoint(centre));
  const double angle = glm::length(rotationVector(to.rotation * glm::conjugate(from.rotation)));
  changeUnlocked(ids, Step{verb, shift, angle}, std::move(command), [&](Part& part) {
    part.worldFromPart = part.id == lead ? to : moved(part.worldFromPart, from, to);
  });
}

void Session::setVisible(const std::vector<PartId>& ids, bool visible) {
  change(ids, visible ? "Show" : "Hide", steps::SetVisible{ids, visible},
         [visible](Part& part) { part.isVisible = visible; });
}

void Session::setColour(const std::vector<PartId>& ids, const Colour& colour) {
  change(ids, "Recolour", steps::SetColour{ids, colour}, [&colour](Part& part) { part.colour = colour; });
}

void Session::setOpacity(const std::vector<PartId>& ids, double opacity) {
  change(ids, "Change the transparency of", steps::SetOpacity{ids, opacity},
         [opacity](Part& part) { part.opacity = opacity; });
}

void Session::setDensity(const std::vector<PartId>& ids, double density) {
  changeUnlocked(ids, "Change the density of", steps::SetDensity{ids, density},
                 [density](Part& part) { part.density = density; });
}

void Session::setPivots(const std::vector<NewPivot>& pivots) {
  const bool isReset =
      std::ranges::none_of(pivots, [](const NewPivot& each) { return each.inPart.has_value(); });
  std::map<PartId, std::optional<glm::dvec3>> places;
  for (const NewPivot& each : pivots) {
    if (each.inPart) checkPosition(*each.inPart);
    places.try_emplace(each.part, each.inPart);
  }
  changeUnlocked(partsOf(pivots), isReset ? "Reset the pivot of" : "Move the pivot of",
                 steps::SetPivots{pivots}, [&](Part& part) { part.pivot = places.at(part.id); });
}

void Session::reloadParts(const std::vector<NewGeometry>& parts) {
  const std::map<PartId, PartGeometryPtr> geometries = byPart(parts);
  change(partsOf(parts), "Reload", steps::ReloadParts{parts},
         [&](Part& part) { part.geometry = geometries.at(part.id); });
}

void Session::repairParts(const std::vector<NewGeometry>& parts) {
  const std::map<PartId, PartGeometryPtr> geometries = byPart(parts);
  changeUnlocked(partsOf(parts), "Repair", steps::RepairParts{parts},
                 [&](Part& part) { part.geometry = geometries.at(part.id); });
}

void Session::rescaleParts(const std::vector<NewGeometry>& parts) {
  const std::map<PartId, PartGeometryPtr> geometries = byPart(parts);
  const auto factorOf = [&](const Part& part) {
    return geometries.at(part.id)->metresPerUnit / part.geometry->metresPerUnit;
  };
  const auto rescale = [&](Part& part) {
    if (part.pivot) {
      *part.pivot *= factorOf(part);
      checkPosition(*part.pivot);
    }
    // The document places its parts in its unit too. Anything else would tear an assembly apart.
    if (mayBeInWrongUnit(part.geometry->file)) {
      part.worldFromPart.translation *= factorOf(part);
      part.worldFromPart = checkedPose(part.worldFromPart);
    }
    part.geometry = geometries.at(part.id);
  };
  const auto scaleJoints = [&](Scene& next) {
    for (const auto& [id, geometry] : geometries) {
      const Part& before = scene().get(id);
      next.scaleJointsOn(id, factorOf(before));
      // The part has moved about the world's origin; what it is kept on in the world must too.
      if (mayBeInWrongUnit(before.geometry->file)) next.scaleWorldJointsOf(id, factorOf(before));
    }
  };
  changeUnlocked(partsOf(parts), "Change the unit of", steps::RescaleParts{parts}, rescale, scaleJoints);
}

void Session::refineParts(const std::vector<NewGeometry>& parts) {
  const std::map<PartId, PartGeometryPtr> geometries = byPart(parts);
  changeUnlocked(partsOf(parts), "Refine", steps::RefineParts{parts},
                 [&](Part& part) { part.geometry = geometries.at(part.id); });
}

void Session::isolate(const std::vector<PartId>& ids) {
  Scene next = scene();
  next.isolate(ids);
  const bool isSameView = std::ranges::equal(next.parts(), scene().parts(),
                                             [](const auto& a, const auto& b) { return isSame(*a, *b); });
  if (isSameView) return;
  commit(std::move(next), "Isolate " + nameOf(scene(), {ids, {}}), steps::Isolate{ids});
}

void Session::endIsolation() {
  if (!scene().isIsolated()) return;
  Scene next = scene();
  next.endIsolation();
  commit(std::move(next), "End isolation", steps::EndIsolation{});
}

}  // namespace nearfit
