#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ui/detail/kept_renderer.h"
#include "ui/scene_renderer.h"

namespace nearfit::ui {

/// What of the parts a picture shows.
struct PictureDetail {
  std::size_t triangles = 0;  ///< Drawn for it, lines among them; without what was kept.
  bool isKept = false;        ///< What does not move was drawn before and put in.
  bool isFull = true;         ///< Nothing was left out to be quick.
};

/// Keeps pictures quick while something moves and makes them whole when it stands still. Where there is more
/// to draw than a moment allows, what moves is drawn coarsely; once the camera stands still, all that does
/// not move is drawn as it is, a little at a time between events, and kept (KeptRenderer).
class ViewDetail : public QObject {
  Q_OBJECT

 public:
  /// All outlive this. @param overlay  Drawn over the parts.
  ViewDetail(KeptRenderer& renderer, vtkRenderer& overlay, SceneRenderer& parts, QObject* parent = nullptr);

  /// Just before and just after a picture is drawn.
  void beforePicture();
  void afterPicture();
  const PictureDetail& detail() const noexcept { return detail_; }
  /// Whether the last picture is final: none that shows more follows by itself.
  bool isSettled() const;
  /// Whether the depths that the camera sees must stay, as some are kept.
  bool holdsDepths() const noexcept { return isKeeping_ || renderer_.hasKept(); }

  /// Triangles while something moves; else as many as this machine draws in time.
  void setBudget(std::size_t triangles);
  /// Ends when the next picture will be a full one, however long that takes.
  void complete();
  /// The same, whatever the last picture showed.
  void completeAnew();
  /// The next picture leaves nothing out that its triangles' budget allows.
  void drawFullNext() { isAtRest_ = true; }
  /// What is kept is no longer right.
  void drop();

 signals:
  void pictureWanted();
  /// The camera's depths are about to be kept: they should leave room for what moves.
  void depthsNeeded();

 private:
  using Key = std::array<double, 16>;  ///< All that what is kept depends on.

  Key key() const;
  /// The camera stands still: what does not move can be kept.
  void beginKeeping();
  void keepMore();
  /// Nothing has moved for a while.
  void rest();
  void smooth(bool isSmooth);
  void adaptBudget();

  KeptRenderer& renderer_;
  vtkRenderer& overlay_;
  SceneRenderer& parts_;
  QTimer still_, resting_, next_;
  QElapsedTimer picture_;
  PictureDetail detail_;
  std::optional<Key> key_, keptKey_;
  std::vector<vtkProp*> toKeep_;
  std::size_t kept_ = 0;  ///< Of toKeep_.
  bool isKeeping_ = false;
  bool isAtRest_ = false;  ///< The next picture is to be a full one.
  bool isFinal_ = true;    ///< None that shows more follows the picture that is being drawn.
  bool isLimited_ = false;
  bool isBudgetFixed_ = false;
  std::size_t budget_;
};

}  // namespace nearfit::ui
