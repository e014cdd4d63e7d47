#include "ui/dialogs/error_box.h"

#include <QClipboard>
#include <QGuiApplication>
#include <QMessageBox>
#include <QObject>
#include <QPushButton>
#include <QStringList>

#include "core/error.h"

namespace nearfit::ui {
namespace {

constexpr int kMostLines = 9;

QString sentence(const std::string& text) {
  QString result = QString::fromStdString(text);
  if (result.isEmpty()) return result;
  result[0] = result[0].toUpper();
  return result.endsWith('.') ? result : result + QChar('.');
}

}  // namespace

Failure describe(const QString& attempt, const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Error& e) {
    QStringList lines;
    if (!e.problem().empty()) lines << sentence(e.problem());
    if (!e.remedy().empty()) lines << sentence(e.remedy());
    if (!e.where().empty()) lines << QObject::tr("Where: %1").arg(QString::fromStdString(e.where()));
    return {attempt, lines.join(QStringLiteral("\n\n"))};
  } catch (const std::bad_alloc&) {
    return {attempt,
            QObject::tr("There is not enough memory.\n\nClose other programs or use a smaller file.")};
  } catch (const std::exception& e) {
    return {attempt, QString::fromLocal8Bit(e.what())};
  } catch (...) {
    return {attempt, QObject::tr("The cause is unknown.")};
  }
}

void showFailure(const Failure& failure, QWidget* parent) {
  QMessageBox box(QMessageBox::Warning, QObject::tr("Nearfit"), failure.summary, QMessageBox::Ok, parent);
  box.setObjectName(QStringLiteral("errorBox"));
  box.setTextFormat(Qt::PlainText);
  box.setTextInteractionFlags(Qt::TextSelectableByMouse);
  // Of fifty files nobody reads all at once, and a box taller than the screen has no button.
  const QStringList lines = failure.details.split('\n');
  if (lines.size() > kMostLines) {
    box.setInformativeText(lines.mid(0, kMostLines).join('\n') + QStringLiteral("\n…"));
    box.setDetailedText(failure.details);
  } else {
    box.setInformativeText(failure.details);
  }
  QPushButton* copy = box.addButton(QObject::tr("Copy details"), QMessageBox::ActionRole);
  copy->setObjectName(QStringLiteral("copyDetails"));
  copy->setToolTip(QObject::tr("Puts this message on the clipboard"));
  copy->disconnect();  // It copies, and the box stays.
  QObject::connect(copy, &QPushButton::clicked, &box, [&failure] {
    QGuiApplication::clipboard()->setText(failure.summary + QStringLiteral("\n\n") + failure.details);
  });
  box.setDefaultButton(QMessageBox::Ok);
  box.setEscapeButton(QMessageBox::Ok);
  box.exec();
}

}  // namespace nearfit::ui
