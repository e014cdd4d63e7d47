#pragma once

#include <QCoreApplication>
#include <QIcon>
#include <QString>

#include "core/scene/scene.h"
#include "ui/model/part_checks.h"

namespace nearfit::ui {

/// Contents of the cells in a part's row (columns: PartsModel::Column).
class PartCell {
  Q_DECLARE_TR_FUNCTIONS(PartCell)

 public:
  /// @param scene  Must outlive this.
  /// @param part   Must outlive this.
  /// @param badge  Its findings; null if it has none. Must outlive this.
  PartCell(const Scene& scene, const Part& part, const FindingsBadge* badge = nullptr)
      : scene_(scene), part_(part), badge_(badge) {}

  /// Returns a cell's icon; null if it has none.
  QIcon picture(int column) const;
  /// Returns a cell's tooltip.
  QString toolTip(int column) const;

 private:
  QString handText() const;
  QString lockText() const;
  QString jointText() const;
  QString description() const;

  const Scene& scene_;
  const Part& part_;
  const FindingsBadge* badge_;
};

/// Contents of the cells in a group's row.
class GroupCell {
  Q_DECLARE_TR_FUNCTIONS(GroupCell)

 public:
  /// @param scene  Must outlive this.
  /// @param group  Must outlive this.
  GroupCell(const Scene& scene, const Group& group) : scene_(scene), group_(group) {}

  QIcon picture(int column) const;
  QString toolTip(int column) const;

 private:
  const Scene& scene_;
  const Group& group_;
};

}  // namespace nearfit::ui
