#include "ui/widgets/make_action.h"

#include <QAction>
#include <QtTest>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class MakeActionTest : public QObject {
  Q_OBJECT

 private slots:
  void aToolTipNamesTheCommandAndItsKeysAboveItsHelp();
  void aToolTipFollowsTextAndKeys();
  void aNameIsNeverReadAsMarkup();
};

void MakeActionTest::aToolTipNamesTheCommandAndItsKeysAboveItsHelp() {
  const QAction* open = ui::makeAction(this, "open", QStringLiteral("&Open…"), {}, QStringLiteral("Ctrl+O"),
                                       QStringLiteral("Open a scene"));
  QCOMPARE(open->toolTip(), QStringLiteral("Open (Ctrl+O)\nOpen a scene"));
  const QAction* fit =
      ui::makeSwitch(this, "edges", QStringLiteral("&Edges"), {}, true, QStringLiteral("Draw edges"));
  QCOMPARE(fit->toolTip(), QStringLiteral("Edges\nDraw edges"));
}

void MakeActionTest::aToolTipFollowsTextAndKeys() {
  QAction* record = ui::makeAction(this, "record", QStringLiteral("&Record…"), {}, Qt::Key_F8,
                                   QStringLiteral("Record every tick"));
  record->setText(QStringLiteral("Stop &recording"));
  QCOMPARE(record->toolTip(), QStringLiteral("Stop recording (F8)\nRecord every tick"));
  record->setShortcut(Qt::Key_F7);
  QCOMPARE(record->toolTip(), QStringLiteral("Stop recording (F7)\nRecord every tick"));
  ui::setHelp(*record, QStringLiteral("Stop and keep the file"));
  record->setShortcut({});
  QCOMPARE(record->toolTip(), QStringLiteral("Stop recording\nStop and keep the file"));
}

void MakeActionTest::aNameIsNeverReadAsMarkup() {
  QAction* undo =
      ui::makeAction(this, "undo", QStringLiteral("&Undo"), {}, {}, QStringLiteral("Undo the last step"));
  undo->setText(QStringLiteral("&Undo Move <b>nut</b> && <i>bolt</i>"));
  QCOMPARE(undo->toolTip(),
           QStringLiteral("<qt>Undo Move &lt;b&gt;nut&lt;/b&gt; &amp; &lt;i&gt;bolt&lt;/i&gt;"
                          "<br>Undo the last step</qt>"));
}

NEARFIT_QT_SUITE(MakeActionTest, test::runQtTest<MakeActionTest>)
#include "make_action_test.moc"
