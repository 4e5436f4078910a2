// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/interpret/frame.hpp>
#include <steadyrest/nc/interpret/parameters.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;

constexpr int kProbe = 5061;       // … 5069, and 5070 whether it touched
constexpr int kHome = 5161;        // … 5169
constexpr int kSecondHome = 5181;  // … 5189
constexpr int kG92InForce = 5210;
constexpr int kG92 = 5211;  // … 5219
constexpr int kActiveOffset = 5220;
constexpr int kOffsets = 5221;  // nine of twenty numbers each; the tenth is the rotation
constexpr int kOffsetStride = 20;
constexpr int kTool = 5400;
constexpr int kToolOffset = 5401;    // … 5409
constexpr int kToolDiameter = 5410;  // then front angle, back angle, orientation
constexpr int kPosition = 5420;      // … 5428
constexpr int kAxes = 9;
constexpr int kDebugging = 5599;     // whether (DEBUG,…) shows: 1 at the start
constexpr int kChangerFault = 5600;  // and 5601: the tool changer's, nothing can be set there

constexpr bool within(int index, int first) noexcept {
  return index >= first && index < first + kAxes;
}
constexpr bool is_rotary(int axis) noexcept {
  return axis >= 3 && axis < 6;
}
constexpr bool reads_only(int index) noexcept {
  return (index >= kTool && index < kToolDiameter + 4) || within(index, kPosition) ||
         index == kG92InForce || index == kActiveOffset;
}

// What only the running machine knows.
bool of_machine(std::string_view name) noexcept {
  return name.starts_with("_hal[") || name.starts_with("_ini[") || name == "_current_pocket" ||
         name == "_selected_pocket" || name == "_metric_machine";
}

using Answers = std::unordered_map<std::string_view, double (*)(const State&)>;

/// What the interpreter answers for by name.
const Answers& answers() {
  static constexpr auto kTruth = [](bool yes) { return yes ? 1.0 : 0.0; };
  static const Answers kAnswers = {
      {"_vmajor", [](const State&) { return 2.9; }},
      {"_vminor", [](const State&) { return 0.0; }},
      {"_motion_mode",
       [](const State& s) { return s.motion < 0 ? 800.0 : static_cast<double>(s.motion); }},
      {"_plane",
       [](const State& s) {
         return s.plane == Plane::xy ? 170.0 : s.plane == Plane::zx ? 180.0 : 190.0;
       }},
      {"_ccomp",
       [](const State& s) {
         return s.cutter_side == 0 ? 400.0 : s.cutter_side < 0 ? 410.0 : 420.0;
       }},
      {"_metric", [](const State& s) { return kTruth(s.unit_mm == 1.0); }},
      {"_imperial", [](const State& s) { return kTruth(s.unit_mm != 1.0); }},
      {"_absolute", [](const State& s) { return kTruth(!s.incremental); }},
      {"_incremental", [](const State& s) { return kTruth(s.incremental); }},
      {"_inverse_time",
       [](const State& s) { return kTruth(s.feed_mode == FeedMode::inverse_time); }},
      {"_units_per_minute",
       [](const State& s) { return kTruth(s.feed_mode == FeedMode::per_minute); }},
      {"_units_per_rev",
       [](const State& s) { return kTruth(s.feed_mode == FeedMode::per_revolution); }},
      {"_coord_system",
       [](const State& s) {
         const auto set = static_cast<double>(s.active_offset);
         return set < 6.0 ? 540.0 + 10.0 * set : 585.0 + set;
       }},
      {"_tool_offset", [](const State& s) { return kTruth(s.tool_offset != Axes{}); }},
      {"_retract_r_plane", [](const State& s) { return kTruth(!s.retract_to_initial); }},
      {"_retract_old_z", [](const State& s) { return kTruth(s.retract_to_initial); }},
      {"_spindle_rpm_mode", [](const State& s) { return kTruth(!s.surface_speed); }},
      {"_spindle_css_mode", [](const State& s) { return kTruth(s.surface_speed); }},
      {"_ijk_absolute_mode", [](const State& s) { return kTruth(s.centre_absolute); }},
      {"_lathe_diameter_mode", [](const State& s) { return kTruth(s.diameter); }},
      {"_lathe_radius_mode", [](const State& s) { return kTruth(!s.diameter); }},
      {"_spindle_on", [](const State& s) { return kTruth(s.spindle_direction != 0); }},
      {"_spindle_cw", [](const State& s) { return kTruth(s.spindle_direction > 0); }},
      {"_mist",
       [](const State& s) { return kTruth((static_cast<unsigned>(s.coolant) & 1U) != 0); }},
      {"_flood",
       [](const State& s) { return kTruth((static_cast<unsigned>(s.coolant) & 2U) != 0); }},
      {"_speed_override", [](const State&) { return 1.0; }},
      {"_feed_override", [](const State& s) { return kTruth(!s.override_off); }},
      {"_adaptive_feed", [](const State&) { return 0.0; }},
      {"_feed_hold", [](const State&) { return 1.0; }},
      {"_feed",
       [](const State& s) {
         return s.feed_mm_s * (s.feed_mode == FeedMode::per_revolution ? 1.0 : 60.0) /
                (s.feed_mode == FeedMode::inverse_time ? 1.0 : s.unit_mm);
       }},
      {"_rpm", [](const State& s) { return s.spindle_speed_rev_s * 60.0; }},
      {"_current_tool", [](const State& s) { return static_cast<double>(s.tool_in_spindle); }},
      {"_selected_tool", [](const State& s) { return static_cast<double>(s.selected_tool); }},
      {"_task", [](const State&) { return 0.0; }},
      {"_remap_level", [](const State&) { return 0.0; }},
  };
  return kAnswers;
}

}  // namespace

Parameters::Parameters() : numbers_(static_cast<std::size_t>(kNumbers), 0.0) {
  numbers_[kDebugging] = 1.0;
}

double* Parameters::stored(int index, bool& rotary) const noexcept {
  const auto axis_of = [&](int first, Axes& axes) {
    rotary = is_rotary(index - first);
    return &axes[static_cast<std::size_t>(index - first)];
  };
  if (within(index, kHome)) {
    return axis_of(kHome, state_->home[0]);
  }
  if (within(index, kSecondHome)) {
    return axis_of(kSecondHome, state_->home[1]);
  }
  if (within(index, kG92)) {
    return axis_of(kG92, state_->g92_stored);
  }
  const int set = (index - kOffsets) / kOffsetStride;
  if (index >= kOffsets && set < static_cast<int>(kWorkOffsets)) {
    const int first = kOffsets + set * kOffsetStride;
    if (within(index, first)) {
      return axis_of(first, state_->work_offset[static_cast<std::size_t>(set)]);
    }
    if (index == first + kAxes) {
      rotary = true;
      return &state_->rotation_deg[static_cast<std::size_t>(set)];
    }
  }
  return nullptr;
}

bool Parameters::of_state(int index, double& value) const {
  const auto in_force = [&](const Axes& axes, int first, double unit_mm) {
    value =
        axes[static_cast<std::size_t>(index - first)] / (is_rotary(index - first) ? 1.0 : unit_mm);
    return true;
  };
  if (within(index, kPosition)) {
    Axes shown = state_->position;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      shown[i] += state_->cutter_shift[i];
    }
    return in_force(shown, kPosition, state_->unit_mm);
  }
  if (within(index, kToolOffset)) {
    return in_force(state_->tool.offset, kToolOffset, config_->data_unit_mm);
  }
  bool rotary = false;
  if (const double* const place = stored(index, rotary); place != nullptr) {
    value = rotary ? *place : *place / config_->data_unit_mm;
    return true;
  }
  switch (index) {
    case kG92InForce:
      value = state_->g92_on ? 1.0 : 0.0;
      return true;
    case kActiveOffset:
      value = static_cast<double>(state_->active_offset + 1);
      return true;
    case kTool:
      value = state_->tool_in_spindle;
      return true;
    case kToolDiameter:
      value = state_->tool.diameter_mm / config_->data_unit_mm;
      return true;
    case kToolDiameter + 1:
      value = state_->tool.front_angle_deg;
      return true;
    case kToolDiameter + 2:
      value = state_->tool.back_angle_deg;
      return true;
    case kToolDiameter + 3:
      value = state_->tool.orientation;
      return true;
    default:
      return false;
  }
}

bool Parameters::of_state(std::string_view name, double& value) const {
  if (name.size() == 2 && name[0] == '_') {
    constexpr std::string_view kLetters = "xyzabcuvw";
    if (const auto axis = kLetters.find(name[1]); axis != std::string_view::npos) {
      return of_state(kPosition + static_cast<int>(axis), value);
    }
  }
  if (name.starts_with("_abs_") && name.size() == 6) {
    constexpr std::string_view kLetters = "xyzabc";
    if (const auto axis = kLetters.find(name[5]); axis != std::string_view::npos) {
      const Axes machine = turned(state_->position, state_->rotation_in_force_deg);
      value = (machine[axis] + state_->offset[axis]) /
              (is_rotary(static_cast<int>(axis)) ? 1.0 : state_->unit_mm);
      return true;
    }
  }
  if (name == "_line") {
    value = state_->line;
    return true;
  }
  if (name == "_value" || name == "_value_returned") {
    value = name == "_value" ? value_ : value_returned_;
    return true;
  }
  if (name == "_call_level") {
    value = static_cast<double>(calls_.size());
    return true;
  }
  const auto found = answers().find(name);
  if (found == answers().end()) {
    return false;
  }
  value = found->second(*state_);
  return true;
}

Lookup Parameters::number(int index, double& value) const {
  if (index < 1 || index >= kNumbers) {
    return Lookup::no_such_number;
  }
  if (within(index, kPosition) && state_->cutter_side != 0) {
    return Lookup::not_while_compensating;
  }
  if (index >= kHome && of_state(index, value)) {
    return Lookup::found;
  }
  value = numbers_[static_cast<std::size_t>(index)];
  return Lookup::found;
}

const Parameters::Names& Parameters::local_names() const noexcept {
  const auto own =
      std::find_if(calls_.rbegin(), calls_.rend(), [](const Call& call) { return !call.shared; });
  return own == calls_.rend() ? main_names_ : own->names;
}

Parameters::Names& Parameters::local_names() noexcept {
  return const_cast<Names&>(std::as_const(*this).local_names());
}

Lookup Parameters::name(std::string_view name, double& value) const {
  if (name.front() != '_') {
    const Names& names = local_names();
    const auto found = names.find(name);
    if (found == names.end()) {
      return Lookup::no_such_name;
    }
    value = found->second;
    return Lookup::found;
  }
  if (of_state(name, value)) {
    return Lookup::found;
  }
  const auto found = globals_.find(name);
  if (found != globals_.end()) {
    value = found->second;
    return Lookup::found;
  }
  return of_machine(name) ? Lookup::not_known_here : Lookup::no_such_name;
}

Lookup Parameters::set_number(int index, double value) {
  if (index < 1 || index >= kNumbers) {
    return Lookup::no_such_number;
  }
  if (reads_only(index)) {
    return Lookup::read_only;
  }
  pending_numbers_.emplace_back(index, value);
  return Lookup::found;
}

Lookup Parameters::set_name(std::string_view name, double value) {
  double ignored = 0.0;
  if (name.front() == '_' &&
      (of_state(name, ignored) || of_machine(name) || name.find('[') != std::string_view::npos)) {
    return Lookup::read_only;
  }
  pending_names_.emplace_back(name, value);
  return Lookup::found;
}

void Parameters::assign(int index, double value) {
  bool rotary = false;
  if (double* const place = index >= kHome ? stored(index, rotary) : nullptr; place != nullptr) {
    *place = rotary ? value : value * config_->data_unit_mm;
    return;
  }
  if (index < kChangerFault) {
    numbers_[static_cast<std::size_t>(index)] = value;
  }
}

void Parameters::commit() {
  for (const auto& [index, value] : pending_numbers_) {
    assign(index, value);
  }
  for (const auto& [name, value] : pending_names_) {
    Names& names = name.front() == '_' ? globals_ : local_names();
    names[name] = value;
  }
  drop();
}

void Parameters::drop() noexcept {
  pending_numbers_.clear();
  pending_names_.clear();
}

void Parameters::record_probe(const Axes& end) {
  for (int axis = 0; axis < kAxes; ++axis) {
    numbers_[static_cast<std::size_t>(kProbe) + static_cast<std::size_t>(axis)] =
        end[static_cast<std::size_t>(axis)] / (is_rotary(axis) ? 1.0 : state_->unit_mm);
  }
  numbers_[kProbe + kAxes] = 0.0;
}

void Parameters::enter(std::span<const double> arguments) {
  Call call;
  std::copy_n(numbers_.begin() + 1, kLocals, call.saved.begin());
  std::fill_n(numbers_.begin() + 1, kLocals, 0.0);
  std::ranges::copy(arguments, numbers_.begin() + 1);
  calls_.push_back(std::move(call));
}

void Parameters::enter_shared() {
  calls_.emplace_back().shared = true;
}

void Parameters::leave(const double* returned) {
  if (!calls_.back().shared) {
    std::ranges::copy(calls_.back().saved, numbers_.begin() + 1);
  }
  calls_.pop_back();
  record_value(returned);
}

void Parameters::record_value(const double* returned) noexcept {
  value_ = returned != nullptr ? *returned : 0.0;
  value_returned_ = returned != nullptr ? 1.0 : 0.0;
}

}  // namespace steadyrest::nc::interpret
