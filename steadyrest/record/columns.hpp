// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include <steadyrest/record/sample.hpp>

/// Each field of a sample and of a path segment by its name in the file: the one list from which
/// writer and reader work.
namespace steadyrest::record {

/// A field's name: `feed.panel_ratio`, and with an index `axis.actual_mm.2`.
struct ColumnName {
  std::string_view name;
  int index = -1;  ///< ≥ 0: one of several

  [[nodiscard]] std::string text() const {
    return index < 0 ? std::string(name) : std::string(name) + "." + std::to_string(index);
  }
};

/// A value as 64 bits, and back: exact for every double, NaN with its payload.
template <class T>
[[nodiscard]] constexpr std::uint64_t to_bits(T value) noexcept {
  if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<std::uint64_t>(value);
  } else if constexpr (std::is_enum_v<T>) {
    return static_cast<std::uint64_t>(static_cast<std::underlying_type_t<T>>(value));
  } else {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
  }
}

/// False for bits that no value of this type has.
template <class T>
[[nodiscard]] constexpr bool from_bits(std::uint64_t bits, T& value) noexcept {
  if constexpr (std::is_same_v<T, double>) {
    value = std::bit_cast<double>(bits);
  } else if constexpr (std::is_same_v<T, bool>) {
    value = bits != 0;
    return bits <= 1;
  } else {
    value = static_cast<T>(bits);
  }
  if constexpr (std::is_same_v<T, kernel::signal::Motion>) {
    return bits <= to_bits(kernel::signal::Motion::spindle_wait);
  } else if constexpr (std::is_same_v<T, kernel::signal::ProgramState>) {
    return bits <= to_bits(kernel::signal::ProgramState::paused);
  } else if constexpr (std::is_same_v<T, kernel::signal::Geometry>) {
    return bits <= to_bits(kernel::signal::Geometry::arc);
  }
  return to_bits(value) == bits;
}

template <class Values, class Visit>
void each(std::string_view name, Values& values, Visit& visit) {
  int index = 0;
  for (auto& value : values) {
    visit(ColumnName{name, index++}, value);
  }
}

template <class Visit>
void axis_columns(int i, kernel::signal::AxisSample& axis, Visit& visit) {
  visit(ColumnName{"axis.command_mm", i}, axis.command_mm);
  visit(ColumnName{"axis.actual_mm", i}, axis.actual_mm);
  visit(ColumnName{"axis.following_error_mm", i}, axis.following_error_mm);
  visit(ColumnName{"axis.offset_mm", i}, axis.offset_mm);
  visit(ColumnName{"axis.encoder_shown", i}, axis.encoder_shown);
  visit(ColumnName{"axis.count", i}, axis.count);
  visit(ColumnName{"axis.edge_s", i}, axis.edge_s);
  visit(ColumnName{"axis.edge_direction", i}, axis.edge_direction);
  visit(ColumnName{"axis.velocity_mm_s", i}, axis.velocity_mm_s);
  visit(ColumnName{"axis.acceleration_mm_s2", i}, axis.acceleration_mm_s2);
  visit(ColumnName{"axis.velocity_bound_mm_s", i}, axis.velocity_bound_mm_s);
  visit(ColumnName{"axis.acceleration_bound_mm_s2", i}, axis.acceleration_bound_mm_s2);
}

/// Index 0: feed, 1: rapid, 2: spindle.
template <class Visit>
void override_columns(int i, kernel::signal::OverrideState& state, Visit& visit) {
  visit(ColumnName{"override.panel_ratio", i}, state.panel_ratio);
  visit(ColumnName{"override.effective_ratio", i}, state.effective_ratio);
  visit(ColumnName{"override.panel_code", i}, state.panel_code);
  visit(ColumnName{"override.panel_code_known", i}, state.panel_code_known);
}

template <class Visit>
void frame_columns(kernel::signal::Frame& frame, Visit& visit) {
  visit(ColumnName{"time_s"}, frame.time_s);
  visit(ColumnName{"age_s"}, frame.age_s);
  visit(ColumnName{"cycle"}, frame.cycle);
  visit(ColumnName{"axis_count"}, frame.axis_count);
  int index = 0;
  for (auto& axis : frame.axis) {
    axis_columns(index++, axis, visit);
  }
  override_columns(0, frame.feed, visit);
  override_columns(1, frame.rapid, visit);
  override_columns(2, frame.spindle, visit);
  visit(ColumnName{"motion"}, frame.motion);
  visit(ColumnName{"program_line"}, frame.program_line);
  visit(ColumnName{"program"}, frame.program);
  visit(ColumnName{"programmed_feed_mm_s"}, frame.programmed_feed_mm_s);
  visit(ColumnName{"path_speed_mm_s"}, frame.path_speed_mm_s);
  visit(ColumnName{"feed_per_revolution"}, frame.feed_per_revolution);
  visit(ColumnName{"speed_modulation"}, frame.speed_modulation);
  visit(ColumnName{"spindle_programmed_rev_s"}, frame.spindle_programmed_rev_s);
  visit(ColumnName{"spindle_command_rev_s"}, frame.spindle_command_rev_s);
  visit(ColumnName{"spindle_actual_rev_s"}, frame.spindle_actual_rev_s);
  visit(ColumnName{"coolant"}, frame.coolant);
  each("temperature_c", frame.temperature_c, visit);
  visit(ColumnName{"probe.number"}, frame.probe.number);
  visit(ColumnName{"probe.axis"}, frame.probe.axis);
  visit(ColumnName{"probe.displacement_mm"}, frame.probe.displacement_mm);
  visit(ColumnName{"probe.sd_mm"}, frame.probe.sd_mm);
  visit(ColumnName{"vibration_rate_hz"}, frame.vibration_rate_hz);
  visit(ColumnName{"path_index"}, frame.path_index);
  visit(ColumnName{"path_position_mm"}, frame.path_position_mm);
  visit(ColumnName{"original_unknown"}, frame.original_unknown);
  visit(ColumnName{"heat_in_text"}, frame.heat_in_text);
}

template <class Visit>
void command_columns(kernel::signal::Command& command, Visit& visit) {
  visit(ColumnName{"command.feed_ratio"}, command.feed_ratio);
  visit(ColumnName{"command.feed_code"}, command.feed_code);
  visit(ColumnName{"command.feed_masks_panel"}, command.feed_masks_panel);
  visit(ColumnName{"command.spindle_ratio"}, command.spindle_ratio);
  visit(ColumnName{"command.spindle_code"}, command.spindle_code);
  visit(ColumnName{"command.spindle_masks_panel"}, command.spindle_masks_panel);
  each("command.offset_mm", command.offset_mm, visit);
  each("command.path_offset_mm", command.path_offset_mm, visit);
  visit(ColumnName{"command.write"}, command.write);
  visit(ColumnName{"command.heartbeat"}, command.heartbeat);
  visit(ColumnName{"command.feed_reason"}, command.feed_reason);
  visit(ColumnName{"command.spindle_reason"}, command.spindle_reason);
  visit(ColumnName{"command.offset_reason"}, command.offset_reason);
  visit(ColumnName{"command.path_offset_reason"}, command.path_offset_reason);
}

template <class Visit>
void sample_columns(Sample& sample, Visit&& visit) {
  visit(ColumnName{"number"}, sample.number);
  visit(ColumnName{"path"}, sample.path);
  visit(ColumnName{"vibrations"}, sample.vibrations);
  frame_columns(sample.frame, visit);
  command_columns(sample.command, visit);
  visit(ColumnName{"original"}, sample.original);
}

template <class Visit>
void segment_columns(kernel::signal::PathSegment& segment, Visit&& visit) {
  visit(ColumnName{"geometry"}, segment.geometry);
  visit(ColumnName{"motion"}, segment.motion);
  visit(ColumnName{"speed_modulation"}, segment.speed_modulation);
  visit(ColumnName{"line"}, segment.line);
  each("start_mm", segment.start_mm, visit);
  each("end_mm", segment.end_mm, visit);
  each("centre_mm", segment.centre_mm, visit);
  each("axis", segment.axis, visit);
  visit(ColumnName{"radius_mm"}, segment.radius_mm);
  visit(ColumnName{"radius_end_mm"}, segment.radius_end_mm);
  visit(ColumnName{"sweep_rad"}, segment.sweep_rad);
  visit(ColumnName{"rise_mm"}, segment.rise_mm);
  each("other_start", segment.other_start, visit);
  each("other_end", segment.other_end, visit);
  visit(ColumnName{"length_mm"}, segment.length_mm);
  visit(ColumnName{"position_mm"}, segment.position_mm);
  visit(ColumnName{"feed_mm_s"}, segment.feed_mm_s);
  visit(ColumnName{"speed_limit_mm_s"}, segment.speed_limit_mm_s);
  visit(ColumnName{"exit_speed_limit_mm_s"}, segment.exit_speed_limit_mm_s);
  visit(ColumnName{"original_start_mm"}, segment.original_start_mm);
  visit(ColumnName{"original_end_mm"}, segment.original_end_mm);
  visit(ColumnName{"by_text"}, segment.by_text);
}

}  // namespace steadyrest::record
