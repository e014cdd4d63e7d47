#include "ui/model/snapshot_look.h"

#include <algorithm>

namespace nearfit::ui {
namespace {

bool isSamePose(const RigidTransform& a, const RigidTransform& b) {
  return a.rotation == b.rotation && a.translation == b.translation;
}

}  // namespace

bool looksTheSame(const ServoSnapshot& a, const ServoSnapshot& b) {
  if (a.moving != b.moving || !isSamePose(a.proxy, b.proxy) || a.storedLmds != b.storedLmds) return false;
  if (!isSamePose(a.handle, b.handle) || a.mode != b.mode || a.contactCount != b.contactCount) return false;
  if (a.storedContacts != b.storedContacts || a.overlappingCount != b.overlappingCount ||
      a.overlapping != b.overlapping)
    return false;
  const auto isSameContact = [](const SnapshotContact& p, const SnapshotContact& q) {
    return p.point == q.point && p.direction == q.direction && p.force == q.force;
  };
  if (!std::equal(a.contacts.begin(), a.contacts.begin() + a.storedContacts, b.contacts.begin(),
                  isSameContact))
    return false;
  if (a.wrench.force != b.wrench.force || a.wrench.torque != b.wrench.torque) return false;
  return std::equal(a.lmds.begin(), a.lmds.begin() + a.storedLmds, b.lmds.begin(),
                    [](const SnapshotLmd& p, const SnapshotLmd& q) {
                      return p.other == q.other && p.lmd.scenePoint == q.lmd.scenePoint &&
                             p.lmd.partPoint == q.lmd.partPoint;
                    });
}

}  // namespace nearfit::ui
