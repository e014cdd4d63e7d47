#pragma once

#include <QAction>
#include <QList>
#include <QString>
#include <QVector>
#include <exception>

class QWidget;

namespace nearfit::ui {

/// One file of several that failed, for a line of a list. Full sentences.
struct FailedItem {
  QString name, reason, remedy;
  QString where;  ///< With path and line.
};

/// What went wrong, for a person: a short sentence and the details that name place and remedy.
struct Failure {
  QString summary;
  QString details;
  QVector<FailedItem> items = {};  ///< What the details say, where they are of several files.
};

/// @param attempt  What was tried ("The scene could not be opened").
Failure describe(const QString& attempt, const std::exception_ptr& error);

/// Of one file.
/// @param name  That it is shown by.
FailedItem describeItem(const QString& name, const std::exception_ptr& error);

/// Of several files, of which one line of the details is about each; of a single one as `describe`.
Failure describeItems(const QString& summary, const QVector<FailedItem>& items);

/// Shows what failed beside whatever goes on, and returns at once; what is shown already is joined.
/// @param actions  Whose keys are to work there as they do in the window.
void showFailure(const Failure& failure, QWidget* parent, const QList<QAction*>& actions = {});

}  // namespace nearfit::ui
