// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/web/role.hpp>

namespace steadyrest::web {

/// Who may log in, and the tokens of scripts: a JSON file that its owner alone can read.
///
/// Of a password it has the Argon2id hash with libsodium's limits for interactive use (64 MiB), of
/// a token the SHA-256: a token is 256 random bits, so that nothing can be guessed from it.
class Accounts {
 public:
  struct Entry {
    std::string name;
    Role role = Role::viewer;
    std::string hash;  ///< of the password or the token
  };

  static constexpr std::size_t kLongestName = 32;
  static constexpr std::size_t kShortestPassword = 8;
  static constexpr std::size_t kLongestPassword = 1024;

  /// Refused: a file that is missing, faulty, or open to other users.
  [[nodiscard]] static kernel::outcome::Result<Accounts> read(const std::string& file);
  /// Replaces the file as a whole, for its owner alone.
  [[nodiscard]] kernel::outcome::Result<void> write(const std::string& file) const;

  /// A user of that name is replaced. Refused: a name that is not 1 … 32 letters, digits, dots,
  /// dashes and underscores; a password that is not 8 … 1024 bytes long.
  [[nodiscard]] kernel::outcome::Result<void> set_user(const std::string& name,
                                                       const std::string& password, Role role);
  /// Gives the token: it is in no file and cannot be shown again.
  [[nodiscard]] kernel::outcome::Result<std::string> set_token(const std::string& name, Role role);
  /// False: there is none of this name.
  bool remove_user(std::string_view name);
  bool remove_token(std::string_view name);

  /// Takes as long for a name that does not exist.
  [[nodiscard]] std::optional<Caller> check(std::string_view name,
                                            const std::string& password) const;
  /// Null: there is none of this name.
  [[nodiscard]] const Entry* find_user(std::string_view name) const noexcept;
  [[nodiscard]] std::optional<Caller> of_token(std::string_view token) const;

  [[nodiscard]] const std::vector<Entry>& users() const noexcept { return users_; }
  [[nodiscard]] const std::vector<Entry>& tokens() const noexcept { return tokens_; }

 private:
  std::vector<Entry> users_;
  std::vector<Entry> tokens_;
};

}  // namespace steadyrest::web
