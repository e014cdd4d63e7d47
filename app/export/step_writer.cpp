#include "app/export/step_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <ostream>
#include <set>
#include <streambuf>
#include <utility>

#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_Static.hxx>
#include <Message_ProgressRange.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>

#include "app/import/import_job.h"
#include "app/import/occ_progress.h"
#include "core/base/error.h"
#include "core/scene/names.h"

namespace nearfit::exporter {
namespace {

/// OpenCASCADE's numbers of the schemas.
constexpr int kOccAp214 = 4, kOccAp242 = 5;
/// Begin of the texts that stand for names until the file is written; ten digits follow. OpenCASCADE would replace blanks
/// and characters beyond ASCII, differently in each version.
constexpr std::string_view kPlaceholder = "'NFNAME";
constexpr std::size_t kPlaceholderDigits = 10;
/// Progress once the assembly is STEP entities; what is left is their text.
constexpr double kTransferred = 0.8;

Quantity_Color occColour(const CadColour& colour) {
  return {static_cast<double>(colour[0]), static_cast<double>(colour[1]), static_cast<double>(colour[2]),
          Quantity_TOC_sRGB};
}

TopLoc_Location locationOf(const RigidTransform& pose) {
  const glm::dquat& q = pose.rotation;
  const glm::dvec3 t = kMillimetresPerMetre * pose.translation;
  gp_Trsf place;
  place.SetTransformation(gp_Quaternion(q.x, q.y, q.z, q.w), gp_Vec(t.x, t.y, t.z));
  return place;
}

/// Names by the placeholders that stand for them.
class Names {
 public:
  std::string placeholderOf(const std::string& name) {
    names_.push_back(name);
    return fmt::format("{}{:0{}}", kPlaceholder.substr(1), names_.size() - 1, kPlaceholderDigits);
  }
  /// Writes the text with the names in place of what stands for them.
  void substitute(std::string_view text, const std::function<void(std::string_view text)>& sink) const {
    for (std::size_t at = 0; (at = text.find(kPlaceholder)) != text.npos;) {
      const std::string_view digits = text.substr(at + kPlaceholder.size(), kPlaceholderDigits);
      std::size_t index = 0;
      for (const char c : digits)
        index = 10 * index + static_cast<std::size_t>(c - '0');
      if (index >= names_.size()) throw Error("", "a name of the STEP file is damaged", "report this");
      sink(text.substr(0, at));
      sink(stepString(names_[index]));
      // The quote behind it too.
      text.remove_prefix(at + kPlaceholder.size() + kPlaceholderDigits + 1);
    }
    sink(text);
  }

 private:
  std::vector<std::string> names_;
};

/// Puts a request into OpenCASCADE's document.
class AssemblyBuilder {
 public:
  AssemblyBuilder(const StepRequest& request, std::vector<ProductShape>& shapes, Names& names)
      : request_(request), shapes_(shapes), names_(names), taken_(kMaxDocumentKeyBytes + 20) {
    // Without names such as "COMPOUND" for what has none.
    XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
    document_ = new TDocStd_Document("BinXCAF");
    shapeTool_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colourTool_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
  }

  Handle(TDocStd_Document) build() {
    const TDF_Label root = shapeTool_->NewShape();
    name(root, request_.name);
    std::vector<TDF_Label> labelOf(request_.document.nodes.size());
    for (std::size_t i = 0; i < labelOf.size(); ++i) {
      const CadNode& node = request_.document.nodes[i];
      if (node.shape < 0) {
        labelOf[i] = shapeTool_->NewShape();
        name(labelOf[i], node.name);
      } else {
        labelOf[i] = productFor(node);
      }
      const TDF_Label& parent = node.parent < 0 ? root : labelOf[static_cast<std::size_t>(node.parent)];
      name(shapeTool_->AddComponent(parent, labelOf[i], locationOf(node.parentFromNode)), node.name);
    }
    shapeTool_->UpdateAssemblies();
    return document_;
  }

 private:
  void name(const TDF_Label& label, const std::string& text) {
    TDataStd_Name::Set(label, TCollection_ExtendedString(names_.placeholderOf(text).c_str()));
  }

  using Place = std::array<double, 7>;
  static Place placeOf(const RigidTransform& pose) {
    const glm::dquat& q = pose.rotation;
    const glm::dvec3& t = pose.translation;
    return {q.w, q.x, q.y, q.z, t.x, t.y, t.z};
  }

  /// A shape in a colour, and where it has been placed: OpenCASCADE takes two occurrences of one product at one place
  /// for one, so that the second gets a product of its own.
  struct Product {
    TDF_Label label;
    std::set<Place> places;
  };

  TDF_Label productFor(const CadNode& node) {
    std::vector<Product>& products = products_[{node.shape, node.colour}];
    const Place place = placeOf(node.parentFromNode);
    for (Product& product : products)
      if (product.places.insert(place).second) return product.label;
    products.push_back({addProduct(node), {place}});
    return products.back().label;
  }

  TDF_Label addProduct(const CadNode& node) {
    const auto index = static_cast<std::size_t>(node.shape);
    const bool isFirst = used_.insert(node.shape).second;
    const ProductShape product = isFirst ? shapes_[index] : copyOf(shapes_[index]);
    const TDF_Label label = shapeTool_->AddShape(product.shape, Standard_False);
    name(label, taken_.takeFree(request_.document.shapes[index].key));
    if (node.colour) colourTool_->SetColor(label, occColour(*node.colour), XCAFDoc_ColorSurf);
    for (const auto& [face, colour] : product.faceColours) {
      const TDF_Label faceLabel = shapeTool_->AddSubShape(label, face);
      if (!faceLabel.IsNull()) colourTool_->SetColor(faceLabel, occColour(colour), XCAFDoc_ColorSurf);
    }
    return label;
  }

  const StepRequest& request_;
  std::vector<ProductShape>& shapes_;
  Names& names_;
  TakenNames taken_;
  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapeTool_;
  Handle(XCAFDoc_ColorTool) colourTool_;
  std::set<std::int32_t> used_;  ///< Shapes that a product has.
  std::map<std::pair<std::int32_t, std::optional<CadColour>>, std::vector<Product>> products_;
};

/// Gathers text, and gives it on in pieces that end at a line's end.
class LineBuffer : public std::streambuf {
 public:
  explicit LineBuffer(std::function<void(std::string_view text)> sink) : sink_(std::move(sink)) {}
  void finish() { sink_(text_); }

 protected:
  int_type overflow(int_type c) override {
    if (c == traits_type::eof()) return 0;
    const char one = traits_type::to_char_type(c);
    return xsputn(&one, 1) == 1 ? c : traits_type::eof();
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    constexpr std::size_t kLines = std::size_t{1} << 20;
    text_.append(text, static_cast<std::size_t>(count));
    if (text_.size() >= kLines && text_.back() == '\n') {
      sink_(text_);
      text_.clear();
    }
    return count;
  }

 private:
  std::function<void(std::string_view text)> sink_;
  std::string text_;
};

void nameHeader(const Handle(StepData_StepModel) & model, const std::string& placeholder) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(new TCollection_HAsciiString(placeholder.c_str()));
  header.SetOriginatingSystem(new TCollection_HAsciiString("Nearfit " NEARFIT_VERSION));
}

[[noreturn]] void throwUnwritten() {
  throw Error("", "OpenCASCADE cannot write it as STEP", "export fewer parts to find the one that fails");
}

void appendHex(std::string& to, std::uint32_t code, int digits) {
  to += fmt::format("{:0{}X}", code, digits);
}

/// Decodes the character at the begin of well-formed UTF-8; sets the bytes that it takes.
std::uint32_t characterOf(std::string_view utf8, std::size_t& bytes) {
  const auto first = static_cast<unsigned char>(utf8.front());
  bytes = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  std::uint32_t code = bytes == 1 ? first : first & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes && i < utf8.size(); ++i)
    code = (code << 6) | (static_cast<unsigned char>(utf8[i]) & 0x3FU);
  return code;
}

/// Names of instances are their ids too: OpenCASCADE's readers take the id where a name has no ASCII character.
void setIdsOfInstances(const StepData_StepModel& model) {
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const auto instance = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(model.Value(i));
    if (!instance.IsNull()) instance->SetId(instance->Name());
  }
}

}  // namespace

std::string stepString(std::string_view utf8) {
  std::string text = "'";
  while (!utf8.empty()) {
    std::size_t bytes = 1;
    const std::uint32_t code = characterOf(utf8, bytes);
    if (code >= 0x10000) {
      text += "\\X4\\";
      appendHex(text, code, 8);
      text += "\\X0\\";
    } else if (code < 0x20 || code >= 0x7F) {
      text += "\\X2\\";
      appendHex(text, code, 4);
      text += "\\X0\\";
    } else {
      text += static_cast<char>(code);
      if (code == '\'' || code == '\\') text += static_cast<char>(code);
    }
    utf8.remove_prefix(std::min(bytes, utf8.size()));
  }
  return text + "'";
}

void writeStep(const StepRequest& request, std::vector<ProductShape>& shapes,
               const std::function<void(double fraction)>& progress,
               const std::function<void(std::string_view text)>& sink) {
  // Parameters exist once the controller does, and a model takes the schema when it is made.
  STEPCAFControl_Controller::Init();
  Interface_Static::SetIVal("write.step.schema", request.schema == StepSchema::Ap242 ? kOccAp242 : kOccAp214);
  Names names;
  const Handle(TDocStd_Document) document = AssemblyBuilder(request, shapes, names).build();
  STEPCAFControl_Writer writer;
  writer.ChangeWriter().Model(Standard_True);
  writer.SetColorMode(Standard_True);
  writer.SetNameMode(Standard_True);
  writer.SetLayerMode(Standard_False);
  writer.SetPropsMode(Standard_False);
  writer.SetSHUOMode(Standard_False);
  writer.SetDimTolMode(Standard_False);
  writer.SetMaterialMode(Standard_False);
  importer::ImportJob job;
  job.progress = [&](double fraction) { progress(fraction * kTransferred); };
  importer::OccProgress stages(job);
  if (!writer.Transfer(document, STEPControl_AsIs, nullptr, stages.stageTo(1.0))) throwUnwritten();
  const Handle(StepData_StepModel) model = writer.ChangeWriter().Model();
  nameHeader(model, names.placeholderOf(request.name));
  setIdsOfInstances(*model);
  progress(kTransferred);
  const Handle(StepData_Protocol) protocol =
      Handle(StepData_Protocol)::DownCast(writer.Writer().WS()->Protocol());
  if (protocol.IsNull()) throwUnwritten();
  StepData_StepWriter text(model);
  text.SendModel(protocol);
  LineBuffer buffer([&](std::string_view lines) { names.substitute(lines, sink); });
  std::ostream stream(&buffer);
  // An error of the sink is no reason to go on.
  stream.exceptions(std::ios::badbit);
  if (!text.Print(stream)) throwUnwritten();
  buffer.finish();
  progress(1.0);
}

}  // namespace nearfit::exporter
