#pragma once

#include <QWidget>
#include <memory>

#include <vtkRenderer.h>

#include "core/scene/scene.h"
#include "core/servo/servo_snapshot.h"
#include "ui/view3d/glyphs/contact_glyphs.h"
#include "ui/view3d/glyphs/hand_ghost.h"
#include "ui/view3d/glyphs/lmd_overlay.h"
#include "ui/view3d/glyphs/wrench_arrows.h"

namespace nearfit::ui {

class ColourLegend;

/// Draws a servo snapshot beside its parts: minima, contacts, force and torque, the hand's ghost, and the
/// legend with their numbers.
class SnapshotGlyphs {
 public:
  /// @param parts    Draws the ghost's copy of the part; outlives this.
  /// @param overlay  Draws all other glyphs over the parts; outlives this.
  /// @param view     Gets the legend, at first in its lower left corner; outlives this.
  SnapshotGlyphs(vtkRenderer& parts, vtkRenderer& overlay, QWidget& view);

  /// Shows the glyphs of a snapshot.
  /// @param settings  Of the scene.
  /// @param size      Diagonal of what is in hand [m]; 0 if nothing is.
  void show(const ServoSnapshot& snapshot, const HapticSettings& settings, double size);
  /// Shows the legend with the snapshot's numbers. Call just before the glyphs are drawn, or the numbers
  /// would be ahead of them.
  void showNumbers(const ServoSnapshot& snapshot);
  /// Hides the legend: there are no numbers.
  void hideNumbers();
  /// Draws all of it paler: it is past.
  void setPast(bool isPast);
  void clear();
  /// Moves the legend to its place; call after the view was resized.
  void placeLegend();
  void setLegendVisible(bool isVisible);

  HandGhost& hand() noexcept { return hand_; }
  LmdOverlay& minima() noexcept { return minima_; }
  ContactGlyphs& contacts() noexcept { return contacts_; }
  WrenchArrows& arrows() noexcept { return arrows_; }

 private:
  HandGhost hand_;
  LmdOverlay minima_;
  ContactGlyphs contacts_;
  WrenchArrows arrows_;
  ColourLegend* legend_;
  bool isLegendWanted_ = true, hasNumbers_ = false;
};

/// True if the view looks the same with both snapshots.
bool looksTheSame(const ServoSnapshot& a, const ServoSnapshot& b);

}  // namespace nearfit::ui
