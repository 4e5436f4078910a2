// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/cycle/klartext_hole.hpp>

// Which cycle is in force, its values, and when it runs.
namespace steadyrest::nc::interpret {
namespace {

constexpr double kKlartextRapid = 99999.0;
constexpr double kLargestHeight_mm = 1e7;
constexpr std::array kQCycles = {200, 201, 203, 205, 206, 207, 240};
constexpr int kOldPeck = 1;
constexpr int kPlaneCycle = 19;
/// Values 1 to 5 of the old cycle 1 at their bits.
constexpr std::uint32_t kOldPeckValues = 0b111110;

std::string cycle_named(int number) {
  return "CYCL DEF " + std::to_string(number);
}

}  // namespace

bool KlartextCycles::define(const Step& step) {
  const KlartextStep& own = step.klartext;
  KlartextState& state = state_.klartext;
  if (own.part > 0) {
    return define_part(step);
  }
  // A cycle that acts at once leaves the one for CYCL CALL in force.
  const bool q_cycle = std::ranges::find(kQCycles, own.cycle) != kQCycles.end();
  const bool acts_at_once =
      own.cycle == 9 || own.cycle == 13 || own.cycle == kPlaneCycle || own.cycle == 32;
  if (own.part == 0 && acts_at_once) {
    return true;
  }
  if (!(q_cycle && own.part < 0) && !(own.cycle == kOldPeck && own.part == 0)) {
    return refusals_.block(
        step, "cycle_not_interpreted",
        cycle_named(own.cycle) +
            " is not interpreted; 1, 7 to 10, 13, 32, 200, 201, 203, 205 to 207, "
            "240 and 247 are");
  }
  state.cycle = own.cycle;
  state.cycle_modal = false;
  state.cycle_ready = q_cycle && own.complete;
  state.cycle_given = 0;
  return true;
}

// CYCL DEF n.k with its value.
bool KlartextCycles::define_part(const Step& step) {
  const KlartextStep& own = step.klartext;
  KlartextState& state = state_.klartext;
  switch (own.cycle) {
    case kOldPeck: {
      if (state.cycle != kOldPeck || own.part > 5 || !own.has_value) {
        return refusals_.block(step, "cycle_value", "a value that does not belong to CYCL DEF 1");
      }
      state.cycle_parts[static_cast<std::size_t>(own.part)] = own.value;
      state.cycle_given |= 1U << static_cast<unsigned>(own.part);
      state.cycle_ready = state.cycle_given == kOldPeckValues;
      return true;
    }
    case 9:
      if (!own.has_value || !(own.value >= 0.0 && own.value <= 1e6)) {
        return refusals_.block(step, "dwell_missing",
                               "a dwell (CYCL DEF 9.1) without its time from 0 to 1000000 s");
      }
      out_.dwell(own.value);
      return true;
    case 13:           // orientation of the spindle: nothing moves
    case kPlaneCycle:  // only with angles of zero
      return true;
    case 32:  // 32.2 chooses finishing or roughing
      if (own.part == 1) {
        if (own.has_value && !(own.value >= 0.0 && own.value <= 1e3)) {
          return refusals_.block(step, "out_of_range", "a tolerance outside 0 to 1000");
        }
        state_.path_mode = PathMode::continuous;
        state_.path_tolerance_mm = own.has_value ? own.value * state_.unit_mm : 0.0;
      }
      return true;
    default:
      break;
  }
  return refusals_.block(step, "cycle_not_interpreted",
                         cycle_named(own.cycle) + " is not interpreted");
}

bool KlartextCycles::optional(int number, double& out) const {
  return q_ != nullptr && q_->number(number, out) == read::Lookup::found;
}

bool KlartextCycles::value(const Step& step, int number, double& out) {
  return optional(number, out) ||
         refusals_.block(step, "cycle_value_missing",
                         "a cycle (CYCL DEF) without its value Q" + std::to_string(number));
}

// In mm/min, in inch programs 0.1 inch/min; 99999 is FMAX, stored as 0.
bool KlartextCycles::feed(const Step& step, int number, double& feed_mm_s) {
  double written = 0.0;
  if (!value(step, number, written)) {
    return false;
  }
  const double unit = state_.unit_mm != 1.0 ? 0.1 * kMmPerInch : 1.0;
  feed_mm_s = written >= kKlartextRapid ? 0.0 : written * unit / 60.0;
  return written > 0.0 ||
         refusals_.block(step, "feed_missing",
                         cycle_named(state_.klartext.cycle) + " with a feed of zero (Q" +
                             std::to_string(number) + ")");
}

// Not every control has every dwell: one that is not given is none.
bool KlartextCycles::dwell(const Step& step, int number, double& seconds) {
  seconds = 0.0;
  static_cast<void>(optional(number, seconds));
  return (seconds >= 0.0 && seconds <= 1e6) ||
         refusals_.block(step, "out_of_range",
                         "a dwell outside 0 to 1000000 s (Q" + std::to_string(number) + ")");
}

bool KlartextCycles::measure(const Step& step, Hole& hole) {
  double clearance = 0.0;
  double depth = 0.0;
  double surface = 0.0;
  double second = 0.0;
  if (!value(step, 200, clearance) || !value(step, 201, depth) || !value(step, 203, surface) ||
      !value(step, 204, second)) {
    return false;
  }
  const double unit = state_.unit_mm;
  hole.normal = axes_of(state_.plane).normal;
  hole.clearance_mm = clearance * unit;
  hole.surface_mm = surface * unit;
  hole.clear_mm = hole.surface_mm + hole.clearance_mm;
  hole.bottom_mm = hole.surface_mm + depth * unit;
  hole.second_mm = hole.surface_mm + std::max(clearance, second) * unit;
  for (const double height : {hole.clear_mm, hole.bottom_mm, hole.second_mm}) {
    if (!(std::abs(height) <= kLargestHeight_mm)) {
      return refusals_.block(
          step, "out_of_range",
          "a value too large for any machine; allowed: up to 10000000 in magnitude");
    }
  }
  // A positive depth is an error or a hole upwards, as the control is set.
  return (clearance >= 0.0 && depth < 0.0) ||
         refusals_.block(step, "cycle_planes",
                         "a cycle whose clearance (Q200) is below 0 or whose depth (Q201) is not "
                         "below 0");
}

bool KlartextCycles::check_position(const Step& step) {
  Hole hole;
  if (state_.klartext.cycle < 200) {
    return refusals_.block(step, "cycle_position", "CYCL CALL POS with a cycle of the old kind");
  }
  if (!measure(step, hole)) {
    return false;
  }
  return state_.position[hole.normal] >= hole.clear_mm ||
         refusals_.block(step, "cycle_position",
                         "CYCL CALL POS below the set-up clearance; move the tool above it first");
}

bool KlartextCycles::run(const Step& step) {
  if (state_.klartext.cycle == 0 || !state_.klartext.cycle_ready) {
    return refusals_.block(step, "no_cycle", "the call of a cycle, but none is defined completely");
  }
  Hole hole;
  if (state_.klartext.cycle == kOldPeck) {
    return old_peck(step);
  }
  if (!measure(step, hole)) {
    return false;
  }
  const double feed_before = state_.feed_mm_s;
  out_.along(MoveKind::rapid, hole.normal, hole.clear_mm);
  bool accepted = false;
  switch (state_.klartext.cycle) {
    case 200:
      accepted = drill(step, hole);
      break;
    case 201:
      accepted = ream(step, hole);
      break;
    case 203:
      accepted = universal_drill(step, hole);
      break;
    case 205:
      accepted = universal_peck(step, hole);
      break;
    case 206:
      accepted = tap(step, hole);
      break;
    case 240:
      accepted = centre(step, hole);
      break;
    default:
      accepted = rigid_tap(step, hole);
      break;
  }
  state_.feed_mm_s = feed_before;
  return accepted;
}

}  // namespace steadyrest::nc::interpret
