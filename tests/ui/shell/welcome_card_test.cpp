#include "ui/shell/welcome_card.h"

#include <QAction>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QSettings>
#include <QtTest>

#include "core/session/session.h"
#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class WelcomeCardTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void whereThereIsRoomNothingScrolls();
  void nothingIsCutInASmallView_data();
  void nothingIsCutInASmallView();
};

namespace {

/// An empty scene's card in a view of some size.
struct WelcomeInView {
  explicit WelcomeInView(const QSize& size) {
    view.resize(size);
    view.show();
    (void)QTest::qWaitForWindowExposed(&view);
  }
  QScrollArea& scroll() const { return *card.findChild<QScrollArea*>(QStringLiteral("welcomeScroll")); }
  const QLabel& hint() const { return *card.findChild<QLabel*>(QStringLiteral("welcomeHint")); }

  Session session;
  QWidget view;
  QAction first{QStringLiteral("Open the demo of some parts")}, second{QStringLiteral("Add parts")};
  ui::WelcomeCard card{session, {&first, &second}, &view};
};

}  // namespace

void WelcomeCardTest::whereThereIsRoomNothingScrolls() {
  WelcomeInView w(QSize(900, 700));
  QTRY_COMPARE(w.scroll().widget()->size(), w.scroll().widget()->sizeHint());
  QTRY_COMPARE(w.scroll().verticalScrollBar()->maximum(), 0);
  QTRY_COMPARE(w.scroll().horizontalScrollBar()->maximum(), 0);
  QVERIFY(!w.hint().wordWrap());
  // As before, after the view was small for a while.
  const QSize usual = w.card.size();
  w.view.resize(260, 200);
  QTRY_VERIFY(w.hint().wordWrap());
  w.view.resize(900, 700);
  QTRY_COMPARE(w.card.size(), usual);
  QVERIFY(!w.hint().wordWrap());
}

void WelcomeCardTest::nothingIsCutInASmallView_data() {
  QTest::addColumn<QSize>("size");
  QTest::newRow("low") << QSize(900, 200);
  QTest::newRow("narrow") << QSize(280, 700);
  QTest::newRow("both") << QSize(280, 220);
  QTest::newRow("narrower than a button") << QSize(150, 120);
}

/// At scale 2 the view between the panels was narrower than the card, which was cut on both sides.
void WelcomeCardTest::nothingIsCutInASmallView() {
  QFETCH(QSize, size);
  WelcomeInView w(size);
  QTRY_COMPARE(w.view.size(), size);
  QTRY_VERIFY(w.view.rect().contains(w.card.geometry()));
  const QWidget& content = *w.scroll().widget();
  const auto pieces = [&content] {
    QList<QWidget*> all;
    for (QWidget* piece : content.findChildren<QWidget*>()) {
      const bool isText =
          qobject_cast<QLabel*>(piece) != nullptr || qobject_cast<QPushButton*>(piece) != nullptr;
      if (isText && piece->isVisible()) all << piece;
    }
    return all;
  };
  QVERIFY(pieces().size() >= 5);
  for (const QWidget* piece : pieces()) {
    const auto isWhole = [&] {
      const QRect place(piece->mapTo(&content, QPoint()), piece->size());
      const int needed = piece->hasHeightForWidth() ? piece->heightForWidth(piece->width())
                                                    : piece->minimumSizeHint().height();
      return content.rect().contains(place) && piece->width() >= piece->minimumSizeHint().width() &&
             piece->height() >= needed;
    };
    QTRY_VERIFY2(isWhole(), qPrintable(piece->objectName()));
  }
  // All of the content can be scrolled to.
  const auto isReached = [&w, &content] {
    return w.scroll().viewport()->width() + w.scroll().horizontalScrollBar()->maximum() >= content.width() &&
           w.scroll().viewport()->height() + w.scroll().verticalScrollBar()->maximum() >= content.height();
  };
  QTRY_VERIFY(isReached());
  for (const QScrollBar* bar : {w.scroll().horizontalScrollBar(), w.scroll().verticalScrollBar()})
    QVERIFY(bar->maximum() == 0 || bar->isVisible());
}

NEARFIT_QT_SUITE(WelcomeCardTest, test::runQtTest<WelcomeCardTest>)
#include "welcome_card_test.moc"
