#include "ui/shell/guide_dialog.h"

#include <QCursor>
#include <QDesktopServices>
#include <QDir>
#include <QFileInfo>
#include <QImage>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QScrollBar>
#include <QTextBlock>
#include <QTextBrowser>
#include <QToolTip>
#include <QUrl>
#include <QVBoxLayout>

namespace nearfit::ui {
namespace {

/// Widest picture [pixels of the window]: fits the page at its first size.
constexpr int kWidestPicture = 640;
constexpr int kDeepestHeading = 3;

/// A page whose pictures fit it.
class PageBrowser : public QTextBrowser {
 public:
  using QTextBrowser::QTextBrowser;

  QVariant loadResource(int type, const QUrl& name) override {
    if (type != QTextDocument::ImageResource) return QTextBrowser::loadResource(type, name);
    const QImage picture(source().resolved(name).toLocalFile());
    if (picture.width() <= kWidestPicture) return picture;
    return picture.scaledToWidth(kWidestPicture, Qt::SmoothTransformation);
  }
};

/// The fragment by which links name a heading: lower case, dashes for blanks, no punctuation.
QString slugOf(const QString& heading) {
  QString slug;
  for (const QChar c : heading.trimmed().toLower()) {
    if (c.isLetterOrNumber() || c == QChar('_') || c == QChar('-')) slug += c;
    if (c == QChar(' ')) slug += QChar('-');
  }
  return slug;
}

}  // namespace

GuideDialog::GuideDialog(const QString& file, QWidget* parent)
    : QDialog(parent),
      page_(new PageBrowser(this)),
      headings_(new QListWidget(this)),
      search_(new QLineEdit(this)) {
  setObjectName(QStringLiteral("guideDialog"));
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("User guide"));
  page_->setObjectName(QStringLiteral("guidePage"));
  page_->setAccessibleName(tr("Page"));
  page_->setOpenLinks(false);
  page_->document()->setDocumentMargin(16);
  headings_->setObjectName(QStringLiteral("guideHeadings"));
  headings_->setAccessibleName(tr("Headings"));
  headings_->setMaximumWidth(fontMetrics().averageCharWidth() * 34);
  search_->setObjectName(QStringLiteral("guideSearch"));
  search_->setAccessibleName(tr("Search this page"));
  search_->setPlaceholderText(tr("Search this page; Enter finds the next place"));
  search_->setClearButtonEnabled(true);
  auto* back = new QPushButton(tr("Back"), this);
  back->setObjectName(QStringLiteral("guideBack"));
  back->setAutoDefault(false);
  back->setEnabled(false);
  auto* top = new QHBoxLayout;
  top->addWidget(back);
  top->addWidget(search_, 1);
  auto* body = new QHBoxLayout;
  body->addWidget(headings_);
  body->addWidget(page_, 1);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(top);
  layout->addLayout(body, 1);
  connect(back, &QPushButton::clicked, page_, &QTextBrowser::backward);
  connect(page_, &QTextBrowser::backwardAvailable, back, &QPushButton::setEnabled);
  connect(page_, &QTextBrowser::sourceChanged, this, &GuideDialog::listHeadings);
  connect(page_, &QTextBrowser::anchorClicked, this, &GuideDialog::follow);
  connect(search_, &QLineEdit::returnPressed, this, &GuideDialog::search);
  connect(headings_, &QListWidget::itemClicked, this,
          [this](const QListWidgetItem* item) { goToHeading(slugOf(item->text())); });
  resize(980, 720);
  showPage(file);
}

void GuideDialog::showPage(const QString& file) {
  page_->setSource(QUrl::fromLocalFile(file), QTextDocument::MarkdownResource);
}

void GuideDialog::follow(const QUrl& link) {
  const QUrl target = page_->source().resolved(link);
  if (!target.isLocalFile()) {
    QDesktopServices::openUrl(target);
    return;
  }
  const QString file = QDir::cleanPath(target.toLocalFile());
  if (!QFileInfo(file).isFile()) {
    QToolTip::showText(QCursor::pos(), tr("%1 is not installed").arg(QFileInfo(file).fileName()), page_);
    return;
  }
  if (file != page_->source().toLocalFile()) showPage(file);
  if (target.hasFragment()) goToHeading(target.fragment());
}

void GuideDialog::listHeadings() {
  headings_->clear();
  for (QTextBlock block = page_->document()->begin(); block.isValid(); block = block.next()) {
    const int level = block.blockFormat().headingLevel();
    if (level < 1 || level > kDeepestHeading) continue;
    headings_->addItem(QString(2 * (level - 1), QChar(' ')) + block.text());
  }
}

void GuideDialog::goToHeading(const QString& slug) {
  for (QTextBlock block = page_->document()->begin(); block.isValid(); block = block.next()) {
    if (block.blockFormat().headingLevel() < 1 || slugOf(block.text()) != slug) continue;
    page_->setTextCursor(QTextCursor(block));
    page_->verticalScrollBar()->setValue(page_->verticalScrollBar()->value() + page_->cursorRect().top());
    return;
  }
}

void GuideDialog::search() {
  if (page_->find(search_->text())) return;
  page_->moveCursor(QTextCursor::Start);
  if (!page_->find(search_->text()) && !search_->text().isEmpty())
    QToolTip::showText(search_->mapToGlobal(QPoint(0, search_->height())), tr("Not on this page"), search_);
}

}  // namespace nearfit::ui
