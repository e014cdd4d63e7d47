#pragma once

#include <QAbstractItemModel>
#include <map>
#include <optional>
#include <vector>

#include "core/scene/scene_tree.h"
#include "ui/model/part_checks.h"

namespace nearfit::ui {

/// The scene's groups and parts as a tree, in each group its groups before its parts; columns of icons show
/// and switch states. Changes nothing itself: requests changes by signals.
class PartsModel : public QAbstractItemModel {
  Q_OBJECT

 public:
  enum Column { Name, Moving, Visible, Locked, Joints, Findings, ColumnCount };

  explicit PartsModel(QObject* parent = nullptr);

  /// Shows `scene`. Keeps the rows, and so what is expanded, if the tree and all meshes are the same;
  /// else resets the model.
  void setScene(const Scene& scene);
  /// Shows the findings of parts; those that are not listed have none.
  void setFindings(std::map<PartId, FindingsBadge> findings);
  /// Nullopt if the index is invalid or a group's.
  std::optional<PartId> partAt(const QModelIndex& index) const;
  /// Nullopt if the index is invalid or a part's.
  std::optional<GroupId> groupAt(const QModelIndex& index) const;
  /// Returns why the node cannot have that name, as a sentence; empty if it can.
  QString renameRefusal(const QModelIndex& index, const QString& name) const;
  /// Returns the index in column Name; invalid if the node is not in the scene.
  QModelIndex indexOf(PartId part) const;
  QModelIndex indexOf(GroupId group) const;

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex& index) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  Qt::DropActions supportedDropActions() const override { return Qt::MoveAction; }
  QStringList mimeTypes() const override;
  QMimeData* mimeData(const QModelIndexList& indexes) const override;
  bool dropMimeData(const QMimeData* data, Qt::DropAction action, int row, int column,
                    const QModelIndex& parent) override;

 signals:
  /// Emitted when the user has typed a new name for a part; trimmed.
  void renameRequested(nearfit::PartId part, const QString& name);
  /// The same for a group.
  void groupRenameRequested(nearfit::GroupId group, const QString& name);
  /// Emitted when nodes were dropped on a group, or at the top level (nullopt).
  void regroupRequested(const nearfit::SceneNodes& nodes, std::optional<nearfit::GroupId> target);

 private:
  /// A row: either a part or a group.
  struct Node {
    std::optional<PartId> part;
    std::optional<GroupId> group;
    int parent = -1, row = 0;
    std::vector<int> children;
    bool operator==(const Node&) const = default;
  };
  static std::vector<Node> treeOf(const Scene& scene);
  void setNodes(std::vector<Node> nodes);
  const Node* nodeAt(const QModelIndex& index) const;
  QModelIndex indexOfNode(int node, int column) const;
  QVariant partData(const Part& part, int column, int role) const;
  QVariant groupData(const Group& group, int column, int role) const;

  /// Tells that cells of these columns look different, in all rows.
  void tellChanged(int firstColumn, int lastColumn);

  Scene scene_;
  std::map<PartId, FindingsBadge> findings_;
  std::vector<Node> nodes_;  ///< The first is the scene, the invisible root.
  std::map<PartId, int> nodeOfPart_;
  std::map<GroupId, int> nodeOfGroup_;
  bool isGeometrySame(const Scene& scene) const;
};

}  // namespace nearfit::ui
