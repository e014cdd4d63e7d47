#include "ui/model/parts_model.h"

#include <QCoreApplication>
#include <QDataStream>
#include <QFont>
#include <QMimeData>
#include <algorithm>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "ui/model/part_cells.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QString kNodesType = QStringLiteral("application/x-nearfit-nodes");

}  // namespace

PartsModel::PartsModel(QObject* parent) : QAbstractItemModel(parent), nodes_(1) {}

std::vector<PartsModel::Node> PartsModel::treeOf(const Scene& scene) {
  std::vector<Node> nodes(1);
  std::map<std::optional<GroupId>, int> nodeOf{{std::nullopt, 0}};
  const auto add = [&](std::optional<GroupId> parent, Node node) {
    const auto number = static_cast<int>(nodes.size());
    node.parent = nodeOf.at(parent);
    Node& above = nodes[static_cast<std::size_t>(node.parent)];
    node.row = static_cast<int>(above.children.size());
    above.children.push_back(number);
    if (node.group) nodeOf[node.group] = number;
    nodes.push_back(std::move(node));
  };
  visitGroups(scene, [&](const Group& group, std::size_t) {
    Node node;
    node.group = group.id;
    add(group.parent, std::move(node));
  });
  for (const Scene::PartPtr& part : scene.parts()) {
    Node node;
    node.part = part->id;
    add(part->group, std::move(node));
  }
  return nodes;
}

void PartsModel::setNodes(std::vector<Node> nodes) {
  nodes_ = std::move(nodes);
  nodeOfPart_.clear();
  nodeOfGroup_.clear();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].part) nodeOfPart_[*nodes_[i].part] = static_cast<int>(i);
    if (nodes_[i].group) nodeOfGroup_[*nodes_[i].group] = static_cast<int>(i);
  }
}

bool PartsModel::isGeometrySame(const Scene& scene) const {
  return std::ranges::equal(scene_.parts(), scene.parts(),
                            [](const auto& a, const auto& b) { return a->geometry == b->geometry; });
}

void PartsModel::setScene(const Scene& scene) {
  std::vector<Node> nodes = treeOf(scene);
  if (nodes != nodes_ || !isGeometrySame(scene)) {
    beginResetModel();
    scene_ = scene;
    setNodes(std::move(nodes));
    endResetModel();
    return;
  }
  scene_ = scene;
  tellChanged(0, ColumnCount - 1);
}

void PartsModel::setFindings(std::map<PartId, FindingsBadge> findings) {
  if (findings == findings_) return;
  findings_ = std::move(findings);
  tellChanged(Findings, Findings);
}

void PartsModel::tellChanged(int firstColumn, int lastColumn) {
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const QModelIndex above = indexOfNode(static_cast<int>(node), Name);
    const int rows = rowCount(above);
    if (rows > 0) emit dataChanged(index(0, firstColumn, above), index(rows - 1, lastColumn, above));
  }
}

const PartsModel::Node* PartsModel::nodeAt(const QModelIndex& index) const {
  return index.isValid() ? &nodes_[static_cast<std::size_t>(index.internalId())] : nullptr;
}

QModelIndex PartsModel::indexOfNode(int node, int column) const {
  if (node <= 0) return {};
  return createIndex(nodes_[static_cast<std::size_t>(node)].row, column, static_cast<quintptr>(node));
}

std::optional<PartId> PartsModel::partAt(const QModelIndex& index) const {
  const Node* node = nodeAt(index);
  return node != nullptr ? node->part : std::nullopt;
}

std::optional<GroupId> PartsModel::groupAt(const QModelIndex& index) const {
  const Node* node = nodeAt(index);
  return node != nullptr ? node->group : std::nullopt;
}

QModelIndex PartsModel::indexOf(PartId part) const {
  const auto found = nodeOfPart_.find(part);
  return found == nodeOfPart_.end() ? QModelIndex() : indexOfNode(found->second, Name);
}

QModelIndex PartsModel::indexOf(GroupId group) const {
  const auto found = nodeOfGroup_.find(group);
  return found == nodeOfGroup_.end() ? QModelIndex() : indexOfNode(found->second, Name);
}

QModelIndex PartsModel::index(int row, int column, const QModelIndex& parent) const {
  if (!hasIndex(row, column, parent)) return {};
  const Node& above = parent.isValid() ? *nodeAt(parent) : nodes_.front();
  return indexOfNode(above.children[static_cast<std::size_t>(row)], column);
}

QModelIndex PartsModel::parent(const QModelIndex& index) const {
  const Node* node = nodeAt(index);
  return node != nullptr ? indexOfNode(node->parent, Name) : QModelIndex();
}

int PartsModel::rowCount(const QModelIndex& parent) const {
  if (parent.column() > 0) return 0;
  const Node& above = parent.isValid() ? *nodeAt(parent) : nodes_.front();
  return static_cast<int>(above.children.size());
}

int PartsModel::columnCount(const QModelIndex&) const {
  return ColumnCount;
}

QVariant PartsModel::data(const QModelIndex& index, int role) const {
  const Node* node = nodeAt(index);
  if (node == nullptr) return {};
  if (node->part) return partData(*scene_.find(*node->part), index.column(), role);
  return groupData(*scene_.findGroup(*node->group), index.column(), role);
}

QVariant PartsModel::partData(const Part& part, int column, int role) const {
  const auto found = findings_.find(part.id);
  const PartCell cell(scene_, part, found != findings_.end() ? &found->second : nullptr);
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return column == Name ? QVariant(QString::fromStdString(part.name)) : QVariant();
    case Qt::DecorationRole:
      return cell.picture(column);
    case Qt::ToolTipRole:
      return cell.toolTip(column);
    case Qt::AccessibleTextRole:
      return column == Name ? QString::fromStdString(part.name) : cell.toolTip(column);
    case Qt::ForegroundRole:
      return part.isVisible ? QVariant() : QVariant(themed(colours::kMutedText));
    case Qt::FontRole: {
      QFont font;
      font.setBold(scene_.isMoving(part.id));
      return font;
    }
    default:
      return {};
  }
}

QVariant PartsModel::groupData(const Group& group, int column, int role) const {
  const GroupCell cell(scene_, group);
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return column == Name ? QVariant(QString::fromStdString(group.name)) : QVariant();
    case Qt::DecorationRole:
      return cell.picture(column);
    case Qt::ToolTipRole:
      return cell.toolTip(column);
    case Qt::FontRole: {
      QFont font;
      font.setBold(scene_.movingGroup() == group.id);
      return font;
    }
    case Qt::AccessibleTextRole:
      return column == Name ? tr("Group %1").arg(QString::fromStdString(group.name)) : cell.toolTip(column);
    default:
      return {};
  }
}

QVariant PartsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole || section != Name) return {};
  return tr("Part");
}

Qt::ItemFlags PartsModel::flags(const QModelIndex& index) const {
  // Nodes can be dropped at the top level.
  if (!index.isValid()) return Qt::ItemIsDropEnabled;
  Qt::ItemFlags result = QAbstractItemModel::flags(index) | Qt::ItemIsDragEnabled;
  const std::optional<PartId> part = partAt(index);
  const bool isLocked =
      part ? scene_.isLocked(*scene_.find(*part)) : scene_.isLocked(*scene_.findGroup(*groupAt(index)));
  if (index.column() == Name && !isLocked) result |= Qt::ItemIsEditable;
  if (groupAt(index)) result |= Qt::ItemIsDropEnabled;
  return result;
}

QString PartsModel::renameRefusal(const QModelIndex& index, const QString& name) const {
  // Try the name on a copy; the scene is a value and cheap to copy.
  Scene tried = scene_;
  try {
    if (const std::optional<PartId> id = partAt(index)) {
      Part part = *tried.find(*id);
      part.name = name.trimmed().toStdString();
      tried.replace(std::move(part));
    } else if (const std::optional<GroupId> group = groupAt(index)) {
      Group renamed = *tried.findGroup(*group);
      renamed.name = name.trimmed().toStdString();
      tried.replaceGroup(std::move(renamed));
    }
  } catch (const UsageError& error) {
    QString problem = QString::fromStdString(error.problem());
    problem[0] = problem[0].toUpper();
    return tr("%1: %2").arg(problem, QString::fromStdString(error.remedy()));
  }
  return {};
}

bool PartsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || index.column() != Name) return false;
  const QString name = value.toString().trimmed();
  if (const std::optional<PartId> part = partAt(index)) {
    emit renameRequested(*part, name);
  } else if (const std::optional<GroupId> group = groupAt(index)) {
    emit groupRenameRequested(*group, name);
  } else {
    return false;
  }
  return true;
}

QStringList PartsModel::mimeTypes() const {
  return {kNodesType};
}

QMimeData* PartsModel::mimeData(const QModelIndexList& indexes) const {
  QByteArray bytes;
  QDataStream out(&bytes, QIODevice::WriteOnly);
  out << QCoreApplication::applicationPid();
  for (const QModelIndex& index : indexes) {
    if (index.column() != Name) continue;
    const std::optional<PartId> part = partAt(index);
    out << part.has_value()
        << (part ? static_cast<quint32>(*part) : static_cast<quint32>(groupAt(index).value_or(GroupId{})));
  }
  auto* data = new QMimeData;
  data->setData(kNodesType, bytes);
  return data;
}

bool PartsModel::dropMimeData(const QMimeData* data, Qt::DropAction, int, int, const QModelIndex& parent) {
  QByteArray bytes = data->data(kNodesType);
  QDataStream in(&bytes, QIODevice::ReadOnly);
  qint64 process = 0;
  in >> process;
  // IDs from another process mean other nodes here.
  if (process != QCoreApplication::applicationPid()) return false;
  SceneNodes nodes;
  while (!in.atEnd()) {
    bool isPart = false;
    quint32 id = 0;
    in >> isPart >> id;
    if (in.status() != QDataStream::Ok) break;
    if (isPart && scene_.find(PartId{id}) != nullptr) nodes.parts.push_back(PartId{id});
    if (!isPart && scene_.findGroup(GroupId{id}) != nullptr) nodes.groups.push_back(GroupId{id});
  }
  if (!nodes.isEmpty()) emit regroupRequested(nodes, groupAt(parent));
  // False, as the session moves the nodes: after true the view would remove the rows.
  return false;
}

}  // namespace nearfit::ui
