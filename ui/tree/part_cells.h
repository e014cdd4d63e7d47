#pragma once

#include <QCoreApplication>
#include <QIcon>
#include <QString>

#include "core/scene/scene.h"

namespace nearfit::ui {

/// What stands in the cells of a part's row (columns: PartsModel::Column).
class PartCell {
  Q_DECLARE_TR_FUNCTIONS(PartCell)

 public:
  /// @param scene, part  Outlive this.
  PartCell(const Scene& scene, const Part& part) : scene_(scene), part_(part) {}

  QIcon picture(int column) const;
  QString toolTip(int column) const;

 private:
  QString lockText() const;
  QString description() const;

  const Scene& scene_;
  const Part& part_;
};

/// The same for a group.
class GroupCell {
  Q_DECLARE_TR_FUNCTIONS(GroupCell)

 public:
  /// @param scene, group  Outlive this.
  GroupCell(const Scene& scene, const Group& group) : scene_(scene), group_(group) {}

  QIcon picture(int column) const;
  QString toolTip(int column) const;

 private:
  const Scene& scene_;
  const Group& group_;
};

}  // namespace nearfit::ui
