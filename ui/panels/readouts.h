#pragma once

#include <QWidget>

class QLabel;
class QVBoxLayout;

namespace nearfit::ui {

/// Numbers by name, one below the other, with a heading.
class Readouts : public QWidget {
  Q_OBJECT

 public:
  explicit Readouts(const QString& heading, QWidget* parent = nullptr);

  /// @param objectName  Of the number's label.
  QLabel* add(const QString& name, const char* objectName, const QString& toolTip = {});
  /// A text below them, in that colour of the light theme; keeps its line while it is empty, so that nothing
  /// jumps.
  QLabel* addNote(const char* objectName, const QColor& colour);
  /// What stands where there is no number.
  static QString nothing() { return QStringLiteral("–"); }

 private:
  QVBoxLayout* layout_;
};

}  // namespace nearfit::ui
