// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/apps/report/fill_page.hpp>

namespace steadyrest::apps::report {
namespace {

constexpr std::string_view kPlace = "\"@STEADYREST_REPORT_DATA@\"";

/// Without `<` no text can close the script element or open a comment in it; JSON reads the escape
/// back as the same character.
void append_escaped(std::string& out, std::string_view json) {
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
}

}  // namespace

std::string fill_page(std::string_view page, std::string_view json) {
  const std::size_t place = page.find(kPlace);
  std::string out;
  out.reserve(page.size() + json.size() + json.size() / 64);
  out += page.substr(0, place);
  append_escaped(out, json);
  out += page.substr(place + kPlace.size());
  return out;
}

}  // namespace steadyrest::apps::report
