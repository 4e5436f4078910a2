// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/record/sample.hpp>

namespace steadyrest::apps::live_page::past_runs {

/// An event as people read it: without the machine file that took over, a wish in plain words.
[[nodiscard]] std::string event_words(const record::Event& event);

}  // namespace steadyrest::apps::live_page::past_runs
