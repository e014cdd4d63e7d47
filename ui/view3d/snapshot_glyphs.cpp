#include "ui/view3d/snapshot_glyphs.h"

#include <span>

#include "ui/view3d/glyphs/colour_legend.h"
#include "ui/view3d/view_picture.h"

namespace nearfit::ui {

SnapshotGlyphs::SnapshotGlyphs(vtkRenderer& parts, vtkRenderer& overlay, QWidget& view)
    : view_(view),
      hand_(parts, overlay),
      minima_(overlay),
      contacts_(overlay),
      arrows_(overlay),
      legend_(new ColourLegend(&view)) {
  setInPictures(*legend_);
  legend_->hide();
}

void SnapshotGlyphs::show(const ServoSnapshot& snapshot, double cutoff, const Part* moving) {
  const double size = moving != nullptr ? moving->geometry->mesh.bounds().diagonal() : 0.0;
  minima_.show(std::span(snapshot.lmds).first(snapshot.storedLmds), cutoff);
  arrows_.show(snapshot.centre, snapshot.wrench, size);
  contacts_.show(std::span(snapshot.contacts).first(snapshot.storedContacts), size);
  hand_.show(snapshot, size);
}

void SnapshotGlyphs::showNumbers(const ServoSnapshot& snapshot) {
  legend_->showSnapshot(snapshot);
  placeLegend();
  legend_->show();
}

void SnapshotGlyphs::clear() {
  minima_.clear();
  arrows_.clear();
  contacts_.clear();
  hand_.clear();
  legend_->hide();
}

void SnapshotGlyphs::setCutoff(double cutoff) {
  legend_->setCutoff(cutoff);
}

void SnapshotGlyphs::placeLegend() {
  constexpr int kMargin = 14;
  legend_->move(kMargin, view_.height() - legend_->height() - kMargin);
}

}  // namespace nearfit::ui
