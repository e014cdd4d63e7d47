#pragma once

#include <QWidget>

class QLabel;
class QVBoxLayout;

namespace nearfit::ui {

/// A heading with named numbers below it.
class Readouts : public QWidget {
  Q_OBJECT

 public:
  explicit Readouts(const QString& heading, QWidget* parent = nullptr);

  /// Adds a number and returns its label.
  /// @param objectName  Object name of the label.
  QLabel* add(const QString& name, const char* objectName, const QString& toolTip = {});
  /// Adds a text below the numbers, in a colour of the light theme, and returns its label. The text keeps its
  /// line while empty, so that nothing jumps.
  QLabel* addNote(const char* objectName, const QColor& colour);
  /// Text in place of a missing number.
  static QString nothing() { return QStringLiteral("–"); }

 private:
  QVBoxLayout* layout_;
};

}  // namespace nearfit::ui
