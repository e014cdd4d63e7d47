#include "ui/widgets/column_widths.h"

#include <QEvent>
#include <QHeaderView>
#include <QTableView>
#include <algorithm>
#include <numeric>
#include <utility>

namespace nearfit::ui {

ColumnWidths::ColumnWidths(QTableView& table, std::vector<Column> columns)
    : QObject(&table),
      table_(table),
      columns_(std::move(columns)),
      needed_(columns_.size(), 0),
      isUsers_(columns_.size(), false) {
  QHeaderView* header = table_.horizontalHeader();
  header->setSectionResizeMode(QHeaderView::Interactive);
  header->setStretchLastSection(false);
  connect(header, &QHeaderView::sectionResized, this, [this](int column, int, int) {
    if (!isApplying_) isUsers_[static_cast<std::size_t>(column)] = true;
  });
  const QAbstractItemModel* model = table_.model();
  connect(model, &QAbstractItemModel::modelReset, this, &ColumnWidths::measure);
  connect(model, &QAbstractItemModel::dataChanged, this, &ColumnWidths::measure);
  table_.viewport()->installEventFilter(this);
  measure();
}

bool ColumnWidths::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) apply();
  return QObject::eventFilter(watched, event);
}

void ColumnWidths::measure() {
  const QHeaderView& header = *table_.horizontalHeader();
  // The table hides its own.
  const QAbstractItemView& contents = table_;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const int column = static_cast<int>(i);
    needed_[i] = std::max({needed_[i], header.sectionSizeHint(column), contents.sizeHintForColumn(column)});
  }
  apply();
}

void ColumnWidths::apply() {
  QHeaderView& header = *table_.horizontalHeader();
  std::vector<int> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const int least = std::max(header.minimumSectionSize(), header.sectionSizeHint(static_cast<int>(i)));
    const int wanted = std::clamp(needed_[i], least, std::max(least, columns_[i].most));
    widths.push_back(isUsers_[i] ? header.sectionSize(static_cast<int>(i)) : wanted);
  }
  int room = table_.viewport()->width() - std::accumulate(widths.begin(), widths.end(), 0);
  int stretched = 0;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (isUsers_[i]) continue;
    const int more = std::clamp(needed_[i] - widths[i], 0, std::max(room, 0));
    widths[i] += more;
    room -= more;
    stretched += columns_[i].isStretched ? 1 : 0;
  }
  for (std::size_t i = 0; i < columns_.size() && room > 0; ++i) {
    if (isUsers_[i] || !columns_[i].isStretched) continue;
    const int share = room / stretched--;
    widths[i] += share;
    room -= share;
  }
  isApplying_ = true;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    header.resizeSection(static_cast<int>(i), widths[i]);
  isApplying_ = false;
}

}  // namespace nearfit::ui
