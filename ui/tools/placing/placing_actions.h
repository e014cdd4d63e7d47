#pragma once

#include <QKeySequence>
#include <QObject>

#include "core/placing/gizmo.h"
#include "core/placing/gizmo_drag.h"

class QAction;
class QMainWindow;
class QMenu;
class QToolBar;

namespace nearfit::ui {

class NumberField;

/// Actions, menu and toolbar for placing by hand. Keeps the choices between runs. Knows the
/// choices, not their effects.
class PlacingActions : public QObject {
  Q_OBJECT

 public:
  explicit PlacingActions(QObject* parent);

  QAction *noGizmo, *move, *turn, *moveAndTurn;
  QAction *localAxes, *snap, *solid;
  QAction *movePivot, *pivotAtMass, *pivotAtBox;

  /// Adds the actions to a menu.
  void addTo(QMenu& menu);
  /// Makes the toolbar; `window` becomes its parent. Call once.
  QToolBar* makeToolBar(QMainWindow& window);

  /// Returns the gizmo mode chosen; without regard to movePivot.
  GizmoMode mode() const;
  /// Returns the steps chosen for shifts and turns, whether snapping is on or not.
  SnapSteps steps() const;

 signals:
  /// Emitted when mode, axes, snapping, steps, solidity or movePivot has changed.
  void changed();

 private:
  QAction* make(const char* name, const QString& text, const char* iconName, const QKeySequence& keys,
                const QString& tip);
  QAction* makeSwitch(const char* name, const QString& text, const char* iconName, const QKeySequence& keys,
                      const QString& tip);
  void makeModes();
  void makeSwitches();
  void makePivotActions();
  void makeSteps();
  NumberField* makeStep(const char* name, const QString& label);
  void restore();
  void remember() const;

  NumberField *lengthStep_ = nullptr, *angleStep_ = nullptr;
};

}  // namespace nearfit::ui
