#include "ui/view3d/snapshot_glyphs.h"

#include <algorithm>
#include <span>

#include "ui/view3d/glyphs/colour_legend.h"
#include "ui/view3d/view_picture.h"

namespace nearfit::ui {
namespace {

/// Opacity of glyphs that are past, against that of present ones: seen through, and still told apart by colour.
constexpr double kTrailOpacity = 0.4;
/// Width of the view, over that of the legend, below which the legend would cover what is felt; the panel has its numbers.
constexpr double kLeastRoom = 1.5;

}  // namespace

SnapshotGlyphs::SnapshotGlyphs(vtkRenderer& parts, vtkRenderer& overlay, QWidget& view)
    : hand_(parts, overlay),
      minima_(overlay),
      contacts_(overlay),
      arrows_(overlay),
      legend_(new ColourLegend(&view)) {
  setInPictures(*legend_);
  legend_->hide();
}

void SnapshotGlyphs::show(const ServoSnapshot& snapshot, const HapticSettings& settings, double size) {
  minima_.show(std::span(snapshot.lmds).first(snapshot.storedLmds), settings.springs.cutoff,
               settings.proxy.margin, snapshot.time);
  arrows_.show(snapshot.centre, snapshot.wrench, size);
  contacts_.show(std::span(snapshot.contacts).first(snapshot.storedContacts), size);
  hand_.show(snapshot, size);
}

void SnapshotGlyphs::showNumbers(const ServoSnapshot& snapshot) {
  legend_->setColourRange(minima_.colourRange());
  legend_->showSnapshot(snapshot);
  hasNumbers_ = true;
  placeLegend();
}

void SnapshotGlyphs::hideNumbers() {
  hasNumbers_ = false;
  legend_->hide();
}

void SnapshotGlyphs::setPast(bool isPast) {
  const double share = isPast ? kTrailOpacity : 1.0;
  minima_.setOpacity(share);
  arrows_.setOpacity(share);
  contacts_.setOpacity(share);
  hand_.setOpacity(share);
  legend_->setPast(isPast);
}

void SnapshotGlyphs::clear() {
  minima_.clear();
  arrows_.clear();
  contacts_.clear();
  hand_.clear();
  hideNumbers();
}

void SnapshotGlyphs::placeLegend() {
  legend_->place();
  const bool hasRoom = legend_->parentWidget()->width() >= kLeastRoom * legend_->width();
  legend_->setVisible(isLegendWanted_ && hasNumbers_ && hasRoom);
}

void SnapshotGlyphs::setLegendVisible(bool isVisible) {
  isLegendWanted_ = isVisible;
  placeLegend();
}

bool looksTheSame(const ServoSnapshot& a, const ServoSnapshot& b) {
  if (a.moving != b.moving || a.proxy != b.proxy || a.storedLmds != b.storedLmds) return false;
  if (a.handle != b.handle || a.mode != b.mode || a.contactCount != b.contactCount) return false;
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
