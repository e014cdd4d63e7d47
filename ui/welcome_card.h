#pragma once

#include <QFrame>

class QAction;

namespace nearfit::ui {

/// What an empty scene offers to begin with, in the middle of its parent.
class WelcomeCard : public QFrame {
  Q_OBJECT

 public:
  /// @param tour  Explains the window.
  WelcomeCard(QAction* openDemo, QAction* tour, QAction* addParts, QAction* open, QWidget* parent);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void addButton(QAction* action, bool isMain);
  void centre();
};

}  // namespace nearfit::ui
