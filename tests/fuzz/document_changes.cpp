#include "tests/fuzz/document_changes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <random>
#include <string_view>
#include <utility>

#include <zlib.h>

#include "core/import/document_import.h"
#include "core/math/mixed_bits.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModelExtension = ".model";

using Random = std::mt19937_64;

/// 0 to limit - 1.
std::size_t below(Random& random, std::size_t limit) {
  return static_cast<std::size_t>(random() % limit);
}

enum class TokenKind : std::uint8_t { Number, Reference, Word };

struct Token {
  TokenKind kind{};
  std::size_t at = 0, size = 0;
};

bool isDigitAt(std::string_view text, std::size_t at) {
  return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
}

bool isLetterAt(std::string_view text, std::size_t at) {
  return at < text.size() && (std::isalpha(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
}

/// Bytes of the number that begins there; 0 if none does.
std::size_t numberSize(std::string_view text, std::size_t at) {
  std::size_t end = at;
  if (end < text.size() && (text[end] == '-' || text[end] == '+')) ++end;
  if (!isDigitAt(text, end)) return 0;
  while (isDigitAt(text, end) || (end < text.size() && text[end] == '.'))
    ++end;
  if (end < text.size() && (text[end] == 'E' || text[end] == 'e')) {
    const std::size_t sign = end + 1 < text.size() && (text[end + 1] == '-' || text[end + 1] == '+') ? 2 : 1;
    if (isDigitAt(text, end + sign)) end += sign;
    while (isDigitAt(text, end))
      ++end;
  }
  return end - at;
}

/// The token that begins there; none if none does.
std::optional<Token> tokenAt(std::string_view text, std::size_t at) {
  std::size_t end = at;
  if (text[at] == '#' && isDigitAt(text, at + 1)) {
    for (++end; isDigitAt(text, end);)
      ++end;
    return Token{TokenKind::Reference, at, end - at};
  }
  if (isLetterAt(text, at)) {
    while (isLetterAt(text, end) || isDigitAt(text, end))
      ++end;
    return Token{TokenKind::Word, at, end - at};
  }
  const std::size_t size = numberSize(text, at);
  return size > 0 ? std::optional(Token{TokenKind::Number, at, size}) : std::nullopt;
}

/// A token of that kind near a place chosen at random; none if there is none near it.
std::optional<Token> someToken(std::string_view text, TokenKind kind, Random& random) {
  if (text.empty()) return std::nullopt;
  constexpr std::size_t kNear = 4096;
  std::size_t at = below(random, text.size());
  const std::size_t end = std::min(text.size(), at + kNear);
  // Not from the middle of one.
  while (at < end && (isLetterAt(text, at) || isDigitAt(text, at)))
    ++at;
  while (at < end) {
    const std::optional<Token> token = tokenAt(text, at);
    if (token && token->kind == kind) return token;
    at += token ? token->size : 1;
  }
  return std::nullopt;
}

std::string someNumber(std::string_view text, Random& random) {
  constexpr std::array kNumbers{"0",          "-1",     "1.",    "-0.5",       "1.E-30",
                                "1.E+30",     "1.E300", "1e39",  "2147483647", "-2147483648",
                                "4294967296", "1E400",  "1.E-7", "65536",      "3",
                                "1000000",    "nan",    "inf",   "1e-400",     "999999999"};
  const std::optional<Token> other =
      below(random, 2) == 0 ? someToken(text, TokenKind::Number, random) : std::nullopt;
  if (other) return std::string(text.substr(other->at, other->size));
  return kNumbers[below(random, kNumbers.size())];
}

/// Replaces one token by another one.
/// @param keepsPlaces  What lies behind it stays where it is: formats with columns, and with sizes in bytes.
void changeToken(std::string& text, bool keepsPlaces, Random& random) {
  const auto kind = static_cast<TokenKind>(below(random, 3));
  const std::optional<Token> token = someToken(text, kind, random);
  if (!token) return;
  std::string with;
  if (kind == TokenKind::Number) {
    with = someNumber(text, random);
  } else if (const std::optional<Token> other = someToken(text, kind, random)) {
    with = text.substr(other->at, other->size);
  }
  if (keepsPlaces) with.resize(token->size, ' ');
  text.replace(token->at, token->size, with);
}

/// Begin and end of a statement: up to and with what ends one in any of the formats.
std::pair<std::size_t, std::size_t> someStatement(const std::string& text, Random& random) {
  const std::size_t at = text.find_first_of(";>}\n", below(random, text.size()));
  if (at == std::string::npos) return {0, 0};
  const std::size_t end = text.find_first_of(";>}\n", at + 1);
  return {at + 1, end == std::string::npos ? text.size() : end + 1};
}

/// Drops a statement, or repeats it somewhere else.
void changeStatement(std::string& text, Random& random) {
  if (text.empty()) return;
  const auto [from, to] = someStatement(text, random);
  if (below(random, 2) == 0) {
    text.erase(from, to - from);
  } else {
    const std::string copy = text.substr(from, to - from);
    text.insert(someStatement(text, random).first, copy);
  }
}

void changeBytes(std::string& bytes, Random& random) {
  if (bytes.empty()) return;
  const std::size_t at = below(random, bytes.size()), count = 1 + below(random, 8);
  switch (below(random, 4)) {
    case 0:
      bytes[at] = static_cast<char>(random());
      break;
    case 1:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 7)));
      break;
    case 2:
      bytes.erase(at, count);
      break;
    default:
      bytes.insert(at, count, static_cast<char>(random()));
  }
}

void change(DocumentBytes& document, Random& random) {
  const fs::path extension = fs::path(document.name).extension();
  const bool keepsPlaces = extension == ".glb" || extension == ".igs" || extension == ".iges";
  constexpr std::size_t kOneIn = 200;
  if (below(random, kOneIn) == 0) {
    document.bytes.resize(below(random, document.bytes.size() + 1));
  } else if (extension == ".3mf" || below(random, 8) == 0) {
    changeBytes(document.bytes, random);
  } else if (!keepsPlaces && below(random, 4) == 0) {
    changeStatement(document.bytes, random);
  } else {
    changeToken(document.bytes, keepsPlaces, random);
  }
}

/// Numbers of a zip file, whose first byte is the lowest; several fields of zeros at once.
void append(std::string& to, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i, value >>= 8)
    to += static_cast<char>(value & 0xFFU);
}

/// A zip file, nothing in it compressed.
std::string zipOf(std::span<const DocumentBytes> files) {
  // APPNOTE.TXT of PKWARE, 4.3: version 2.0, no flags, stored, the first day that there is.
  constexpr std::uint64_t kVersion = 20, kStored = 0, kDay = 0x21;
  std::string zip, directory;
  for (const DocumentBytes& file : files) {
    const auto checksum = ::crc32(0, reinterpret_cast<const ::Bytef*>(file.bytes.data()),
                                  static_cast<::uInt>(file.bytes.size()));
    const std::size_t begin = zip.size();
    std::string head;
    append(head, kVersion, 2);
    append(head, 0, 2);
    append(head, kStored, 2);
    append(head, kDay << 16, 4);
    append(head, checksum, 4);
    append(head, file.bytes.size(), 4);
    append(head, file.bytes.size(), 4);
    append(head, file.name.size(), 2);
    append(head, 0, 2);
    zip += "PK\x03\x04" + head + file.name + file.bytes;
    directory += "PK\x01\x02";
    append(directory, kVersion, 2);
    directory += head;
    append(directory, 0, 10);
    append(directory, begin, 4);
    directory += file.name;
  }
  const std::size_t begin = zip.size();
  zip += directory + "PK\x05\x06";
  append(zip, 0, 4);
  append(zip, files.size(), 2);
  append(zip, files.size(), 2);
  append(zip, directory.size(), 4);
  append(zip, begin, 4);
  append(zip, 0, 2);
  return zip;
}

/// A 3MF file with that model.
std::string threeMfOf(std::string model) {
  constexpr const char* kTypes =
      R"(<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
      R"(<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>)"
      R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)";
  constexpr const char* kRelations =
      R"(<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
      R"(<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>)"
      R"(</Relationships>)";
  const std::array<DocumentBytes, 3> files{DocumentBytes{"[Content_Types].xml", kTypes},
                                           DocumentBytes{"_rels/.rels", kRelations},
                                           DocumentBytes{"3D/3dmodel.model", std::move(model)}};
  return zipOf(files);
}

void collect(const fs::path& path, std::vector<fs::path>& files) {
  if (!fs::is_directory(path)) {
    files.push_back(path);
    return;
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
}

}  // namespace

std::vector<DocumentBytes> documentsIn(std::span<const fs::path> paths, std::uintmax_t maxBytes) {
  std::vector<fs::path> files;
  for (const fs::path& path : paths)
    collect(path, files);
  // The order in which a file system lists them differs from one to the next.
  std::ranges::sort(files, {}, [](const fs::path& file) { return std::pair(file.filename(), file); });
  std::vector<DocumentBytes> documents;
  for (const fs::path& file : files)
    if ((file.extension() == kModelExtension || isDocumentFile(file)) && fs::file_size(file) <= maxBytes)
      documents.push_back({file.filename().string(), test::readBytes(file)});
  return documents;
}

DocumentBytes packed(DocumentBytes document) {
  const fs::path name = document.name;
  if (name.extension() != kModelExtension) return document;
  return {name.stem().string() + ".3mf", threeMfOf(std::move(document.bytes))};
}

DocumentBytes changedDocument(std::span<const DocumentBytes> seeds, std::uint64_t seed, std::uint64_t index) {
  Random random(mixedBits(mixedBits(seed) + index));
  DocumentBytes document = seeds[below(random, seeds.size())];
  // Few, which readers take far, and now and then many.
  constexpr std::size_t kFew = 4, kMany = 64;
  const std::size_t changes = 1 + below(random, below(random, 8) == 0 ? kMany : kFew);
  for (std::size_t i = 0; i < changes; ++i)
    change(document, random);
  return packed(std::move(document));
}

}  // namespace nearfit::fuzz
