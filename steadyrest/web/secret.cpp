// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdlib>

#include <sodium.h>

#include <steadyrest/web/secret.hpp>

namespace steadyrest::web {
namespace {

constexpr std::size_t kBytes = 32;
constexpr int kAlphabet = sodium_base64_VARIANT_URLSAFE_NO_PADDING;

/// libsodium opens the system's random source once; without one nothing here is safe.
void ready() {
  if (sodium_init() < 0) {
    std::abort();
  }
}

}  // namespace

std::string new_secret() {
  ready();
  std::array<unsigned char, kBytes> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  std::array<char, sodium_base64_ENCODED_LEN(kBytes, kAlphabet)> text{};
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), kAlphabet);
  return text.data();
}

std::string digest(std::string_view secret) {
  ready();
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256(hash.data(), reinterpret_cast<const unsigned char*>(secret.data()),
                     secret.size());
  std::array<char, 2 * crypto_hash_sha256_BYTES + 1> text{};
  return sodium_bin2hex(text.data(), text.size(), hash.data(), hash.size());
}

bool same_secret(std::string_view one, std::string_view other) noexcept {
  return one.size() == other.size() && sodium_memcmp(one.data(), other.data(), one.size()) == 0;
}

}  // namespace steadyrest::web
