// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include <steadyrest/nc/interpret/provenance/opaque_stretches.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>

namespace steadyrest::nc::interpret {
namespace {

/// Reasons that say nothing of the text being wrong: the control may know the word.
constexpr std::array<std::string_view, 37> kNotUnderstood = {
    "ambiguous_code",
    "array",
    "bad_name",
    "cycle_not_interpreted",
    "cycle_value",
    "extended_address",
    "frame",
    "frame_axis",
    "frame_incremental",
    "frame_rotation",
    "function_not_interpreted",
    "g_code_not_interpreted",
    "lathe_code",
    "lathe_word",
    "m_code_not_interpreted",
    "machine_builders_code",
    "macro_call",
    "macro_output",
    "modal_call",
    "no_such_program",
    "parameter",
    "parameter_of_the_control",
    "parameter_of_the_machine",
    "polar_coordinates",
    "remapped_code",
    "spindle_selection",
    "subprogram_call",
    "system_variable",
    "transformation",
    "unknown_g_code",
    "unknown_m_code",
    "unknown_word",
    "definition",
    "unknown_function",
    "unset_parameter",
    "vacant_variable",
    "variable",
};

/// The interpreter of LinuxCNC knows all of its words: only these are a machine's own.
constexpr std::array<std::string_view, 6> kMachinesOwnOnLinuxcnc = {
    "m_code_not_interpreted",   "machine_builders_code", "parameter_of_the_control",
    "parameter_of_the_machine", "remapped_code",         "python"};

/// sinumerik: actions and couplings that go on acting beside the blocks behind them.
constexpr std::array<std::string_view, 19> kLasting = {
    "COUPDEF", "COUPON", "DO",  "EGDEF",  "EGON",   "EVERY",   "FOCON",  "FROM", "FXS",     "ID",
    "IDS",     "LEADON", "OSC", "SETINT", "TANGON", "TRAILON", "WAITMC", "WHEN", "WHENEVER"};

template <std::size_t kCount>
bool among(const std::array<std::string_view, kCount>& reasons, std::string_view reason) noexcept {
  return std::ranges::find(reasons, reason) != reasons.end();
}

}  // namespace

std::optional<Effects> may_change(const read::Refused& refused, read::Dialect dialect) {
  if (dialect == read::Dialect::sinumerik &&
      std::ranges::any_of(kLasting, [&](std::string_view name) {
        return read::equal(std::string_view{refused.word}.substr(0, name.size() + 1), name);
      })) {
    return std::nullopt;
  }
  const bool opaque = dialect == read::Dialect::linuxcnc
                          ? among(kMachinesOwnOnLinuxcnc, refused.reason)
                          : among(kNotUnderstood, refused.reason);
  return opaque ? std::optional(Effects{.all = true}) : std::nullopt;
}

void OpaqueStretches::open(const read::Refused& refused, std::uint32_t axes, ModeMask modes) {
  constexpr ModeMask kNotAsked = kHarmlessModes | mode(GGroup::retract);
  axes_ |= axes;
  modes_ |= modes & ~kNotAsked;
  ++blocks_;
  if (found_.size() < kMostListed) {
    found_.push_back({.line = refused.line,
                      .last_line = any_open() ? 0U : refused.line,
                      .word = refused.word,
                      .reason = refused.reason,
                      .text = refused.text,
                      .file = refused.file});
  }
}

void OpaqueStretches::settle(std::uint32_t line, std::uint32_t unknown_axes,
                             ModeMask lost) noexcept {
  if (!any_open()) {
    return;
  }
  axes_ &= unknown_axes;
  modes_ &= lost;
  if (any_open()) {
    return;
  }
  for (; first_open_ < found_.size(); ++first_open_) {
    std::uint32_t& last = found_[first_open_].last_line;
    last = last == 0 ? line : last;
  }
}

}  // namespace steadyrest::nc::interpret
