#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <memory>
#include <optional>
#include <vector>

#include "core/report/clearance_histogram.h"
#include "core/report/clearance_map.h"
#include "core/session/session.h"
#include "ui/view3d/parts/scene_renderer.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

namespace nearfit::ui {

class HandState;
class Selection;
class ShownPoses;

/// A map of clearance with all that is shown of it. Immutable once made.
struct ShownMap {
  std::vector<PartId> subject;
  bool isAutomatic = false;  ///< The range was chosen by the distances.
  ClearanceMap map;
  AreaByClearance areas;           ///< Of the subject.
  SceneRenderer::Colours colours;  ///< What the view draws.
};

/// Keeps the map of clearance of the selected part, else of the part or group in hand, up to date while it is wanted. Computes in
/// another thread, one map at a time and always of the newest poses. Small maps follow a part that moves, several times
/// a second; large ones are computed once it rests. While a part is felt, one processor is used, at most half the time.
class ClearanceMapSearch : public QObject {
  Q_OBJECT

 public:
  /// Max number of samples of a map that follows motion: some 0.1 s of one processor.
  static constexpr std::size_t kMaxLiveSamples = 60'000;

  /// Whose map it is, and where the parts are; all outlive this.
  struct Context {
    Session& session;
    const Selection& selection;
    const ShownPoses& poses;
    const HandState& hand;
  };
  explicit ClearanceMapSearch(const Context& context, QObject* parent = nullptr);

  /// Starts or stops computing; at first nothing is wanted. The map is dropped when it is no longer wanted.
  void setWanted(bool isWanted);
  bool isWanted() const noexcept { return isWanted_; }
  /// @param range  [m]; 0: automatic.
  void setRange(double range);
  void setNearParts(bool hasNearParts);
  /// Gives up the map that is being computed; the next change computes one again.
  void cancel();
  /// Computes the map anew.
  void refresh();

  /// Parts that are mapped: see mapSubject(). Empty if there are none.
  std::vector<PartId> subject() const;
  /// The last map; null if there is none of the subject.
  const std::shared_ptr<const ShownMap>& shown() const noexcept { return shown_; }
  /// True if a change that is some tenths of a second old is not in the map yet.
  bool isStale() const noexcept { return isStale_; }
  bool isRunning() const noexcept { return task_.isRunning(); }
  /// True if the user has cancelled, and nothing has changed since.
  bool isCancelled() const noexcept { return isCancelled_; }

 signals:
  /// Emitted when shown() or isStale() changed.
  void changed();
  /// Emitted when isRunning() or isCancelled() changed.
  void workChanged();
  /// Emitted with the fraction done of the map that is being computed.
  void progressed(double fraction);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  /// True if the next map is probably small enough to follow motion.
  bool isLive() const;
  void followSubject();
  /// Request for the map of the present poses. There is a subject.
  ClearanceMapRequest present() const;
  /// Computes a map, now or once it rests, if parts have moved, come or gone since the last one was begun.
  void followParts();
  void request();
  void startIfDue();
  void start();
  void finish(const std::shared_ptr<const ShownMap>& found, const std::exception_ptr& error);
  void setStale(bool isStale);
  void drop();

  const Context context_;
  const std::shared_ptr<ClearanceMapper> mapper_ = std::make_shared<ClearanceMapper>();
  BackgroundTask task_;
  QTimer pace_, rest_, late_;
  QElapsedTimer running_;
  std::shared_ptr<const ShownMap> shown_;
  std::vector<PartId> subject_;
  std::vector<MeasuredPart> begun_;            ///< Parts of the map begun last.
  std::uint64_t sceneSerial_ = 0;              ///< Serial of the scene that owns the subject.
  double range_ = 0.0, automaticRange_ = 0.0;  ///< As chosen; the last one found, 0 if none [m].
  bool hasNearParts_ = false;
  bool isWanted_ = false, isDue_ = false, isStale_ = false, isCancelled_ = false;
  Subscription changes_;
};

}  // namespace nearfit::ui
