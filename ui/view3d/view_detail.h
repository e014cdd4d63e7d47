#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <QWidget>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ui/view3d/drawing/caching_renderer.h"
#include "ui/view3d/parts/scene_renderer.h"
#include "ui/view3d/parts/shader_samples.h"

namespace nearfit::ui {

/// How much of the parts a picture shows.
struct PictureDetail {
  std::size_t triangles = 0;  ///< Triangles and lines drawn for it, without the kept picture.
  bool isKept = false;        ///< Resting parts come from the kept picture.
  bool isFull = true;         ///< Nothing was left out for speed.
};

/// How much is drawn while a part is felt.
enum class FeelQuality : std::uint8_t {
  Full,      ///< Everything.
  Balanced,  ///< Everything of scenes that are not large: coarse stand-ins lose holes and outlines.
  Fast,      ///< As while anything else moves.
};

/// How parts that no picture has shown yet come into the view. Times are of software OpenGL.
struct FillLimits {
  /// So few are in the next picture: some 50 ms. More are uploaded in turns before pictures show them.
  NewPartLimits atOnce{16, 20'000};
  /// Time to upload parts before events are handled again; one part at least.
  std::chrono::microseconds turn{30'000};
  /// Time from a picture to the next while parts are uploaded: each draws all that are there.
  std::chrono::milliseconds betweenPictures{150};
};

/// Keeps pictures fast while something moves, and completes them at rest. Where there is too much to draw,
/// moving parts are drawn coarsely. Once the camera stands still, all resting opaque parts are drawn in full,
/// a little at a time between events, into a kept picture (CachingRenderer). Where many parts are new, as those of a
/// document just opened, their geometry goes to OpenGL a little at a time too, and the view fills up meanwhile.
class ViewDetail : public QObject {
  Q_OBJECT

 public:
  /// @param renderer, parts  Outlive this.
  /// @param overlay          Drawn over the parts; outlives this.
  ViewDetail(CachingRenderer& renderer, vtkRenderer& overlay, SceneRenderer& parts,
             QObject* parent = nullptr);

  /// Call just before and just after each picture.
  void beforePicture();
  void afterPicture();
  const PictureDetail& detail() const noexcept { return detail_; }
  /// True if the last picture is final: no fuller one will follow by itself.
  bool isSettled() const;
  /// True once the shaders of parts have been compiled: soon after the first picture.
  bool areShadersReady() const noexcept { return areShadersReady_; }
  /// True if the clipping range must not change, as a kept picture depends on it.
  bool holdsDepths() const noexcept { return isKeeping_ || renderer_.hasKept(); }

  /// Fixes the max number of triangles while something moves; without this call it adapts
  /// to the machine's speed.
  void setBudget(std::size_t triangles);
  /// Sets how new parts come into the view; FillLimits{} without this call.
  void setFillLimits(const FillLimits& limits) { fillLimits_ = limits; }
  /// Sets how much is drawn while a part is felt; Balanced without this call.
  void setFeelQuality(FeelQuality quality) { quality_ = quality; }
  FeelQuality feelQuality() const noexcept { return quality_; }
  /// Tells if a part is felt.
  void setFeeling(bool isFeeling) { isFeeling_ = isFeeling; }
  /// Prepares a full next picture, however long that takes. If the last picture was full, only adds new parts.
  void complete();
  /// Prepares a full next picture, even if the last one was full.
  void completeAnew();
  /// The next picture shows all parts, new ones too, however long that takes.
  void showAllNext();
  /// Draws the next picture as at rest: smoothed, and with the larger budget if nothing else moves.
  void drawFullNext() { isAtRest_ = true; }
  /// Discards the kept picture, which is no longer right.
  void drop();

 signals:
  /// Emitted when a fuller picture can be drawn.
  void pictureWanted();
  /// Emitted before the clipping range is kept: set one with room for what moves.
  void depthsNeeded();

 private:
  using Key = std::array<double, 16>;  ///< Everything that a kept picture depends on.

  Key key() const;
  /// The camera stands still: starts a kept picture of the resting parts.
  void beginKeeping();
  /// Draws on the kept picture for one turn.
  void keepMore();
  /// Compiles shaders for one turn, before the first document needs them.
  void compileMore();
  /// Uploads parts that are held back, for one turn.
  void fillMore();
  /// Nothing has moved for a while.
  void rest();
  void smooth(bool isSmooth);
  /// Returns the triangles that a picture may have because a part is felt; 0 if none is.
  std::size_t budgetOfFeeling() const noexcept;
  void adaptBudget();

  CachingRenderer& renderer_;
  vtkRenderer& overlay_;
  SceneRenderer& parts_;
  QTimer still_, resting_, next_, filling_, compiling_;
  QElapsedTimer picture_, sincePicture_;
  PictureDetail detail_;
  std::optional<Key> key_, keptKey_;
  std::vector<vtkProp*> toKeep_;
  std::size_t kept_ = 0;  ///< Number of toKeep_ drawn.
  bool isKeeping_ = false;
  bool isAtRest_ = false;  ///< The next picture is to be full.
  bool isFinal_ = true;    ///< No fuller picture follows the one being drawn.
  bool isLimited_ = false;
  bool isFilling_ = false;     ///< The last picture left new parts out.
  bool showsAllNext_ = false;  ///< The next picture leaves none out.
  FillLimits fillLimits_;
  std::unique_ptr<ShaderSamples> samples_;
  bool hasDrawn_ = false, areShadersReady_ = false;
  bool isBudgetFixed_ = false;
  bool isFeeling_ = false;
  FeelQuality quality_ = FeelQuality::Balanced;
  std::size_t budget_;
};

/// Decides when a view draws: only on request, and at most as often as the display refreshes.
class PicturePace : public QObject {
  Q_OBJECT

 public:
  /// @param view  Outlives this.
  explicit PicturePace(QWidget& view) : view_(view) {}

  /// Requests a picture. Requests until it is due are answered by one.
  void request();
  /// Notes that a picture was drawn, requested or not.
  void noteDrawn() { sincePicture_.start(); }

 signals:
  /// Emitted when the view is to draw; not while it is hidden.
  void pictureDue();

 private:
  QWidget& view_;
  QElapsedTimer sincePicture_;
  bool hasRequest_ = false;
};

}  // namespace nearfit::ui
