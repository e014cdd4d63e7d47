#pragma once

#include <QFrame>
#include <QPointer>
#include <vector>

class QLabel;
class QPushButton;

namespace nearfit::ui {

/// Callouts that say in turn what the parts of a window are for; each can be passed over, and all be left.
class Tour : public QFrame {
  Q_OBJECT

 public:
  struct Stop {
    QPointer<QWidget> where;  ///< One that is not shown is passed over.
    QString title, text;
  };

  explicit Tour(QWidget* window);

  void begin(std::vector<Stop> stops);

 signals:
  void ended();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void show(std::size_t stop);
  void next();
  void end();
  void place();

  std::vector<Stop> stops_;
  std::size_t current_ = 0;
  QLabel *title_, *text_, *count_;
  QPushButton *next_, *leave_;
  QFrame* frame_;  ///< Around what is spoken of.
};

}  // namespace nearfit::ui
