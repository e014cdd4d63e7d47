#pragma once

#include <QList>
#include <QMenu>
#include <QObject>

#include "core/session/scene_events.h"
#include "ui/view3d/glyphs/minima_choice.h"

class QAction;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class FeelingView;
class Selection;
class Viewport;

/// Menu of what the view draws of minima: segments, points, normals, how many, how near, and the range of their
/// colours. Kept between runs.
class MinimaMenu : public QMenu {
  Q_OBJECT

 public:
  explicit MinimaMenu(QWidget* parent);

  const MinimaChoice& choice() const noexcept { return choice_; }

 signals:
  /// Emitted when the user has changed the choice.
  void choiceChanged(const nearfit::ui::MinimaChoice& choice);

 private:
  void addForm(const QString& name, const QString& text, const QString& toolTip, bool MinimaChoice::* form);
  QMenu* addChoices(const QString& title);
  void addColours();
  void chooseColours();
  /// Shows the chosen range of colours in its menu.
  void showColours();
  template <class Number>
  void addNumber(QMenu& menu, const QString& name, const QString& text, Number MinimaChoice::* number,
                 Number value);
  template <class Value>
  void set(Value MinimaChoice::* member, Value value);
  void choose(const MinimaChoice& choice);

  MinimaChoice choice_;
  QAction *automaticColours_ = nullptr, *chosenColours_ = nullptr;
};

/// What the user can choose about the view: where it looks from, and what it draws besides the parts.
class ViewActions : public QObject {
  Q_OBJECT

 public:
  /// @param session, selection, view  Outlive this.
  /// @param window                    Becomes the parent.
  ViewActions(Session& session, Selection& selection, Viewport& view, QWidget* window);

  QAction *fit, *fitSelection;
  QAction *orthographic, *scaleBar;  ///< Switches that are kept between runs.

  /// Returns the actions that turn to a standard view.
  const QList<QAction*>& views() const noexcept { return views_; }
  /// Returns the switches of what is drawn.
  const QList<QAction*>& switches() const noexcept { return switches_; }
  /// Returns the menu of what is drawn of minima.
  QMenu* minimaMenu() const noexcept;
  /// Returns what is chosen about pictures while a part is felt.
  const FeelingView& feeling() const noexcept { return *feeling_; }

 private:
  void setUpLooking();
  void setUpDrawing();
  void setUpKeptSwitches();
  void update();

  Session& session_;
  Selection& selection_;
  Viewport& view_;
  MinimaMenu* minima_;
  FeelingView* feeling_;
  QList<QAction*> views_, switches_;
  Subscription changes_;
};

}  // namespace nearfit::ui
