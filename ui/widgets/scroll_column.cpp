#include "ui/widgets/scroll_column.h"

#include <QScrollArea>
#include <QScrollBar>

namespace nearfit::ui {

QScrollArea* makeScrollPane(QWidget* content, const char* name) {
  // In the content's window, so that the content keeps its place in the order of the Tab key.
  auto* scroll = new QScrollArea(content->parentWidget());
  scroll->setObjectName(QLatin1String(name));
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setFocusPolicy(Qt::NoFocus);
  scroll->setWidgetResizable(true);
  scroll->setWidget(content);
  return scroll;
}

QScrollArea* makeScrollColumn(QWidget* content, const char* name) {
  QScrollArea* scroll = makeScrollPane(content, name);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setMinimumWidth(content->minimumSizeHint().width() +
                          scroll->verticalScrollBar()->sizeHint().width());
  return scroll;
}

}  // namespace nearfit::ui
