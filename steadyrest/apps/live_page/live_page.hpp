// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::live_page {

/// The page of a running layer: its server, and a thread that sends what the cycle leaves, 30 times
/// a second while somebody watches.
class LivePage {
 public:
  struct Config {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;     ///< 0: any free one
    std::string accounts_file;  ///< empty: the key alone
    std::string certificate;    ///< file, PEM; empty: no TLS
    std::string key;
    std::string outer_origin;          ///< `https://mill.example[:8443]`, behind a proxy
    std::vector<std::string> proxies;  ///< addresses of the proxies; empty: on this computer alone
    std::string name;                  ///< of the address; empty: it was given as a number
  };

  /// Refused: an address that others reach without accounts, without TLS or a proxy, or behind a
  /// proxy that is not named; an outer origin that is none; accounts, certificate or key that
  /// cannot be used.
  [[nodiscard]] static kernel::outcome::Result<void> check(const Config& config);
  /// `desk` outlives the page. Refused: as check(), and an address that cannot be had.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<LivePage>> open(const Config& config,
                                                                               const Desk& desk);
  LivePage() = default;
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;
  virtual ~LivePage() = default;

  /// Where it is: `http://127.0.0.1:8080/`.
  [[nodiscard]] virtual std::string address() const = 0;
  /// The same with the key, where there are no accounts: only for whoever started the process.
  [[nodiscard]] virtual std::string address_with_key() const = 0;
};

}  // namespace steadyrest::apps::live_page
