// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/kernel/file/json_object.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/web/accounts.hpp>
#include <steadyrest/web/secret.hpp>

namespace steadyrest::web {
namespace {

using Json = nlohmann::ordered_json;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr int kVersion = 1;
constexpr const char* kAdd = "make it with `steadyrest page add-user`";

bool is_name(std::string_view name) {
  constexpr std::string_view kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  return !name.empty() && name.size() <= Accounts::kLongestName &&
         name.find_first_not_of(kAllowed) == std::string_view::npos;
}

Result<void> check_name(const std::string& name) {
  if (!is_name(name)) {
    return refuse("the name is not 1 … 32 letters, digits, dots, dashes and underscores",
                  "choose another name");
  }
  return {};
}

std::string hash_of(const std::string& password) {
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  const bool made = crypto_pwhash_str(hash.data(), password.c_str(), password.size(),
                                      crypto_pwhash_OPSLIMIT_INTERACTIVE,
                                      crypto_pwhash_MEMLIMIT_INTERACTIVE) == 0;
  return made ? hash.data() : "";
}

using Entries = std::vector<Accounts::Entry>;

/// Every entry of a list; false where one is not as it should be.
bool read_list(const Json& root, const char* key, const char* hash, Entries& out) {
  const Json list = root.value(key, Json::array());
  if (!list.is_array()) {
    return false;
  }
  for (const Json& at : list) {
    if (!at.is_object()) {
      return false;
    }
    const auto text = [&at](const char* of) {
      const auto found = at.find(of);
      return found != at.end() && found->is_string() ? found->get<std::string>() : "";
    };
    const auto role = role_of(text("role"));
    if (!is_name(text("name")) || !role || text(hash).empty()) {
      return false;
    }
    out.push_back({.name = text("name"), .role = *role, .hash = text(hash)});
  }
  return true;
}

bool remove(Entries& from, std::string_view name) {
  return std::erase_if(from, [name](const auto& entry) { return entry.name == name; }) > 0;
}

Json json_of(const Entries& entries, const char* hash) {
  Json out = Json::array();
  for (const auto& entry : entries) {
    out.push_back({{"name", entry.name}, {"role", word(entry.role)}, {hash, entry.hash}});
  }
  return out;
}

/// The file's text, if no other user can read it.
Result<std::string> private_text(const std::string& file) {
  struct stat status{};
  if (::stat(file.c_str(), &status) != 0) {
    return refuse(file, std::strerror(errno), kAdd);
  }
  if (!S_ISREG(status.st_mode)) {
    return refuse(file, "is not a file", kAdd);
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return refuse(file, "other users may open it", "chmod 600 it");
  }
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) {
    return refuse(file, "cannot be read", "see its owner and permissions");
  }
  return text;
}

}  // namespace

Result<Accounts> Accounts::read(const std::string& file) {
  auto text = private_text(file);
  if (!text) {
    return std::unexpected(std::move(text.error()));
  }
  const auto root = kernel::file::json_object(*text);
  Accounts out;
  if (!root || root->value("version", Json()) != Json(kVersion) ||
      !read_list(*root, "users", "argon2id", out.users_) ||
      !read_list(*root, "tokens", "sha256", out.tokens_)) {
    const auto fault = kernel::file::json_fault(*text);
    return refuse(file, fault ? fault->line : 0,
                  "is not a file of accounts" + (fault ? ": " + fault->what : ""), kAdd);
  }
  return out;
}

Result<void> Accounts::write(const std::string& file) const {
  Json root;
  root["version"] = kVersion;
  root["users"] = json_of(users_, "argon2id");
  root["tokens"] = json_of(tokens_, "sha256");
  const std::string text = root.dump(2) + "\n";
  std::string beside = file + ".XXXXXX";
  const int descriptor = ::mkostemp(beside.data(), O_CLOEXEC);  // for its owner alone
  errno = descriptor >= 0 ? ENOSPC : errno;                     // a write that ends early sets none
  const bool written =
      descriptor >= 0 &&
      ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(descriptor) == 0;
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  if (!written || ::rename(beside.c_str(), file.c_str()) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor >= 0) {
      ::unlink(beside.c_str());
    }
    return refuse(file, "cannot be written: " + why, "name a file that you may write");
  }
  return {};
}

Result<void> Accounts::set_user(const std::string& name, const std::string& password, Role role) {
  if (auto named = check_name(name); !named) {
    return named;
  }
  if (password.size() < kShortestPassword || password.size() > kLongestPassword) {
    return refuse(fmt::format("the password has {} bytes; allowed: {} … {}", password.size(),
                              kShortestPassword, kLongestPassword),
                  "choose another one");
  }
  static_cast<void>(digest({}));  // libsodium is ready
  Entry user{.name = name, .role = role, .hash = hash_of(password)};
  if (user.hash.empty()) {
    return refuse("the password cannot be hashed: that takes 64 MiB of memory", "free some memory");
  }
  remove_user(name);
  users_.push_back(std::move(user));
  return {};
}

Result<std::string> Accounts::set_token(const std::string& name, Role role) {
  if (auto named = check_name(name); !named) {
    return std::unexpected(std::move(named.error()));
  }
  std::string token = new_secret();
  remove_token(name);
  tokens_.push_back({.name = name, .role = role, .hash = digest(token)});
  return token;
}

bool Accounts::remove_user(std::string_view name) {
  return remove(users_, name);
}

bool Accounts::remove_token(std::string_view name) {
  return remove(tokens_, name);
}

std::optional<Caller> Accounts::check(std::string_view name, const std::string& password) const {
  if (password.size() > kLongestPassword) {
    return std::nullopt;
  }
  static_cast<void>(digest({}));  // libsodium is ready
  const Entry* const user = find_user(name);
  if (user == nullptr) {
    static_cast<void>(hash_of(password));
    return std::nullopt;
  }
  if (crypto_pwhash_str_verify(user->hash.c_str(), password.c_str(), password.size()) != 0) {
    return std::nullopt;
  }
  return Caller{.name = user->name, .role = user->role};
}

const Accounts::Entry* Accounts::find_user(std::string_view name) const noexcept {
  const auto at = std::ranges::find(users_, name, &Entry::name);
  return at == users_.end() ? nullptr : &*at;
}

std::optional<Caller> Accounts::of_token(std::string_view token) const {
  const std::string seen = digest(token);
  std::optional<Caller> out;
  for (const Entry& known : tokens_) {
    if (same_secret(known.hash, seen)) {
      out = Caller{.name = known.name, .role = known.role};
    }
  }
  return out;
}

}  // namespace steadyrest::web
