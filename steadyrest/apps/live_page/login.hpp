// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include <steadyrest/web/accounts.hpp>
#include <steadyrest/web/message.hpp>
#include <steadyrest/web/rate_limit.hpp>
#include <steadyrest/web/sessions.hpp>

namespace steadyrest::apps::live_page {

/// Who is at the other end: by a session's cookie or a script's token.
///
/// Without an accounts file the process makes a key with the role engineer: anyone who can see what
/// `run` prints can use it.
class Login {
 public:
  struct Config {
    std::string accounts_file;  ///< empty: the key alone
  };
  /// Who asks, and the session they do it by; without one, by a token.
  struct Who {
    web::Caller caller;
    std::optional<std::string> csrf;
  };

  explicit Login(const Config& config);

  /// Empty where there are accounts.
  [[nodiscard]] const std::string& key() const noexcept { return key_; }

  [[nodiscard]] std::optional<Who> who(const web::Request& request, double now_s);
  /// Whether whoever began a stream may still watch: logged in, or with a token that is still
  /// there.
  [[nodiscard]] bool goes_on(const web::Request& request, double now_s) const;

  [[nodiscard]] web::Response show(const web::Request& request, double now_s);
  /// A password is checked beside other answers (web::Takes::hashing): that takes long.
  [[nodiscard]] web::Response begin(const web::Request& request, double now_s);
  [[nodiscard]] web::Response end(const web::Request& request);

 private:
  struct Known {
    web::Caller caller;
    std::string mark;  ///< of the account as it is
  };
  /// As the file is; while it cannot be read, as it was when it could. Nothing: it never could.
  [[nodiscard]] std::optional<web::Accounts> accounts() const;
  /// By the token of a script.
  [[nodiscard]] std::optional<web::Caller> of_token(const web::Request& request) const;
  /// Of a session as the accounts are now: whoever was removed or has a new password must log in
  /// again, and a role that has changed counts.
  [[nodiscard]] std::optional<web::Caller> as_now(const web::Sessions::Session& session) const;
  struct Shown {
    std::string name;
    std::string password;
    std::string key;
  };
  [[nodiscard]] std::optional<Known> check(const Shown& shown) const;
  /// Nothing: the address and the name may still try.
  [[nodiscard]] std::optional<web::Response> too_many(const web::Request& request,
                                                      const std::string& name, double now_s) const;
  [[nodiscard]] web::Response decide(const web::Request& request, const Shown& shown, double now_s);

  Config config_;
  mutable std::mutex mutex_;
  mutable std::optional<web::Accounts> last_good_;
  mutable std::string fault_;  ///< of the file, as it was said
  std::string key_;
  web::Sessions sessions_;
  web::RateLimit failures_from_;  ///< an address, with any account
  web::RateLimit failures_of_;    ///< an account, from anywhere
};

}  // namespace steadyrest::apps::live_page
