#include "ui/model/findings_model.h"

#include <utility>

#include "ui/model/part_checks.h"
#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

void FindingsModel::show(std::shared_ptr<const MeshCheck> check) {
  if (check == check_) return;
  beginResetModel();
  check_ = std::move(check);
  endResetModel();
}

void FindingsModel::refresh() {
  if (rowCount() > 0) emit dataChanged(index(0, 0), index(rowCount() - 1, ColumnCount - 1));
}

int FindingsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() || check_ == nullptr ? 0 : static_cast<int>(check_->findings.size());
}

int FindingsModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : ColumnCount;
}

QString FindingsModel::textOf(const MeshFinding& finding, int column) {
  switch (column) {
    case Kind:
      return nameOf(finding.kind);
    case Count:
      return countText(finding);
    case Size:
      return finding.length > 0.0 ? formatLength(finding.length) : QStringLiteral("–");
    case Place:
      return finding.hasPlace ? QStringLiteral("%1, %2, %3")
                                    .arg(formatLength(finding.point.x), formatLength(finding.point.y),
                                         formatLength(finding.point.z))
                              : QStringLiteral("–");
    default:
      return finding.isMended ? tr("mended on loading") : nameOf(finding.severity);
  }
}

QString FindingsModel::toolTipOf(const MeshFinding& finding, int column) {
  if (column != Size) return textOf(finding, column);
  if (finding.kind == FindingKind::OpenEdges) return tr("Length of the loop");
  return finding.length > 0.0 ? tr("Max width") : QString();
}

QVariant FindingsModel::sortKeyOf(const MeshFinding& finding, int column) {
  switch (column) {
    case Kind:
      return static_cast<int>(finding.kind);
    case Count:
      return QVariant::fromValue<qulonglong>(finding.count);
    case Size:
      return finding.length;
    case Place:
      return finding.point.x;
    default:
      return finding.isMended ? -1 : static_cast<int>(finding.severity);
  }
}

QVariant FindingsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || check_ == nullptr) return {};
  const MeshFinding& finding = at(index.row());
  switch (role) {
    case Qt::DisplayRole:
      return textOf(finding, index.column());
    case Qt::ToolTipRole:
      return toolTipOf(finding, index.column());
    case Qt::ForegroundRole:
      return finding.severity == FindingSeverity::Serious && index.column() == Effect
                 ? QVariant(themed(colours::kOverlap))
                 : QVariant();
    case kSortRole:
      return sortKeyOf(finding, index.column());
    default:
      return {};
  }
}

QVariant FindingsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal) return {};
  if (role == Qt::ToolTipRole && section == Place) return tr("Place in the part");
  if (role != Qt::DisplayRole) return {};
  switch (section) {
    case Kind:
      return tr("Finding");
    case Count:
      return tr("Count");
    case Size:
      return tr("Size");
    case Place:
      return tr("Place");
    case Effect:
      return tr("Effect");
    default:
      return {};
  }
}

}  // namespace nearfit::ui
