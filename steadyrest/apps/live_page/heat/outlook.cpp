// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/apps/live_page/heat/outlook.hpp>
#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/supervisor/settings.hpp>
#include <steadyrest/thermal/online/offset_governor.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Machine;
using kernel::override::OffsetEnvelope;
using kernel::signal::Frame;
using kernel::signal::Motion;
using steadyrest::live::HeatNow;
using thermal::online::OffsetGovernor;

constexpr double kStep_s = 1.0;  ///< the room steps its filters no more often
constexpr double kShown_s = 60.0;

/// What a second of the future is like, by its number. Within a stretch the cut comes first: a
/// second is in the cut or not, as the room's levels are.
class Future {
 public:
  Future(std::span<const Stretch> again, const OffsetGovernor::Running& now) : now_(now) {
    for (const Stretch& stretch : again) {
      const double seconds = std::max(1.0, std::round(stretch.seconds));
      for (double n = 0.0; n < seconds; n += kStep_s) {
        second_.push_back({.speed_rev_s = stretch.speed_rev_s,
                           .feed_mm_s = stretch.feed_mm_s,
                           .cutting = n + 0.5 < stretch.cut_share * seconds,
                           .coolant = n + 0.5 < stretch.coolant_share * seconds});
      }
    }
  }
  [[nodiscard]] const OffsetGovernor::Running& at(std::size_t n) const noexcept {
    return second_.empty() ? now_ : second_[n % second_.size()];
  }
  [[nodiscard]] double seconds() const noexcept {
    return kStep_s * static_cast<double>(second_.size());
  }

 private:
  OffsetGovernor::Running now_;
  std::vector<OffsetGovernor::Running> second_;
};

Frame frame_of(const HeatNow& now, const OffsetGovernor::Running& does) {
  Frame frame;
  frame.spindle_actual_rev_s = does.speed_rev_s;
  frame.path_speed_mm_s = does.feed_mm_s;
  frame.motion = does.cutting ? Motion::feed : Motion::rapid;
  frame.coolant = does.coolant;
  frame.temperature_c = now.state.temperature_c;
  return frame;
}

std::optional<OffsetGovernor> room_of(const Machine& machine, const HeatNow& now) {
  auto room = OffsetGovernor::make(machine);
  if (!now.on || !room) {
    return std::nullopt;
  }
  OffsetGovernor::State state = now.state;
  state.sensors = {};  // temperatures that stay would look stuck
  room->restore(state);
  return std::move(*room);
}

std::optional<OffsetEnvelope> envelope_of(const Machine& machine, const HeatNow& now) {
  auto config = supervisor::offset_config(machine, true);
  config.max_step_s = std::max(config.max_step_s, kStep_s);
  auto envelope = OffsetEnvelope::make(config);
  if (!envelope) {
    return std::nullopt;
  }
  envelope->restore({.offset_mm = now.offset_mm});
  return *envelope;
}

std::vector<Outlook::Axis> axes_of(const Machine& machine) {
  std::vector<Outlook::Axis> out;
  for (std::size_t i = 0; i < std::min(machine.axes.size(), kernel::signal::kMaxAxes); ++i) {
    const bool has =
        std::ranges::find(machine.thermal.axis, machine.axes[i].name,
                          &kernel::machine::ThermalAxis::name) != machine.thermal.axis.end();
    if (has && !machine.axes[i].rotary) {
      out.push_back({.index = i, .displacement_mm = {}, .sd_mm = {}, .offset_mm = {}});
    }
  }
  return out;
}

void note(Outlook& into, double in_s, const OffsetGovernor::Output& seen,
          const kernel::signal::AxisValues& offset_mm) {
  into.in_s.push_back(in_s);
  for (Outlook::Axis& axis : into.axis) {
    axis.displacement_mm.push_back(seen.displacement_mm[axis.index]);
    axis.sd_mm.push_back(seen.sd_mm[axis.index]);
    axis.offset_mm.push_back(offset_mm[axis.index]);
  }
}

}  // namespace

std::optional<Outlook> outlook(const Machine& machine, const HeatNow& now,
                               std::span<const Stretch> again, bool corrects,
                               const Corrections& done, double seconds) {
  auto room = room_of(machine, now);
  auto envelope = envelope_of(machine, now);
  if (!room || !envelope) {
    return std::nullopt;
  }
  const Future future(again, now.state.drive);
  Outlook out{.again_s = future.seconds(), .in_s = {}, .axis = axes_of(machine), .to_come = {}};
  Corrections moves = done.from_here();
  note(out, 0.0, room->output(), now.offset_mm);
  const auto steps = static_cast<std::size_t>(seconds / kStep_s);
  for (std::size_t n = 1; n <= steps; ++n) {
    const double in_s = kStep_s * static_cast<double>(n);
    Frame frame = frame_of(now, future.at(n - 1));
    frame.time_s = now.state.time_s + in_s;
    const bool in_cut = frame.motion == Motion::feed;
    const auto& seen = room->update(
        frame, kernel::outcome::Reason::none, in_cut,
        {.offset_mm = envelope->state().offset_mm, .active = corrects, .written = corrects});
    if (corrects) {
      envelope->update({.step_s = kStep_s, .request = seen.request, .tool_in_cut = in_cut});
    }
    const auto& offset_mm = envelope->state().offset_mm;
    moves.see(in_s, offset_mm, machine.axes.size());
    if (std::fmod(in_s, kShown_s) == 0.0) {
      note(out, in_s, seen, offset_mm);
    }
  }
  out.to_come.assign(moves.list().begin(), moves.list().end());
  return out;
}

}  // namespace steadyrest::apps::live_page
