#pragma once

#include <QFrame>
#include <QMap>
#include <QString>
#include <functional>
#include <vector>

namespace nearfit::ui {

/// Offers at the top of their parent, shown until they are taken or dismissed. Nothing waits for them.
class NoticeBar : public QFrame {
  Q_OBJECT

 public:
  struct Choice {
    QString text;
    std::function<void()> act;
  };

  explicit NoticeBar(QWidget* parent);

  /// Shows an offer; replaces one with the same key.
  /// @param choices    One button each; a click withdraws the offer.
  /// @param dismissed  Called when the user dismisses it.
  void offer(const QString& key, const QString& text, std::vector<Choice> choices,
             std::function<void()> dismissed = {});
  /// Removes an offer; no-op if there is none with this key.
  void withdraw(const QString& key);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void place();

  QMap<QString, QWidget*> offers_;
};

}  // namespace nearfit::ui
