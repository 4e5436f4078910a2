// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/nc/interpret/control/control.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>

namespace steadyrest::nc::interpret {

Control::Control(Config start) : config(std::move(start)), rules(rules_of(config.dialect)) {
  for (const char letter : config.axes) {
    axes |= Step::bit(letter);
  }
  for (const char letter : config.settings.wrapped_axes) {
    wrapped |= Step::bit(letter);
  }
  for (const char letter : config.settings.indexer_axes) {
    indexers |= Step::bit(letter);
  }
  kernel::machine::each_remapped(config.settings.remapped, [this](std::string_view text) {
    if (const auto code = kernel::machine::remapped_code(text)) {
      remapped.push_back(*code);
    }
  });
  state.work_offset = config.work_offset;
  state.rotation_deg = config.rotation_deg;
  state.active_offset = config.active_offset;
  state.work_in_force = state.work_offset[state.active_offset];
  state.external = config.external;
  state.g92 = config.g92_on ? config.g92 : Axes{};
  state.g92_stored = config.g92;
  state.g92_on = config.g92_on;
  state.tool_offset = config.tool_offset;
  state.home = config.home;
  state.unit_mm = config.inch ? kMmPerInch : 1.0;
  state.feed_unit_mm = state.unit_mm;
  state.unit_known = state.feed_unit_known = config.unit_known;
  state.incremental = config.incremental;
  state.path_mode = config.path_mode;
  state.path_tolerance_mm = config.path_tolerance_mm;
  state.tool_in_spindle = config.tool_in_spindle;
  state.selected_tool = config.selected_tool.value_or(config.tool_in_spindle);
  state.plane = config.plane;
  state.centre_absolute = config.centre_absolute;
  state.retract_to_initial = config.retract_to_initial || rules.starts_with_g98;
  // update_offset() keeps the machine where it is and moves the work coordinates, so it must run
  // before the given machine position is converted to them.
  state.position = config.start;
  update_offset(state);
  state.position = to_work(state, config.start);
}

}  // namespace steadyrest::nc::interpret
