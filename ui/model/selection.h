#pragma once

#include <QObject>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/session/session.h"

namespace nearfit::ui {

/// The selected parts of the session's scene, shared by tree, view and commands. Parts that leave the scene
/// leave the selection; undo does not bring them back. Another scene starts with an empty selection.
class Selection : public QObject {
  Q_OBJECT

 public:
  /// @param session  Outlives this. Its listeners of later stages never find a part here that has left the
  ///                 scene.
  explicit Selection(Session& session, QObject* parent = nullptr);

  /// In order of selection, without duplicates.
  const std::vector<PartId>& parts() const noexcept { return parts_; }
  /// The part selected last, which number and name fields show.
  std::optional<PartId> current() const noexcept;
  bool contains(PartId part) const noexcept;
  /// Groups selected as a whole; all parts in them are selected too.
  const std::vector<GroupId>& groups() const noexcept { return groups_; }
  SceneNodes nodes() const { return {parts_, groups_}; }
  bool isEmpty() const noexcept { return parts_.empty() && groups_.empty(); }

  /// Selects exactly these; the last part becomes the current one. Leaves out what is not in the scene, and
  /// groups of which not all parts are selected.
  void set(const std::vector<PartId>& parts, const std::vector<GroupId>& groups = {});
  /// Selects one part alone, or none.
  void select(std::optional<PartId> part);
  /// Adds a part and makes it the current one.
  void add(PartId part);
  /// Adds a part, or removes it if it is selected.
  void toggle(PartId part);
  /// Selects all visible parts; hidden ones should not be changed unseen.
  void selectAllVisible();

 signals:
  /// Emitted when the selected parts or groups have changed.
  void changed();

 private:
  Session& session_;
  std::uint64_t sceneSerial_;  ///< Serial of the scene that owns the parts.
  std::vector<PartId> parts_;
  std::vector<GroupId> groups_;
  Subscription changes_;
};

}  // namespace nearfit::ui
