#pragma once

#include <QDialog>
#include <QObject>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/recovery/recovery_folder.h"
#include "ui/files/recovery/autosave.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QVBoxLayout;

namespace nearfit::ui {

class Document;
class HandState;

/// Offers to restore each piece of lost work, to discard it, or to leave it for later. Closing the dialog
/// leaves the rest for later.
class RecoveryDialog : public QDialog {
  Q_OBJECT

 public:
  RecoveryDialog(const std::vector<LostWork>& lost, QWidget* parent);

 signals:
  /// Emitted when the user restores one; the dialog closes, since only one scene is open at a time.
  void restoreRequested(const nearfit::LostWork& work);
  /// Emitted when the user discards one.
  void discardRequested(const nearfit::LostWork& work);

 private:
  void addRow(const LostWork& work, int number);
  void removeRow(QWidget* row);

  QVBoxLayout* rows_;
  int rowCount_ = 0;
};

/// Protects work from a crash: keeps a journal of this run, and offers what earlier runs left.
class Recovery : public QObject {
  Q_OBJECT

 public:
  /// @param folder                   Folder from userRecoveryFolder(); not empty.
  /// @param session, document, hand  Outlive this.
  /// @param window                   The parent, and that of dialogs.
  Recovery(const std::filesystem::path& folder, Session& session, Document& document, const HandState& hand,
           QWidget* window);

  /// Times by which a process that was ending has ended, even if it held much memory [ms].
  static constexpr int kSecondLookMs = 2500, kThirdLookMs = 10'000;
  /// Searches for lost work in another thread, and offers what it finds. Searches again while other processes
  /// run: a program restarted right after a crash may be faster than the end of the crashed one.
  void offer();

 signals:
  /// Emitted after each search, when what it found has been offered.
  void looked();
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  void look(int number);
  void show(const FoundWork& found);
  void restore(const LostWork& work);

  std::shared_ptr<RecoveryFolder> folder_;
  Document& document_;
  QWidget* window_;
  Autosave* autosave_;
  BackgroundTask search_;
};

}  // namespace nearfit::ui
