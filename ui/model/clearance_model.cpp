#include "ui/model/clearance_model.h"

#include <QColor>
#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

QString overlapText(InterferenceKind overlap) {
  switch (overlap) {
    case InterferenceKind::PartInside:
      return QObject::tr("inside the other");
    case InterferenceKind::SceneInside:
      return QObject::tr("the other inside");
    case InterferenceKind::SurfacesMeet:
    case InterferenceKind::Disjoint:
      break;
  }
  return QObject::tr("overlapping");
}

/// The other part's name; beside a group in hand also which of its parts is nearest.
QString rowNameOf(const Part& other, const PartClearance& clearance, const Scene& scene) {
  const QString name = QString::fromStdString(other.name);
  if (!scene.movingGroup() || !scene.isMoving(clearance.part)) return name;
  return QObject::tr("%1, from %2").arg(name, QString::fromStdString(scene.get(clearance.part).name));
}

}  // namespace

QString ClearanceModel::valueOf(const PartClearance& clearance) {
  if (clearance.isTouching) return tr("touching");
  return clearance.isOverlapping() ? overlapText(clearance.overlap)
                                   : formatDistance(clearance.distance, clearance.isDistanceBound);
}

void ClearanceModel::show(const std::vector<PartClearance>& clearances, const Scene& scene) {
  std::vector<Row> rows;
  for (const PartClearance& each : clearances) {
    const Part* other = scene.find(each.other);
    if (other != nullptr) rows.push_back({each, rowNameOf(*other, each, scene)});
  }
  const bool isSame = rows.size() == rows_.size() &&
                      std::equal(rows.begin(), rows.end(), rows_.begin(), [](const Row& a, const Row& b) {
                        return a.clearance.other == b.clearance.other;
                      });
  // A reset would lose the selected row.
  if (!isSame) beginResetModel();
  rows_ = std::move(rows);
  if (!isSame) {
    endResetModel();
  } else if (!rows_.empty()) {
    emit dataChanged(index(0, 0), index(rowCount() - 1, ColumnCount - 1));
  }
}

void ClearanceModel::setThreshold(double metres) {
  threshold_ = metres;
  if (!rows_.empty()) emit dataChanged(index(0, 0), index(rowCount() - 1, ColumnCount - 1));
}

std::optional<int> ClearanceModel::rowOf(PartId other) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].clearance.other == other) return static_cast<int>(i);
  }
  return std::nullopt;
}

int ClearanceModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int ClearanceModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : ColumnCount;
}

bool ClearanceModel::isTooNear(const PartClearance& clearance) const {
  return clearance.isOverlapping() || clearance.isTouching || clearance.distance < threshold_;
}

QString ClearanceModel::textOf(const Row& row, int column) const {
  const PartClearance& c = row.clearance;
  switch (column) {
    case Other:
      return row.name;
    case Distance:
      // How deep parts are in each other is not searched here.
      if (c.isOverlapping()) return QStringLiteral("–");
      return formatDistance(c.distance, c.isDistanceBound);
    case Minima:
      if (c.isOverlapping() || c.isTouching) return QStringLiteral("–");
      return c.isEveryMinimum ? QString::number(c.minima) : tr("%1+").arg(c.minima);
    default:
      break;
  }
  if (c.isOverlapping() || c.isTouching) return valueOf(c);
  if (!isTooNear(c)) return tr("clear");
  // The points are those of the nearest minimum found.
  const bool isSure = !c.isDistanceBound || glm::distance(c.partPoint, c.otherPoint) < threshold_;
  return isSure ? tr("too near") : tr("may be too near");
}

QVariant ClearanceModel::sortKeyOf(const Row& row, int column) const {
  const PartClearance& c = row.clearance;
  switch (column) {
    case Other:
      return row.name;
    case Distance:
      return c.distance;
    case Minima:
      return static_cast<qulonglong>(c.minima);
    default:
      break;
  }
  return c.isOverlapping() ? 0 : c.isTouching ? 1 : isTooNear(c) ? 2 : 3;
}

QVariant ClearanceModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const Row& row = rows_[static_cast<std::size_t>(index.row())];
  switch (role) {
    case Qt::DisplayRole:
      return textOf(row, index.column());
    case kSortRole:
      return sortKeyOf(row, index.column());
    case Qt::TextAlignmentRole:
      return QVariant::fromValue<int>(
          (index.column() == Distance || index.column() == Minima ? Qt::AlignRight : Qt::AlignLeft) |
          Qt::AlignVCenter);
    case Qt::ForegroundRole:
      if (index.column() == Other || index.column() == Minima || !isTooNear(row.clearance)) return {};
      return themed(row.clearance.isOverlapping() ? colours::kOverlap : colours::kWarning);
    case Qt::ToolTipRole:
      return tr("%1: %2, %3").arg(row.name, textOf(row, Distance), textOf(row, Verdict));
    default:
      return {};
  }
}

QVariant ClearanceModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal) return {};
  if (role == Qt::TextAlignmentRole)
    return QVariant::fromValue<int>(
        (section == Distance || section == Minima ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
  if (role == Qt::ToolTipRole && section == Minima)
    return tr("Local minimum distances within the cutoff of the feel settings");
  if (role != Qt::DisplayRole) return {};
  switch (section) {
    case Other:
      return tr("Other part");
    case Distance:
      return tr("Distance");
    case Minima:
      return tr("Minima");
    default:
      return tr("Verdict");
  }
}

}  // namespace nearfit::ui
