#pragma once

#include <QMouseEvent>
#include <QObject>
#include <functional>
#include <memory>
#include <optional>

#include "core/placing/feature_pick.h"
#include "core/session/session.h"
#include "ui/view3d/feature_highlight.h"

class QShortcut;

namespace nearfit::ui {

class Viewport;
struct PickedPoint;

/// A picked feature of a part.
struct FeaturePick {
  PartId part{};
  PickedFeature picked;  ///< In the part's frame.
  glm::dvec3 hit{0.0};   ///< The surface point under the pointer, in the part's frame [m].
};

/// Returns the name of a feature: "Flat face", "Circle ⌀ 12.344 mm", and of one by exact surfaces "Exact circle
/// ⌀ 12.344 mm". Diameters have the figures of measured distances.
QString describeFeature(const AlignFeature& feature);
/// The same to stand within a sentence: "circle ⌀ 12.344 mm".
QString describeFeatureWithin(const AlignFeature& feature);

/// Lets the user pick features in the view: highlights the one under the pointer and reports
/// clicks on it. Drags, the wheel and other buttons still control the view. One at a time: starting a
/// picker cancels any other.
class FeaturePicker : public QObject {
  Q_OBJECT

 public:
  /// @param session, view  Outlive this.
  /// @param colour  Of the highlight.
  FeaturePicker(const Session& session, Viewport& view, const QColor& colour, QObject* parent);
  ~FeaturePicker() override;

  /// Returns why a part cannot be picked; empty if it can.
  using Refusal = std::function<QString(const Part&)>;
  /// Starts picking; if already active, only replaces the refusal. Null: every part can be picked.
  void start(Refusal refusal);
  void stop();
  bool isActive() const noexcept { return isActive_; }
  /// Sets which features can be picked.
  void setFilter(FeatureFilter filter);

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// Emitted with what a click would pick, or why it would pick nothing; empty over the background.
  void told(const QString& text);
  /// Emitted when a feature is clicked.
  void picked(const nearfit::ui::FeaturePick& pick);
  /// Emitted on Return in the view.
  void accepted();
  /// Emitted on Escape, or when another tool takes the clicks. The receiver calls stop().
  void cancelled();

 private:
  bool press(const QMouseEvent& event);
  bool move(const QMouseEvent& event);
  bool release(const QMouseEvent& event);
  bool key(QEvent& event);
  void hoverAt(const QPoint& position);
  /// Returns the surface that is meant at a pixel of the view: what is seen through others comes before these.
  std::optional<PickedPoint> meantAt(const QPoint& position) const;
  /// Returns the feature at a point that is seen; std::nullopt if none is picked by the filter.
  /// @param pixels  Reach of edges and corners.
  std::optional<FeaturePick> featureOf(const Part& part, const PickedPoint& seen, double pixels) const;
  /// Returns an edge or corner on the outline of a part that ends beside a pixel of the view.
  /// @param seen  At the pixel; what ends beside it is in front.
  std::optional<FeaturePick> outlineNear(const QPoint& position,
                                         const std::optional<PickedPoint>& seen) const;
  QString refusalOf(PartId part) const;
  void forgetHover();
  void showHovered();

  const Session& session_;
  Viewport& view_;
  FeatureHighlight highlight_;
  QShortcut* escape_;
  Refusal refusal_;
  FeatureFilter filter_ = FeatureFilter::Any;
  std::optional<FeaturePick> hovered_;
  std::unique_ptr<QMouseEvent> pressed_;  ///< Held back until it turns out to be a click or a drag.
  QPoint pointer_;
  bool isActive_ = false, isReplaying_ = false, isHoverQueued_ = false;
};

}  // namespace nearfit::ui
