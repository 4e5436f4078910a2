// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <arpa/inet.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <steadyrest/web/gate.hpp>
#include <steadyrest/web/listen.hpp>

namespace steadyrest::web {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; font-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

/// `192.168.1.7`, `[fe80::1]`.
bool is_number(const std::string& host) {
  in6_addr address{};
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  return bracketed ? ::inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), &address) == 1
                   : ::inet_pton(AF_INET, host.c_str(), &address) == 1;
}

bool is_proxy(const Gate::Config& config, const std::string& from) {
  return config.proxies.empty() || std::ranges::find(config.proxies, from) != config.proxies.end();
}

}  // namespace

Response error(unsigned status, const std::string& code, const std::string& what,
               const std::string& to_do) {
  const Json body = {{"version", 1}, {"error", {{"code", code}, {"what", what}, {"to_do", to_do}}}};
  Response out;
  out.status = status;
  out.body = body.dump(-1, ' ', false, Json::error_handler_t::replace);
  return out;
}

bool Gate::knows_host(const std::string& host) const {
  if (config_.any_number && is_number(without_port(host))) {
    return true;
  }
  return std::ranges::find(config_.hosts, without_port(lower(host))) != config_.hosts.end();
}

bool Gate::is_own(const Request& request) const {
  const std::string own = (request.secure ? "https://" : "http://") + lower(request.host);
  const std::string origin = lower(request.origin);
  return origin.empty() || origin == own ||
         (!config_.outer_origin.empty() && origin == config_.outer_origin);
}

bool Gate::is_urgent(const Request& request) const {
  return !config_.urgent_path.empty() && request.path == config_.urgent_path;
}

std::optional<Response> Gate::refuse(const Request& request, bool writes, double now_s) {
  RateLimit& rate = is_urgent(request) ? urgent_ : rate_;
  if (!rate.take(request.address, now_s)) {
    Response out = error(429, "too_many_requests", "too many requests", "wait, then ask again");
    out.head.emplace_back("Retry-After",
                          fmt::format("{}", std::ceil(rate.wait_s(request.address, now_s))));
    return out;
  }
  if (!knows_host(request.host)) {
    return error(421, "unknown_host", "this server has another name",
                 "use the address that `steadyrest run` has printed");
  }
  if (writes && !is_own(request)) {
    return error(403, "origin", "the request comes from a page of another site",
                 "use the page of this server");
  }
  return std::nullopt;
}

std::optional<Response> refuse_framing(const Framing& framing) {
  if (framing.codings.empty() &&
      framing.length.find_first_not_of("0123456789") == std::string::npos) {
    return std::nullopt;
  }
  if (!framing.length.empty() || framing.codings.size() > 1 || !framing.knows_chunks) {
    return error(400, "bad_request", "it is not clear where the body ends",
                 "send one of Content-Length and Transfer-Encoding: chunked, once");
  }
  if (lower(framing.codings.front()) != "chunked") {
    return error(501, "unknown_coding", "the transfer coding is not known; allowed: chunked",
                 "send the body with its Content-Length");
  }
  return std::nullopt;
}

std::string without_port(const std::string& host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.rfind(':');
  const bool has_port =
      colon != std::string::npos && (bracket == std::string::npos || colon > bracket);
  return has_port ? host.substr(0, colon) : host;
}

std::string client_address(const Gate::Config& config, const std::string& from,
                           const std::string& forwarded) {
  const std::size_t before = forwarded.find_last_of(", ");
  const std::string last = before == std::string::npos ? forwarded : forwarded.substr(before + 1);
  const bool known = is_number(last) || is_number("[" + last + "]");
  return !config.outer_origin.empty() && is_proxy(config, from) && known ? last : from;
}

bool may_connect(const Gate::Config& config, const std::string& from) {
  return config.outer_origin.empty() || is_proxy(config, from) || is_loopback(from);
}

void add_security_heads(Response& response, bool secure) {
  response.head.emplace_back("Content-Security-Policy", kPolicy);
  response.head.emplace_back("X-Content-Type-Options", "nosniff");
  response.head.emplace_back("Referrer-Policy", "no-referrer");
  response.head.emplace_back("Cross-Origin-Opener-Policy", "same-origin");
  response.head.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
  if (secure) {
    response.head.emplace_back("Strict-Transport-Security", "max-age=31536000");
  }
  const auto is_cache = [](const auto& head) { return head.first == "Cache-Control"; };
  if (std::ranges::none_of(response.head, is_cache)) {
    response.head.emplace_back("Cache-Control", "no-store");
  }
}

}  // namespace steadyrest::web
