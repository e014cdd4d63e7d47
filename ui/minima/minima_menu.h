#pragma once

#include <QMenu>
#include <vector>

#include "ui/minima/minima_choice.h"

namespace nearfit::ui {

/// The choice of what the view draws of minima: segments, points, normals, how many of the nearest and how
/// near. Remembered from one run to the next.
class MinimaMenu : public QMenu {
  Q_OBJECT

 public:
  explicit MinimaMenu(QWidget* parent);

  const MinimaChoice& choice() const noexcept { return choice_; }

 signals:
  void choiceChanged(const nearfit::ui::MinimaChoice& choice);

 private:
  void addForm(const QString& name, const QString& text, bool MinimaChoice::*form);
  QMenu* addChoices(const QString& title);
  void addMost(QMenu& menu, std::size_t most);
  void addNearerThan(QMenu& menu, int percent);
  void choose(const MinimaChoice& choice);

  MinimaChoice choice_;
};

}  // namespace nearfit::ui
