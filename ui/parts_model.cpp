#include "ui/parts_model.h"

#include <QFont>
#include <QIcon>
#include <QPainter>
#include <QPixmap>
#include <algorithm>

#include "ui/format.h"
#include "ui/theme.h"

namespace nearfit::ui {
namespace {

/// Else the style tints pictures in selected rows until they look disabled.
QIcon sameWhenSelected(const QPixmap& pixmap) {
  QIcon result(pixmap);
  result.addPixmap(pixmap, QIcon::Selected);
  return result;
}

QIcon listIcon(const QString& name) {
  constexpr int kSize = 36;
  return sameWhenSelected(icon(name).pixmap(kSize, kSize));
}

QIcon swatch(const Colour& colour) {
  constexpr int kSize = 32;
  QPixmap pixmap(kSize, kSize);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor fill = QColor::fromRgbF(static_cast<double>(colour.r), static_cast<double>(colour.g),
                                       static_cast<double>(colour.b));
  painter.setPen(QPen(fill.darker(150), 2.0));
  painter.setBrush(fill);
  painter.drawRoundedRect(QRectF(4, 4, 24, 24), 6, 6);
  return sameWhenSelected(pixmap);
}

}  // namespace

PartsModel::PartsModel(QObject* parent) : QAbstractTableModel(parent) {}

void PartsModel::setScene(const Scene& scene) {
  const bool sameParts =
      std::equal(scene_.parts().begin(), scene_.parts().end(), scene.parts().begin(), scene.parts().end(),
                 [](const Scene::PartPtr& a, const Scene::PartPtr& b) {
                   return a->id == b->id && a->geometry == b->geometry;
                 });
  if (!sameParts) beginResetModel();
  scene_ = scene;
  if (!sameParts) {
    endResetModel();
  } else if (rowCount() > 0) {
    emit dataChanged(index(0, 0), index(rowCount() - 1, ColumnCount - 1));
  }
}

std::optional<PartId> PartsModel::partAt(const QModelIndex& index) const {
  const auto row = static_cast<std::size_t>(index.row());
  if (!index.isValid() || row >= scene_.parts().size()) return std::nullopt;
  return scene_.parts()[row]->id;
}

QModelIndex PartsModel::indexOf(PartId part) const {
  for (int row = 0; row < rowCount(); ++row) {
    if (scene_.parts()[static_cast<std::size_t>(row)]->id == part) return index(row, Name);
  }
  return {};
}

int PartsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(scene_.parts().size());
}

int PartsModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : ColumnCount;
}

QVariant PartsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const Part& part = *scene_.parts()[static_cast<std::size_t>(index.row())];
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return index.column() == Name ? QVariant(QString::fromStdString(part.name)) : QVariant();
    case Qt::DecorationRole:
      return decoration(part, index.column());
    case Qt::ToolTipRole:
      return toolTip(part, index.column());
    case Qt::ForegroundRole:
      return part.isVisible ? QVariant() : QVariant(colours::kMutedText);
    case Qt::FontRole: {
      QFont font;
      font.setBold(scene_.movingPart() == part.id);
      return font;
    }
    default:
      return {};
  }
}

QVariant PartsModel::decoration(const Part& part, int column) const {
  switch (column) {
    case Name:
      return swatch(part.colour);
    case Moving:
      return listIcon(scene_.movingPart() == part.id ? QStringLiteral("hand") : QStringLiteral("hand-off"));
    case Visible:
      return listIcon(part.isVisible ? QStringLiteral("eye") : QStringLiteral("eye-off"));
    case Locked:
      return listIcon(part.isLocked ? QStringLiteral("lock") : QStringLiteral("unlock"));
    default:
      return {};
  }
}

QString PartsModel::toolTip(const Part& part, int column) const {
  switch (column) {
    case Moving:
      return scene_.movingPart() == part.id ? tr("In hand") : tr("Take in hand: make it the moving part");
    case Visible:
      return part.isVisible ? tr("Shown and felt: hide it") : tr("Hidden and not felt: show it");
    case Locked:
      return part.isLocked ? tr("Locked: unlock it") : tr("Lock it against changes");
    default:
      break;
  }
  const TriangleMesh& mesh = part.geometry->mesh;
  const glm::dvec3 size = mesh.bounds().upper - mesh.bounds().lower;
  QString text =
      tr("%1\n%2\n%L3 triangles, %4 × %5 × %6")
          .arg(QString::fromStdString(part.name), QString::fromStdString(part.geometry->file.string()))
          .arg(mesh.triangles().size())
          .arg(formatLength(size.x), formatLength(size.y), formatLength(size.z));
  for (const std::string& warning : part.geometry->report.warnings)
    text += '\n' + QString::fromStdString(warning);
  return text;
}

QVariant PartsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole || section != Name) return {};
  return tr("Part");
}

Qt::ItemFlags PartsModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags result = QAbstractTableModel::flags(index);
  if (index.column() == Name) result |= Qt::ItemIsEditable;
  return result;
}

bool PartsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  const std::optional<PartId> part = partAt(index);
  if (!part || role != Qt::EditRole || index.column() != Name) return false;
  emit renameRequested(*part, value.toString().trimmed());
  return true;
}

}  // namespace nearfit::ui
