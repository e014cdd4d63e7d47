#pragma once

#include <QAction>
#include <QList>
#include <QString>
#include <QVector>
#include <exception>

class QWidget;

namespace nearfit::ui {

/// One of several files that failed, for a line of a list. Full sentences.
struct FailedItem {
  QString name, reason, remedy;
  QString where;  ///< Path and line.
};

/// A failure worded for the user: a short summary, and details with place and remedy.
struct Failure {
  QString summary;
  QString details;
  QVector<FailedItem> items = {};  ///< The details by file, if there are several files.
};

/// Words an error for the user.
/// @param attempt  Summary of what failed ("The scene could not be opened").
Failure describe(const QString& attempt, const std::exception_ptr& error);

/// Words the error of one file.
/// @param name  Name that the file is shown by.
FailedItem describeItem(const QString& name, const std::exception_ptr& error);

/// Words the failure of several files, with a line of details for each; a single file is
/// worded as by describe().
Failure describeItems(const QString& summary, const QVector<FailedItem>& items);

/// Shows a failure without blocking, and returns at once. If a failure dialog is open already, it
/// takes the failure in.
/// @param actions  Actions whose keys must work there as they do in the window.
void showFailure(const Failure& failure, QWidget* parent, const QList<QAction*>& actions = {});

}  // namespace nearfit::ui
