#include "ui/widgets/error_box.h"

#include <QApplication>
#include <QObject>
#include <QStringList>

#include "core/base/error.h"
#include "ui/widgets/failure_dialog.h"

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
  auto* dialog = parent->findChild<FailureDialog*>(QString(), Qt::FindDirectChildrenOnly);
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
