// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/nc/interpret/control/tool_table.hpp>

namespace steadyrest::nc::interpret {

// Without a tool table every tool exists with length 0, so programs can be timed without the shop's
// data. Tool 0 is "none" unless the table describes it.
const Tool* find_tool(const Config& config, std::int32_t number) noexcept {
  static constexpr Tool kNoTool{};
  if (number == 0 || !config.tools) {
    if (config.tools) {
      const auto found = std::ranges::find(*config.tools, 0, &Tool::number);
      return found == config.tools->end() ? &kNoTool : &*found;
    }
    return &kNoTool;
  }
  const auto found = std::ranges::find(*config.tools, number, &Tool::number);
  return found == config.tools->end() ? nullptr : &*found;
}

Tool* place_of_tool(Config& config, std::int32_t number) {
  if (!config.tools) {
    return nullptr;
  }
  const auto found = std::ranges::find(*config.tools, number, &Tool::number);
  return found == config.tools->end() ? nullptr : &*found;
}

// The callers have checked that the word is a whole number; it must also be in the table.
bool tool_number(Control& control, const Step& step, char letter, std::int32_t& number) {
  number = static_cast<std::int32_t>(step[letter]);
  return find_tool(control.config, number) != nullptr ||
         control.refusals.letter(step, letter, "no_such_tool",
                                 "this tool is not in the tool table");
}

// The data of the tool in the spindle, as shown by #5401 …; the length acts only at G43.
void load_tool(Control& control) {
  const Tool* const tool = place_of_tool(control.config, control.state.tool_in_spindle);
  if (tool != nullptr) {
    control.state.tool = *tool;
  }
}

}  // namespace steadyrest::nc::interpret
