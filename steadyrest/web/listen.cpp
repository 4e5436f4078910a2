// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/web/listen.hpp>
#include <steadyrest/web/message.hpp>

namespace steadyrest::web {
namespace {

namespace ip = boost::asio::ip;
using kernel::outcome::refuse;
using kernel::outcome::Result;

/// IPv4 first: it is what a browser takes for `localhost`.
std::vector<ip::address> addresses_of(const std::string& name) {
  boost::asio::io_context io;
  ip::tcp::resolver resolver(io);
  boost::system::error_code fault;
  std::vector<ip::address> out;
  for (const auto& found : resolver.resolve(name, "", fault)) {
    out.push_back(found.endpoint().address());
  }
  std::ranges::stable_sort(out, {}, &ip::address::is_v6);
  return out;
}

Result<std::string> number_of(const std::string& name) {
  const auto found = addresses_of(name);
  if (found.empty()) {
    return refuse(fmt::format("--listen {}: no address has this name", name),
                  "give the address as a number, like --listen 127.0.0.1:8080");
  }
  const auto other = std::ranges::find_if_not(found, &ip::address::is_loopback);
  if (other != found.end()) {
    return refuse(fmt::format("--listen {}: this name leads to {}, which others reach", name,
                              other->to_string()),
                  fmt::format("give that address as a number, or --listen localhost:PORT for this "
                              "computer alone"));
  }
  return found.front().to_string();
}

}  // namespace

std::optional<std::string> address_of(const std::string& text) {
  boost::system::error_code fault;
  const auto address = ip::make_address(text, fault);
  if (fault) {
    return std::nullopt;
  }
  return address.is_v6() && address.to_v6().is_v4_mapped()
             ? ip::make_address_v4(ip::v4_mapped, address.to_v6()).to_string()
             : address.to_string();
}

bool is_loopback(const std::string& address) {
  boost::system::error_code fault;
  return ip::make_address(address, fault).is_loopback() && !fault;
}

Result<ListenPlace> listen_place(const std::string& listen) {
  ListenPlace out;
  const std::size_t colon = listen.rfind(':');
  const std::string port = colon == std::string::npos ? listen : listen.substr(colon + 1);
  const char* const end = port.data() + port.size();
  const auto read = std::from_chars(port.data(), end, out.port);
  std::string host = colon == std::string::npos ? out.address : listen.substr(0, colon);
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  if (read.ec != std::errc() || read.ptr != end || host.empty() ||
      (!bracketed && host.find(':') != std::string::npos)) {
    return refuse(fmt::format("--listen {} is no port, nor ADDRESS:PORT", listen),
                  "give --listen 8080, --listen 127.0.0.1:8080, or --listen [::1]:8080");
  }
  host = bracketed ? host.substr(1, host.size() - 2) : host;
  if (auto number = address_of(host)) {
    out.address = std::move(*number);
    return out;
  }
  auto number = bracketed
                    ? refuse(fmt::format("--listen {} has no address in its brackets", listen),
                             "give --listen [::1]:8080")
                    : number_of(host);
  if (!number) {
    return std::unexpected(std::move(number.error()));
  }
  out.address = std::move(*number);
  out.name = lower(host);
  return out;
}

}  // namespace steadyrest::web
