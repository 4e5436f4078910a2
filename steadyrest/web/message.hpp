// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
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

struct Response {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> head;
  std::string file;  ///< its contents are the body; removed once they are sent
};

/// The target of a request in its parts; false where it cannot be one: not from `/`, wrong escapes,
/// control characters, a folder up.
[[nodiscard]] bool parse_target(std::string_view target, Request& into);

/// The value of a cookie; empty: there is none.
[[nodiscard]] std::string cookie(const Request& request, std::string_view name);

}  // namespace steadyrest::web
