#pragma once

#include <QObject>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scene/scene_tree.h"

namespace nearfit {
class Session;
}

namespace nearfit::ui {

/// Which parts of the session's scene are selected: the one truth that tree, view and commands share. Parts
/// that leave the scene leave it by themselves; undo does not bring them back. Another scene begins with
/// none.
class Selection : public QObject {
  Q_OBJECT

 public:
  /// @param session  Outlives this; told of it first, so that whoever else hears of a change finds no part
  ///                 here that the scene no longer has.
  explicit Selection(Session& session, QObject* parent = nullptr);

  /// In the order in which they were selected, each once.
  const std::vector<PartId>& parts() const noexcept { return parts_; }
  /// The one that was selected last: numbers and names are of this one.
  std::optional<PartId> current() const noexcept;
  bool contains(PartId part) const noexcept;
  /// Groups that are selected as such: all parts in them are selected too.
  const std::vector<GroupId>& groups() const noexcept { return groups_; }
  SceneNodes nodes() const { return {parts_, groups_}; }
  bool isEmpty() const noexcept { return parts_.empty() && groups_.empty(); }

  /// These and no others, the last part the current one; what the scene does not have is left out, and so is
  /// a group of which not all parts are selected.
  void set(const std::vector<PartId>& parts, const std::vector<GroupId>& groups = {});
  /// One alone, or none.
  void select(std::optional<PartId> part);
  /// Makes it the current one, beside those that are selected.
  void add(PartId part);
  /// Adds it, or takes it out.
  void toggle(PartId part);
  /// All that are shown: what nobody sees should not be changed along with the rest.
  void selectAllVisible();

 signals:
  void changed();

 private:
  Session& session_;
  std::uint64_t sceneSerial_;  ///< Of the scene that the parts are of.
  std::vector<PartId> parts_;
  std::vector<GroupId> groups_;
};

}  // namespace nearfit::ui
