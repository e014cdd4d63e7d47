#include "core/session/command_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/names.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_file_haptics.h"
#include "core/scene/scene_json.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;
using CommandJson = nlohmann::ordered_json;

/// Writes the fields of each kind of command.
class CommandWriter {
 public:
  CommandWriter(const Scene& before, const fs::path& script) : scene_(before), script_(script) {}

  template <class Step>
  CommandJson operator()(const Step& step) {
    CommandJson json;
    json["do"] = Step::kName;
    write(json, step);
    return json;
  }

 private:
  void write(CommandJson& json, const steps::AddNodes& step) {
    CommandJson groups = CommandJson::array(), parts = CommandJson::array();
    for (const NewNodes::NewGroup& group : step.nodes.groups)
      groups.push_back({{"name", group.name}, {"parent", indexJson(group.parent)}});
    for (const NewNodes::NewPart& part : step.nodes.parts) {
      CommandJson each;
      each["name"] = part.name;
      each["file"] = fileJson(part.geometry);
      addPose(each, part.worldFromPart);
      each["colour"] = part.colour ? colourJson(*part.colour) : CommandJson();
      each["group"] = indexJson(part.group);
      parts.push_back(std::move(each));
    }
    json["files"] = std::move(files_);
    json["groups"] = std::move(groups);
    json["parts"] = std::move(parts);
  }
  void write(CommandJson& json, const steps::DeleteNodes& step) { addNodesOf(json, step.nodes); }
  void write(CommandJson& json, const steps::Duplicate& step) { addNodesOf(json, step.nodes); }
  void write(CommandJson& json, const steps::RenamePart& step) const {
    json["part"] = partJson(step.part);
    json["name"] = step.name;
  }
  void write(CommandJson& json, const steps::RenameGroup& step) {
    json["group"] = groupJson(step.group);
    json["name"] = step.name;
  }
  void write(CommandJson& json, const steps::MoveParts& step) const {
    json["parts"] = partsJson(step.parts);
    json["lead"] = partJson(step.lead);
    addPose(json, step.worldFromLead);
    json["verb"] = step.verb;
  }
  void write(CommandJson& json, const steps::SetColour& step) const {
    json["parts"] = partsJson(step.parts);
    json["colour"] = colourJson(step.colour);
  }
  void write(CommandJson& json, const steps::SetOpacity& step) const {
    json["parts"] = partsJson(step.parts);
    json["opacity"] = step.opacity;
  }
  void write(CommandJson& json, const steps::SetDensity& step) const {
    json["parts"] = partsJson(step.parts);
    json["density"] = step.density;
  }
  void write(CommandJson& json, const steps::SetVisible& step) const {
    json["parts"] = partsJson(step.parts);
    json["visible"] = step.isVisible;
  }
  void write(CommandJson& json, const steps::SetPivots& step) const {
    json["pivots"] = CommandJson::array();
    for (const steps::NewPivot& each : step.pivots)
      json["pivots"].push_back({{"part", partJson(each.part)}, {"pivot", pivotJson(each.inPart)}});
  }
  void write(CommandJson& json, const steps::ReloadParts& step) { addGeometries(json, step.parts); }
  void write(CommandJson& json, const steps::RepairParts& step) { addGeometries(json, step.parts); }
  void write(CommandJson& json, const steps::RescaleParts& step) { addGeometries(json, step.parts); }
  void write(CommandJson& json, const steps::RefineParts& step) { addGeometries(json, step.parts); }
  void write(CommandJson& json, const steps::Isolate& step) const { json["parts"] = partsJson(step.parts); }
  void write(CommandJson&, const steps::EndIsolation&) const {}
  void write(CommandJson& json, const steps::SetLocked& step) {
    addNodesOf(json, step.nodes);
    json["locked"] = step.isLocked;
  }
  void write(CommandJson& json, const steps::GroupNodes& step) {
    addNodesOf(json, step.nodes);
    json["name"] = step.name;
  }
  void write(CommandJson& json, const steps::Ungroup& step) { json["groups"] = groupsJson(step.groups); }
  void write(CommandJson& json, const steps::Regroup& step) {
    addNodesOf(json, step.nodes);
    json["target"] = step.target ? groupJson(*step.target) : CommandJson();
  }
  void write(CommandJson& json, const steps::AddJoint& step) const {
    const Joint& joint = step.joint;
    json["kind"] = wordOf(joint.kind);
    json["part"] = partJson(joint.part);
    json["base"] = joint.base ? partJson(*joint.base) : CommandJson();
    json["onPart"] = jointFeatureJson(joint.onPart, joint.kind);
    json["onBase"] = jointFeatureJson(joint.onBase, joint.kind);
    json["on"] = joint.isOn;
    addPose(json, step.worldFromPart);
  }
  void write(CommandJson& json, const steps::RemoveJoints& step) const {
    json["joints"] = jointsJson(step.joints);
  }
  void write(CommandJson& json, const steps::SetJointsOn& step) const {
    json["joints"] = jointsJson(step.joints);
    json["on"] = step.isOn;
  }
  void write(CommandJson& json, const steps::SetPairRules& step) const {
    json["rules"] = pairRulesJson(step.rules);
  }
  void write(CommandJson& json, const steps::SetPairRecords& step) const {
    json["records"] = CommandJson::array();
    for (const PairRecord& record : step.records) {
      CommandJson each = pairJson(record.pair);
      addFinding(each, record);
      json["records"].push_back(std::move(each));
    }
  }
  void write(CommandJson& json, const steps::SetFindingState& step) const {
    json["pairs"] = CommandJson::array();
    for (const PartPair& pair : step.pairs)
      json["pairs"].push_back(pairJson(pair));
    json["state"] = wordOf(step.state);
    json["reason"] = step.reason;
  }
  void write(CommandJson& json, const steps::SetMovingPart& step) const {
    json["part"] = step.part ? partJson(*step.part) : CommandJson();
  }
  void write(CommandJson& json, const steps::SetMovingGroup& step) { json["group"] = groupJson(step.group); }
  void write(CommandJson& json, const steps::SetHaptics& step) const {
    json["haptics"] = hapticsJson(step.haptics);
    json["label"] = step.label;
  }

  static CommandJson indexJson(std::optional<std::size_t> index) {
    return index ? CommandJson(*index) : CommandJson();
  }
  CommandJson partJson(PartId id) const { return scene_.get(id).name; }
  CommandJson partsJson(const std::vector<PartId>& ids) const {
    CommandJson json = CommandJson::array();
    for (const PartId id : ids)
      json.push_back(partJson(id));
    return json;
  }
  CommandJson pairJson(const PartPair& pair) const {
    CommandJson json;
    json["part"] = partJson(pair.part);
    json["other"] = partJson(pair.other);
    return json;
  }

  /// The name alone, or with a number where groups share it.
  CommandJson groupJson(GroupId id) {
    const Group* group = scene_.findGroup(id);
    if (group == nullptr)
      throw UsageError(fmt::format("group {}", static_cast<std::uint32_t>(id)), "the scene has no such group",
                       "choose one that is in the scene");
    if (numbers_.empty()) {
      std::map<std::string, std::size_t> counts;
      for (const Scene::GroupPtr& each : scene_.groups())
        numbers_.emplace(each->id, ++counts[each->name]);
    }
    const std::size_t number = numbers_.at(id);
    if (number == 1) return group->name;
    CommandJson json;
    json["name"] = group->name;
    json["number"] = number;
    return json;
  }
  CommandJson groupsJson(const std::vector<GroupId>& ids) {
    CommandJson json = CommandJson::array();
    for (const GroupId id : ids)
      json.push_back(groupJson(id));
    return json;
  }
  void addNodesOf(CommandJson& json, const SceneNodes& nodes) {
    json["parts"] = partsJson(nodes.parts);
    json["groups"] = groupsJson(nodes.groups);
  }

  CommandJson jointsJson(const std::vector<JointId>& ids) const {
    CommandJson json = CommandJson::array();
    for (const JointId id : ids) {
      const Joint& joint = scene_.getJoint(id);
      const auto isBefore = [&](const Joint& other) {
        return other.part == joint.part && other.id < joint.id;
      };
      CommandJson each;
      each["part"] = partJson(joint.part);
      each["number"] = 1 + std::ranges::count_if(scene_.joints(), isBefore);
      json.push_back(std::move(each));
    }
    return json;
  }

  /// Lists a geometry among the files and returns its place there; null for none.
  CommandJson fileJson(const PartGeometryPtr& geometry) {
    if (geometry == nullptr) return {};
    const auto [known, isNew] = places_.emplace(geometry, files_.size());
    if (isNew) {
      CommandJson file;
      file["mesh"] = meshPathFrom(geometry->file, script_);
      file["metresPerUnit"] = geometry->metresPerUnit;
      file["shape"] = shapeJson(*geometry);
      file["repairs"] = repairsJson(geometry->repairs);
      files_.push_back(std::move(file));
    }
    return known->second;
  }
  void addGeometries(CommandJson& json, const std::vector<steps::NewGeometry>& renewed) {
    CommandJson parts = CommandJson::array();
    for (const steps::NewGeometry& each : renewed) {
      CommandJson part = CommandJson::object();
      part["part"] = partJson(each.part);
      part["file"] = fileJson(each.geometry);
      parts.push_back(std::move(part));
    }
    json["files"] = std::move(files_);
    json["parts"] = std::move(parts);
  }

  const Scene& scene_;
  const fs::path& script_;
  std::map<GroupId, std::size_t> numbers_;         ///< Among the groups of one name, from 1.
  std::map<PartGeometryPtr, std::size_t> places_;  ///< In files_.
  CommandJson files_ = CommandJson::array();
};

/// Reads the fields of each kind of command.
class CommandReader {
 public:
  CommandReader(const JsonField& line, const Scene& scene, const fs::path& folder,
                const ProgressCallback& progress)
      : line_(line), scene_(scene), folder_(folder), progress_(progress) {}

  void read(steps::AddNodes& step) const {
    const JsonField parts = line_.at("parts");
    const std::size_t groups = line_.has("groups") ? countOf(line_.at("groups"), kMaxGroups, "groups") : 0;
    const std::size_t count = countOf(parts, kMaxSceneFileParts, "parts");
    requireRoom(parts, count);
    for (std::size_t i = 0; i < groups; ++i) {
      const JsonField each = line_.at("groups").at(i);
      NewNodes::NewGroup& group = step.nodes.groups.emplace_back();
      group.name = each.at("name").text(kMaxGroupNameBytes);
      if (each.has("parent")) group.parent = indexOrNull(each.at("parent"), i, "earlier groups");
    }
    const std::vector<PartGeometryPtr> files = readFiles();
    for (std::size_t i = 0; i < count; ++i) {
      const JsonField each = parts.at(i);
      NewNodes::NewPart& part = step.nodes.parts.emplace_back();
      part.name = each.at("name").text(kMaxPartNameBytes);
      part.geometry = files[indexAt(each.at("file"), files.size(), "files")];
      if (each.has("position") || each.has("quaternion")) part.worldFromPart = readPose(each);
      if (each.has("colour") && !each.at("colour").isNull()) part.colour = readColour(each.at("colour"));
      if (each.has("group")) part.group = indexOrNull(each.at("group"), groups, "groups");
    }
  }
  void read(steps::DeleteNodes& step) const { step.nodes = nodes(); }
  void read(steps::Duplicate& step) const {
    step.nodes = nodes();
    requireRoom(line_, partsOf(scene_, step.nodes).size());
  }
  void read(steps::RenamePart& step) const {
    step.part = partAt(line_.at("part"));
    step.name = line_.at("name").text(kMaxPartNameBytes);
  }
  void read(steps::RenameGroup& step) const {
    step.group = groupAt(line_.at("group"));
    step.name = line_.at("name").text(kMaxGroupNameBytes);
  }
  void read(steps::MoveParts& step) const {
    step.parts = parts();
    step.lead = partAt(line_.at("lead"));
    if (std::ranges::find(step.parts, step.lead) == step.parts.end())
      line_.at("lead").fail("this part is not one of \"parts\"", "name one of them");
    step.worldFromLead = readPose(line_);
    step.verb = labelAt("verb");
    if (step.verb.empty()) step.verb = "Move";
  }
  void read(steps::SetColour& step) const {
    step.parts = parts();
    step.colour = readColour(line_.at("colour"));
  }
  void read(steps::SetOpacity& step) const {
    step.parts = parts();
    step.opacity = line_.at("opacity").number();
  }
  void read(steps::SetDensity& step) const {
    step.parts = parts();
    step.density = line_.at("density").number();
  }
  void read(steps::SetVisible& step) const {
    step.parts = parts();
    step.isVisible = line_.at("visible").isTrue();
  }
  void read(steps::SetPivots& step) const {
    const JsonField pivots = line_.at("pivots");
    const std::size_t count = countOf(pivots, kMaxSceneFileParts, "pivots");
    for (std::size_t i = 0; i < count; ++i)
      step.pivots.push_back({partAt(pivots.at(i).at("part")), readPivot(pivots.at(i).at("pivot"))});
  }
  void read(steps::ReloadParts& step) const { step.parts = geometries(); }
  void read(steps::RepairParts& step) const { step.parts = geometries(); }
  void read(steps::RescaleParts& step) const { step.parts = geometries(); }
  void read(steps::RefineParts& step) const { step.parts = geometries(); }
  void read(steps::Isolate& step) const { step.parts = parts(); }
  void read(steps::EndIsolation&) const {}
  void read(steps::SetLocked& step) const {
    step.nodes = nodes();
    step.isLocked = line_.at("locked").isTrue();
  }
  void read(steps::GroupNodes& step) const {
    step.nodes = nodes();
    step.name = line_.at("name").text(kMaxGroupNameBytes);
  }
  void read(steps::Ungroup& step) const { step.groups = groups(line_.at("groups")); }
  void read(steps::Regroup& step) const {
    step.nodes = nodes();
    const JsonField target = line_.at("target");
    if (!target.isNull()) step.target = groupAt(target);
  }
  void read(steps::AddJoint& step) const {
    Joint& joint = step.joint;
    joint.kind = readJointKind(line_.at("kind"));
    joint.part = partAt(line_.at("part"));
    if (!line_.at("base").isNull()) joint.base = partAt(line_.at("base"));
    joint.onPart = readJointFeature(line_.at("onPart"), joint.kind);
    joint.onBase = readJointFeature(line_.at("onBase"), joint.kind);
    joint.isOn = line_.at("on").isTrue();
    step.worldFromPart = readPose(line_);
  }
  void read(steps::RemoveJoints& step) const { step.joints = joints(); }
  void read(steps::SetJointsOn& step) const {
    step.joints = joints();
    step.isOn = line_.at("on").isTrue();
  }
  void read(steps::SetPairRules& step) const { step.rules = readPairRules(line_.at("rules")); }
  void read(steps::SetPairRecords& step) const {
    const JsonField records = line_.at("records");
    const std::size_t count = countOf(records, kMaxPairRecords, "records");
    for (std::size_t i = 0; i < count; ++i) {
      step.records.push_back(readFinding(records.at(i)));
      step.records.back().pair = pairAt(records.at(i));
    }
  }
  void read(steps::SetFindingState& step) const {
    const JsonField pairs = line_.at("pairs");
    const std::size_t count = countOf(pairs, kMaxPairRecords, "pairs");
    for (std::size_t i = 0; i < count; ++i)
      step.pairs.push_back(pairAt(pairs.at(i)));
    step.state = readFindingState(line_.at("state"));
    if (line_.has("reason")) step.reason = line_.at("reason").text(kMaxReasonBytes);
  }
  void read(steps::SetMovingPart& step) const {
    if (!line_.at("part").isNull()) step.part = partAt(line_.at("part"));
  }
  void read(steps::SetMovingGroup& step) const { step.group = groupAt(line_.at("group")); }
  void read(steps::SetHaptics& step) const {
    step.haptics = readHaptics(line_.at("haptics"));
    step.label = labelAt("label");
  }

 private:
  static std::size_t countOf(const JsonField& field, std::size_t max, const char* what) {
    const std::size_t count = field.size();
    if (count > max) field.fail(fmt::format("there are more than {} {}", max, what), "give fewer");
    return count;
  }
  void requireRoom(const JsonField& field, std::size_t more) const {
    if (scene_.parts().size() + more <= kMaxSceneFileParts) return;
    field.fail(fmt::format("the scene would have more than {} parts", kMaxSceneFileParts), "add fewer");
  }
  /// A whole number from `least` on, below `end`.
  static std::size_t wholeAt(const JsonField& field, std::size_t least, std::size_t end, const char* what) {
    const double value = field.number();
    if (!(value >= static_cast<double>(least) && value < static_cast<double>(end) &&
          value == std::floor(value))) {
      field.fail(fmt::format("{} is not the number of one of the {} {}", value, end - least, what),
                 fmt::format("count from {}", least));
    }
    return static_cast<std::size_t>(value);
  }
  static std::size_t indexAt(const JsonField& field, std::size_t count, const char* what) {
    return wholeAt(field, 0, count, what);
  }
  static std::optional<std::size_t> indexOrNull(const JsonField& field, std::size_t count, const char* what) {
    if (field.isNull()) return std::nullopt;
    return indexAt(field, count, what);
  }
  /// A text for undo labels; empty if it is not there.
  std::string labelAt(const char* key) const {
    if (!line_.has(key)) return {};
    std::string text = line_.at(key).text(kMaxStepLabelBytes);
    if (!text.empty()) checkedAt(line_.at(key), [&] { checkName("step", text, kMaxStepLabelBytes); });
    return text;
  }

  PartId partAt(const JsonField& field) const {
    const std::string name = field.text(kMaxPartNameBytes);
    if (parts_.empty()) {
      for (const Scene::PartPtr& part : scene_.parts())
        parts_.emplace(part->name, part->id);
    }
    const auto known = parts_.find(name);
    if (known == parts_.end())
      field.fail(fmt::format("there is no part \"{}\"", printableText(name)),
                 "name a part that the scene has at this line");
    return known->second;
  }
  /// The field "parts".
  std::vector<PartId> parts() const { return partsAt(line_.at("parts")); }
  std::vector<PartId> partsAt(const JsonField& field) const {
    const std::size_t count = countOf(field, kMaxSceneFileParts, "parts");
    std::vector<PartId> ids;
    ids.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      ids.push_back(partAt(field.at(i)));
    return ids;
  }
  PartPair pairAt(const JsonField& field) const {
    const PartId part = partAt(field.at("part")), other = partAt(field.at("other"));
    if (part == other) field.at("other").fail("it is the same part", "name another part");
    return {std::min(part, other), std::max(part, other)};
  }

  GroupId groupAt(const JsonField& field, const std::string& name, std::size_t number) const {
    if (groups_.empty()) {
      for (const Scene::GroupPtr& group : scene_.groups())
        groups_[group->name].push_back(group->id);
    }
    const auto known = groups_.find(name);
    if (known == groups_.end() || number > known->second.size()) {
      const std::string which = number > 1 ? fmt::format(" number {}", number) : std::string();
      field.fail(fmt::format("there is no group \"{}\"{}", printableText(name), which),
                 "name a group that the scene has at this line");
    }
    return known->second[number - 1];
  }
  /// @param field  A name, or an object of name and number.
  GroupId groupAt(const JsonField& field) const {
    if (!field.isObject()) return groupAt(field, field.text(kMaxGroupNameBytes), 1);
    return groupAt(field, field.at("name").text(kMaxGroupNameBytes),
                   wholeAt(field.at("number"), 1, kMaxGroups + 1, "groups"));
  }
  std::vector<GroupId> groups(const JsonField& field) const {
    const std::size_t count = countOf(field, kMaxGroups, "groups");
    std::vector<GroupId> ids;
    ids.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      ids.push_back(groupAt(field.at(i)));
    return ids;
  }
  /// The fields "parts" and "groups", of which one may be missing.
  SceneNodes nodes() const {
    SceneNodes found;
    if (line_.has("parts") || !line_.has("groups")) found.parts = parts();
    if (line_.has("groups")) found.groups = groups(line_.at("groups"));
    return found;
  }

  std::vector<JointId> joints() const {
    const JsonField field = line_.at("joints");
    const std::size_t count = countOf(field, kMaxJoints, "joints");
    std::vector<JointId> ids;
    for (std::size_t i = 0; i < count; ++i) {
      const PartId part = partAt(field.at(i).at("part"));
      std::vector<JointId> ofPart;
      for (const Joint& joint : scene_.joints())
        if (joint.part == part) ofPart.push_back(joint.id);
      ids.push_back(
          ofPart[wholeAt(field.at(i).at("number"), 1, ofPart.size() + 1, "joints of the part") - 1]);
    }
    return ids;
  }

  MeshSource sourceAt(const JsonField& field) const {
    MeshSource source;
    source.file = readMeshPath(field.at("mesh"), folder_);
    source.metresPerUnit = field.at("metresPerUnit").number();
    checkedAt(field.at("metresPerUnit"), [&] { checkMetresPerUnit(source.metresPerUnit); });
    if (field.has("shape")) {
      ShapeOfFile shape = readShape(field.at("shape"), source.file);
      source.shape = std::move(shape.key);
      source.tessellation = shape.tessellation;
    }
    if (field.has("repairs")) source.repairs = readRepairs(field.at("repairs"));
    std::error_code failure;
    if (!fs::exists(source.file, failure)) {
      field.at("mesh").fail(fmt::format("the mesh file {} is missing", printableText(source.file.string())),
                            "put it there, or correct the path, which is relative to the script's folder");
    }
    return source;
  }
  /// Loads the field "files".
  std::vector<PartGeometryPtr> readFiles() const {
    const JsonField field = line_.at("files");
    const std::size_t count = countOf(field, kMaxSceneFileParts, "files");
    std::vector<MeshSource> sources;
    for (std::size_t i = 0; i < count; ++i)
      sources.push_back(sourceAt(field.at(i)));
    const std::vector<LoadedPart> loaded = loadPartGeometries(sources, progress_);
    std::vector<PartGeometryPtr> geometries;
    for (std::size_t i = 0; i < count; ++i) {
      try {
        if (loaded[i].problem) std::rethrow_exception(loaded[i].problem);
      } catch (const Cancelled&) {
        throw;
      } catch (const Error& e) {
        field.at(i).at("mesh").fail(e.where() + ": " + e.problem(), e.remedy());
      }
      if (loaded[i].geometry == nullptr)
        field.at(i).at("mesh").fail("the file changed while it was read", "try again");
      geometries.push_back(loaded[i].geometry);
    }
    return geometries;
  }
  /// The fields "files" and "parts" of commands that replace geometry.
  std::vector<steps::NewGeometry> geometries() const {
    const JsonField field = line_.at("parts");
    const std::size_t count = countOf(field, kMaxSceneFileParts, "parts");
    const std::vector<PartGeometryPtr> files = readFiles();
    std::vector<steps::NewGeometry> renewed;
    for (std::size_t i = 0; i < count; ++i)
      renewed.push_back(
          {partAt(field.at(i).at("part")), files[indexAt(field.at(i).at("file"), files.size(), "files")]});
    return renewed;
  }

  const JsonField& line_;
  const Scene& scene_;
  const fs::path& folder_;
  const ProgressCallback& progress_;
  mutable std::map<std::string, PartId> parts_;                 ///< By name, once asked for.
  mutable std::map<std::string, std::vector<GroupId>> groups_;  ///< The same, oldest first.
};

/// Reads the command of that name, the one at `Index` of the variant or a later one.
template <std::size_t Index = 0>
SessionCommand readNamed(const std::string& name, const JsonField& field, const CommandReader& reader) {
  if constexpr (Index < std::variant_size_v<SessionCommand>) {
    using Step = std::variant_alternative_t<Index, SessionCommand>;
    if (name != Step::kName) return readNamed<Index + 1>(name, field, reader);
    Step step;
    reader.read(step);
    return step;
  } else {
    field.fail(fmt::format("there is no command \"{}\"", printableText(name)),
               "give one of those in scripts.md, or use a newer Nearfit");
  }
}

}  // namespace

nlohmann::ordered_json commandJson(const SessionCommand& command, const Scene& before,
                                   const std::filesystem::path& script) {
  CommandWriter writer(before, script);
  return std::visit(writer, command);
}

SessionCommand readCommand(const JsonField& line, const Scene& scene, const std::filesystem::path& folder,
                           const ProgressCallback& progress) {
  const JsonField name = line.at("do");
  return readNamed(name.text(kMaxPartNameBytes), name, CommandReader(line, scene, folder, progress));
}

}  // namespace nearfit
