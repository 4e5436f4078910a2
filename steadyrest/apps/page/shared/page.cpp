// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/apps/page/shared/page.hpp>

// The one page for all reports is linked into the binary; the data go into its script element.
// template.S puts the page between these two.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the symbols of template.S
extern const char steadyrest_page_begin[];
extern const char steadyrest_page_end[];
// NOLINTEND(readability-identifier-naming)
}

namespace steadyrest::apps::page {
namespace {

/// With the quotes: the placeholder is a JSON string in the page as it was built.
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

/// The schema tells the page what to draw; the version tells a reader which program drew it.
Json page_head(std::string_view schema) {
  return {{"schema", schema}, {"version", STEADYREST_VERSION}};
}

/// Text from programs and file names need not be UTF-8.
std::string text_of(const Json& page) {
  return page.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// One search for the place, one copy: pages of tens of megabytes are written in one go.
std::string to_html(std::string_view json) {
  const char* const begin = static_cast<const char*>(steadyrest_page_begin);
  const char* const end = static_cast<const char*>(steadyrest_page_end);
  const std::string_view page(begin, static_cast<std::size_t>(end - begin));
  const std::size_t place = page.find(kPlace);
  std::string out;
  out.reserve(page.size() + json.size() + json.size() / 64);
  out += page.substr(0, place);
  append_escaped(out, json);
  out += page.substr(place + kPlace.size());
  return out;
}

}  // namespace steadyrest::apps::page
