#include "ui/model/pair_findings_model.h"

#include <QColor>
#include <limits>
#include <utility>

#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Of what may not be, as letters: colours::kOverlap is too light for them on white.
const QColor kForbiddenText(0xc8, 0x37, 0x2d);
const QString kNoValue = QStringLiteral("–");

QString partNameIn(const Scene& scene, PartId id) {
  return QString::fromStdString(scene.get(id).name);
}

/// Highest for a clash that no rule allows; 0 for a pair that is clear now.
int severityOf(const ShownFinding& row) {
  if (row.verdict == PairVerdict::Clear) return 0;
  if (row.isForbidden) return 3;
  return row.rule.isEmpty() ? 2 : 1;
}

bool isNumberColumn(int column) {
  return column == PairFindingsModel::Distance || column == PairFindingsModel::Depth ||
         column == PairFindingsModel::Volume;
}

QVariant alignmentOf(int column) {
  return QVariant::fromValue<int>((isNumberColumn(column) ? Qt::AlignRight : Qt::AlignLeft) |
                                  Qt::AlignVCenter);
}

}  // namespace

std::vector<ShownFinding> shownFindings(const Scene& scene, const SceneCheck& check,
                                        const std::vector<ComparedFinding>& compared) {
  std::vector<ShownFinding> rows;
  for (const ComparedFinding& each : compared) {
    const PairFinding* now = each.now;
    // A pair that a rule leaves out, or of a hidden part, is as the last check left it: this one says nothing of it.
    const bool wasGone = each.before && each.before->verdict == PairVerdict::Clear;
    if (now == nullptr && each.change != FindingChange::Gone && !wasGone) continue;
    ShownFinding& row = rows.emplace_back();
    row.pair = each.pair;
    row.part = partNameIn(scene, each.pair.part);
    row.other = partNameIn(scene, each.pair.other);
    row.change = each.change;
    row.before = each.before;
    row.state = each.state;
    row.reason = QString::fromStdString(each.reason);
    row.now = now;
    if (now == nullptr) continue;
    row.verdict = now->verdict;
    row.isForbidden = now->isForbidden();
    if (now->allowedBy) row.rule = ruleText(check.rules[*now->allowedBy]);
    row.distance = now->distance;
    row.depth = now->depth();
    if (!now->clash) continue;
    row.isDepthExact = now->clash->isDepthExact;
    row.volume = now->clash->volume;
    if (!row.volume) row.volumeProblem = QString::fromLatin1(textOf(now->clash->volumeProblem));
  }
  return rows;
}

std::vector<ShownFinding> shownRecords(const Scene& scene) {
  std::vector<ShownFinding> rows;
  for (const PairRecord& record : scene.pairRecords()) {
    ShownFinding& row = rows.emplace_back();
    row.pair = record.pair;
    row.part = partNameIn(scene, record.pair.part);
    row.other = partNameIn(scene, record.pair.other);
    row.verdict = record.verdict;
    row.isForbidden = record.verdict >= PairVerdict::Clash;
    if (record.verdict != PairVerdict::Clear) row.distance = record.distance;
    row.depth = record.depth;
    row.state = record.state;
    row.reason = QString::fromStdString(record.reason);
    row.isKept = true;
  }
  return rows;
}

QString nameOf(PairVerdict verdict) {
  switch (verdict) {
    case PairVerdict::Clear:
      return QObject::tr("clear");
    case PairVerdict::Near:
      return QObject::tr("near");
    case PairVerdict::Touching:
      return QObject::tr("touching");
    case PairVerdict::Clash:
      return QObject::tr("clash");
    case PairVerdict::Contained:
      break;
  }
  return QObject::tr("contained");
}

QString nameOf(FindingState state) {
  switch (state) {
    case FindingState::New:
      return QObject::tr("new");
    case FindingState::Accepted:
      return QObject::tr("accepted");
    case FindingState::Fixed:
      break;
  }
  return QObject::tr("fixed");
}

QString nameOf(FindingChange change) {
  switch (change) {
    case FindingChange::New:
      return QObject::tr("new");
    case FindingChange::Worse:
      return QObject::tr("worse");
    case FindingChange::Same:
      return QObject::tr("same");
    case FindingChange::Better:
      return QObject::tr("better");
    case FindingChange::Gone:
      break;
  }
  return QObject::tr("gone");
}

QString stateText(const ShownFinding& finding) {
  return wasAccepted(finding.state, finding.reason.toStdString()) ? QObject::tr("changed")
                                                                  : nameOf(finding.state);
}

QString changeText(const ShownFinding& finding) {
  if (!finding.change) return kNoValue;
  const QString change = nameOf(*finding.change);
  if (!finding.before || *finding.change == FindingChange::Same) return change;
  const PairRecord& before = *finding.before;
  const bool isSameVerdict = before.verdict == finding.verdict;
  const QString was =
      isSameVerdict ? formatLength(before.depth.value_or(before.distance)) : nameOf(before.verdict);
  return QObject::tr("%1, was %2").arg(change, was);
}

QString ruleText(const PairRule& rule) {
  const QString part = shortName(rule.part), other = shortName(rule.other);
  switch (rule.kind) {
    case PairRuleKind::LeaveOut:
      return QObject::tr("Leave out: %1 with %2").arg(part, other);
    case PairRuleKind::SameGroup:
      return QObject::tr("Leave out parts of one group");
    case PairRuleKind::Touching:
      return QObject::tr("Meant to touch: %1 and %2").arg(part, other);
    case PairRuleKind::PressFit:
      break;
  }
  return QObject::tr("Press fit: %1 and %2, up to %3").arg(part, other, formatRoundLength(rule.interference));
}

QString depthText(const ShownFinding& finding) {
  if (!finding.depth) return {};
  const QString length = formatLength(*finding.depth);
  // What a scene keeps of its last check does not say how well the depth is known.
  const bool isBound = finding.now != nullptr && !finding.isDepthExact;
  return isBound ? QObject::tr("at most %1").arg(length) : length;
}

QString formatVolume(double cubicMetres) {
  constexpr double kInch = 0.0254, kCentimetre = 1e-2, kMillimetre = 1e-3;
  const auto in = [&](double side, const QString& text) {
    return text.arg(formatNumber(cubicMetres / (side * side * side)));
  };
  const LengthUnit unit = shownLengthUnit();
  if (unit == LengthUnit::Inch) return in(kInch, QObject::tr("%1 in³"));
  if (unit == LengthUnit::Metre || cubicMetres >= 1.0) return in(1.0, QObject::tr("%1 m³"));
  // Below ten cubic centimetres, cubic millimetres have the better figures.
  const bool isSmall = unit == LengthUnit::Millimetre && cubicMetres < 1e-5;
  return isSmall ? in(kMillimetre, QObject::tr("%1 mm³")) : in(kCentimetre, QObject::tr("%1 cm³"));
}

void PairFindingsModel::show(std::vector<ShownFinding> rows) {
  beginResetModel();
  rows_ = std::move(rows);
  endResetModel();
}

void PairFindingsModel::follow(const Scene& scene) {
  bool isChanged = false;
  const auto set = [&isChanged](auto& shown, const auto& value) {
    if (shown == value) return;
    shown = value;
    isChanged = true;
  };
  for (ShownFinding& row : rows_) {
    const Part *part = scene.find(row.pair.part), *other = scene.find(row.pair.other);
    if (part != nullptr) set(row.part, QString::fromStdString(part->name));
    if (other != nullptr) set(row.other, QString::fromStdString(other->name));
    const PairRecord* record = scene.findPairRecord(row.pair);
    set(row.isKept, record != nullptr);
    if (record == nullptr) continue;
    set(row.state, record->state);
    set(row.reason, QString::fromStdString(record->reason));
  }
  if (isChanged) refresh();
}

void PairFindingsModel::setStale(bool isStale) {
  if (std::exchange(isStale_, isStale) != isStale) refresh();
}

void PairFindingsModel::refresh() {
  if (rowCount() > 0) emit dataChanged(index(0, 0), index(rowCount() - 1, ColumnCount - 1));
}

int PairFindingsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int PairFindingsModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : ColumnCount;
}

QString PairFindingsModel::textOf(const ShownFinding& row, int column) {
  switch (column) {
    case First:
      return row.part;
    case Second:
      return row.other;
    case Verdict:
      return row.rule.isEmpty() ? nameOf(row.verdict) : tr("%1, allowed").arg(nameOf(row.verdict));
    case Distance:
      return row.distance ? formatLength(*row.distance) : kNoValue;
    case Depth:
      return row.depth ? depthText(row) : kNoValue;
    case Volume:
      return row.volume ? formatVolume(*row.volume) : kNoValue;
    case Change:
      return changeText(row);
    case State:
      return stateText(row);
    default:
      return row.reason;
  }
}

QString PairFindingsModel::toolTipOf(const ShownFinding& row, int column) {
  switch (column) {
    case Verdict:
      return row.rule.isEmpty() ? textOf(row, column) : tr("Allowed by the rule: %1").arg(row.rule);
    case Depth:
      if (!row.depth) return {};
      return row.isDepthExact ? tr("No shorter way frees the first part")
                              : tr("A way of this length frees the first part; there may be a shorter one");
    case Volume:
      return row.volumeProblem.isEmpty() ? QString() : tr("Not known: %1").arg(row.volumeProblem);
    case Change:
      return row.change ? tr("Beside the last check") : tr("As the last check found it");
    case State:
      return wasAccepted(row.state, row.reason.toStdString())
                 ? tr("It was accepted, and is worse or another since: accept it again, or mend it")
                 : stateText(row);
    default:
      return textOf(row, column);
  }
}

QVariant PairFindingsModel::sortKeyOf(const ShownFinding& row, int column) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  switch (column) {
    case First:
    case Second:
    case Reason:
      return textOf(row, column);
    case Verdict: {
      // The worst last, so that a table that descends begins with it: forbidden ones, then by verdict, depth
      // and nearness.
      const double depth = row.depth.value_or(0.0), distance = row.distance.value_or(kMaxPosition);
      const double within = depth > 0.0 ? depth / (1.0 + depth) : 1.0 / (1.0 + distance) - 1.0;
      return 100.0 * severityOf(row) + 10.0 * static_cast<double>(row.verdict) + within;
    }
    case Distance:
      return row.distance.value_or(kNone);
    case Depth:
      return row.depth.value_or(-1.0);
    case Volume:
      return row.volume.value_or(-1.0);
    case Change:
      return row.change ? static_cast<int>(*row.change) : -1;
    default:
      // What has to be judged again comes before all else.
      return wasAccepted(row.state, row.reason.toStdString()) ? -1 : static_cast<int>(row.state);
  }
}

QVariant PairFindingsModel::colourOf(const ShownFinding& row, int column) const {
  if (isStale_) return themed(colours::kMutedText);
  if (column != Verdict || row.verdict == PairVerdict::Clear || !row.rule.isEmpty()) return {};
  return themed(row.isForbidden ? kForbiddenText : colours::kWarning);
}

QVariant PairFindingsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const ShownFinding& row = at(index.row());
  switch (role) {
    case Qt::DisplayRole:
      return textOf(row, index.column());
    case kSortRole:
      return sortKeyOf(row, index.column());
    case Qt::TextAlignmentRole:
      return alignmentOf(index.column());
    case Qt::ForegroundRole:
      return colourOf(row, index.column());
    case Qt::ToolTipRole:
      return toolTipOf(row, index.column());
    default:
      return {};
  }
}

QVariant PairFindingsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= ColumnCount) return {};
  if (role == Qt::TextAlignmentRole) return alignmentOf(section);
  if (role != Qt::DisplayRole && role != Qt::ToolTipRole) return {};
  const std::pair<QString, QString> texts[ColumnCount] = {
      {tr("Part"), tr("The part that is older in the scene")},
      {tr("Other part"), {}},
      {tr("Verdict"), tr("Near, touching, clash, or one part contained in the other; decided exactly")},
      {tr("Distance"), tr("Min distance of the two surfaces")},
      {tr("Depth"), tr("Length of the way that frees the first part")},
      {tr("Volume"), tr("Volume that both parts take")},
      {tr("Change"), tr("Difference from the last check")},
      {tr("State"), tr("What you said about it")},
      {tr("Reason"), tr("Why it may stay")}};
  return role == Qt::DisplayRole ? texts[section].first : texts[section].second;
}

}  // namespace nearfit::ui
