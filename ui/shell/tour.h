#pragma once

#include <QFrame>
#include <QPointer>
#include <vector>

class QLabel;
class QPushButton;

namespace nearfit::ui {

/// Callouts that explain the parts of a window one by one. The user can pass over each, or leave the tour: by Return and
/// Escape, also after a click into the view.
class Tour : public QFrame {
  Q_OBJECT

 public:
  struct Stop {
    QPointer<QWidget> where;  ///< Passed over if it is not visible.
    QString title, text;
  };

  explicit Tour(QWidget* window);

  /// Starts at the first visible stop; no-op if there is none.
  void begin(std::vector<Stop> stops);
  /// Ends the tour; no-op if there is none.
  void end();

 signals:
  /// Emitted when the tour ends, completed or not.
  void ended();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void show(std::size_t stop);
  void next();
  /// Ends the tour or goes on by a key for another widget of the window; false if the key is not for the tour.
  bool takeKey(const QWidget& receiver, int key);
  void place();

  std::vector<Stop> stops_;
  std::size_t current_ = 0;
  QLabel *title_, *text_, *count_;
  QPushButton *next_, *leave_;
  QFrame* frame_;  ///< Frames what the callout is about.
};

}  // namespace nearfit::ui
