// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/live_page/api.hpp>
#include <steadyrest/apps/live_page/live_page.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/web/accounts.hpp>
#include <steadyrest/web/gate.hpp>
#include <steadyrest/web/listen.hpp>
#include <steadyrest/web/message.hpp>
#include <steadyrest/web/server.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr auto kFrame = std::chrono::microseconds(33'333);
constexpr int kFramesPerSpectrum = 6;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string in_address(const std::string& address) {
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

/// Of labels, each with something in it.
bool is_name(const std::string& host) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789-_.";
  return !host.empty() && host.size() <= 253 && !host.starts_with('.') && !host.ends_with('.') &&
         host.find("..") == std::string::npos &&
         host.find_first_not_of(kAllowed) == std::string::npos;
}

bool is_host(const std::string& host) {
  const bool bracketed = host.size() > 2 && host.starts_with('[') && host.ends_with(']');
  return bracketed ? web::address_of(host.substr(1, host.size() - 2)).has_value() : is_name(host);
}

/// None, or `:8443`.
bool is_port(const std::string& text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  if (text.empty()) {
    return true;
  }
  const auto read = std::from_chars(text.data() + 1, end, port);
  return read.ec == std::errc() && read.ptr == end && port > 0;
}

/// `mill.example` of `https://mill.example:8443`; none: that is no origin over TLS.
std::optional<std::string> host_of(const std::string& origin) {
  constexpr std::string_view kScheme = "https://";
  const std::string small = web::lower(origin);
  const std::string rest = small.substr(std::min(small.size(), kScheme.size()));
  const std::string host = web::without_port(rest);
  return small.starts_with(kScheme) && is_host(host) && is_port(rest.substr(host.size()))
             ? std::optional(host)
             : std::nullopt;
}

web::Gate::Config gate_of(const LivePage::Config& config) {
  web::Gate::Config gate;
  gate.hosts = {in_address(config.address), "localhost", "127.0.0.1", "[::1]"};
  gate.any_number = config.address == "0.0.0.0" || config.address == "::";
  gate.outer_origin = web::lower(config.outer_origin);
  for (const std::string& proxy : config.proxies) {
    gate.proxies.push_back(web::address_of(proxy).value_or(""));
  }
  if (!config.name.empty()) {
    gate.hosts.push_back(config.name);
  }
  gate.urgent_path = Api::kHandBack;
  if (auto host = host_of(config.outer_origin)) {
    gate.hosts.push_back(std::move(*host));
  }
  return gate;
}

class Page final : public LivePage {
 public:
  Page(Config config, const Desk& desk)
      : config_(std::move(config)),
        desk_(desk),
        api_(desk, {.accounts_file = config_.accounts_file}, now_s),
        frames_(desk) {}
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  ~Page() override {
    ends_.store(true);
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  Result<void> start() {
    web::Server::Config server;
    server.address = config_.address;
    server.port = config_.port;
    server.certificate = config_.certificate;
    server.key = config_.key;
    server.gate = gate_of(config_);
    server.stream_path = Api::kStream;
    auto opened = web::Server::open(
        std::move(server), {.answer = [this](const auto& request) { return api_.answer(request); },
                            .admit = [this](const auto& request) { return api_.admit(request); },
                            .now_s = now_s});
    if (!opened) {
      return std::unexpected(std::move(opened.error()));
    }
    server_ = std::move(*opened);
    thread_ = std::thread([this] { send(); });
    return {};
  }

  [[nodiscard]] std::string address() const override {
    return fmt::format("{}://{}:{}/", config_.certificate.empty() ? "http" : "https",
                       config_.name.empty() ? in_address(config_.address) : config_.name,
                       server_->port());
  }
  [[nodiscard]] std::string address_with_key() const override {
    return api_.key().empty() ? address() : address() + "#key=" + api_.key();
  }

 private:
  /// What may change in a hello.
  struct Told {
    std::uint64_t reload = 0;
    std::optional<chatter::online::Modulation> modulation;
    friend bool operator==(const Told&, const Told&) = default;
  };

  /// Sends a new hello when another machine file or another modulation is in force.
  void tell_changes() {
    Told now = told_;
    if (desk_.asked.reloader != nullptr) {
      const auto reload = desk_.asked.reloader->status();
      now.reload = reload.taken ? reload.number : told_.reload;
    }
    if (!desk_.chatter || !desk_.chatter->acts) {  // else a hello has none
      now.modulation = desk_.asked.loop.status().modulation;
    }
    if (now != told_) {
      told_ = now;
      server_->announce(std::make_shared<const std::string>(frames_.hello()));
    }
  }

  void send_spectrum() {
    if (++since_spectrum_ < kFramesPerSpectrum) {
      return;
    }
    since_spectrum_ = 0;
    if (std::string text = frames_.spectrum(); !text.empty()) {
      server_->offer(std::make_shared<const std::string>(std::move(text)));
    }
  }

  void send() {
    auto next = std::chrono::steady_clock::now();
    while (!ends_.load()) {
      const bool watched = server_->streams() > 0;
      desk_.tap.watch(watched);
      if (watched) {
        server_->publish(std::make_shared<const std::string>(frames_.frame()));
        send_spectrum();
      }
      api_.look();
      tell_changes();
      next = std::max(next + kFrame, std::chrono::steady_clock::now());
      std::this_thread::sleep_until(next);
    }
    desk_.tap.watch(false);
  }

  Config config_;
  const Desk& desk_;
  Api api_;
  StreamText frames_;
  std::unique_ptr<web::Server> server_;
  std::atomic<bool> ends_{false};
  Told told_;
  int since_spectrum_ = 0;
  std::thread thread_;
};

Result<void> check_proxy(const LivePage::Config& config) {
  if (!config.outer_origin.empty() && !host_of(config.outer_origin)) {
    return refuse(fmt::format("--behind-proxy {} is no origin; allowed: https://NAME, "
                              "https://NAME:PORT",
                              config.outer_origin),
                  "give it as the browser's address line begins, without a path");
  }
  for (const std::string& proxy : config.proxies) {
    if (!web::address_of(proxy)) {
      return refuse(fmt::format("--trusted-proxy {} is not an address", proxy),
                    "give the address by which the proxy connects, as a number");
    }
  }
  if (!config.proxies.empty() && config.outer_origin.empty()) {
    return refuse("--trusted-proxy is for a page behind a proxy", "give --behind-proxy, too");
  }
  if (!config.outer_origin.empty() && config.proxies.empty() && !web::is_loopback(config.address)) {
    return refuse(
        fmt::format("--behind-proxy: others reach {} without the proxy", config.address),
        "name the proxy with --trusted-proxy ADDRESS: nobody else may then connect; where it runs "
        "on this computer, give --listen PORT alone");
  }
  return {};
}

}  // namespace

Result<void> LivePage::check(const Config& config) {
  if (auto fits = check_proxy(config); !fits) {
    return fits;
  }
  const bool reached = !web::is_loopback(config.address) || !config.outer_origin.empty();
  if (reached && config.accounts_file.empty()) {
    return refuse("the page would be open to others without accounts",
                  "make accounts with `steadyrest page add-user` and give --users FILE");
  }
  if (!web::is_loopback(config.address) && config.certificate.empty() &&
      config.outer_origin.empty()) {
    return refuse("passwords would go over the network unencrypted",
                  "give --tls-certificate and --tls-key, or --behind-proxy ORIGIN where a proxy "
                  "encrypts");
  }
  if (config.certificate.empty() != config.key.empty()) {
    return refuse("a certificate needs its key", "give both --tls-certificate and --tls-key");
  }
  if (!config.accounts_file.empty()) {
    const auto accounts = web::Accounts::read(config.accounts_file);
    if (!accounts) {
      return std::unexpected(accounts.error());
    }
  }
  return {};
}

Result<std::unique_ptr<LivePage>> LivePage::open(const Config& config, const Desk& desk) {
  if (auto checked = check(config); !checked) {
    return std::unexpected(std::move(checked.error()));
  }
  auto page = std::make_unique<Page>(config, desk);
  if (auto started = page->start(); !started) {
    return std::unexpected(std::move(started.error()));
  }
  return page;
}

}  // namespace steadyrest::apps::live_page
