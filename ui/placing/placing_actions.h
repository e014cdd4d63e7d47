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

/// What is chosen about placing by hand: actions, their menu and their toolbar. What is chosen is remembered
/// from run to run. Knows what can be chosen, not what comes of it.
class PlacingActions : public QObject {
  Q_OBJECT

 public:
  explicit PlacingActions(QObject* parent);

  QAction *noGizmo, *move, *turn, *moveAndTurn;
  QAction *localAxes, *snap, *solid;
  QAction *movePivot, *pivotAtMass, *pivotAtBox;

  void addTo(QMenu& menu);
  QToolBar* makeToolBar(QMainWindow& window);

  GizmoMode mode() const;
  /// Of shifts and turns, whether they are on or not.
  SnapSteps steps() const;

 signals:
  /// Of mode, axes, snapping, steps or solidity.
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
