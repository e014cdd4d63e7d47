#pragma once

#include <QDialog>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene_file.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/files/recovery/recovery.h"

/// Journals of processes that died, and the dialog that offers them.
namespace nearfit::test {

inline std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder,
                                                  const char* ending = ".nearfit") {
  std::vector<std::filesystem::path> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    if (entry.path().extension() == ending && entry.path().filename().string().front() != '.')
      files.push_back(entry.path());
  }
  return files;
}

/// What the one journal of a folder holds; none while there is not one that is whole.
inline std::optional<Scene> journalIn(const std::filesystem::path& folder) {
  try {
    const std::vector<std::filesystem::path> files = filesIn(folder);
    if (files.size() == 1) return readSceneFile(files.front());
  } catch (const Error&) {
  }
  return std::nullopt;
}

inline std::string poses(const Scene& scene) {
  std::string text;
  char line[400];
  for (const Scene::PartPtr& part : scene.parts()) {
    const glm::dquat& q = part->worldFromPart.rotation;
    const glm::dvec3& t = part->worldFromPart.translation;
    std::snprintf(line, sizeof line, "%s %a %a %a %a %a %a %a\n", part->name.c_str(), q.w, q.x, q.y, q.z, t.x,
                  t.y, t.z);
    text += line;
  }
  return text;
}

/// Waits until the one journal of a folder holds parts in these poses.
inline bool isJournalKept(const std::filesystem::path& folder, const std::string& expected) {
  return QTest::qWaitFor(
      [&] {
        const auto kept = journalIn(folder);
        return kept && poses(*kept) == expected;
      },
      kQtPatienceMs);
}

inline ui::RecoveryDialog* dialogOf(DesktopDriver& d) {
  ui::RecoveryDialog* dialog = nullptr;
  (void)QTest::qWaitFor(
      [&] {
        dialog = d.window().findChild<ui::RecoveryDialog*>();
        return dialog != nullptr && dialog->isVisible();
      },
      30'000);
  return dialog;
}

inline void clickIn(QDialog* dialog, const char* button) {
  auto* found = dialog->findChild<QPushButton*>(QLatin1String(button));
  QVERIFY2(found != nullptr, button);
  QTest::mouseClick(found, Qt::LeftButton);
}

}  // namespace nearfit::test
