// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <steadyrest/adapters/linuxcnc/control_state.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::outcome::Result;
using Json = nlohmann::json;

ControlState::Tool tool_of(const Json& json) {
  return {.number = json.at("number").get<int>(),
          .offset = json.at("offset").get<ControlAxes>(),
          .diameter_mm = json.at("diameter_mm").get<double>(),
          .front_deg = json.at("front_deg").get<double>(),
          .back_deg = json.at("back_deg").get<double>(),
          .orientation = json.at("orientation").get<int>()};
}

ControlState state_of(const Json& json) {
  ControlState state;
  json.at("version").get_to(state.version);
  json.at("ini").get_to(state.ini);
  json.at("program").get_to(state.program);
  json.at("text_is_file").get_to(state.text_is_file);
  json.at("stopped").get_to(state.stopped);
  if (const Json& position = json.at("position"); !position.is_null()) {
    position.get_to(state.position);
  }
  json.at("work_offset").get_to(state.work_offset);
  json.at("work_offset_mm").get_to(state.work_offset_mm);
  json.at("rotation_deg").get_to(state.rotation_deg);
  json.at("g92_mm").get_to(state.g92_mm);
  json.at("tool_offset_mm").get_to(state.tool_offset_mm);
  json.at("tool").get_to(state.tool);
  for (const Json& tool : json.at("tools")) {
    state.tools.push_back(tool_of(tool));
  }
  json.at("block_delete").get_to(state.block_delete);
  json.at("inch").get_to(state.inch);
  json.at("incremental").get_to(state.incremental);
  json.at("plane").get_to(state.plane);
  json.at("retract_to_initial").get_to(state.retract_to_initial);
  json.at("centre_absolute").get_to(state.centre_absolute);
  if (const Json& tool = json.at("selected_tool"); !tool.is_null()) {
    state.selected_tool = tool.get<int>();
  }
  json.at("unread").get_to(state.unread);
  json.at("path_mode").get_to(state.path_mode);
  json.at("path_tolerance_mm").get_to(state.path_tolerance_mm);
  json.at("machine_inch").get_to(state.machine_inch);
  json.at("variables").get_to(state.variables);
  json.at("folders").get_to(state.folders);
  return state;
}

}  // namespace

Result<ControlState> control_state(std::string_view line) {
  try {
    const Json json = Json::parse(line);
    if (const auto error = json.find("error"); error != json.end()) {
      return kernel::outcome::unavailable(error->get<std::string>(),
                                          "see whether LinuxCNC runs, as this user");
    }
    return state_of(json);
  } catch (const Json::exception& fault) {
    return kernel::outcome::refuse(
        std::string("what LinuxCNC's status script printed is not understood: ") + fault.what(),
        "use LinuxCNC 2.9");
  }
}

}  // namespace steadyrest::adapters::linuxcnc
