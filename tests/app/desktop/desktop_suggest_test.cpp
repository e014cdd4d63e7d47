#include <QDialog>
#include <QPushButton>
#include <QRadioButton>

#include "core/files/sha256.h"
#include "core/path/certificate.h"
#include "core/path/path_file.h"
#include "core/path/path_verifier.h"
#include "core/scene/scene_file.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/dialog_answers.h"
#include "tests/app/desktop/view_driver.h"
#include "ui/panels/suggest/path_suggestion.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The application with the two cubes; the moving one, drawn above the fixed one, was put beside it.
struct SuggestFixture {
  SuggestFixture() {
    d.window().setFailureSink([this](const ui::Failure& failure) { failures << failure; });
    d.addCubes();
    RigidTransform beside;
    beside.translation = {0.06, 0.0, -0.03};
    d.session().movePart(d.partId("moving"), beside);
    QObject::connect(&d.window().viewport(), &ui::Viewport::snapshotDrawn, &d.application,
                     [this](const ServoSnapshot& snapshot) { ghosts << snapshot.handle.translation.x; });
  }
  /// Answers the question by a goal's button and *Search*.
  void suggest(const char* goal) {
    answers.expect(QStringLiteral("suggestDialog"), [goal](QDialog& dialog) {
      auto* choice = dialog.findChild<QRadioButton*>(QLatin1String(goal));
      choice->setFocus();
      QTest::keyClick(choice, Qt::Key_Space);
      QTest::mouseClick(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
      return !dialog.isVisible();
    });
    d.choose("suggestPath");
  }
  QDialog* card() { return d.widget<QDialog>("suggestionCard"); }
  void press(const char* button) {
    QTest::mouseClick(card()->findChild<QPushButton*>(QLatin1String(button)), Qt::LeftButton);
  }

  DesktopDriver d;
  QVector<ui::Failure> failures;
  QVector<double> ghosts;  ///< Where the view has drawn the ghost, x [m].
  DialogAnswers answers;
};

}  // namespace

class DesktopSuggestTest : public QObject {
  Q_OBJECT

 private slots:
  void aPathThatIsFoundIsPlayedSavedAndFelt();
  void theCertificateIsSavedUntilTheSceneChanges();
  void theGuideIsSeenAndTheKeysGoToTheView();
  void closingTheCardEndsTheGhost();
  void theSeparationOfferedCanBeRead();
  void whatIsOutAlreadyIsTold();
  void withoutAPartInHandThereIsNothingToSuggest();
};

void DesktopSuggestTest::aPathThatIsFoundIsPlayedSavedAndFelt() {
  SuggestFixture f;
  f.suggest("suggestToDrawn");
  QTRY_VERIFY_WITH_TIMEOUT(f.card() != nullptr && f.card()->isVisible(), 60'000);
  QVERIFY(f.d.text("suggestionText").contains(QStringLiteral("Proven to keep")));
  // The ghost goes from where the part is to where it was drawn; the part stays.
  QTRY_VERIFY(std::ranges::any_of(f.ghosts, [](double x) { return x > 0.001 && x < 0.059; }));
  QTRY_VERIFY(std::ranges::any_of(f.ghosts, [](double x) { return std::abs(x) < 1e-9; }));
  QCOMPARE(f.d.part("moving").worldFromPart.translation.x, 0.06);

  const std::filesystem::path file = f.d.folder.path() / "in.nfpath";
  f.answers.expectFile(QString::fromStdString(file.string()));
  f.press("suggestionSave");
  QTRY_VERIFY(std::filesystem::exists(file));
  const AssemblyPath path = readPathFile(file);
  QCOMPARE(path.poses.front().worldFromLead.translation.x, 0.06);
  QCOMPARE(path.poses.back().worldFromLead.translation.x, 0.0);

  f.d.chooseHand(ui::Hand::Manual);
  f.press("suggestionFeel");
  QTRY_VERIFY(f.d.application.servo().isRunning());
  f.d.choose("stop");
  QTRY_VERIFY(!f.d.application.servo().status().isTaken());
  QVERIFY2(f.answers.faults().isEmpty(), qPrintable(f.answers.faults().join(QLatin1Char(','))));
  QVERIFY(f.failures.isEmpty());
}

void DesktopSuggestTest::theCertificateIsSavedUntilTheSceneChanges() {
  SuggestFixture f;
  f.suggest("suggestToDrawn");
  QTRY_VERIFY_WITH_TIMEOUT(f.card() != nullptr && f.card()->isVisible(), 60'000);
  const auto* button = f.card()->findChild<QPushButton*>(QStringLiteral("suggestionCertificate"));
  QVERIFY(button->isEnabled());
  const auto savedTo = [&f](const char* name) {
    const std::filesystem::path file = f.d.folder.path() / name;
    f.answers.expectFile(QString::fromStdString(file.string()));
    f.press("suggestionCertificate");
    [&file] { QTRY_VERIFY(std::filesystem::exists(file)); }();
    return parseCertificate(readBytes(file), file);
  };
  const Certificate unsaved = savedTo("unsaved.nfcert");
  QVERIFY(unsaved.sceneSha256.empty());
  Verification verified = verifyCertificate(unsaved, f.d.session().scene(), {});
  QVERIFY2(verified.isProven(), verified.problem.c_str());
  QVERIFY(verified.stretches > 0);

  const std::filesystem::path scene = f.d.folder.path() / "cubes.nearfit";
  f.d.session().save(scene);
  QTRY_VERIFY(button->isEnabled());
  const Certificate saved = savedTo("saved.nfcert");
  QCOMPARE(saved.sceneSha256, sha256OfFile(scene));
  verified = verifyCertificate(saved, readSceneFile(scene), saved.sceneSha256);
  QVERIFY2(verified.isProven(), verified.problem.c_str());

  QTRY_VERIFY(button->isEnabled());
  RigidTransform away;
  away.translation = {0.0, 0.2, 0.0};
  f.d.session().movePart(f.d.partId("fixed"), away);
  QVERIFY(!button->isEnabled());
  f.d.session().undo();
  QVERIFY(button->isEnabled());
  QVERIFY2(f.answers.faults().isEmpty(), qPrintable(f.answers.faults().join(QLatin1Char(','))));
  QVERIFY(f.failures.isEmpty());
}

/// The card kept the focus and lay over the part, and nothing showed the path that the hand was to follow.
void DesktopSuggestTest::theGuideIsSeenAndTheKeysGoToTheView() {
  SuggestFixture f;
  std::shared_ptr<const AssemblyPath> path;
  QObject::connect(&f.d.window().suggestion(), &ui::PathSuggestion::guidanceChanged, &f.d.application,
                   [&path](const auto& given) {
                     if (given != nullptr) path = given;
                   });
  f.d.choose("viewFront");
  f.suggest("suggestToDrawn");
  QTRY_VERIFY_WITH_TIMEOUT(f.card() != nullptr && f.card()->isVisible(), 60'000);
  QTRY_VERIFY(!f.ghosts.isEmpty());
  // Nothing is felt yet, so there are no numbers.
  QVERIFY(!f.d.widget<QWidget>("colourLegend")->isVisible());
  const ui::Viewport& view = f.d.window().viewport();
  QVERIFY(!f.card()->frameGeometry().contains(view.mapToGlobal(view.rect().center())));

  f.d.chooseHand(ui::Hand::Manual);
  QApplication::setActiveWindow(f.card());
  QTRY_COMPARE(QApplication::activeWindow(), static_cast<QWidget*>(f.card()));
  f.press("suggestionFeel");
  QTRY_VERIFY(f.d.application.servo().isRunning());
  QTRY_VERIFY(view.hasFocus());
  QTRY_VERIFY(f.d.widget<QWidget>("colourLegend")->isVisible());

  // The centre goes straight from pose to pose.
  QVERIFY(path != nullptr && path->poses.size() > 1);
  constexpr glm::dvec3 kCentre(0.0, 0.0, 0.035);  // Of the moving cube, in its frame [m].
  glm::dvec3 middle(0.0);
  double longest = 0.0;
  for (std::size_t i = 1; i < path->poses.size(); ++i) {
    const glm::dvec3 a = path->poses[i - 1].worldFromLead.applyToPoint(kCentre),
                     b = path->poses[i].worldFromLead.applyToPoint(kCentre);
    if (glm::distance(a, b) <= longest) continue;
    longest = glm::distance(a, b);
    middle = 0.5 * (a + b);
  }
  const auto isLineSeen = [&f, &middle] {
    constexpr int kReach = 3, kAlike = 60;
    ViewDriver driver(f.d);
    const QImage picture = f.d.picture();
    const QPoint at = driver.seen(middle) * driver.view().devicePixelRatioF();
    for (int y = -kReach; y <= kReach; ++y) {
      for (int x = -kReach; x <= kReach; ++x) {
        const QColor pixel = picture.pixelColor(at + QPoint(x, y));
        const int off = std::abs(pixel.red() - ui::colours::kHand.red()) +
                        std::abs(pixel.green() - ui::colours::kHand.green()) +
                        std::abs(pixel.blue() - ui::colours::kHand.blue());
        if (off < kAlike) return true;
      }
    }
    return false;
  };
  QTRY_VERIFY(isLineSeen());
  keepPictures(f.d.window(), QStringLiteral("guided"));
  f.d.choose("stop");
  QTRY_VERIFY(!f.d.application.servo().status().isTaken());
  f.card()->reject();
  QTRY_VERIFY(f.card() == nullptr);
  QTRY_VERIFY(!isLineSeen());
  QVERIFY(f.failures.isEmpty());
}

void DesktopSuggestTest::closingTheCardEndsTheGhost() {
  SuggestFixture f;
  f.suggest("suggestToDrawn");
  QTRY_VERIFY_WITH_TIMEOUT(f.card() != nullptr && f.card()->isVisible(), 60'000);
  QTRY_VERIFY(!f.ghosts.isEmpty());
  f.card()->reject();
  QTRY_VERIFY(f.card() == nullptr);
  const int count = f.ghosts.size();
  QTest::qWait(200);
  QCOMPARE(f.ghosts.size(), count);
}

/// A millionth of the diagonal of a cube of 20 mm is 0.0346 um.
void DesktopSuggestTest::theSeparationOfferedCanBeRead() {
  SuggestFixture f;
  double offered = 0.0;
  QString shown;
  f.answers.expect(QStringLiteral("suggestDialog"), [&](QDialog& dialog) {
    const auto* field = dialog.findChild<ui::NumberField*>(QStringLiteral("suggestSeparation"));
    offered = field->quantity();
    shown = field->text();
    dialog.reject();
    return true;
  });
  f.d.choose("suggestPath");
  QVERIFY2(f.answers.faults().isEmpty(), qPrintable(f.answers.faults().join(QLatin1Char(','))));
  QVERIFY2(std::abs(offered - 0.04e-6) < 1e-15, qPrintable(QString::number(offered)));
  QCOMPARE(shown, QStringLiteral("0.00004 mm"));
}

void DesktopSuggestTest::whatIsOutAlreadyIsTold() {
  SuggestFixture f;
  f.suggest("suggestOut");
  QTRY_COMPARE(f.failures.size(), 1);
  QVERIFY(f.failures[0].details.contains(QStringLiteral("out already")));
  QVERIFY(f.card() == nullptr);
}

void DesktopSuggestTest::withoutAPartInHandThereIsNothingToSuggest() {
  SuggestFixture f;
  QVERIFY(f.d.action("suggestPath")->isEnabled());
  f.d.session().setMovingPart(std::nullopt);
  QVERIFY(!f.d.action("suggestPath")->isEnabled());
}

NEARFIT_QT_SUITE(DesktopSuggestTest, runDesktopTest<DesktopSuggestTest>)
#include "desktop_suggest_test.moc"
