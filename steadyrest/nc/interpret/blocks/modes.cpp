// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/blocks/modes.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/smoothing.hpp>

namespace steadyrest::nc::interpret {

// Lengths and feeds are converted as they are read; stored values are already in mm.
void Modes::units(const Step& step) noexcept {
  const int code = step.code(GGroup::units);
  if (code == kNoCode) {
    return;
  }
  // The feed's unit changes too, except after G70 and G71, which are for lengths only.
  state_.unit_mm = code == g::kInch ? kMmPerInch : 1.0;
  state_.unit_known = true;
  if (step.work_feed) {
    state_.feed_unit_mm = state_.unit_mm;
    state_.feed_unit_known = true;
  }
}

void Modes::plane_and_units(const Step& step) noexcept {
  const int plane = step.code(GGroup::plane);
  if (plane != kNoCode) {
    state_.plane = plane == g::kPlaneXy ? Plane::xy : plane == g::kPlaneZx ? Plane::zx : Plane::yz;
  }
  units(step);
  const int diameter = step.code(GGroup::lathe_diameter);
  if (diameter != kNoCode) {
    state_.diameter = diameter == g::kDiameter;
  }
}

void Modes::path(const Step& step) noexcept {
  if (control_.rules.rounding_distance) {
    smoothing(step);
  }
  switch (step.code(GGroup::path_mode)) {
    case g::kExactPath:
      state_.path_mode = PathMode::exact_path;
      state_.path_tolerance_mm = 0.0;
      break;
    case g::kExactStop:
      state_.path_mode = PathMode::exact_stop;
      state_.path_tolerance_mm = 0.0;
      break;
    case g::kContinuous:
      state_.path_mode = PathMode::continuous;
      // A negative P means "none given" on LinuxCNC.
      state_.path_tolerance_mm =
          step.has('P') && step['P'] > 0.0 ? step['P'] * state_.unit_mm : 0.0;
      state_.merge_tolerance_mm =
          step.has('Q') && step['Q'] >= 0.0 ? step['Q'] * state_.unit_mm : -1.0;
      break;
    default:
      break;
  }
  if (control_.rules.rounding_distance) {
    apply_smoothing(state_);
  }
}

// sinumerik: distances and tolerances stay in force from block to block, ready for a later G641 or
// G642; they come from words of their own.
void Modes::smoothing(const Step& step) noexcept {
  Smoothing& smoothing = state_.smoothing;
  if (step.rounding_mm >= 0.0) {
    smoothing.distance_mm = step.rounding_mm;
  }
  if (!step.named) {
    return;
  }
  const NamedWords& named = *step.named;
  if (!std::isnan(named.tolerance_mm)) {
    smoothing.tolerance_mm = named.tolerance_mm;
  }
  if (named.rounds_by >= 0) {
    smoothing.by_tolerance = named.rounds_by == 1;
  }
  if (named.compressor >= 0) {
    smoothing.compressor = named.compressor == 1;
  }
}

void Modes::distance_and_retract(const Step& step) noexcept {
  const int distance = step.code(GGroup::distance);
  if (distance != kNoCode) {
    state_.incremental = distance == g::kIncremental;
  }
  const int centre = step.code(GGroup::arc_centre);
  if (centre != kNoCode) {
    state_.centre_absolute = centre == g::kCentreAbsolute;
  }
  const int retract = step.code(GGroup::retract);
  if (retract != kNoCode) {
    state_.retract_to_initial = retract == g::kRetractToInitial;
  }
}

// M70 saves the modes until M72, M73 until the subprogram ends; M71 discards them. Each call has
// its own.
bool Modes::keep(const Step& step) {
  const int code = step.code(MGroup::modes);
  Kept& kept = kept_.back();
  switch (code) {
    case m::kKeepModes:
    case m::kKeepModesForCall:
      kept = {.state = state_, .restores_itself = code == m::kKeepModesForCall};
      return true;
    case m::kForgetModes:
      kept = {};
      return true;
    case m::kRestoreModes:
      if (!kept.state) {
        return refusals_.m_word(
            step, 72, "modes_not_kept",
            "M72 without saved modes; save them first with M70 or M73 in the same subprogram");
      }
      restore(*kept.state);
      return true;
    default:
      return true;
  }
}

// All modes but the motion mode; positions and offset values are not modes.
void Modes::restore(const State& kept) {
  state_.unit_mm = kept.unit_mm;
  state_.feed_unit_mm = kept.feed_unit_mm;
  state_.unit_known = kept.unit_known;
  state_.feed_unit_known = kept.feed_unit_known;
  state_.plane = kept.plane;
  state_.incremental = kept.incremental;
  state_.centre_absolute = kept.centre_absolute;
  state_.retract_to_initial = kept.retract_to_initial;
  state_.diameter = kept.diameter;
  state_.feed_mode = kept.feed_mode;
  state_.feed_mm_s = kept.feed_mm_s;
  state_.feed_deg_s = kept.feed_deg_s;
  state_.path_mode = kept.path_mode;
  state_.path_tolerance_mm = kept.path_tolerance_mm;
  state_.merge_tolerance_mm = kept.merge_tolerance_mm;
  state_.override_off = kept.override_off;
  state_.surface_speed = kept.surface_speed;
  state_.surface_speed_mm_s = kept.surface_speed_mm_s;
  state_.spindle_limit_rev_s = kept.spindle_limit_rev_s;
  state_.spindle_speed_rev_s = kept.spindle_speed_rev_s;
  state_.tool_offset = kept.tool_offset;
  // Only a change loads the offset's stored numbers: in the same system LinuxCNC keeps those in
  // force.
  if (state_.active_offset != kept.active_offset) {
    state_.active_offset = kept.active_offset;
    state_.work_in_force = state_.work_offset[kept.active_offset];
  }
  // Spindle and coolant really change, so events must follow.
  if (state_.spindle_direction != kept.spindle_direction) {
    state_.spindle_direction = kept.spindle_direction;
    out_.spindle();
  }
  if (state_.coolant != kept.coolant) {
    state_.coolant = kept.coolant;
    out_.event(EventKind::coolant, state_.coolant);
  }
  update_offset(state_);
}

void Modes::enter_call() {
  kept_.emplace_back();
}

// True when modes were restored, so the current move must be filled in again.
bool Modes::leave_call() {
  const Kept kept = kept_.back();
  kept_.pop_back();
  if (!kept.state || !kept.restores_itself) {
    return false;
  }
  restore(*kept.state);
  return true;
}

}  // namespace steadyrest::nc::interpret
