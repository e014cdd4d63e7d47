#pragma once

#include <QDialog>
#include <QString>

class QLineEdit;
class QListWidget;
class QTextBrowser;
class QUrl;

namespace nearfit::ui {

/// Shows the user's guide: pages in Markdown with pictures, the headings of the page beside it, and a search. Links between
/// pages are followed here, those to the web by the system's browser.
class GuideDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param file    Page to begin with.
  /// @param parent  Window that it stays above; may be used meanwhile.
  GuideDialog(const QString& file, QWidget* parent);

 private:
  void follow(const QUrl& link);
  void showPage(const QString& file);
  void listHeadings();
  void goToHeading(const QString& slug);
  void search();

  QTextBrowser* page_;
  QListWidget* headings_;
  QLineEdit* search_;
};

}  // namespace nearfit::ui
