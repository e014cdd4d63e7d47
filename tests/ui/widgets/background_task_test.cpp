#include "ui/widgets/background_task.h"

#include <QtTest>

#include "core/base/error.h"
#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class BackgroundTaskTest : public QObject {
  Q_OBJECT

 private slots:
  void reportsProgressAndEndOnItsOwnThread();
  void cancelEndsTheJobWithCancelled();
  void cancelIsToldBeforeTheJobLooks();
  void handsOnWhatTheJobThrows();
  void endMayStartTheNextJob();
  void destructionCancelsAndWaits();
};

void BackgroundTaskTest::reportsProgressAndEndOnItsOwnThread() {
  ui::BackgroundTask task;
  std::vector<double> fractions;
  connect(&task, &ui::BackgroundTask::progressed, this, [&](double fraction) {
    QCOMPARE(QThread::currentThread(), thread());
    fractions.push_back(fraction);
  });
  bool isDone = false;
  std::thread::id worker;
  task.run(
      [&](const ProgressCallback& progress) {
        worker = std::this_thread::get_id();
        for (int i = 0; i <= 1000; ++i)
          progress(i / 1000.0);
      },
      [&](const std::exception_ptr& error) {
        QVERIFY(error == nullptr);
        isDone = true;
      });
  QVERIFY(task.isRunning());
  QTRY_VERIFY(isDone);
  QVERIFY(!task.isRunning());
  QVERIFY(worker != std::this_thread::get_id());
  QVERIFY(!fractions.empty());
  QVERIFY(std::is_sorted(fractions.begin(), fractions.end()));
  QVERIFY2(fractions.size() <= 50, "a flood of reports would choke the window");
}

void BackgroundTaskTest::cancelEndsTheJobWithCancelled() {
  ui::BackgroundTask task;
  bool wasCancelled = false;
  task.run(
      [](const ProgressCallback& progress) {
        while (progress(0.5))
          std::this_thread::yield();
        throw Cancelled();
      },
      [&](const std::exception_ptr& error) {
        try {
          std::rethrow_exception(error);
        } catch (const Cancelled&) {
          wasCancelled = true;
        }
      });
  task.cancel();
  QTRY_VERIFY(wasCancelled);
}

void BackgroundTaskTest::cancelIsToldBeforeTheJobLooks() {
  std::atomic<bool> mayLook{false}, hasEnded{false};
  bool wasTold = false, isNextDone = false;
  ui::BackgroundTask task;
  task.run(
      [&](const ProgressCallback& progress) {
        while (!mayLook)
          std::this_thread::yield();
        hasEnded = !progress(0.5);
      },
      [&](const std::exception_ptr& error) {
        QVERIFY_EXCEPTION_THROWN(std::rethrow_exception(error), Cancelled);
        wasTold = true;
        QVERIFY(!task.isRunning());
        task.run([](const ProgressCallback&) {}, [&](const std::exception_ptr&) { isNextDone = true; });
      });
  task.cancel();
  QTRY_VERIFY(wasTold && isNextDone);
  QVERIFY(!hasEnded);
  mayLook = true;
  QTRY_VERIFY(hasEnded);
}

void BackgroundTaskTest::handsOnWhatTheJobThrows() {
  ui::BackgroundTask task;
  QString message;
  task.run([](const ProgressCallback&) { throw FileError("a.stl:7", "no number", "mend it"); },
           [&](const std::exception_ptr& error) {
             try {
               std::rethrow_exception(error);
             } catch (const FileError& e) {
               message = QString::fromStdString(e.where());
             }
           });
  QTRY_COMPARE(message, QStringLiteral("a.stl:7"));
}

void BackgroundTaskTest::endMayStartTheNextJob() {
  ui::BackgroundTask task;
  int done = 0;
  const auto nothing = [](const ProgressCallback&) {};
  task.run(nothing, [&](const std::exception_ptr&) {
    ++done;
    task.run(nothing, [&](const std::exception_ptr&) { ++done; });
  });
  QTRY_COMPARE(done, 2);
}

void BackgroundTaskTest::destructionCancelsAndWaits() {
  std::atomic<bool> hasEnded{false};
  {
    ui::BackgroundTask task;
    task.run(
        [&](const ProgressCallback& progress) {
          while (progress(0.0))
            std::this_thread::yield();
          hasEnded = true;
        },
        [](const std::exception_ptr&) { QFAIL("nobody is left to tell"); });
  }
  QVERIFY(hasEnded);
}

NEARFIT_QT_SUITE(BackgroundTaskTest, test::runQtTest<BackgroundTaskTest, QCoreApplication>)
#include "background_task_test.moc"
