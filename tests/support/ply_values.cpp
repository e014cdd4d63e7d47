#include "tests/support/ply_values.h"

#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/support/temporary_folder.h"

namespace nearfit::test {
namespace {

/// The bytes after the header, taken from the front.
class PlyBytes {
 public:
  PlyBytes(const std::string& bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  double take(const std::string& type) {
    if (type == "double") return take<double>();
    if (type == "float") return static_cast<double>(take<float>());
    if (type == "uchar") return static_cast<double>(take<std::uint8_t>());
    if (type == "uint") return static_cast<double>(take<std::uint32_t>());
    throw std::runtime_error("unexpected type " + type);
  }
  bool isAtEnd() const { return at_ == bytes_.size(); }

 private:
  template <class T>
  T take() {
    if (at_ + sizeof(T) > bytes_.size()) throw std::runtime_error("the file is too short");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  const std::string& bytes_;
  std::size_t at_;
};

}  // namespace

PlyValues readPlyValues(const std::filesystem::path& file) {
  const std::string bytes = readBytes(file);
  const std::string end = "end_header\n";
  const std::size_t at = bytes.find(end);
  if (at == std::string::npos) throw std::runtime_error("no header");
  std::istringstream header(bytes.substr(0, at));
  PlyValues values;
  std::vector<std::pair<std::string, std::string>> properties;
  std::size_t vertices = 0, faces = 0;
  bool isBinary = false;
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string key, first, second;
    words >> key >> first;
    if (line == "format binary_little_endian 1.0") isBinary = true;
    if (key == "comment") values.comments.push_back(line.substr(8));
    if (key == "element") words >> (first == "vertex" ? vertices : faces);
    if (key == "property" && first != "list") {
      words >> second;
      properties.emplace_back(second, first);
    }
  }
  if (!isBinary) throw std::runtime_error("not binary");
  PlyBytes data(bytes, at + end.size());
  for (std::size_t i = 0; i < vertices; ++i) {
    for (const auto& [name, type] : properties)
      values.vertex[name].push_back(data.take(type));
  }
  for (std::size_t i = 0; i < faces; ++i) {
    std::vector<std::size_t> corners(static_cast<std::size_t>(data.take("uchar")));
    for (std::size_t& corner : corners)
      corner = static_cast<std::size_t>(data.take("uint"));
    values.faces.push_back(std::move(corners));
  }
  if (!data.isAtEnd()) throw std::runtime_error("the file is too long");
  return values;
}

}  // namespace nearfit::test
