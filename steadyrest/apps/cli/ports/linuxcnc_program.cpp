// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include <steadyrest/apps/cli/ports/linuxcnc_live.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/interpret/parameters/linuxcnc_files.hpp>

namespace steadyrest::apps::cli::live {

using adapters::linuxcnc::ControlState;
using nc::interpret::PathMode;

namespace {

PathMode path_mode(const std::string& word) {
  return word == "exact_path"   ? PathMode::exact_path
         : word == "exact_stop" ? PathMode::exact_stop
                                : PathMode::continuous;
}

std::vector<nc::interpret::Tool> tools_of(const ControlState& state) {
  std::vector<nc::interpret::Tool> tools;
  tools.reserve(state.tools.size());
  for (const ControlState::Tool& tool : state.tools) {
    tools.push_back({.number = tool.number,
                     .offset = tool.offset,
                     .diameter_mm = tool.diameter_mm,
                     .front_angle_deg = tool.front_deg,
                     .back_angle_deg = tool.back_deg,
                     .orientation = tool.orientation});
  }
  return tools;
}

}  // namespace

Result<steadyrest::live::LoadedProgram> loaded_program(const ControlState& state,
                                                       const kernel::machine::Machine& machine) {
  if (!state.unread.empty()) {
    return std::unexpected(bad_input(
        "LinuxCNC has " + state.unread + " from before the program, which the layer does not read",
        "return to G8 G40 G94 G97 before the start; a remapped word has no path"));
  }
  steadyrest::live::LoadedProgram loaded{.file = state.program,
                                         .start = {},
                                         .stopped = state.stopped,
                                         .text_is_file = state.text_is_file};
  auto config = program_config({}, machine);
  if (!config) {
    return std::unexpected(config.error());
  }
  nc::interpret::Config& start = loaded.start;
  start = std::move(*config);
  // What the file says of the offsets in force may be older than the control's own figures.
  if (std::error_code none; std::filesystem::exists(state.variables, none)) {
    const double unit_mm = state.machine_inch ? kernel::units::kMmPerInch : 1.0;
    if (auto read = nc::interpret::read_variables(state.variables, unit_mm, start); !read) {
      return std::unexpected(read.error());
    }
  }
  // LinuxCNC shows no offset before one is set or chosen; until then those of the file hold.
  if (state.work_offset > 0) {
    const auto last = static_cast<int>(nc::interpret::kWorkOffsets);
    start.active_offset = static_cast<std::size_t>(std::min(state.work_offset, last) - 1);
    start.work_offset[start.active_offset] = state.work_offset_mm;
    start.rotation_deg[start.active_offset] = state.rotation_deg;
    start.g92 = state.g92_mm;
    start.g92_on = std::ranges::any_of(state.g92_mm, [](double value) { return value != 0.0; });
  }
  start.tool_offset = state.tool_offset_mm;
  start.tool_in_spindle = state.tool;
  start.start = state.position;
  start.start_known = true;
  start.on_control = true;
  if (!state.tools.empty()) {
    start.tools = tools_of(state);
  }
  start.subprogram_folders = state.folders;
  start.subprogram_folders.push_back(std::filesystem::path(state.program).parent_path().string());
  start.block_delete = state.block_delete;
  // The control's modes are known; what it executed when it was started is in them.
  start.settings.startup.clear();
  start.inch = state.inch;
  start.unit_known = true;
  start.incremental = state.incremental;
  start.plane = state.plane == "zx"   ? nc::interpret::Plane::zx
                : state.plane == "yz" ? nc::interpret::Plane::yz
                                      : nc::interpret::Plane::xy;
  start.retract_to_initial = state.retract_to_initial;
  start.centre_absolute = state.centre_absolute;
  start.selected_tool = state.selected_tool;
  start.path_mode = path_mode(state.path_mode);
  start.path_tolerance_mm = state.path_tolerance_mm;
  return loaded;
}

}  // namespace steadyrest::apps::cli::live
