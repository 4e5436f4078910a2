// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Lines of the bridge's protocol (README.md), made and read on the layer's side. A line is at most
/// kMaxLine bytes; whatever is not an answer is refused, whoever sent it.
namespace steadyrest::adapters::opcua {

inline constexpr std::size_t kMaxLine = 65536;
inline constexpr std::size_t kMaxNodes = 256;
inline constexpr std::size_t kMaxEntries = 1024;  ///< of an array

/// One line from the bridge.
struct Answer {
  struct Value {
    std::uint32_t status = 0;     ///< OPC UA status code; 0 is Good
    std::vector<double> numbers;  ///< of an array or a single number; NaN where it is none
    std::string text;
    double time_s = 0.0;  ///< by the server's clock; 0: not given
  };
  struct Checked {
    std::uint32_t status = 0;
    std::string status_name;
    std::string type;
    std::int64_t length = -1;      ///< −1: a single value
    std::optional<bool> writable;  ///< by this user; none: the server does not say
  };
  enum class Kind : std::uint8_t { hello, state, reply };

  Kind kind = Kind::reply;
  std::optional<std::uint64_t> id;  ///< of the request
  bool ok = false;
  std::string state;  ///< connecting, connected, lost
  std::string why;    ///< one stable word
  std::string detail;
  std::vector<Value> values;          ///< of read
  std::vector<std::uint32_t> status;  ///< of write
  std::vector<Checked> nodes;         ///< of check
  std::uint32_t protocol = 0;         ///< of hello
  // Of certificate.
  std::string fingerprint, subject, from, until, own;
};

/// None: not a line of the protocol.
[[nodiscard]] std::optional<Answer> decode_line(std::string_view line);

struct Configure {
  std::string endpoint;
  bool secure = true;
  std::string user;
  std::string password_file;
  std::string password_variable;
  std::string state;
  int timeout_ms = 1000;
  std::string uri;
  std::vector<std::string> reads;
  std::vector<std::string> writes;
};

[[nodiscard]] std::string configure_line(std::uint64_t id, const Configure& configure);
[[nodiscard]] std::string write_line(std::uint64_t id,
                                     const std::vector<std::vector<double>>& values,
                                     const std::vector<bool>& is_array);
[[nodiscard]] std::string trust_line(std::uint64_t id, const std::string& fingerprint);
/// A request without anything more: read, check, certificate, stop.
[[nodiscard]] std::string plain_line(std::uint64_t id, std::string_view act);

}  // namespace steadyrest::adapters::opcua
