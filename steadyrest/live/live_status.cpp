// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <optional>

#include <steadyrest/live/live_status.hpp>

namespace steadyrest::live {
namespace {

/// By the room's last reason about heat: an unfit frame says nothing of the model.
bool switched_off(const thermal::online::OffsetGovernor::Output& heat, bool before) noexcept {
  using kernel::outcome::Reason;
  const Reason reason = heat.request.reason;
  const bool of_heat = reason == Reason::none || (reason >= Reason::thermal_correcting &&
                                                  reason <= Reason::thermal_model_unfit);
  return of_heat ? reason == Reason::thermal_model_unfit : before;
}

void look_at_rooms(const supervisor::Supervisor::Estimates& estimates, LiveStatus& into) noexcept {
  const auto& contour = estimates.contour;
  into.error_known = contour && contour->error_valid;
  into.contour_error_mm = into.error_known ? contour->error_mm : 0.0;
  into.feed_asked_ratio = contour ? contour->advised_ratio : 1.0;
  into.predicted_error_mm = contour ? contour->predicted_error_mm : 0.0;
  into.predicted_at_mm = contour ? contour->predicted_at_mm : 0.0;
  into.limit_used_mm = contour ? contour->limit_mm : 0.0;
  into.path_known = contour && contour->path_known;
  const auto& chatter = estimates.chatter;
  into.chatter_on = chatter.has_value();
  into.modulates = chatter && chatter->active;
  into.modulation_goal_ratio = chatter ? chatter->goal_ratio : 1.0;
  into.modulation_phase = chatter ? chatter->phase : 0.0;
  into.feed_per_tooth_ratio = chatter ? chatter->feed_per_tooth_ratio : 1.0;
  into.heat_on = estimates.thermal.has_value();
  into.heat_switched_off = into.heat_on && switched_off(*estimates.thermal, into.heat_switched_off);
  into.heat_fed = into.heat_on ? estimates.thermal->fed : into.heat_fed;
}

}  // namespace

void look_at(const supervisor::Supervisor& layer, LiveStatus& into) noexcept {
  const kernel::signal::Frame& frame = layer.frame();
  const auto in_force = layer.in_force();
  look_at_rooms(layer.estimates(), into);
  const auto* const modulation = layer.modulation();
  into.modulation = modulation != nullptr ? std::optional(*modulation) : std::nullopt;
  into.time_s = frame.time_s;
  into.mode_in_force = layer.mode_in_force();
  into.motion = frame.motion;
  into.program_line = frame.program_line;
  into.feed_ratio = in_force.feed.ratio;
  into.feed_panel_ratio = frame.feed.panel_ratio;
  into.feed_effective_ratio = frame.feed.effective_ratio;
  into.spindle_ratio = in_force.spindle.ratio;
  into.spindle_effective_ratio = frame.spindle.effective_ratio;
  into.path_speed_mm_s = frame.path_speed_mm_s;
  into.spindle_rev_s = frame.spindle_actual_rev_s;
  into.spindle_programmed_rev_s = frame.spindle_programmed_rev_s;
  into.offset_mm = in_force.offset_mm;
  into.path_offset_mm = in_force.path_offset_mm;
  into.axis_count = std::min<std::uint8_t>(frame.axis_count, kernel::signal::kMaxAxes);
  const auto& heat = layer.estimates().thermal;
  for (std::size_t i = 0; i < into.axis_count; ++i) {
    const kernel::signal::AxisSample& axis = frame.axis[i];
    into.axis[i] = {.position_au = axis.actual_mm,
                    .following_au = axis.following_error_mm,
                    .velocity_au_s = axis.velocity_mm_s,
                    .velocity_bound_au_s = axis.velocity_bound_mm_s,
                    .acceleration_au_s2 = axis.acceleration_mm_s2,
                    .acceleration_bound_au_s2 = axis.acceleration_bound_mm_s2,
                    .displacement_mm = heat ? heat->displacement_mm[i] : 0.0,
                    .displacement_sd_mm = heat ? heat->sd_mm[i] : 0.0};
  }
}

}  // namespace steadyrest::live
