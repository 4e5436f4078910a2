// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/kernel/file/json_object.hpp>

namespace steadyrest::kernel::file {

using Json = nlohmann::ordered_json;

std::optional<Json> json_object(std::string_view text) {
  constexpr int kDeepest = 32;
  bool deep = false;
  using Event = Json::parse_event_t;
  const auto watch = [&deep](int depth, Event event, Json& /*parsed*/) {
    const bool begins = event == Event::object_start || event == Event::array_start;
    deep = deep || (begins && depth >= kDeepest);  // the outermost has depth 0
    return !deep;
  };
  Json json = Json::parse(text, watch, false);
  return !deep && json.is_object() ? std::optional(std::move(json)) : std::nullopt;
}

}  // namespace steadyrest::kernel::file
