#include "ui/widgets/error_box.h"

#include <QApplication>
#include <QClipboard>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFileInfo>
#include <QGuiApplication>
#include <QHeaderView>
#include <QLabel>
#include <QObject>
#include <QPushButton>
#include <QStringList>
#include <QStyle>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "core/base/error.h"
#include "ui/widgets/font_scale.h"

namespace nearfit::ui {
namespace {

QString sentence(const std::string& text) {
  QString result = QString::fromStdString(text);
  if (result.isEmpty()) return result;
  result[0] = result[0].toUpper();
  return result.endsWith('.') ? result : result + QChar('.');
}

QString paragraphsOf(const FailedItem& item) {
  QStringList paragraphs{item.reason, item.remedy};
  if (!item.where.isEmpty()) paragraphs << QObject::tr("Where: %1").arg(item.where);
  paragraphs.removeAll(QString());
  return paragraphs.join(QStringLiteral("\n\n"));
}

/// Says what went wrong. It blocks nothing: the window behind it stays usable, above all to stop the servo.
/// Failures that follow while it is open are added to it.
class FailureDialog : public QDialog {
 public:
  explicit FailureDialog(QWidget* parent);

  void add(const Failure& failure);

 private:
  /// A failure that occurred several times is listed once.
  struct Entry {
    Failure failure;
    int count = 1;
  };
  void showAll();
  void showTable(const QVector<FailedItem>& rows, bool areFiles);
  QString text() const;

  QLabel *summary_, *details_;
  QTableWidget* table_;
  QVector<Entry> entries_;
};

const QString kFailureDialog = QStringLiteral("errorBox");  ///< Object name.

enum Column { Name, Reason, Remedy, ColumnCount };

constexpr int kTextWidth = 400, kTableWidth = 760, kNameWidth = 200;
constexpr int kTableRowHeight = 56,
              kMaxTableHeight = 340;  ///< Initial size of the table; the user may enlarge it.
/// Nobody reads more, and a longer table responds slowly; copying includes all rows.
constexpr int kMaxRows = 500;

QLabel* addLabel(QVBoxLayout& layout, const char* name) {
  auto* label = new QLabel;
  label->setObjectName(QLatin1String(name));
  label->setTextFormat(Qt::PlainText);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  label->setWordWrap(true);
  layout.addWidget(label);
  return label;
}

QString counted(const QString& summary, int count) {
  return count == 1 ? summary : QObject::tr("%1 (%2 times)").arg(summary).arg(count);
}

/// Returns a failure as a row among others: its summary stands in place of a file's name.
FailedItem rowOf(const Failure& failure, int count) {
  const QStringList paragraphs = failure.details.split(QStringLiteral("\n\n"));
  return {
      counted(failure.summary, count), paragraphs.value(0), paragraphs.mid(1).join(QStringLiteral("\n")), {}};
}

FailureDialog::FailureDialog(QWidget* parent) : QDialog(parent), table_(new QTableWidget(this)) {
  setObjectName(kFailureDialog);
  setWindowTitle(tr("Nearfit"));
  setAttribute(Qt::WA_DeleteOnClose);
  auto* picture = new QLabel(this);
  const int size = style()->pixelMetric(QStyle::PM_MessageBoxIconSize, nullptr, this);
  picture->setPixmap(style()->standardIcon(QStyle::SP_MessageBoxWarning, nullptr, this).pixmap(size, size));
  auto* texts = new QVBoxLayout;
  texts->setSpacing(10);
  summary_ = addLabel(*texts, "errorSummary");
  QFont bold = summary_->font();
  bold.setBold(true);
  summary_->setFont(bold);
  summary_->setMinimumWidth(forFont(*this, kTextWidth));
  details_ = addLabel(*texts, "errorDetails");
  texts->addStretch();
  auto* top = new QHBoxLayout;
  top->setSpacing(14);
  top->addWidget(picture, 0, Qt::AlignTop);
  top->addLayout(texts, 1);

  table_->setObjectName(QStringLiteral("errorTable"));
  table_->setAccessibleName(tr("What failed, why, and what to do"));
  table_->setColumnCount(ColumnCount);
  table_->setWordWrap(true);
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setTabKeyNavigation(false);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table_->horizontalHeader()->setSectionResizeMode(Name, QHeaderView::Interactive);
  table_->setColumnWidth(Name, forFont(*this, kNameWidth));
  table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  table_->setMinimumWidth(forFont(*this, kTableWidth));

  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok, this);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  QPushButton* copy = buttons->addButton(tr("Copy details"), QDialogButtonBox::ActionRole);
  copy->setObjectName(QStringLiteral("copyDetails"));
  copy->setToolTip(tr("Copy this message to the clipboard"));
  copy->setAutoDefault(false);
  connect(copy, &QPushButton::clicked, this, [this] { QGuiApplication::clipboard()->setText(text()); });
  buttons->button(QDialogButtonBox::Ok)->setDefault(true);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(16, 16, 16, 14);
  layout->setSpacing(12);
  layout->addLayout(top);
  layout->addWidget(table_, 1);
  layout->addWidget(buttons);
  buttons->button(QDialogButtonBox::Ok)->setFocus();
}

void FailureDialog::add(const Failure& failure) {
  const auto same = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.failure.summary == failure.summary && entry.failure.details == failure.details;
  });
  if (same != entries_.end())
    ++same->count;
  else
    entries_ << Entry{failure};
  showAll();
}

void FailureDialog::showAll() {
  const bool isOne = entries_.size() == 1;
  const Entry& first = entries_.front();
  const bool hasTable = !isOne || !first.failure.items.isEmpty();
  summary_->setText(isOne ? counted(first.failure.summary, first.count)
                          : tr("%n failures.", nullptr, static_cast<int>(entries_.size())));
  details_->setText(isOne && !hasTable ? first.failure.details : QString());
  details_->setVisible(!details_->text().isEmpty());
  table_->setVisible(hasTable);
  if (!hasTable) return;
  QVector<FailedItem> rows;
  for (const Entry& entry : entries_) {
    if (!isOne) rows << rowOf(entry.failure, entry.count);
    if (!isOne && !entry.failure.items.isEmpty()) rows.back().reason = rows.back().remedy = QString();
    rows << entry.failure.items;
  }
  showTable(rows, isOne);
}

void FailureDialog::showTable(const QVector<FailedItem>& rows, bool areFiles) {
  table_->setHorizontalHeaderLabels({areFiles ? tr("File") : tr("What failed"), tr("Why"), tr("What to do")});
  const auto all = static_cast<int>(rows.size()), shown = std::min(all, kMaxRows);
  table_->setRowCount(shown + (shown < all ? 1 : 0));
  table_->setMinimumHeight(
      forFont(*this, std::min(kMaxTableHeight, kTableRowHeight * (table_->rowCount() + 1))));
  for (int row = 0; row < shown; ++row) {
    const QString texts[] = {rows[row].name, rows[row].reason, rows[row].remedy};
    for (int column = Name; column < ColumnCount; ++column) {
      auto* cell = new QTableWidgetItem(texts[column]);
      cell->setTextAlignment(Qt::AlignLeft | Qt::AlignTop);
      cell->setToolTip(rows[row].where);
      table_->setItem(row, column, cell);
    }
  }
  if (shown < all)
    table_->setItem(shown, Name, new QTableWidgetItem(tr("and %n more", nullptr, all - shown)));
}

QString FailureDialog::text() const {
  QStringList texts;
  for (const Entry& entry : entries_)
    texts << counted(entry.failure.summary, entry.count) + QStringLiteral("\n\n") + entry.failure.details;
  return texts.join(QStringLiteral("\n\n\n"));
}

}  // namespace

FailedItem describeItem(const QString& name, const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Error& e) {
    return {name, sentence(e.problem()), sentence(e.remedy()), QString::fromStdString(e.where())};
  } catch (const std::bad_alloc&) {
    return {name,
            QObject::tr("There is not enough memory."),
            QObject::tr("Close other programs or use a smaller file."),
            {}};
  } catch (const std::exception& e) {
    return {name, QString::fromLocal8Bit(e.what()), {}, {}};
  } catch (...) {
    return {name, QObject::tr("The cause is unknown."), {}, {}};
  }
}

Failure describe(const QString& attempt, const std::exception_ptr& error) {
  return describeItems(attempt, {describeItem({}, error)});
}

Failure describeItems(const QString& summary, const QVector<FailedItem>& items) {
  if (items.size() == 1) return {summary, paragraphsOf(items.first())};
  QStringList lines;
  for (const FailedItem& item : items) {
    const QString place = item.where.isEmpty() ? item.name : item.where;
    lines << QStringLiteral("%1: %2 %3").arg(place, item.reason, item.remedy).trimmed();
  }
  return {summary, lines.join('\n'), items};
}

void showFailure(const Failure& failure, QWidget* parent, const QList<QAction*>& actions) {
  // Only failure dialogs have that name.
  auto* dialog =
      static_cast<FailureDialog*>(parent->findChild<QDialog*>(kFailureDialog, Qt::FindDirectChildrenOnly));
  // A closed dialog may still await deletion.
  if (dialog == nullptr || !dialog->isVisible()) {
    dialog = new FailureDialog(parent);
    dialog->addActions(actions);
    // A modal question would keep the dialog out of reach otherwise.
    if (QApplication::activeModalWidget() != nullptr) dialog->setWindowModality(Qt::ApplicationModal);
  }
  dialog->add(failure);
  dialog->show();
  dialog->raise();
}

}  // namespace nearfit::ui
