#pragma once

#include <QWidget>
#include <memory>

#include <vtkRenderer.h>

#include "core/haptics/servo_snapshot.h"
#include "core/scene/scene.h"
#include "ui/contact_glyphs.h"
#include "ui/hand_ghost.h"
#include "ui/minima/lmd_overlay.h"
#include "ui/wrench_arrows.h"

namespace nearfit::ui {

class ColourLegend;

/// What is drawn beside the parts of a servo snapshot: minima, contacts, force and torque, the hand, and the
/// legend that says in numbers what the glyphs show. All follow one snapshot.
class SnapshotGlyphs {
 public:
  /// All outlive this. @param parts  Where the hand's ghost stands. @param view  Has the legend in its
  /// corner.
  SnapshotGlyphs(vtkRenderer& parts, vtkRenderer& overlay, QWidget& view);

  /// @param cutoff  Distance that gets the last colour [m]; > 0.
  /// @param moving  The part in hand; null: there is none.
  void show(const ServoSnapshot& snapshot, double cutoff, const Part* moving);
  /// The numbers become those of the glyphs: just before these are drawn, or they would be ahead of them.
  void showNumbers(const ServoSnapshot& snapshot);
  void clear();
  /// As of the scene, before any snapshot.
  void setCutoff(double cutoff);
  /// After the view has another size.
  void placeLegend();

  HandGhost& hand() noexcept { return hand_; }
  LmdOverlay& minima() noexcept { return minima_; }
  ContactGlyphs& contacts() noexcept { return contacts_; }
  WrenchArrows& arrows() noexcept { return arrows_; }

 private:
  QWidget& view_;
  HandGhost hand_;
  LmdOverlay minima_;
  ContactGlyphs contacts_;
  WrenchArrows arrows_;
  ColourLegend* legend_;
};

}  // namespace nearfit::ui
