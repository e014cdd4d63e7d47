// A random user does thousands of things to the window, and after each burst of them all has to be
// consistent. Each user is a process of its own: one that crashes, or hangs, is told with what it did last
// and how to repeat it.
//   desktop_monkey_test                     the usual users; NEARFIT_MONKEY_EVENTS says how many events for
//   all desktop_monkey_test --user SEED EVENTS  one of them, its log on stdout; 0: all is as it should be
#include <QDesktopServices>
#include <QDir>
#include <QProcess>
#include <limits>

#include "tests/app/desktop/monkey/random_user.h"
#include "tests/app/desktop/monkey/session_watch.h"
#include "tests/support/scoped_variable.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

constexpr int kUsers = 2, kUsualEvents = 2000, kEventsInBurst = 50;
/// Without a line of its log a user hangs [ms]: the slowest act, beside a busy machine and under sanitizers.
constexpr int kSilence = 240'000;
constexpr int kLinesShown = 60;

/// Nothing that it does reaches anybody's files: not those of settings, of caches, nor of recovery.
void moveIn(const QString& home) {
  for (const char* variable :
       {"HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME"})
    qputenv(variable, home.toLocal8Bit());
  QDir::setCurrent(home);
}

class Browser : public QObject {
  Q_OBJECT

 public slots:
  void open(const QUrl& url) { std::printf("asked for %s\n", qPrintable(url.toString())); }
};

/// What is not as it should be.
QStringList playUser(unsigned seed, int events, MonkeyFiles& files) {
  auto* devices = new FakeSource;
  DesktopDriver driver{std::unique_ptr<desktop::DeviceSource>(devices)};
  // Small: drawn by software, most of its time are pictures.
  driver.window().resize(800, 560);
  driver.window().setDemoScene(files.scene());
  driver.window().protectWork(files.folder() / "recovery");
  SessionWatch watch(driver);
  RandomUser user(driver, *devices, files, seed);
  driver.addCubes();
  for (int done = 0; done < events;) {
    for (int i = 0; i < kEventsInBurst; ++i, ++done)
      user.act();
    if (!user.settle()) return {QStringLiteral("something is under way that never ends")};
    watch.check();
    if (!watch.faults().isEmpty()) return watch.faults();
  }
  return {};
}

int user(int argc, char** argv) {
  MonkeyFiles files;
  moveIn(QString::fromStdString(files.folder().string()));
  desktop::Application::prepare();
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, QDir::currentPath());
  QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  QApplication qt(argc, argv);
  QApplication::setQuitOnLastWindowClosed(false);
  desktop::Application::configure();
  Browser browser;
  for (const char* scheme : {"http", "https", "file", "mailto"})
    QDesktopServices::setUrlHandler(QLatin1String(scheme), &browser, "open");
  const QStringList faults = playUser(QByteArray(argv[2]).toUInt(), QByteArray(argv[3]).toInt(), files);
  for (const QString& fault : faults)
    std::printf("FAULT: %s\n", qPrintable(fault));
  return faults.isEmpty() ? 0 : 1;
}

}  // namespace

class DesktopMonkeyTest : public QObject {
  Q_OBJECT

 private slots:
  void anythingMayBeDoneAndAllStaysConsistent_data();
  void anythingMayBeDoneAndAllStaysConsistent();
};

void DesktopMonkeyTest::anythingMayBeDoneAndAllStaysConsistent_data() {
  QTest::addColumn<int>("seed");
  for (int seed = 1; seed <= kUsers; ++seed)
    QTest::addRow("user %d", seed) << seed;
}

void DesktopMonkeyTest::anythingMayBeDoneAndAllStaysConsistent() {
  QFETCH(int, seed);
  bool isGiven = false;
  const int given = qEnvironmentVariableIntValue("NEARFIT_MONKEY_EVENTS", &isGiven);
  const QStringList arguments{QStringLiteral("--user"), QString::number(seed),
                              QString::number((isGiven ? given : kUsualEvents) / kUsers)};
  const TemporaryFolder folder;
  const ScopedVariable temporary("TMPDIR", folder.path().string());
  QProcess process;
  process.setProcessChannelMode(QProcess::MergedChannels);
  process.start(QCoreApplication::applicationFilePath(), arguments);
  QByteArray log;
  while (process.state() != QProcess::NotRunning && process.waitForReadyRead(kSilence))
    log += process.readAll();
  const bool hasEnded = process.state() == QProcess::NotRunning || process.waitForFinished(kSilence);
  if (!hasEnded) process.kill();
  process.waitForFinished();
  log += process.readAll();
  if (hasEnded && process.exitStatus() == QProcess::NormalExit && process.exitCode() == 0) return;
  const QList<QByteArray> lines = log.split('\n');
  for (const QByteArray& line : lines.mid(std::max(0, lines.size() - kLinesShown)))
    std::printf("%s\n", line.constData());
  std::fflush(stdout);
  QFAIL(qPrintable(QStringLiteral("user %1 %2; to repeat it: %3 %4")
                       .arg(seed)
                       .arg(hasEnded ? QStringLiteral("found something") : QStringLiteral("hangs"),
                            QCoreApplication::applicationFilePath(), arguments.join(QChar(' ')))));
}

int main(int argc, char** argv) {
  if (argc == 4 && QLatin1String(argv[1]) == QLatin1String("--user")) return user(argc, argv);
  // How long it takes is the number of events' to say; what hangs is found by its silence.
  qputenv("QTEST_FUNCTION_TIMEOUT", QByteArray::number(std::numeric_limits<int>::max()));
  QCoreApplication qt(argc, argv);
  DesktopMonkeyTest test;
  return QTest::qExec(&test, argc, argv);
}
#include "desktop_monkey_test.moc"
