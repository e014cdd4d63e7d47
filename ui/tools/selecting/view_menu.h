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

/// The view's context menu, for a right click without a drag and the menu key. Offers what can be done with
/// the clicked part; selects it if it is not selected. A right drag controls the view.
class ViewMenu : public QObject {
  Q_OBJECT

 public:
  /// @param selection, view  Outlive this.
  /// @param ofParts    Actions for the selected parts.
  /// @param ofNothing  Actions for a click beside all parts.
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
