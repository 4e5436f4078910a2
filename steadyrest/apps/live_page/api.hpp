// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <steadyrest/apps/live_page/chatter_study.hpp>
#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/heat_history.hpp>
#include <steadyrest/apps/live_page/login.hpp>
#include <steadyrest/apps/live_page/past_runs/overview.hpp>
#include <steadyrest/apps/live_page/stream.hpp>
#include <steadyrest/web/server.hpp>

namespace steadyrest::apps::live_page {

/// Where a request goes, and what it takes.
struct Route {
  std::string_view method;
  std::string_view path;  ///< one that ends in `/` is followed by a name
  bool open = false;      ///< without a log-in too
  web::Role role = web::Role::viewer;
  bool acts = false;  ///< changes what the layer does at once: confirmed while it acts
};

/// The page's HTTP interface (docs/page-api.md). Its answers come one after the other; those about
/// records are made beside them (web::Response::later).
class Api {
 public:
  static constexpr std::string_view kStream = "/api/v1/stream";
  static constexpr std::string_view kHandBack = "/api/v1/hand-back";

  Api(const Desk& desk, const Login::Config& login, std::function<double()> now_s);

  [[nodiscard]] web::Response answer(const web::Request& request);
  /// A stream for whoever is logged in.
  [[nodiscard]] std::variant<web::Server::Admitted, web::Response> admit(
      const web::Request& request);
  /// Every now and then, whether somebody watches or not.
  void look() {
    heat_.update(now_s_());
    study_.look();
  }
  [[nodiscard]] const std::string& key() const noexcept { return login_.key(); }

  /// All of them; `/api/v1/openapi.json` describes the same.
  [[nodiscard]] static std::span<const Route> routes() noexcept;

 private:
  /// A request whose caller may make it.
  struct Call {
    const web::Request& request;
    web::Caller caller;
    std::string rest;  ///< after a path that ends in `/`
  };
  [[nodiscard]] web::Response run(const Route& route, const Call& call);
  [[nodiscard]] web::Response write(const Route& route, const Call& call);
  [[nodiscard]] bool acts() const;
  [[nodiscard]] web::Response set_mode(const Call& call, const Json& asked);
  [[nodiscard]] web::Response hand_back(const Call& call);

  std::mutex applying_;  ///< one change of the machine file at a time
  const Desk& desk_;
  Login login_;
  StreamText stream_;
  HeatHistory heat_;
  ChatterStudy study_;
  past_runs::Overviews overviews_;
  std::function<double()> now_s_;
};

}  // namespace steadyrest::apps::live_page
