#pragma once

#include <QMouseEvent>
#include <QObject>
#include <functional>
#include <memory>
#include <optional>

#include "core/placing/feature_pick.h"
#include "core/session.h"
#include "ui/placing/feature_highlight.h"

class QShortcut;

namespace nearfit::ui {

class Viewport;

/// A feature of a part.
struct FeaturePick {
  PartId part{};
  PickedFeature picked;  ///< In the part's frame.
  glm::dvec3 hit{0.0};   ///< The point of the surface that was pointed at, in the part's frame [m].
};

/// What a feature is called: "Flat face", "Cylinder ⌀ 12.0 mm".
QString describeFeature(const AlignFeature& feature);

/// Lets the user point at features in the view: lights up the one under the pointer, and tells of a click on
/// it. Drags, the wheel and the other buttons stay the view's. One at a time: who starts sends others away.
class FeaturePicker : public QObject {
  Q_OBJECT

 public:
  /// @param session, view  Outlive this.
  FeaturePicker(const Session& session, Viewport& view, const QColor& colour, QObject* parent);
  ~FeaturePicker() override;

  /// Why a part cannot be picked; empty: it can.
  using Refusal = std::function<QString(const Part&)>;
  void start(Refusal refusal);
  void stop();
  bool isActive() const noexcept { return isActive_; }
  void setFilter(FeatureFilter filter);
  /// What is under the pointer.
  const std::optional<FeaturePick>& hovered() const noexcept { return hovered_; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// What would be picked, or why nothing is; empty over the background.
  void told(const QString& text);
  void picked(const nearfit::ui::FeaturePick& pick);
  /// Return, or Escape, in the view.
  void accepted();
  void cancelled();

 private:
  bool press(const QMouseEvent& event);
  bool move(const QMouseEvent& event);
  bool release(const QMouseEvent& event);
  bool key(QEvent& event);
  void hoverAt(const QPoint& position);
  void forgetHover();
  void showHovered();

  const Session& session_;
  Viewport& view_;
  FeatureHighlight highlight_;
  QShortcut* escape_;
  Refusal refusal_;
  FeatureFilter filter_ = FeatureFilter::Any;
  std::optional<FeaturePick> hovered_;
  std::unique_ptr<QMouseEvent> pressed_;  ///< Held back until it is known whether it is a click.
  QPoint pointer_;
  bool isActive_ = false, isReplaying_ = false, isHoverQueued_ = false;
};

}  // namespace nearfit::ui
