// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/apps/report/fill_page.hpp>
#include <steadyrest/apps/report/report.hpp>

// template.S puts the page between these two.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the symbols of template.S
extern const char steadyrest_report_template_begin[];
extern const char steadyrest_report_template_end[];
// NOLINTEND(readability-identifier-naming)
}

namespace steadyrest::apps::report {

std::string to_html(std::string_view json) {
  const char* const begin = static_cast<const char*>(steadyrest_report_template_begin);
  const char* const end = static_cast<const char*>(steadyrest_report_template_end);
  return fill_page({begin, static_cast<std::size_t>(end - begin)}, json);
}

}  // namespace steadyrest::apps::report
