#pragma once

class QScrollArea;
class QWidget;

namespace nearfit::ui {

/// Returns a scroll area around the content of a panel, which a small window has room for in neither direction.
/// @param content  Becomes a child.
QScrollArea* makeScrollPane(QWidget* content, const char* name);

/// Returns a scroll area around the content of a panel, which a small window has not enough height for. It is as wide
/// as the content now needs, and the scroll bar: nothing is cut off at the sides.
/// @param content  Becomes a child.
QScrollArea* makeScrollColumn(QWidget* content, const char* name);

}  // namespace nearfit::ui
