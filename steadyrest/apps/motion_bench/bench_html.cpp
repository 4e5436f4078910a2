// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/motion_bench/bench_page.hpp>
#include <steadyrest/apps/report/fill_page.hpp>

// template.S puts the page between these two.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the symbols of template.S
extern const char steadyrest_motion_bench_template_begin[];
extern const char steadyrest_motion_bench_template_end[];
// NOLINTEND(readability-identifier-naming)
}

namespace steadyrest::apps::motion_bench {

std::string to_html(std::string_view json) {
  const char* const begin = static_cast<const char*>(steadyrest_motion_bench_template_begin);
  const char* const end = static_cast<const char*>(steadyrest_motion_bench_template_end);
  return report::fill_page({begin, static_cast<std::size_t>(end - begin)}, json);
}

}  // namespace steadyrest::apps::motion_bench
