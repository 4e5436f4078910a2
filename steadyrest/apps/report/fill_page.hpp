// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace steadyrest::apps::report {

/// A page built from web/ with the JSON in the place that is left for it; nothing in the data can
/// leave its script element.
[[nodiscard]] std::string fill_page(std::string_view page, std::string_view json);

}  // namespace steadyrest::apps::report
