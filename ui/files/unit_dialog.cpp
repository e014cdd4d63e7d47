#include "ui/files/unit_dialog.h"

#include <QButtonGroup>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFileInfo>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QRadioButton>
#include <QVBoxLayout>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>

#include "core/scene/mesh_unit.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {
namespace {

struct MeshUnit {
  const char* key;  ///< For object names.
  const char* name;
  double metres;
};
constexpr std::array<MeshUnit, 7> kMeshUnits = {
    {{"um", QT_TRANSLATE_NOOP("QObject", "Micrometres"), 1e-6},
     {"tenth-mm", QT_TRANSLATE_NOOP("QObject", "Tenths of a millimetre"), 1e-4},
     {"mm", QT_TRANSLATE_NOOP("QObject", "Millimetres"), 1e-3},
     {"cm", QT_TRANSLATE_NOOP("QObject", "Centimetres"), 1e-2},
     {"in", QT_TRANSLATE_NOOP("QObject", "Inches"), 0.0254},
     {"ft", QT_TRANSLATE_NOOP("QObject", "Feet"), 0.3048},
     {"m", QT_TRANSLATE_NOOP("QObject", "Metres"), 1.0}}};

/// A unit chosen before is offered only if it gives a size within this factor of the scene's parts: what is farther off
/// is pointed out as wrong once it is in the scene.
constexpr double kPlausibleFactor = 1000.0;
/// The same in an empty scene: parts that a hand can fit [m].
constexpr double kLeastPlausible = 5e-3, kMostPlausible = 5.0;

/// @param size  Diagonal of the box around what is added [m].
bool isPlausible(double size, const UnitHints& hints) {
  if (!hints.scene) return size >= kLeastPlausible && size <= kMostPlausible;
  return size * kPlausibleFactor >= hints.leastSize && size <= kPlausibleFactor * hints.mostSize;
}

/// Units, each with the size that it gives. There is no answer before the sizes are shown.
class UnitDialog : public QDialog {
 public:
  /// @param question  Plain text.
  /// @param accept    Text of the button that accepts.
  UnitDialog(const QString& question, const QString& accept, QWidget* parent);

  /// Checks a unit; adds a row for one that is not in the list.
  void check(double metresPerUnit);
  /// Marks a unit that has a row as the present one.
  void markPresent(double metresPerUnit);
  /// Shows known sizes to compare with, below the units: of the scene, if there is anything in it, and of a hand.
  /// @param sceneText  Text for the scene's size, with a place for it.
  void showKnownSizes(const std::optional<glm::dvec3>& scene, const QString& sceneText);
  /// Shows the sizes, and takes an answer from now on.
  /// @param extent  In the files' units.
  void showSizes(const glm::dvec3& extent);
  /// Reads files in another thread, then shows their sizes, and checks the unit that is likely by these unless the user
  /// has chosen one or did so before. Accepts if none of the files can be read.
  void measure(const QStringList& files, const UnitHints& hints);

  double metresPerUnit() const { return rows_[static_cast<std::size_t>(group_->checkedId())].metres; }

 private:
  struct Row {
    double metres;
    QRadioButton* choice;
    QLabel* size;
  };
  void addRow(const char* key, const QString& name, double metres);
  /// Null if the unit has no row.
  Row* rowOf(double metres);

  QButtonGroup* group_;
  QGridLayout* grid_;
  QLabel* reading_;
  QLabel* known_;
  QPushButton* accept_;
  std::vector<Row> rows_;
  bool isChosen_ = false;  ///< By the user.
  BackgroundTask task_;
};

UnitDialog::UnitDialog(const QString& question, const QString& accept, QWidget* parent)
    : QDialog(parent),
      group_(new QButtonGroup(this)),
      grid_(new QGridLayout),
      reading_(new QLabel(this)),
      known_(new QLabel(this)) {
  setObjectName(QStringLiteral("unitDialog"));
  setWindowTitle(QObject::tr("Unit of length"));
  auto* text = new QLabel(breakable(question), this);
  text->setObjectName(QStringLiteral("unitQuestion"));
  text->setTextFormat(Qt::PlainText);
  text->setWordWrap(true);
  // Not of the dialog: then it would not grow with sizes that arrive later.
  text->setMinimumWidth(forFont(*this, 360));
  grid_->setColumnStretch(1, 1);
  connect(group_, &QButtonGroup::idClicked, this, [this] { isChosen_ = true; });
  for (const MeshUnit& unit : kMeshUnits)
    addRow(unit.key, QObject::tr(unit.name), unit.metres);
  reading_->setText(QObject::tr("Reading the size…"));
  known_->setObjectName(QStringLiteral("knownSizes"));
  known_->setTextFormat(Qt::PlainText);
  known_->setWordWrap(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  accept_ = buttons->button(QDialogButtonBox::Ok);
  accept_->setText(accept);
  accept_->setEnabled(false);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(text);
  layout->addLayout(grid_);
  layout->addWidget(reading_);
  layout->addWidget(known_);
  layout->addWidget(buttons);
}

void UnitDialog::addRow(const char* key, const QString& name, double metres) {
  const int row = static_cast<int>(rows_.size());
  auto* choice = new QRadioButton(name, this);
  choice->setObjectName(QStringLiteral("unit-") + QLatin1String(key));
  auto* size = new QLabel(this);
  size->setObjectName(QStringLiteral("size-") + QLatin1String(key));
  size->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  size->setBuddy(choice);
  group_->addButton(choice, row);
  grid_->addWidget(choice, row, 0);
  grid_->addWidget(size, row, 1);
  rows_.push_back({metres, choice, size});
}

UnitDialog::Row* UnitDialog::rowOf(double metres) {
  // A unit that comes from a correction is off by roundings.
  constexpr double kRounding = 1e-12;
  for (Row& row : rows_) {
    if (std::abs(row.metres - metres) <= kRounding * metres) return &row;
  }
  return nullptr;
}

void UnitDialog::check(double metresPerUnit) {
  if (rowOf(metresPerUnit) == nullptr)
    addRow("other", QObject::tr("%1 metres").arg(formatNumber(metresPerUnit)), metresPerUnit);
  QRadioButton* choice = rowOf(metresPerUnit)->choice;
  choice->setChecked(true);
  choice->setFocus();
}

void UnitDialog::markPresent(double metresPerUnit) {
  const Row* row = rowOf(metresPerUnit);
  if (row != nullptr) row->choice->setText(QObject::tr("%1 (now)").arg(row->choice->text()));
}

void UnitDialog::showKnownSizes(const std::optional<glm::dvec3>& scene, const QString& sceneText) {
  QString text = QObject::tr("For comparison: a hand is about %1 long").arg(formatLength(kHandLength));
  if (scene) text += sceneText.arg(formatExtent(*scene));
  known_->setText(text + '.');
}

void UnitDialog::showSizes(const glm::dvec3& extent) {
  for (const Row& row : rows_) {
    const QString size = formatExtent(row.metres * extent);
    row.size->setText(size);
    row.choice->setAccessibleName(QStringLiteral("%1, %2").arg(row.choice->text(), size));
  }
  reading_->hide();
  accept_->setEnabled(true);
}

void UnitDialog::measure(const QStringList& files, const UnitHints& hints) {
  std::vector<std::filesystem::path> paths;
  for (const QString& file : files)
    paths.push_back(toPath(file));
  const auto extent = std::make_shared<std::optional<glm::dvec3>>();
  task_.run(
      [paths, extent](const ProgressCallback& progress) { *extent = extentOfMeshFiles(paths, progress); },
      [this, extent, hints](const std::exception_ptr& error) {
        if (error || !*extent) return QDialog::accept();
        const double size = glm::length(**extent);
        const bool isKnown = hints.chosen && isPlausible(*hints.chosen * size, hints);
        if (!isChosen_ && !isKnown) check(likelyMeshUnit(size, hints.leastSize, hints.mostSize));
        showSizes(**extent);
      });
}

QString questionAbout(const QStringList& files) {
  if (files.size() == 1) {
    return QObject::tr("“%1” stores no unit. What unit is it in?")
        .arg(shortName(QFileInfo(files.first()).fileName()));
  }
  return QObject::tr(
             "These formats store no unit. What unit are these %1 files in? The sizes are those of all "
             "files together.")
      .arg(files.size());
}

QString questionAboutParts(const QStringList& parts) {
  constexpr int kNamed = 3;
  if (parts.size() == 1)
    return QObject::tr("What unit is the file of “%1” in?").arg(shortName(parts.first()));
  return QObject::tr("What unit are the files of %1 in? The sizes are those of all files together.")
      .arg(listOfNames(parts, kNamed));
}

}  // namespace

std::optional<double> askForUnit(const QStringList& files, const UnitHints& hints, QWidget* parent) {
  constexpr double kMillimetre = 1e-3;
  UnitDialog dialog(questionAbout(files), QObject::tr("Add"), parent);
  dialog.showKnownSizes(hints.scene, QObject::tr("; what is in the scene, %1"));
  dialog.check(hints.chosen.value_or(kMillimetre));
  dialog.measure(files, hints);
  return dialog.exec() == QDialog::Accepted ? std::optional(dialog.metresPerUnit()) : std::nullopt;
}

std::optional<double> askForOtherUnit(const QStringList& parts, const glm::dvec3& extent,
                                      const UnitHints& hints, double metresPerUnit, QWidget* parent) {
  UnitDialog dialog(questionAboutParts(parts), QObject::tr("Change"), parent);
  dialog.check(metresPerUnit);
  dialog.markPresent(metresPerUnit);
  dialog.showKnownSizes(hints.scene, QObject::tr("; what else is in the scene, %1"));
  dialog.showSizes(extent);
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  return dialog.metresPerUnit();
}

}  // namespace nearfit::ui
