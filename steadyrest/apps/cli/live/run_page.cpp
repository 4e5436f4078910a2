// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/live/run_page.hpp>
#include <steadyrest/apps/cli/machine/start_checks.hpp>

namespace steadyrest::apps::cli::live {
namespace {

constexpr const char* kLoopback = "127.0.0.1";

struct Place {
  std::string address = kLoopback;
  std::uint16_t port = 0;
};

/// `8080`, `0.0.0.0:8080`, `[::1]:8080`.
std::optional<Place> place_of(const std::string& listen) {
  Place out;
  const std::size_t colon = listen.rfind(':');
  const std::string port = colon == std::string::npos ? listen : listen.substr(colon + 1);
  const char* const end = port.data() + port.size();
  const auto read = std::from_chars(port.data(), end, out.port);
  if (read.ec != std::errc() || read.ptr != end) {
    return std::nullopt;
  }
  if (colon != std::string::npos) {
    out.address = listen.substr(0, colon);
    if (out.address.starts_with('[') && out.address.ends_with(']')) {
      out.address = out.address.substr(1, out.address.size() - 2);
    }
  }
  return out;
}

Result<live_page::LivePage::Config> config_of(const PageOptions& options) {
  const auto place = place_of(options.listen);
  if (!place) {
    return refuse(fmt::format("--listen {} is no port, nor ADDRESS:PORT", options.listen),
                  "give --listen 8080, or --listen 127.0.0.1:8080");
  }
  live_page::LivePage::Config out;
  out.address = place->address;
  out.port = place->port;
  out.accounts_file = options.users;
  out.certificate = options.certificate;
  out.key = options.key;
  out.outer_origin = options.behind_proxy;
  return out;
}

}  // namespace

void add_page_options(Verb& verb, PageOptions& options) {
  verb.add_option("--listen", options.listen,
                  "Serve the page here; without an address to this computer alone; port 0: any "
                  "free one")
      ->type_name("[ADDRESS:]PORT");
  verb.add_option("--users", options.users,
                  "Who may log in to the page (steadyrest page add-user); without it a key that is "
                  "printed at the start")
      ->type_name("FILE");
  verb.add_option("--tls-certificate", options.certificate, "Certificate of the page (PEM)")
      ->type_name("FILE");
  verb.add_option("--tls-key", options.key, "Its key (PEM)")->type_name("FILE");
  verb.add_option("--behind-proxy", options.behind_proxy,
                  "The page's origin as browsers see it, where a proxy encrypts for it")
      ->type_name("https://NAME");
  verb.add_option("--past-runs", options.records,
                  "Folder of the records that the page shows; default: that of --record")
      ->type_name("FOLDER");
}

Result<void> check_page(const PageOptions& options) {
  if (options.listen.empty()) {
    return {};
  }
  const auto config = config_of(options);
  return config ? live_page::LivePage::check(*config)
                : Result<void>(std::unexpected(config.error()));
}

Result<void> RunPage::open(const Of& of) {
  if (!wanted_) {
    return {};
  }
  const auto config = config_of(options_);
  if (!config) {
    return std::unexpected(config.error());
  }
  desk_ = std::make_unique<live_page::Desk>(live_page::Desk{
      .asked = of.asked,
      .tap = tap_,
      .machine = of.machine,
      .machine_file = of.machine_file,
      .records = options_.records.empty() ? of.record_folder : options_.records,
      .writing = [record =
                      of.record] { return record != nullptr ? record->writing() : std::string(); },
      .findings = start_findings,
      .cycle_s = of.cycle_s,
      .chatter = of.chatter});
  auto page = live_page::LivePage::open(*config, *desk_);
  if (!page) {
    return std::unexpected(std::move(page.error()));
  }
  page_ = std::move(*page);
  std::fputs(("Page: " + page_->address_with_key() + "\n").c_str(), stderr);
  return {};
}

}  // namespace steadyrest::apps::cli::live
