#include "ui/widgets/names.h"

#include <QtTest>
#include <memory>

#include "core/servo/servo_tick.h"
#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/panels/feel/feel_notice.h"
#include "ui/widgets/elided_label.h"

using namespace nearfit;
using namespace nearfit::ui;

class NamesTest : public QObject {
  Q_OBJECT

 private slots:
  void aLongNameIsCutInTheMiddleWithinATextAndAShortOneIsNot();
  void namesAreListedAsASentenceDoes();
  void anUnbrokenWordWrapsAndSaysTheSame();
  void aLabelOfALongNameAsksForNoRoomAndShowsBothEnds();
  void aNoticeOfAPartWithALongNameIsNoWiderThanItsPanel();
};

void NamesTest::aLongNameIsCutInTheMiddleWithinATextAndAShortOneIsNot() {
  QCOMPARE(shortName(QStringLiteral("cube")), QStringLiteral("cube"));
  const QString cut = shortName(QStringLiteral("begin") + QString(190, 'W') + QStringLiteral("end"));
  QVERIFY(cut.startsWith(QStringLiteral("beginW")) && cut.endsWith(QStringLiteral("Wend")));
  QCOMPARE(cut.size(), 40);
  QCOMPARE(cut.count(QChar(0x2026)), 1);
}

void NamesTest::namesAreListedAsASentenceDoes() {
  const QStringList names{QStringLiteral("a"), QStringLiteral("b"), QStringLiteral("c")};
  QCOMPARE(listOfNames({}, 3), QString());
  QCOMPARE(listOfNames(names.mid(0, 1), 3), QStringLiteral("a"));
  QCOMPARE(listOfNames(names.mid(0, 2), 3), QStringLiteral("a and b"));
  QCOMPARE(listOfNames(names, 3), QStringLiteral("a, b and c"));
  QCOMPARE(listOfNames(names, 2), QStringLiteral("a, b and 1 more"));
  QCOMPARE(listOfNames(names, 3, 9), QStringLiteral("a, b, c and 6 more"));
}

void NamesTest::anUnbrokenWordWrapsAndSaysTheSame() {
  const QString sentence = QStringLiteral("These words are left as they are.");
  QCOMPARE(breakable(sentence), sentence);
  QString broken = breakable(QString(195, 'W'));
  QVERIFY(broken.size() > 195);
  QCOMPARE(broken.remove(QChar(0x200B)), QString(195, 'W'));
}

void NamesTest::aLabelOfALongNameAsksForNoRoomAndShowsBothEnds() {
  ElidedLabel label;
  label.setText(QString(195, 'W'));
  QCOMPARE(label.minimumSizeHint().width(), 0);
  label.resize(120, 24);
  const auto drawn = [&label](const QString& text) {
    label.setText(text);
    return label.grab().toImage();
  };
  // What is cut in the middle shows its two ends alone.
  QCOMPARE(drawn(QString(60, 'a') + QString(60, 'b')), drawn(QString(90, 'a') + QString(90, 'b')));
  QVERIFY(drawn(QString(120, 'a')) != drawn(QString(119, 'a') + 'b'));
}

void NamesTest::aNoticeOfAPartWithALongNameIsNoWiderThanItsPanel() {
  Scene scene;
  Part part;
  part.name = std::string(195, 'W');
  const PartId id = scene.add(part);
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->overlapping[0] = id;
  snapshot->overlappingCount = 1;
  FeelNotice notice;
  notice.showSnapshot(*snapshot, scene);
  QVERIFY2(notice.minimumSizeHint().width() < 280,
           qPrintable(QString::number(notice.minimumSizeHint().width())));
}

NEARFIT_QT_SUITE(NamesTest, test::runQtTest<NamesTest>)
#include "names_test.moc"
