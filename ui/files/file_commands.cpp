#include "ui/files/file_commands.h"

#include <QAction>
#include <QMenu>
#include <optional>
#include <utility>

#include "core/session/session.h"
#include "ui/files/document.h"
#include "ui/files/import_tessellation.h"
#include "ui/files/part_files.h"
#include "ui/files/recent_files.h"
#include "ui/files/refine_dialog.h"
#include "ui/model/hand_state.h"
#include "ui/model/selection.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/notice_bar.h"

namespace nearfit::ui {

FileCommands::FileCommands(const Context& context, QWidget* window)
    : QObject(window),
      recentMenu(new QMenu(tr("Open &recent"), window)),
      reloadMenu(new QMenu(tr("Re&load"), window)),
      context_(context),
      window_(window) {
  makeActions();
  connectActions();
  connectDocument();
  setUpRecentFiles();
  setUpPartFiles();
  connect(&context_.hand, &HandState::changed, this, &FileCommands::update);
  changes_ = context_.session.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

void FileCommands::makeActions() {
  newScene = makeAction(this, "newScene", tr("&New scene"), QStringLiteral("new"), QKeySequence::New,
                        tr("Start an empty scene"));
  open = makeAction(
      this, "open", tr("&Open…"), QStringLiteral("open"), QKeySequence::Open,
      tr("Open a scene (*.nearfit), or meshes and CAD documents as a new scene, in place of this one"));
  openDemo = makeAction(this, "openDemo", tr("Open &demo"), QStringLiteral("demo"), {},
                        tr("Open the demo scene: a piston to fit into its cylinder"));
  addParts = makeAction(this, "addParts", tr("Add &parts…"), QStringLiteral("add"), QStringLiteral("Ctrl+I"),
                        tr("Add meshes (STL, OBJ, PLY, OFF) and CAD documents (STEP, IGES, BREP, glTF, 3MF, "
                           "URDF) to the scene; you "
                           "can also drop files and folders on the window"));
  importTriangles = makeAction(
      this, "importTriangles", tr("Trian&gles of CAD files…"), {}, {},
      tr("Choose how fine the triangles of CAD files are that you open or add from now on; at first it "
         "suits the size of each shape"));
  save = makeAction(this, "save", tr("&Save"), QStringLiteral("save"), QKeySequence::Save,
                    tr("Save the scene and where its parts are"));
  saveAs = makeAction(this, "saveAs", tr("Save &as…"), QStringLiteral("save-as"),
                      QStringLiteral("Ctrl+Shift+S"), tr("Save the scene under another name"));
  quit = makeAction(this, "quit", tr("&Quit"), {}, QStringLiteral("Ctrl+Q"),
                    tr("Quit Nearfit; asks first if there are unsaved changes"));
}

void FileCommands::connectActions() {
  Document& document = context_.document;
  connect(newScene, &QAction::triggered, &document, &Document::newScene);
  connect(open, &QAction::triggered, &document, &Document::askAndOpen);
  connect(openDemo, &QAction::triggered, this, &FileCommands::showDemo);
  connect(addParts, &QAction::triggered, &document, &Document::askAndAddParts);
  connect(importTriangles, &QAction::triggered, this, &FileCommands::chooseTriangles);
  connect(save, &QAction::triggered, &document, &Document::save);
  connect(saveAs, &QAction::triggered, &document, &Document::askAndSaveAs);
  connect(quit, &QAction::triggered, window_, &QWidget::close);
}

void FileCommands::connectDocument() {
  const Document& document = context_.document;
  connect(&document, &Document::failed, this, &FileCommands::failed);
  connect(&document, &Document::noted, this, &FileCommands::noted);
  connect(&document, &Document::busyChanged, this, &FileCommands::update);
  // A failed load leaves the view alone, but some of several files may have been added.
  connect(&document, &Document::sceneOpened, this, &FileCommands::showWhole);
  connect(&document, &Document::partsAdded, this, &FileCommands::showAdded);
  connect(&document, &Document::loaded, this, [this](bool isComplete) {
    if (isComplete) showWhole();
  });
}

void FileCommands::setUpRecentFiles() {
  recent_ = new RecentFiles(recentMenu, this);
  connect(recent_, &RecentFiles::openRequested, &context_.document, &Document::openScene);
  connect(recent_, &RecentFiles::missing, this, [this](const QString& file) {
    emit failed({tr("This scene no longer exists."),
                 tr("Its file was moved or deleted. It was removed from the list.\n\nWhere: %1").arg(file)});
  });
}

void FileCommands::openRecent(const QString& file) {
  if (!context_.document.isBusy()) recent_->open(file);
}

void FileCommands::setUpPartFiles() {
  auto* notices = new NoticeBar(&context_.view);
  parts_ = new PartFiles({context_.session, context_.hand, context_.document, *notices}, reloadMenu, window_,
                         this);
  connect(parts_, &PartFiles::failed, this, &FileCommands::failed);
  connect(parts_, &PartFiles::noted, this, &FileCommands::noted);
  connect(parts_, &PartFiles::rescaled, this, &FileCommands::showWhole);
  connect(parts_, &PartFiles::repaired, this, &FileCommands::repaired);
}

void FileCommands::chooseTriangles() {
  const std::optional<Tessellation> chosen = askForImportTessellation(importTessellation(), window_);
  if (!chosen) return;
  setImportTessellation(*chosen);
  emit noted(*chosen == Tessellation{}
                 ? tr("Triangles of CAD files will suit the size of each shape")
                 : tr("CAD files will have triangles of the chord and angle that you chose"));
}

void FileCommands::changeUnit(const std::vector<PartId>& parts) {
  parts_->changeUnit(parts);
}

void FileCommands::repair(const std::vector<PartId>& parts, const MeshRepairs& repairs) {
  parts_->repair(parts, repairs);
}

void FileCommands::refine(const std::vector<PartId>& parts) {
  parts_->refine(parts);
}

void FileCommands::showWhole() {
  context_.view.fit();
  Selection& selection = context_.selection;
  if (!selection.current()) selection.select(context_.session.scene().movingPart());
}

void FileCommands::showAdded(const std::vector<PartId>& parts) {
  // Several would all be drawn as selected, which hides the colours of their file.
  context_.selection.select(parts.size() == 1 ? std::optional(parts.front()) : std::nullopt);
  showWhole();
}

void FileCommands::update() {
  const Session& session = context_.session;
  const bool isFree = !context_.document.isBusy();
  for (QAction* action : {newScene, open, addParts})
    action->setEnabled(isFree);
  openDemo->setEnabled(isFree && !demoScene_.isEmpty());
  save->setEnabled(isFree && (session.isModified() || context_.hand.status().isTaken()));
  saveAs->setEnabled(isFree && !session.scene().parts().empty());
}

void FileCommands::setDemoScene(const QString& file) {
  demoScene_ = file;
  update();
}

bool FileCommands::showDemo() {
  return !demoScene_.isEmpty() && context_.document.openExample(demoScene_);
}

void FileCommands::withParts(std::function<void()> then) {
  const bool isSomethingThere = !context_.session.scene().parts().empty() || demoScene_.isEmpty();
  if (isSomethingThere || context_.document.isBusy()) return then();
  auto* once = new QObject(this);
  connect(&context_.document, &Document::loaded, once, [once, then = std::move(then)](bool isComplete) {
    once->deleteLater();
    if (isComplete) then();
  });
  if (!showDemo()) delete once;
}

}  // namespace nearfit::ui
