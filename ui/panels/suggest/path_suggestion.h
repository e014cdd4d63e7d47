#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QPointer>
#include <QTimer>
#include <memory>
#include <optional>

#include "core/path/path_search.h"
#include "core/servo/servo_snapshot.h"
#include "core/session/session.h"
#include "ui/panels/suggest/suggest_dialog.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QWidget;

namespace nearfit::ui {

class HandState;
class MarkActors;
class SuggestionCard;
class Viewport;

/// *Suggest path...*: searches a path of what is in hand in another thread, draws it in the view as a line, plays it as a
/// ghost, saves it and its certificate, and has the hand guided along it. Changes nothing in the session. The ghost rests while the part is
/// felt: the view then shows the hand's.
class PathSuggestion : public QObject {
  Q_OBJECT

 public:
  /// Objects that it works on; all outlive this.
  struct Context {
    Session& session;
    const HandState& hand;
    Viewport& view;
  };
  /// @param window  The parent, and that of dialogs.
  PathSuggestion(const Context& context, QWidget* window);
  ~PathSuggestion() override;

  /// Returns the action that asks what to search, and does.
  QAction* action() const noexcept { return action_; }
  /// Ends the show of a path, and the guidance.
  void close();

 signals:
  /// Emitted when the hand is to be guided along a path, or no longer (null).
  void guidanceChanged(const std::shared_ptr<const nearfit::AssemblyPath>& path);
  /// Emitted when the user wants to feel the path, after guidanceChanged().
  void feelRequested();
  /// Emitted before a search: whoever holds a part, or a number being typed, puts it into the session.
  void sceneNeeded();
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  /// A search, as the other thread sees it.
  struct Search;

  void askAndSearch();
  void search(const SuggestionRequest& request);
  void show(const std::shared_ptr<const Search>& search);
  void save();
  void saveCertificate();
  /// True if the path on show was proven in the scene as it is.
  bool isCertifiable() const;
  void guide(bool isOn);
  /// Draws the way of the centre of mass of what is in hand along the path.
  void drawWay();
  void update();
  void followSession();
  void play();

  Session& session_;
  const HandState& hand_;
  Viewport& view_;
  QWidget* window_;
  QAction* action_;
  BackgroundTask task_;
  QPointer<SuggestionCard> card_;
  std::shared_ptr<const AssemblyPath> path_;  ///< On show; null if there is none.
  std::shared_ptr<const Search> found_;       ///< That found it; null if there is none.
  bool isGuiding_ = false;
  PartId moving_{};                     ///< Part that the path moves; of a group the one that leads.
  std::optional<GroupId> movingGroup_;  ///< Set if that part leads a group.
  std::uint64_t sceneSerial_ = 0;       ///< Serial of its scene.
  std::uint64_t stateSerial_ = 0;       ///< Serial of the scene's state that was searched.
  std::unique_ptr<ServoSnapshot> ghost_;
  std::unique_ptr<MarkActors> way_;
  QTimer timer_;
  QElapsedTimer sincePlay_;
  Subscription changes_;
};

}  // namespace nearfit::ui
