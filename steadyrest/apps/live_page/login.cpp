// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/login.hpp>
#include <steadyrest/kernel/file/json_object.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/web/gate.hpp>
#include <steadyrest/web/secret.hpp>

namespace steadyrest::apps::live_page {
namespace {

constexpr std::string_view kCookie = "steadyrest_session";
constexpr std::string_view kBearer = "bearer ";
constexpr web::RateLimit::Config kFailures{.per_s = 5.0 / 60.0, .burst = 5.0, .most_keys = 4096};
constexpr std::size_t kLongestLogIn = 8192;  ///< bytes: the longest password, escaped, and a name

/// Browsers share cookies among the ports of a host, where other pages may be.
std::string cookie_name(const web::Request& request) {
  const std::size_t colon = web::without_port(request.host).size();
  const std::string port = request.host.substr(std::min(colon + 1, request.host.size()));
  const bool known = !port.empty() && port.find_first_not_of("0123456789") == std::string::npos;
  return known ? fmt::format("{}_{}", kCookie, port) : std::string(kCookie);
}

std::string session_id(const web::Request& request) {
  return web::cookie(request, cookie_name(request));
}

std::string cookie_head(const web::Request& request, const std::string& id) {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}{}", cookie_name(request), id,
                     request.secure ? "; Secure" : "", id.empty() ? "; Max-Age=0" : "");
}

std::string text(const Json& from, const char* key) {
  const auto at = from.find(key);
  return at != from.end() && at->is_string() ? at->get<std::string>() : "";
}

}  // namespace

Login::Login(const Config& config)
    : config_(config),
      key_(config.accounts_file.empty() ? web::new_secret() : ""),
      failures_from_(kFailures),
      failures_of_(kFailures) {}

std::optional<web::Accounts> Login::accounts() const {
  auto read = web::Accounts::read(config_.accounts_file);
  const std::string fault = read ? "" : kernel::outcome::text(read.error());
  const std::scoped_lock lock(mutex_);
  if (read) {
    last_good_ = std::move(*read);
  }
  if (fault != std::exchange(fault_, fault) && !fault.empty()) {
    std::fputs(("steadyrest: the accounts stay as they were: " + fault + "\n").c_str(), stderr);
  }
  return last_good_;
}

std::optional<web::Caller> Login::of_token(const web::Request& request) const {
  const std::string& authorization = request.authorization;
  if (web::lower(authorization.substr(0, kBearer.size())) != kBearer) {
    return std::nullopt;
  }
  const auto accounts = this->accounts();
  return accounts ? accounts->of_token(authorization.substr(kBearer.size())) : std::nullopt;
}

std::optional<Login::Who> Login::who(const web::Request& request, double now_s) {
  if (!request.authorization.empty()) {
    const auto caller = of_token(request);
    return caller ? std::optional(Who{.caller = *caller, .csrf = std::nullopt}) : std::nullopt;
  }
  const std::string id = session_id(request);
  const auto session = sessions_.find(id, now_s);
  if (!session) {
    return std::nullopt;
  }
  const auto caller = as_now(*session);
  if (!caller) {
    sessions_.end(id);
    return std::nullopt;
  }
  return Who{.caller = *caller, .csrf = session->csrf};
}

std::optional<web::Caller> Login::as_now(const web::Sessions::Session& session) const {
  if (!key_.empty()) {
    return session.caller;
  }
  const auto accounts = this->accounts();
  const auto* const user = accounts ? accounts->find_user(session.caller.name) : nullptr;
  return user != nullptr && user->hash == session.mark
             ? std::optional(web::Caller{.name = user->name, .role = user->role})
             : std::nullopt;
}

bool Login::goes_on(const web::Request& request, double now_s) const {
  if (!request.authorization.empty()) {
    return of_token(request).has_value();
  }
  const auto session = sessions_.look_at(session_id(request), now_s);
  return session && as_now(*session);
}

web::Response Login::show(const web::Request& request, double now_s) {
  const auto seen = who(request, now_s);
  Json session;
  if (seen) {
    session = {{"name", seen->caller.name}, {"role", word(seen->caller.role)}};
    session["csrf"] = seen->csrf ? Json(*seen->csrf) : Json(nullptr);
  }
  return answer({{"session", session}, {"accounts", key_.empty()}, {"key_login", !key_.empty()}});
}

// Read each time: who was removed cannot log in again.
std::optional<Login::Known> Login::check(const Shown& shown) const {
  if (!key_.empty()) {
    return web::same_secret(shown.key, key_)
               ? std::optional(Known{{.name = "local", .role = web::Role::engineer}, ""})
               : std::nullopt;
  }
  const auto accounts = this->accounts();
  const auto caller = accounts ? accounts->check(shown.name, shown.password) : std::nullopt;
  return caller ? std::optional(Known{*caller, accounts->find_user(shown.name)->hash})
                : std::nullopt;
}

std::optional<web::Response> Login::too_many(const web::Request& request, const std::string& name,
                                             double now_s) const {
  if (failures_from_.has_room(request.address, now_s) && failures_of_.has_room(name, now_s)) {
    return std::nullopt;
  }
  web::Response out = web::error(429, "too_many_failures", "too many failed log-ins",
                                 "wait a minute, then try again");
  const double wait_s =
      std::max(failures_from_.wait_s(request.address, now_s), failures_of_.wait_s(name, now_s));
  out.head.emplace_back("Retry-After", fmt::format("{}", std::ceil(wait_s)));
  return out;
}

web::Response Login::begin(const web::Request& request, double now_s) {
  if (request.body.size() > kLongestLogIn) {
    return web::error(413, "too_large", "no log-in is that long",
                      fmt::format("send at most {} bytes", kLongestLogIn));
  }
  const auto asked = kernel::file::json_object(request.body);
  if (!asked) {
    return web::error(400, "bad_request", "the body is not a JSON object",
                      R"(send {"name":…,"password":…} or {"key":…})");
  }
  Shown shown{.name = text(*asked, "name"),
              .password = text(*asked, "password"),
              .key = text(*asked, "key")};
  shown.name.resize(
      std::min(shown.name.size(), web::Accounts::kLongestName + 1));  // not an account
  if (auto refused = too_many(request, shown.name, now_s)) {
    return *refused;
  }
  if (!key_.empty()) {
    return decide(request, shown, now_s);
  }
  web::Response out;
  out.takes = web::Takes::hashing;
  out.later = [this, request, shown = std::move(shown), now_s](const std::stop_token& stop) {
    return stop.stop_requested() ? web::Response{} : decide(request, shown, now_s);
  };
  return out;
}

// One at a time: whoever waits while others fail is counted after them.
web::Response Login::decide(const web::Request& request, const Shown& shown, double now_s) {
  if (auto refused = too_many(request, shown.name, now_s)) {
    return *refused;
  }
  const auto known = check(shown);
  if (!known) {
    static_cast<void>(failures_from_.take(request.address, now_s));
    static_cast<void>(failures_of_.take(shown.name, now_s));
    return web::error(401, "wrong_password", "this is not a name with its password, nor the key",
                      "try again, or ask who keeps the accounts");
  }
  const auto& caller = known->caller;
  const auto begun = sessions_.begin(caller, now_s, known->mark);
  web::Response out =
      answer({{"session",
               {{"name", caller.name}, {"role", word(caller.role)}, {"csrf", begun.session.csrf}}},
              {"accounts", key_.empty()},
              {"key_login", !key_.empty()}});
  out.head.emplace_back("Set-Cookie", cookie_head(request, begun.id));
  return out;
}

web::Response Login::end(const web::Request& request) {
  sessions_.end(session_id(request));
  web::Response out;
  out.status = 204;
  out.head.emplace_back("Set-Cookie", cookie_head(request, ""));
  return out;
}

}  // namespace steadyrest::apps::live_page
