#pragma once

#include <QString>
#include <QStringList>

#include "tests/support/random_values.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test {

/// What a random user has on disk, all of it in a temporary folder: small parts, a scene of some of them,
/// damaged files, and names of files that are not there yet.
class MonkeyFiles {
 public:
  MonkeyFiles();

  /// Of a part, of a scene, damaged, a folder or missing.
  QString any(RandomValues& random) const;
  QStringList some(RandomValues& random) const;
  /// A name to save as, in a folder of its own; what is there may be written over.
  QString forSaving(const QString& suffix, RandomValues& random) const;
  /// Gives one of the parts another shape, damages or removes it. @return What was done.
  QString change(RandomValues& random);
  /// A scene that may be saved where it is.
  QString scene() const { return path("scene.nearfit"); }
  const std::filesystem::path& folder() const noexcept { return folder_.path(); }

 private:
  QString path(const char* name) const;
  void writeParts();
  void writeScene();
  void writeDamaged();

  TemporaryFolder folder_;
  QStringList parts_, odd_;
};

}  // namespace nearfit::test
