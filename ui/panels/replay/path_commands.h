#pragma once

#include <QList>
#include <QObject>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/path/assembly_path.h"
#include "core/path/path_certifier.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QMenu;
class QWidget;

namespace nearfit::ui {

class Replay;
class Timeline;

/// Commands on the motion that the timeline shows, a recording or a path: saves it as a path, plots
/// clearances along it, certifies and exports it. They take the timeline's range. Long work runs in threads
/// of low priority, with progress and *Cancel*.
class PathCommands : public QObject {
  Q_OBJECT

 public:
  /// Objects that they work on; all outlive this.
  struct Context {
    Session& session;
    Replay& replay;
    Timeline& timeline;
  };
  /// @param window  The parent, and that of dialogs.
  PathCommands(const Context& context, QWidget* window);
  ~PathCommands() override;

  /// Menu of all commands.
  QMenu& menu() const noexcept { return *menu_; }

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  /// A path and what was proven of it, with the scene that it was proven in.
  struct Certified {
    Scene scene;
    AssemblyPath path;
    PathProof proof;
    std::string sceneSha256;  ///< Hash of the scene file; empty if the scene is not as saved.
    std::string pathSha256;   ///< Hash of the path file; empty if none holds the path.
    std::filesystem::path sceneFile, pathFile;  ///< Empty without these hashes.
  };
  QAction* add(const char* name, const QString& text, const QString& help, void (PathCommands::*command)());
  void updateActions();
  /// The motion in the timeline's range, or its failure told.
  std::optional<AssemblyPath> rangedPath();
  /// Calls `read`; tells what it throws, and returns std::nullopt then.
  template <class Read>
  auto orTell(const QString& attempt, const Read& read) -> std::optional<decltype(read())>;
  /// Asks for a file to write to.
  std::optional<QString> askForFile(const QString& title, const QString& filter, const QString& suffix);
  /// Runs work in a thread of low priority with a progress dialog; then calls `done`, or tells the failure.
  void run(const QString& title, const QString& attempt, BackgroundTask::Job work,
           std::function<void()> done);
  void noteExported(const QString& file);

  void startHere();
  void endHere();
  void takeWhole();
  void savePath();
  void plotClearance();
  void certify();
  void showCertified();
  void saveCertificate();
  void exportCsv();
  void exportClearance();
  void exportAnimation();
  void exportSwept();
  void followSession();

  const Context context_;
  QWidget* window_;
  QMenu* menu_;
  QList<QAction*> forMotion_;
  QAction *clearance_ = nullptr, *certificate_ = nullptr;
  BackgroundTask task_;
  std::shared_ptr<const Certified> certified_;  ///< Null: nothing is proven of what is open.
  std::uint64_t certifiedState_ = 0;            ///< Session::stateSerial() of what certified_ proves.
  Subscription changes_;
};

}  // namespace nearfit::ui
