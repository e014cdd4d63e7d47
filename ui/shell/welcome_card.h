#pragma once

#include <QFrame>
#include <QList>

#include "core/session/scene_events.h"

class QAction;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

/// A card in the middle of its parent that offers ways to begin while the scene is empty.
class WelcomeCard : public QFrame {
  Q_OBJECT

 public:
  /// @param session  Outlives this.
  /// @param ways     Actions that begin something, the likeliest first.
  WelcomeCard(Session& session, const QList<QAction*>& ways, QWidget* parent);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void addButton(QAction* action, bool isMain);
  void showIfEmpty();
  void centre();

  const Session& session_;
  Subscription changes_;
};

}  // namespace nearfit::ui
