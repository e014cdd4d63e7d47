#pragma once

#include <QObject>
#include <filesystem>
#include <memory>

#include "core/recovery/recovery_folder.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"
#include "ui/recovery/autosave.h"

namespace nearfit::ui {

class Document;

/// That nothing is lost when the program dies: keeps a journal of this run, and offers what earlier runs
/// left.
class Recovery : public QObject {
  Q_OBJECT

 public:
  /// @param folder            As userRecoveryFolder gives it; not empty.
  /// @param session, document, window  Outlive this.
  Recovery(const std::filesystem::path& folder, Session& session, Document& document,
           std::function<Autosave::PoseInHand()> poseInHand, QWidget* window);

  Autosave& autosave() noexcept { return *autosave_; }
  /// After which a process that was ending has ended, also where it held much [ms].
  static constexpr int kSecondLookMs = 2500, kThirdLookMs = 10'000;
  /// Looks in another thread for what was lost, and asks about it when there is something. Where others run,
  /// it looks again: who starts anew at once after a crash may be faster than the end of what crashed.
  void offer();

 signals:
  /// It has looked, and offers what it found.
  void looked();
  /// A quiet word for the status bar.
  void noted(const QString& text);
  void failed(const nearfit::ui::Failure& failure);

 private:
  void look(int number);
  void show(FoundWork found);
  void restore(const LostWork& work);

  std::shared_ptr<RecoveryFolder> folder_;
  Document& document_;
  QWidget* window_;
  Autosave* autosave_;
  BackgroundTask search_;
};

}  // namespace nearfit::ui
