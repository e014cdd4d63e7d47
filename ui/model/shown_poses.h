#pragma once

#include <QObject>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "core/session/session.h"

namespace nearfit::ui {

/// Where each part is now, for the view, panels, tools and exports: the session's poses, and over them what
/// has not come into the session. Poses are worldFromPart.
class ShownPoses : public QObject {
  Q_OBJECT

 public:
  /// Who has a part elsewhere than the session. In order of precedence: the first that has it decides, and the
  /// session comes last.
  enum class Source : std::uint8_t {
    Preview,  ///< A move that is proposed. The part is only shown there; it is not there yet.
    Drag,     ///< A move under way, which the user may take back.
    Replay,   ///< The row of a recording; of what the hand moves alone.
    Hand,     ///< The servo; of what it moves alone.
  };
  using Poses = std::map<PartId, RigidTransform>;

  /// Forgets all poses when another scene opens, and those of replay and hand when one of their parts is no longer to
  /// be moved. Both before the view hears of the change.
  /// @param session  Outlives this.
  explicit ShownPoses(Session& session, QObject* parent = nullptr);

  /// Replaces the poses of a source; an empty map ends it.
  void show(Source source, Poses worldFromPart);

  /// Returns where a part is: as dragged, else replayed, else in hand, else `part.worldFromPart`.
  RigidTransform poseOf(const Part& part) const { return poseFrom(Source::Drag, part); }
  /// Returns where the view shows a part: as previewed, else poseOf().
  RigidTransform shownPoseOf(const Part& part) const { return poseFrom(Source::Preview, part); }
  /// Returns where the hand has a part, whatever else shows it elsewhere; else `part.worldFromPart`.
  RigidTransform heldPoseOf(const Part& part) const { return poseFrom(Source::Hand, part); }
  /// Returns where the moving part is; the identity if there is none.
  RigidTransform poseOfMoving() const;
  /// True while a drag has the part.
  bool isDragged(PartId part) const { return posesOf(Source::Drag).contains(part); }
  /// True while a recording has the part.
  bool isReplayed(PartId part) const { return posesOf(Source::Replay).contains(part); }

 signals:
  /// Emitted when a source has come to show these parts elsewhere, or does so no more. Not for changes of the
  /// session's poses, of which the session tells.
  void changed(const std::vector<nearfit::PartId>& parts);

 private:
  /// The first of the sources from `first` on that has the part decides.
  RigidTransform poseFrom(Source first, const Part& part) const;
  const Poses& posesOf(Source source) const { return poses_.at(static_cast<std::size_t>(source)); }
  void followSession();

  Session& session_;
  std::uint64_t sceneSerial_;   ///< Serial of the scene that owns the parts.
  std::array<Poses, 4> poses_;  ///< One for each Source.
  Subscription changes_;
};

}  // namespace nearfit::ui
