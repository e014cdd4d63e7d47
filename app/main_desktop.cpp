#include <QApplication>
#include <QFile>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>

#include "app/desktop/application.h"
#include "app/desktop/command_line.h"
#include "app/desktop/device_led_session.h"
#include "app/desktop/screenshot.h"
#include "core/base/error.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/recovery/recovery_folder.h"
#include "core/text/utf8.h"

namespace {

using namespace nearfit;

QStringList fileNames(const std::vector<std::string>& files) {
  QStringList names;
  for (const std::string& file : files)
    names << QFile::decodeName(QByteArray::fromStdString(file));
  return names;
}

int run(int argc, char** argv) {
  const auto parsed = desktop::parseCommandLine(argc, argv);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const auto& options = std::get<desktop::Options>(parsed);
  for (const std::string& warning : treeCacheWarnings())
    std::fprintf(stderr, "nearfit: warning: %s\n", printableText(warning).c_str());
  desktop::requireDisplay();
  desktop::Application::prepare();
  QApplication qt(argc, argv);
  desktop::Application::configure();
  const QStringList files = fileNames(options.files);
  desktop::requireUnit(options, files);
  desktop::requireTargets(options, files);
  desktop::requireOpenGl();

  desktop::Application application;
  std::optional<desktop::Screenshot> screenshot;
  std::optional<desktop::DeviceLedSession> led;
  if (!options.record.empty()) application.servo().recordTo(fileNames({options.record}).first());
  const std::filesystem::path recovery = userRecoveryFolder();
  if (!options.isUnattended() && !recovery.empty()) application.window().protectWork(recovery);
  if (options.device) {
    led.emplace(application, desktop::LedOptions{QString::fromStdString(*options.device), options.isArming,
                                                 options.seconds});
    led->begin(files, options.metresPerUnit, options.tessellation);
  } else if (!options.screenshot.empty()) {
    screenshot.emplace(application, fileNames({options.screenshot}).first());
    screenshot->take(files, options.metresPerUnit, options.tessellation);
  } else if (!options.script.empty()) {
    application.replayScript(fileNames({options.script}).first());
  } else {
    application.show(files, options.isDemo, options.metresPerUnit, options.tessellation);
  }
  return QApplication::exec();
}

}  // namespace

int main(int argc, char** argv) {
  // A limit on the size of files is an error to report, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const nearfit::UsageError& error) {
    std::fprintf(stderr, "nearfit: %s\n", error.what());
    return nearfit::desktop::kUsageExitCode;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nearfit: %s\n", error.what());
  } catch (...) {
    std::fprintf(stderr, "nearfit: an unknown error ended the program\n");
  }
  return 1;
}
