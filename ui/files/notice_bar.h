#pragma once

#include <QFrame>
#include <QMap>
#include <QString>
#include <functional>
#include <vector>

namespace nearfit::ui {

/// Offers that stand at the top of their parent until they are taken or waved away; nothing waits for them.
class NoticeBar : public QFrame {
  Q_OBJECT

 public:
  struct Choice {
    QString text;
    std::function<void()> act;
  };

  explicit NoticeBar(QWidget* parent);

  /// Shows an offer; one of the same key is replaced.
  /// @param choices    One button each; the offer goes when one is clicked.
  /// @param dismissed  Called when it is waved away.
  void offer(const QString& key, const QString& text, std::vector<Choice> choices,
             std::function<void()> dismissed = {});
  void withdraw(const QString& key);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void place();

  QMap<QString, QWidget*> offers_;
};

}  // namespace nearfit::ui
