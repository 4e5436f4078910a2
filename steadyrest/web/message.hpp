// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace steadyrest::web {

/// A request, as far as an answer needs it.
struct Request {
  std::string method;
  std::string path;                          ///< without its query, decoded
  std::map<std::string, std::string> query;  ///< decoded; of a key that comes twice, the last
  std::string host;
  std::string origin;         ///< empty: none
  std::string authorization;  ///< of the head of this name, like the next ones
  std::string cookie;
  std::string content_type;
  std::string csrf;  ///< X-Steadyrest-CSRF
  std::string body;
  std::string address;  ///< of the client
  bool secure = false;  ///< over TLS
};

/// How long an answer takes that is made beside the others. None waits for one of another kind.
enum class Takes : std::uint8_t { seconds, minutes, hashing };

struct Response {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> head;
  std::string file;  ///< its contents are the body
  /// Holds the file until it has been opened; then it may go.
  std::shared_ptr<const void> keeper;
  /// Makes the answer, which takes long: beside the others, and without looking at what they share.
  /// It gives up when it is told to stop. The rest of this response then counts for nothing.
  std::function<Response(std::stop_token)> later;
  Takes takes = Takes::seconds;
};

/// Takes a request's target apart. False where it is none: it does not begin with `/`, has a wrong
/// escape or a control character, or leads to a folder above.
[[nodiscard]] bool parse_target(std::string_view target, Request& into);

/// ASCII letters in lower case.
[[nodiscard]] std::string lower(std::string text);

/// `application/json` from `Application/JSON; charset=utf-8`.
[[nodiscard]] std::string media_type(std::string_view content_type);

/// The value of a cookie; empty: there is none.
[[nodiscard]] std::string cookie(const Request& request, std::string_view name);

}  // namespace steadyrest::web
