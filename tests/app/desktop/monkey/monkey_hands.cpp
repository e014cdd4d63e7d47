#include "tests/app/desktop/monkey/monkey_hands.h"

#include <QApplication>
#include <QMouseEvent>
#include <QPointer>
#include <QWheelEvent>
#include <QtTest>
#include <array>
#include <cstdio>

namespace nearfit::test::monkey {
namespace {

void send(const QPointer<QWidget>& widget, QEvent::Type type, const QPoint& at, Qt::MouseButton button,
          Qt::MouseButtons held, Qt::KeyboardModifiers modifiers) {
  if (widget.isNull()) return;
  QMouseEvent event(type, at, widget->mapToGlobal(at), button, held, modifiers);
  QApplication::sendEvent(widget, &event);
}

}  // namespace

void say(const QString& what) {
  std::fprintf(stdout, "%s\n", qPrintable(what));
  std::fflush(stdout);
}

QString nameOf(const QWidget& widget) {
  const QString kind = QLatin1String(widget.metaObject()->className());
  return widget.objectName().isEmpty() ? kind : kind + QChar(' ') + widget.objectName();
}

int pick(RandomValues& random, int count) {
  return std::min(static_cast<int>(random.in(0.0, count)), count - 1);
}

QPoint placeIn(const QWidget& widget, RandomValues& random) {
  const QRect area = widget.visibleRegion().boundingRect();
  const QRect inside = area.isEmpty() ? widget.rect() : area;
  return {inside.left() + pick(random, std::max(inside.width(), 1)),
          inside.top() + pick(random, std::max(inside.height(), 1))};
}

Qt::KeyboardModifiers someModifiers(RandomValues& random) {
  Qt::KeyboardModifiers modifiers;
  if (random.flip(0.2)) modifiers |= Qt::ShiftModifier;
  if (random.flip(0.2)) modifiers |= Qt::ControlModifier;
  return modifiers;
}

QString someText(RandomValues& random) {
  static const std::array texts = {QStringLiteral("0"),
                                   QStringLiteral("-20"),
                                   QStringLiteral("12.5 mm"),
                                   QStringLiteral("1/4 in"),
                                   QStringLiteral("2*(3 mm"),
                                   QStringLiteral("+= 5"),
                                   QStringLiteral("1/0"),
                                   QStringLiteral("nan"),
                                   QStringLiteral("1e308"),
                                   QStringLiteral("-1e-320"),
                                   QStringLiteral("90 deg"),
                                   QStringLiteral("3 N + 2 m"),
                                   QStringLiteral("wheel %1&"),
                                   QStringLiteral("\u00e4\u4e2d\u0301"),
                                   QStringLiteral("<b>x</b>"),
                                   QStringLiteral("1e9"),
                                   QStringLiteral("0.001"),
                                   QStringLiteral("100"),
                                   QStringLiteral("5"),
                                   QString(300, QChar('9')),
                                   QString()};
  return texts[static_cast<std::size_t>(pick(random, static_cast<int>(texts.size())))];
}

void click(QWidget* widget, const QPoint& at, Qt::MouseButton button, Qt::KeyboardModifiers modifiers,
           bool isDouble) {
  const QPointer<QWidget> held(widget);
  send(held, QEvent::MouseButtonPress, at, button, button, modifiers);
  send(held, QEvent::MouseButtonRelease, at, button, Qt::NoButton, modifiers);
  if (isDouble) {
    send(held, QEvent::MouseButtonDblClick, at, button, button, modifiers);
    send(held, QEvent::MouseButtonRelease, at, button, Qt::NoButton, modifiers);
  }
  if (button != Qt::RightButton || held.isNull()) return;
  QContextMenuEvent menu(QContextMenuEvent::Mouse, at, held->mapToGlobal(at), modifiers);
  QApplication::sendEvent(held, &menu);
}

void drag(QWidget* widget, const QPoint& from, const QPoint& to, Qt::MouseButton button,
          Qt::KeyboardModifiers modifiers) {
  constexpr int kSteps = 6;
  const QPointer<QWidget> held(widget);
  send(held, QEvent::MouseMove, from, Qt::NoButton, Qt::NoButton, modifiers);
  send(held, QEvent::MouseButtonPress, from, button, button, modifiers);
  for (int i = 1; i <= kSteps; ++i) {
    send(held, QEvent::MouseMove, from + (to - from) * i / kSteps, Qt::NoButton, button, modifiers);
    QCoreApplication::processEvents();
  }
  send(held, QEvent::MouseButtonRelease, to, button, Qt::NoButton, modifiers);
}

void wheel(QWidget* widget, const QPoint& at, int delta, Qt::KeyboardModifiers modifiers) {
  QWheelEvent event(at, widget->mapToGlobal(at), {}, QPoint(0, delta), Qt::NoButton, modifiers,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(widget, &event);
}

void press(QWidget* widget, int key, Qt::KeyboardModifiers modifiers) {
  const QPointer<QWidget> held(widget);
  QTest::keyEvent(QTest::Press, widget, static_cast<Qt::Key>(key), modifiers);
  if (!held.isNull()) QTest::keyEvent(QTest::Release, held, static_cast<Qt::Key>(key), modifiers);
}

void type(QWidget* widget, const QString& text) {
  const QPointer<QWidget> held(widget);
  for (const QChar letter : text) {
    QKeyEvent down(QEvent::KeyPress, 0, Qt::NoModifier, QString(letter));
    if (!held.isNull()) QApplication::sendEvent(held, &down);
    QKeyEvent up(QEvent::KeyRelease, 0, Qt::NoModifier, QString(letter));
    if (!held.isNull()) QApplication::sendEvent(held, &up);
  }
}

int someKey(RandomValues& random) {
  static constexpr std::array kKeys = {Qt::Key_Up,     Qt::Key_Down,      Qt::Key_Left,   Qt::Key_Right,
                                       Qt::Key_PageUp, Qt::Key_PageDown,  Qt::Key_Home,   Qt::Key_End,
                                       Qt::Key_Return, Qt::Key_Tab,       Qt::Key_Space,  Qt::Key_Escape,
                                       Qt::Key_Delete, Qt::Key_Backspace, Qt::Key_Insert, Qt::Key_Plus,
                                       Qt::Key_Minus,  Qt::Key_Menu,      Qt::Key_Backtab};
  const double kind = random.in(0.0, 1.0);
  if (kind < 0.4) return kKeys[static_cast<std::size_t>(pick(random, static_cast<int>(kKeys.size())))];
  if (kind < 0.75) return Qt::Key_A + pick(random, 26);
  if (kind < 0.9) return Qt::Key_0 + pick(random, 10);
  return Qt::Key_F1 + pick(random, 12);
}

}  // namespace nearfit::test::monkey
