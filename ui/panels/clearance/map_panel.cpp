#include "ui/panels/clearance/map_panel.h"

#include <QAction>
#include <QCheckBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>

#include "ui/model/hand_state.h"
#include "ui/model/selection.h"
#include "ui/panels/clearance/histogram_view.h"
#include "ui/panels/clearance/map_probe.h"
#include "ui/view3d/glyphs/clearance_legend.h"
#include "ui/view3d/view_picture.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QString kMapThreshold = QStringLiteral("clearanceMap/threshold");
/// Limits and first values of range and threshold [m].
constexpr double kMinRange = 1e-6, kMaxRange = 10.0, kFirstRange = 1e-3, kFirstThreshold = 2e-4,
                 kMapStep = 1e-4;
constexpr int kMapDecimals = 4;
constexpr int kPercent = 100;

/// The threshold from the settings [m]; the first one if somebody edited it to nonsense.
double keptMapThreshold() {
  bool isNumber = false;
  const double kept = QSettings().value(kMapThreshold).toDouble(&isNumber);
  return isNumber && kept >= 0.0 && kept <= kMaxRange ? kept : kFirstThreshold;
}

NumberField* lengthField(QWidget* parent, const char* name, const QString& help) {
  auto* field = new NumberField(parent);
  field->setObjectName(QLatin1String(name));
  field->setTrimmed(true);
  field->setActingAtOnce();
  field->setLength(kMapDecimals);
  field->setQuantityStep(kMapStep);
  field->setHelp(help);
  return field;
}

}  // namespace

ClearanceMapPanel::ClearanceMapPanel(const Context& context, QWidget* parent)
    : QWidget(parent),
      session_(context.session),
      view_(context.view),
      search_({context.session, context.selection, context.view.poses(), context.hand}),
      legend_(new ClearanceLegend(&context.view)),
      probe_(new MapProbe(context.view, context.session)),
      colour_(
          makeAction(this, "colourByClearance", tr("Colou&r by clearance"), QStringLiteral("clearance-map"),
                     QStringLiteral("Shift+C"),
                     tr("Colour the selected part, or what is in hand, by its distance to other parts"))) {
  setInPictures(*legend_);
  colour_->setCheckable(true);
  connect(colour_, &QAction::toggled, this, &ClearanceMapPanel::setColoured);
  setUpFields();
  setUpLayout();
  connect(&search_, &ClearanceMapSearch::changed, this, &ClearanceMapPanel::showMap);
  connect(&search_, &ClearanceMapSearch::workChanged, this, &ClearanceMapPanel::showWork);
  connect(&search_, &ClearanceMapSearch::failed, this, &ClearanceMapPanel::failed);
  connect(&search_, &ClearanceMapSearch::progressed, progress_,
          [this](double fraction) { progress_->setValue(qRound(kPercent * fraction)); });
  // Names and colours may change without a new map.
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { showMap(); });
  connect(&context.selection, &Selection::changed, this, &ClearanceMapPanel::showMap);
  showMap();
  showWork();
}

void ClearanceMapPanel::setUpFields() {
  automatic_ = new QCheckBox(tr("&Automatic"), this);
  automatic_->setObjectName(QStringLiteral("clearanceMapAutomatic"));
  automatic_->setToolTip(
      tr("Choose the range by the distances: 1.5 times the median of what is within a 20th of the part"));
  range_ =
      lengthField(this, "clearanceMapRange", tr("Distance from which on a surface keeps its own colour"));
  range_->setAccessibleName(tr("Range"));
  range_->setQuantityRange(kMinRange, kMaxRange);
  const double kept = Preferences::clearanceRange();
  automatic_->setChecked(kept == 0.0);
  range_->showQuantity(kept > 0.0 ? kept : kFirstRange);
  connect(automatic_, &QCheckBox::toggled, this, &ClearanceMapPanel::applyRange);
  connect(range_, &NumberField::quantityEdited, this, &ClearanceMapPanel::applyRange);
  threshold_ = lengthField(this, "clearanceMapThreshold", tr("How much of the surface is nearer than this"));
  threshold_->setAccessibleName(tr("Threshold"));
  threshold_->setQuantityRange(0.0, kMaxRange);
  threshold_->showQuantity(keptMapThreshold());
  connect(threshold_, &NumberField::quantityEdited, this, [this](double metres) {
    QSettings().setValue(kMapThreshold, metres);
    showMap();
  });
  nearParts_ = new QCheckBox(tr("&Near parts too"), this);
  nearParts_->setObjectName(QStringLiteral("clearanceMapNear"));
  nearParts_->setToolTip(tr("Also colour the other parts, by their distance to this one"));
  nearParts_->setChecked(Preferences::hasNearClearances());
  search_.setNearParts(nearParts_->isChecked());
  connect(nearParts_, &QCheckBox::toggled, this, [this](bool isOn) {
    Preferences::setNearClearances(isOn);
    search_.setNearParts(isOn);
  });
  range_->setEnabled(!automatic_->isChecked());
  search_.setRange(kept);
}

void ClearanceMapPanel::setUpLayout() {
  auto* toggle = new QToolButton(this);
  toggle->setObjectName(QStringLiteral("colourByClearanceButton"));
  toggle->setDefaultAction(colour_);
  toggle->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  subject_ = new QLabel(this);
  subject_->setObjectName(QStringLiteral("clearanceMapSubject"));
  subject_->setWordWrap(true);
  subject_->setTextFormat(Qt::PlainText);
  histogram_ = new HistogramView(this);
  areas_ = new QLabel(this);
  areas_->setObjectName(QStringLiteral("clearanceMapAreas"));
  areas_->setWordWrap(true);
  areas_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  progress_ = new QProgressBar(this);
  progress_->setObjectName(QStringLiteral("clearanceMapProgress"));
  progress_->setRange(0, kPercent);
  progress_->setAccessibleName(tr("Progress of the map"));
  cancel_ = new QPushButton(tr("Cancel"), this);
  cancel_->setObjectName(QStringLiteral("cancelClearanceMap"));
  connect(cancel_, &QPushButton::clicked, &search_, [this] {
    // After a cancelled map, the same button computes it again.
    search_.isCancelled() ? search_.refresh() : search_.cancel();
  });
  export_ = new QPushButton(icon(QStringLiteral("export")), tr("Export…"), this);
  export_->setObjectName(QStringLiteral("exportClearanceMap"));
  export_->setToolTip(tr("Export the surface with its distances (PLY), or the histogram (CSV)"));
  connect(export_, &QPushButton::clicked, this, &ClearanceMapPanel::exportWanted);

  auto* rangeLabel = new QLabel(tr("&Range"), this);
  rangeLabel->setBuddy(range_);
  auto* thresholdLabel = new QLabel(tr("&Threshold"), this);
  thresholdLabel->setBuddy(threshold_);
  auto* ranges = new QGridLayout;
  ranges->addWidget(rangeLabel, 0, 0);
  ranges->addWidget(range_, 0, 1);
  ranges->addWidget(automatic_, 0, 2);
  ranges->addWidget(thresholdLabel, 1, 0);
  ranges->addWidget(threshold_, 1, 1);
  ranges->addWidget(nearParts_, 2, 0, 1, 3);
  auto* work = new QHBoxLayout;
  work->addWidget(progress_, 1);
  work->addWidget(cancel_);
  // As wide as it needs: the width that is left is the histogram's.
  auto* controls = new QWidget(this);
  controls->setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Preferred);
  auto* fields = new QVBoxLayout(controls);
  fields->setContentsMargins({});
  fields->addWidget(toggle);
  fields->addLayout(ranges);
  fields->addWidget(export_);
  fields->addStretch();
  auto* results = new QVBoxLayout;
  results->addWidget(subject_);
  results->addWidget(histogram_, 1);
  results->addWidget(areas_);
  results->addLayout(work);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 6, 8, 6);
  row->setSpacing(10);
  row->addWidget(controls);
  row->addLayout(results, 1);
}

void ClearanceMapPanel::setColoured(bool isColoured) {
  search_.setWanted(isColoured);
  showMap();
  showWork();
}

void ClearanceMapPanel::applyRange() {
  range_->setEnabled(!automatic_->isChecked());
  const double range = automatic_->isChecked() ? 0.0 : range_->quantity();
  Preferences::setClearanceRange(range);
  search_.setRange(range);
}

void ClearanceMapPanel::showMap() {
  const std::shared_ptr<const ShownMap>& shown = search_.shown();
  view_.setColours(shown != nullptr ? shown->colours : SceneRenderer::Colours(), search_.isStale());
  probe_->setMap(shown);
  subject_->setText(subjectText());
  areas_->setText(areasText());
  histogram_->setThreshold(threshold_->quantity());
  histogram_->setStale(search_.isStale());
  if (shown != nullptr) {
    histogram_->showBins(clearanceHistogram(shown->areas, shown->map.range), shown->map.range,
                         shown->areas.total());
    if (automatic_->isChecked()) range_->showQuantity(shown->map.range);
  } else {
    histogram_->showBins({}, 0.0, 0.0);
  }
  export_->setEnabled(!search_.subject().empty() && session_.scene().parts().size() > 1);
  showLegend();
}

void ClearanceMapPanel::showLegend() {
  const std::shared_ptr<const ShownMap>& shown = search_.shown();
  const Part* part = shown != nullptr ? session_.scene().find(shown->subject.front()) : nullptr;
  if (part == nullptr) return legend_->hide();
  const auto channel = [](float value) { return static_cast<double>(value); };
  const QColor own =
      QColor::fromRgbF(channel(part->colour.r), channel(part->colour.g), channel(part->colour.b));
  const bool hasOverlap = shown->areas.least().value_or(0.0) < -kContactDistance;
  legend_->showScale({shown->map.range, own, hasOverlap, search_.isStale()});
}

void ClearanceMapPanel::showWork() {
  const bool isRunning = search_.isRunning() && search_.isWanted();
  // Maps that follow motion come several times a second: a bar would flicker.
  const bool isLong = isRunning && (search_.shown() == nullptr || search_.isStale());
  const bool isCancelled = search_.isWanted() && search_.isCancelled() && !search_.isRunning();
  if (!progress_->isVisible()) progress_->setValue(0);
  progress_->setVisible(isLong);
  cancel_->setVisible(isLong || isCancelled);
  cancel_->setText(isCancelled ? tr("Compute again") : tr("Cancel"));
}

QString ClearanceMapPanel::subjectName() const {
  const Scene& scene = session_.scene();
  const std::vector<PartId> subject = search_.subject();
  if (subject.empty()) return {};
  const bool isGroup = subject.size() > 1 && scene.movingGroup();
  return breakable(
      shortName(isGroup ? scene.findGroup(*scene.movingGroup())->name : scene.get(subject.front()).name));
}

QString ClearanceMapPanel::subjectText() const {
  const QString name = subjectName();
  if (name.isEmpty()) return tr("Select a part, or take one in hand.");
  if (!search_.isWanted()) return tr("%1 is not coloured.").arg(name);
  const std::shared_ptr<const ShownMap>& shown = search_.shown();
  if (shown == nullptr)
    return search_.isCancelled() ? tr("%1: cancelled.").arg(name) : tr("%1: computing…").arg(name);
  QString text = leastClearanceOf(shown->map, shown->areas)
                     ? name
                     : tr("%1: no other part is within %2.").arg(name, formatLength(shown->map.range));
  if (shown->map.isCoarse) text += tr(" (sampled coarsely: the surfaces are large)");
  if (search_.isStale()) text += tr(" – of the last pose");
  return text;
}

QString ClearanceMapPanel::areasText() const {
  const std::shared_ptr<const ShownMap>& shown = search_.shown();
  if (shown == nullptr) return {};
  const AreaByClearance& areas = shown->areas;
  const double total = std::max(areas.total(), std::numeric_limits<double>::min());
  const auto withShare = [total](double area) {
    return tr("%1 (%2)").arg(formatArea(area), formatShare(area / total));
  };
  const double threshold = threshold_->quantity();
  QStringList lines{
      tr("%1 nearer than %2").arg(withShare(areas.nearerThan(threshold)), formatLength(threshold))};
  if (const auto least = leastClearanceOf(shown->map, areas)) {
    const QString min =
        least->isExact ? formatLength(least->distance) : tr("about %1").arg(formatLength(least->distance));
    lines << (areas.mean() ? tr("Min %1, mean %2 over the %3 within the range")
                                 .arg(min, formatLength(*areas.mean()), withShare(areas.within()))
                           : tr("Min %1, between samples").arg(min));
  }
  if (areas.inContact() > 0.0) lines << tr("%1 in contact").arg(withShare(areas.inContact()));
  if (areas.overlapping() > 0.0) lines << tr("%1 inside other parts").arg(withShare(areas.overlapping()));
  return lines.join('\n');
}

void ClearanceMapPanel::refresh() {
  showMap();
}

}  // namespace nearfit::ui
