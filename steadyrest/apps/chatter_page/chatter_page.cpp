// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/apps/chatter_page/chatter_page.hpp>
#include <steadyrest/apps/report/fill_page.hpp>

// template.S puts the page between these two.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the symbols of template.S
extern const char steadyrest_chatter_template_begin[];
extern const char steadyrest_chatter_template_end[];
// NOLINTEND(readability-identifier-naming)
}

namespace steadyrest::apps::chatter_page {

Json page_head(std::string_view kind, std::string_view process, const Json& answer) {
  return {{"schema", "steadyrest-chatter/1"},
          {"version", STEADYREST_VERSION},
          {"kind", kind},
          {"process", process},
          {"answer", answer}};
}

std::string text_of(const Json& page) {
  return page.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string to_html(std::string_view json) {
  const char* const begin = static_cast<const char*>(steadyrest_chatter_template_begin);
  const char* const end = static_cast<const char*>(steadyrest_chatter_template_end);
  return report::fill_page({begin, static_cast<std::size_t>(end - begin)}, json);
}

}  // namespace steadyrest::apps::chatter_page
