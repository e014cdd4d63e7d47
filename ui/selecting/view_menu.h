#pragma once

#include <QList>
#include <QObject>
#include <QPoint>
#include <optional>

class QAction;
class QMouseEvent;

namespace nearfit::ui {

class Selection;
class Viewport;

/// The context menu of the view, for a right click that drags nothing, or the menu key: what can be done with
/// the part that is clicked, which is selected where it is not yet. A right drag is the view's.
class ViewMenu : public QObject {
  Q_OBJECT

 public:
  /// @param selection, view  Outlive this.
  /// @param ofParts   Actions for what is selected.
  /// @param ofNothing  Those for a click beside all parts.
  ViewMenu(Selection& selection, Viewport& view, QList<QAction*> ofParts, QList<QAction*> ofNothing,
           QObject* parent);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void press(const QMouseEvent& event);
  void release(const QMouseEvent& event);
  void openAt(const QPoint& position);
  void popUp(const QList<QAction*>& actions, const QPoint& position);

  Selection& selection_;
  Viewport& view_;
  QList<QAction*> ofParts_, ofNothing_;
  std::optional<QPoint> pressedAt_;
};

}  // namespace nearfit::ui
