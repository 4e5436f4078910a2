// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/live_page/api.hpp>
#include <steadyrest/apps/live_page/assets.hpp>
#include <steadyrest/apps/live_page/encoders.hpp>
#include <steadyrest/apps/live_page/machine_desk.hpp>
#include <steadyrest/apps/live_page/records.hpp>
#include <steadyrest/apps/live_page/wish_desk.hpp>
#include <steadyrest/kernel/file/json_object.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/live/status_json.hpp>
#include <steadyrest/live/wish/wish_json.hpp>
#include <steadyrest/web/gate.hpp>
#include <steadyrest/web/secret.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Mode;
using web::Role;

constexpr std::string_view kApi = "/api/";
constexpr std::string_view kRecords = "/api/v1/records/";
constexpr std::string_view kReplay = "/replay";
constexpr std::string_view kExport = "/export";

constexpr std::array<Route, 19> kRoutes = {{
    {"GET", "/api/v1/session", true},
    {"POST", "/api/v1/session", true},
    {"DELETE", "/api/v1/session"},
    {"GET", "/api/v1/status"},
    {"POST", "/api/v1/mode", false, Role::operating},
    {"POST", Api::kHandBack},
    {"POST", "/api/v1/modulation", false, Role::operating, true},
    {"GET", "/api/v1/machine"},
    {"POST", "/api/v1/machine/check", false, Role::operating},
    {"POST", "/api/v1/machine/apply", false, Role::engineer, true},
    {"GET", "/api/v1/thermal"},
    {"GET", "/api/v1/motion"},
    {"GET", "/api/v1/chatter/lobes"},
    {"GET", "/api/v1/chatter/plan"},
    {"POST", "/api/v1/thermal/measured", false, Role::operating, true},
    {"GET", "/api/v1/records"},
    {"GET", kRecords},
    {"POST", kRecords, false, Role::engineer},
    {"GET", "/api/v1/openapi.json", true},
}};

bool matches(const Route& route, std::string_view path) {
  return route.path.ends_with('/') ? path.size() > route.path.size() && path.starts_with(route.path)
                                   : path == route.path;
}

/// No route: the address has other methods, or there is nothing.
web::Response wrong_method(std::string_view path) {
  std::string allowed;
  for (const Route& route : kRoutes) {
    if (matches(route, path)) {
      allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
    }
  }
  if (allowed.empty()) {
    return web::error(404, "not_found", "there is nothing at this address",
                      "see /api/v1/openapi.json");
  }
  web::Response out =
      web::error(405, "method_not_allowed", "this address has another method", "use " + allowed);
  out.head.emplace_back("Allow", allowed);
  return out;
}

/// Of a record's address without `/replay`.
web::Response only_read() {
  web::Response out =
      web::error(405, "method_not_allowed", "this address can only be read", "use GET");
  out.head.emplace_back("Allow", "GET");
  return out;
}

web::Response asset(const web::Request& request) {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  const Asset* const found = reads ? find_asset(request.path) : nullptr;
  return found != nullptr ? response_of(*found) : wrong_method(request.path);
}

/// What is made beside the other answers: it has a copy of the request.
web::Response later(std::function<web::Response(std::stop_token)> make) {
  web::Response out;
  out.later = std::move(make);
  return out;
}

web::Response minutes(web::Response of) {
  of.takes = web::Takes::minutes;
  return of;
}

bool is_confirmed(const Json& asked) {
  return asked.value("confirm", Json()) == Json(true);
}

web::Response unconfirmed(const char* what) {
  return web::error(422, "refused", what, "send \"confirm\": true");
}

std::string author(const web::Caller& caller) {
  return fmt::format("{} ({})", caller.name, word(caller.role));
}

}  // namespace

Api::Api(const Desk& desk, const Login::Config& login, std::function<double()> now_s)
    : desk_(desk),
      login_(login),
      stream_(desk),
      heat_(desk),
      study_(desk),
      now_s_(std::move(now_s)) {}

std::span<const Route> Api::routes() noexcept {
  return kRoutes;
}

// In this order: does it exist, who asks, may they, do they mean it.
web::Response Api::answer(const web::Request& request) {
  if (!request.path.starts_with(kApi)) {
    return asset(request);
  }
  const std::string_view method =
      request.method == "HEAD" ? "GET" : std::string_view(request.method);
  const auto* const route = std::ranges::find_if(
      kRoutes, [&](const Route& at) { return at.method == method && matches(at, request.path); });
  if (route == kRoutes.end()) {
    return wrong_method(request.path);
  }
  const auto who = login_.who(request, now_s_());
  if (!who && !route->open) {
    return web::error(401, "not_logged_in", "nobody is logged in", "log in first");
  }
  if (who && who->caller.role < route->role) {
    return web::error(403, "role_too_low",
                      fmt::format("this takes the role {}; {} has {}", word(route->role),
                                  who->caller.name, word(who->caller.role)),
                      "ask somebody who has it");
  }
  const bool writes = method != "GET";
  if (writes && who && who->csrf && !web::same_secret(*who->csrf, request.csrf)) {
    return web::error(403, "csrf", "the head X-Steadyrest-CSRF is missing or wrong",
                      "send `csrf` of /api/v1/session");
  }
  if (method == "POST" && web::media_type(request.content_type) != "application/json") {
    return web::error(415, "unsupported_type", "the body is not said to be JSON",
                      "send Content-Type: application/json");
  }
  return run(*route, {.request = request,
                      .caller = who ? who->caller : web::Caller{},
                      .rest = request.path.substr(route->path.size())});
}

web::Response Api::run(const Route& route, const Call& call) {
  if (route.path == "/api/v1/session") {
    return route.method == "GET"    ? login_.show(call.request, now_s_())
           : route.method == "POST" ? login_.begin(call.request, now_s_())
                                    : login_.end(call.request);
  }
  if (route.method == "POST") {
    return write(route, call);
  }
  if (route.path == "/api/v1/status") {
    web::Response out;
    out.body = steadyrest::live::answer(desk_.asked, R"({"version":1,"ask":"status"})");
    return out;
  }
  if (route.path == "/api/v1/machine") {
    return show_machine(desk_);
  }
  if (route.path == "/api/v1/thermal") {
    return heat_.show();
  }
  if (route.path == "/api/v1/motion") {
    return show_encoders(desk_);
  }
  if (route.path.starts_with("/api/v1/chatter/")) {
    return route.path.ends_with("plan") ? study_.plan() : study_.lobes();
  }
  if (route.path == "/api/v1/records") {
    return later([this, query = call.request.query](const std::stop_token& stop) {
      return list_records(desk_, query, stop);
    });
  }
  if (route.path == kRecords) {
    web::Response shown =
        later([this, query = call.request.query, rest = call.rest](const std::stop_token& stop) {
          return show_record(desk_, overviews_, {.query = query, .rest = rest, .stop = stop});
        });
    return call.rest.ends_with(kExport) ? minutes(std::move(shown)) : shown;
  }
  return response_of(openapi());
}

web::Response Api::write(const Route& route, const Call& call) {
  const auto body = kernel::file::json_object(call.request.body);
  if (!body) {
    return web::error(400, "bad_request", "the body is not a JSON object", "send {…}");
  }
  const Json& asked = *body;
  if (route.acts && acts() && !is_confirmed(asked)) {
    return unconfirmed("in mode act this moves the machine at once");
  }
  if (route.path == "/api/v1/mode") {
    return set_mode(call, asked);
  }
  if (route.path == kHandBack) {
    return hand_back(call);
  }
  if (route.path == "/api/v1/modulation") {
    return set_modulation(desk_, asked, author(call.caller));
  }
  if (route.path == "/api/v1/thermal/measured") {
    return enter_measured(desk_, heat_, asked, author(call.caller));
  }
  if (route.path == "/api/v1/machine/check") {
    return later([this, asked](const std::stop_token&) { return check_machine(desk_, asked); });
  }
  if (route.path == "/api/v1/machine/apply") {
    return later([this, asked, by = author(call.caller)](const std::stop_token& stop) {
      const std::scoped_lock lock(applying_);
      return apply_machine(desk_, asked, by, stop);
    });
  }
  if (call.rest.ends_with(kReplay)) {
    return minutes(
        later([this, name = call.rest.substr(0, call.rest.size() - kReplay.size())](
                  const std::stop_token& stop) { return replay_record(desk_, name, stop); }));
  }
  return only_read();
}

bool Api::acts() const {
  auto& loop = desk_.asked.loop;
  return loop.mode_wanted() == Mode::act || loop.status().mode_in_force == Mode::act;
}

web::Response Api::set_mode(const Call& call, const Json& asked) {
  const Json name = asked.value("mode", Json());
  const auto mode =
      name.is_string() ? steadyrest::live::mode_of(name.get<std::string>()) : std::nullopt;
  if (!mode) {
    return web::error(
        422, "refused",
        fmt::format("`mode` is {}; allowed: observe, advise, act", steadyrest::live::shown(name)),
        "give one of these");
  }
  if (*mode == Mode::act && !is_confirmed(asked)) {
    return unconfirmed("in mode act the layer moves the machine's overrides and axes");
  }
  desk_.asked.loop.note(
      fmt::format("page: {} asked for {}", author(call.caller), steadyrest::live::word(*mode)));
  desk_.asked.loop.ask_mode(*mode);
  return live_page::answer({{"mode_wanted", steadyrest::live::word(*mode)}});
}

web::Response Api::hand_back(const Call& call) {
  desk_.asked.loop.ask_mode(Mode::observe);
  desk_.asked.loop.note(fmt::format("page: {} handed back", author(call.caller)));
  return live_page::answer({{"mode_wanted", steadyrest::live::word(Mode::observe)}});
}

std::variant<web::Server::Admitted, web::Response> Api::admit(const web::Request& request) {
  if (!login_.who(request, now_s_())) {
    return web::error(401, "not_logged_in", "nobody is logged in", "log in first");
  }
  return web::Server::Admitted{.first = stream_.hello(), .goes_on = [this, request] {
                                 return login_.goes_on(request, now_s_());
                               }};
}

}  // namespace steadyrest::apps::live_page
