#pragma once

#include <QMenu>

#include "ui/view3d/glyphs/minima_choice.h"

namespace nearfit::ui {

/// Menu of what the view draws of minima: segments, points, normals, how many and how
/// near. Kept between runs.
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
  template <class Number>
  void addNumber(QMenu& menu, const QString& name, const QString& text, Number MinimaChoice::* number,
                 Number value);
  template <class Value>
  void set(Value MinimaChoice::* member, Value value);
  void choose(const MinimaChoice& choice);

  MinimaChoice choice_;
};

}  // namespace nearfit::ui
