#pragma once

#include <QFrame>
#include <QList>
#include <QString>

#include "core/session/scene_events.h"

class QAction;
class QLabel;
class QVBoxLayout;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

/// A card in the middle of its parent that offers ways to begin while the scene is empty, and the scenes opened last.
/// Where its parent is narrower its text is wrapped; where that is not enough, or its parent lower, it scrolls.
class WelcomeCard : public QFrame {
  Q_OBJECT

 public:
  /// @param session  Outlives this.
  /// @param ways     Actions that begin something, the likeliest first.
  WelcomeCard(Session& session, const QList<QAction*>& ways, QWidget* parent);

 signals:
  /// Emitted when the user chooses a scene opened before.
  void recentWanted(const QString& file);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void addButton(QAction* action, bool isMain);
  void listRecent();
  void showIfEmpty();
  /// As large as its content, or as its parent has room for, in the middle.
  void fit();

  const Session& session_;
  QWidget *content_, *recent_;
  QLabel* hint_;
  int wideWidth_ = 0;  ///< Of the content while its text is not wrapped [pixels].
  QVBoxLayout* recentRows_;
  Subscription changes_;
};

}  // namespace nearfit::ui
