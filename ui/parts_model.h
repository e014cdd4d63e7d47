#pragma once

#include <QAbstractItemModel>
#include <optional>
#include <vector>

#include "core/scene/scene_tree.h"

namespace nearfit::ui {

/// The scene's groups and parts as a tree, in each group the groups before the parts; icons for what can be
/// switched. Shows a scene and asks for changes by signals; changes nothing itself.
class PartsModel : public QAbstractItemModel {
  Q_OBJECT

 public:
  enum Column { Name, Moving, Visible, Locked, ColumnCount };

  explicit PartsModel(QObject* parent = nullptr);

  /// Keeps rows, and so what is expanded, where the same parts are in the same groups.
  void setScene(const Scene& scene);
  std::optional<PartId> partAt(const QModelIndex& index) const;
  std::optional<GroupId> groupAt(const QModelIndex& index) const;
  /// Why what stands there cannot have that name, as a sentence; empty when it can.
  QString renameRefusal(const QModelIndex& index, const QString& name) const;
  /// Of the name; invalid when it is not in the scene.
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
  void renameRequested(nearfit::PartId part, const QString& name);
  void groupRenameRequested(nearfit::GroupId group, const QString& name);
  /// Nodes were dropped on a group, or at the top.
  void regroupRequested(const nearfit::SceneNodes& nodes, std::optional<nearfit::GroupId> target);

 private:
  /// A row: one of both.
  struct Node {
    std::optional<PartId> part;
    std::optional<GroupId> group;
    int parent = -1, row = 0;
    std::vector<int> children;
    bool operator==(const Node&) const = default;
  };
  static std::vector<Node> treeOf(const Scene& scene);
  const Node* nodeAt(const QModelIndex& index) const;
  QModelIndex indexOfNode(int node, int column) const;
  QVariant partData(const Part& part, int column, int role) const;
  QVariant groupData(const Group& group, int column, int role) const;

  Scene scene_;
  std::vector<Node> nodes_;  ///< The first is the scene itself.
  bool isGeometrySame(const Scene& scene) const;
};

}  // namespace nearfit::ui
