// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstdint>

#include <steadyrest/kernel/link/host_port.hpp>

namespace steadyrest::kernel::link {
namespace {

bool is_letter_or_digit(char c) noexcept {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_name(std::string_view host) noexcept {
  return !host.empty() && std::ranges::all_of(host, [](char c) {
    return is_letter_or_digit(c) || c == '.' || c == '-' || c == '_';
  });
}

/// A zone (`%eth0`) may follow.
bool is_ipv6(std::string_view host) noexcept {
  return host.find(':') != std::string_view::npos && std::ranges::all_of(host, [](char c) {
           return is_letter_or_digit(c) || c == ':' || c == '.' || c == '%' || c == '-' || c == '_';
         });
}

bool is_port(std::string_view port) noexcept {
  std::uint32_t number = 0;
  const auto [rest, fault] = std::from_chars(port.data(), port.data() + port.size(), number);
  return fault == std::errc() && rest == port.data() + port.size() && number >= 1 &&
         number <= 65535;
}

}  // namespace

std::optional<HostPort> host_and_port(std::string_view text, std::string_view default_port) {
  const bool bracketed = text.starts_with('[');
  const std::size_t end = bracketed ? text.find(']') : std::min(text.find(':'), text.size());
  if (end == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view host = bracketed ? text.substr(1, end - 1) : text.substr(0, end);
  const std::string_view rest = text.substr(bracketed ? end + 1 : end);
  const std::string_view port = rest.starts_with(':') ? rest.substr(1) : default_port;
  const bool whole = rest.empty() || rest.starts_with(':');
  if (!whole || !is_port(port) || !(bracketed ? is_ipv6(host) : is_name(host))) {
    return std::nullopt;
  }
  return HostPort{.host = std::string(host), .port = std::string(port)};
}

}  // namespace steadyrest::kernel::link
