#pragma once

#include <QPoint>
#include <QString>
#include <QWidget>

#include "tests/support/random_values.h"

/// Events to widgets that may be gone after any of them.
namespace nearfit::test::monkey {

/// One line to the log, at once: a crash must not take it along.
void say(const QString& what);
/// How the log calls a widget.
QString nameOf(const QWidget& widget);

int pick(RandomValues& random, int count);
/// A place of a widget that is to be seen.
QPoint placeIn(const QWidget& widget, RandomValues& random);
Qt::KeyboardModifiers someModifiers(RandomValues& random);
/// What a user, a cat or a clipboard may put into a field.
QString someText(RandomValues& random);

void click(QWidget* widget, const QPoint& at, Qt::MouseButton button = Qt::LeftButton,
           Qt::KeyboardModifiers modifiers = {}, bool isDouble = false);
/// Presses at the first place, goes to the last in steps, and lets go.
void drag(QWidget* widget, const QPoint& from, const QPoint& to, Qt::MouseButton button,
          Qt::KeyboardModifiers modifiers);
void wheel(QWidget* widget, const QPoint& at, int delta, Qt::KeyboardModifiers modifiers);
void press(QWidget* widget, int key, Qt::KeyboardModifiers modifiers = {});
void type(QWidget* widget, const QString& text);
/// A key that the program, or a widget, may do something with.
int someKey(RandomValues& random);

}  // namespace nearfit::test::monkey
