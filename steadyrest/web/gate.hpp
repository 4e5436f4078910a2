// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/web/message.hpp>
#include <steadyrest/web/rate_limit.hpp>

namespace steadyrest::web {

/// An error as all of them are: `{"version":1,"error":{"code":…,"what":…,"to_do":…}}`.
[[nodiscard]] Response error(unsigned status, const std::string& code, const std::string& what,
                             const std::string& to_do);

/// What is refused before anybody looks at who asks: a name that is not this server's (against DNS
/// rebinding), a page of another site, and too many requests.
class Gate {
 public:
  struct Config {
    // Designated initialisers may leave these out.
    // NOLINTBEGIN(readability-redundant-member-init)
    std::vector<std::string> hosts = {};  ///< names of this server, without port, in lower case
    /// Also the addresses of this computer as numbers: no name that somebody else has led here is
    /// one of these.
    bool any_number = false;
    /// Counted apart from all others, so that those cannot use up their share.
    std::string urgent_path = {};
    /// As the browser sees it through a proxy, in lower case; empty: no proxy.
    std::string outer_origin = {};
    /// The addresses of the proxies; empty: any that can connect.
    std::vector<std::string> proxies = {};
    RateLimit::Config rate = {};
    // NOLINTEND(readability-redundant-member-init)
  };

  explicit Gate(Config config)
      : config_(std::move(config)), rate_(config_.rate), urgent_(config_.rate) {}

  /// Nothing: it may pass. A write, and a stream, must come from the server's own pages or from no
  /// page at all.
  [[nodiscard]] std::optional<Response> refuse(const Request& request, bool writes, double now_s);
  [[nodiscard]] bool is_urgent(const Request& request) const;

 private:
  [[nodiscard]] bool knows_host(const std::string& host) const;
  [[nodiscard]] bool is_own(const Request& request) const;

  Config config_;
  RateLimit rate_;
  RateLimit urgent_;
};

/// How a request says where its body ends.
struct Framing {
  std::string length;                ///< Content-Length; empty: none
  bool knows_chunks = true;          ///< HTTP/1.1
  std::vector<std::string> codings;  ///< each header Transfer-Encoding
};

/// Refused: a length that is not a number alone; any transfer coding but `chunked`, once and
/// without a length. Somebody in front of this server could see the body end elsewhere, and another
/// request in what is left.
[[nodiscard]] std::optional<Response> refuse_framing(const Framing& framing);

/// `[::1]:8080` → `[::1]`, `localhost:8080` → `localhost`.
[[nodiscard]] std::string without_port(const std::string& host);

/// Behind a proxy nobody else may come over the network: they could pretend to be a proxy, and
/// would send their passwords unencrypted. `from` as web::address_of() spells it.
[[nodiscard]] bool may_connect(const Gate::Config& config, const std::string& from);

/// Who asks. A proxy that was named adds the address that it sees to the end of `forwarded`, the
/// head X-Forwarded-For; without one, or where that is no address, `from` counts.
[[nodiscard]] std::string client_address(const Gate::Config& config, const std::string& from,
                                         const std::string& forwarded);

/// The heads of every answer: nothing but the server's own files may be loaded, no other page may
/// show this one in a frame.
void add_security_heads(Response& response, bool secure);

}  // namespace steadyrest::web
