#pragma once

#include <QFrame>

class QAction;

namespace nearfit::ui {

/// A card in the middle of its parent that offers ways to begin while the scene is empty.
class WelcomeCard : public QFrame {
  Q_OBJECT

 public:
  /// @param tour  Starts the tour of the window.
  WelcomeCard(QAction* openDemo, QAction* tour, QAction* addParts, QAction* open, QWidget* parent);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void addButton(QAction* action, bool isMain);
  void centre();
};

}  // namespace nearfit::ui
