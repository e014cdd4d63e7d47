#pragma once

#include <QString>
#include <exception>

class QWidget;

namespace nearfit::ui {

/// What went wrong, for a person: a short sentence and the details that name place and remedy.
struct Failure {
  QString summary;
  QString details;
};

/// @param attempt  What was tried ("The scene could not be opened").
Failure describe(const QString& attempt, const std::exception_ptr& error);

/// Shows one message box and returns when it is closed.
void showFailure(const Failure& failure, QWidget* parent);

}  // namespace nearfit::ui
