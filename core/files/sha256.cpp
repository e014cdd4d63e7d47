#include "core/files/sha256.h"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include <openssl/evp.h>

#include "core/files/input_file.h"

namespace nearfit {
namespace {

constexpr std::size_t kHashedAtOnce = std::size_t{1} << 20;

/// A running digest. OpenSSL's calls fail only if it is out of memory or built without SHA-256.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void update(std::span<const char> bytes) {
    check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  std::string finish() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    check(EVP_DigestFinal_ex(context_.get(), digest.data(), &length) == 1);
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < length; ++i) {
      text += kDigits[digest[i] >> 4];
      text += kDigits[digest[i] & 15];
    }
    return text;
  }

 private:
  static void check(bool succeeded) {
    if (!succeeded) throw std::runtime_error("OpenSSL cannot compute SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256OfFile(const std::filesystem::path& file,
                         const std::function<void(double fraction)>& onBlock) {
  InputFile input(file);
  Sha256 digest;
  std::vector<char> block(kHashedAtOnce);
  double done = 0.0;
  for (;;) {
    const std::size_t count = input.read(block);
    if (count == 0) return digest.finish();
    digest.update({block.data(), count});
    done += static_cast<double>(count);
    // A file that grows meanwhile is still read to its end.
    if (onBlock) onBlock(std::min(1.0, done / static_cast<double>(std::max<std::uint64_t>(1, input.size()))));
  }
}

std::string sha256OfBytes(std::span<const char> bytes) {
  Sha256 digest;
  digest.update(bytes);
  return digest.finish();
}

}  // namespace nearfit
