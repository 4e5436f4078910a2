// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/in_force.hpp>
#include <steadyrest/kernel/signal/request.hpp>
#include <steadyrest/thermal/online/sensor_watch.hpp>
#include <steadyrest/thermal/online/state_filter.hpp>

namespace steadyrest::thermal::online {

/// Asks for the offsets that work against the displacement that the machine has now, cycle by
/// cycle.
///
/// The forecast is driven by what the machine does, not by the cyclogram: by the frames' own time,
/// spindle speed, path speed and temperatures. So a pause of the job is a pause of its heat. What
/// drives it is handed on once a second, speed and feed by their mean, and where cutting, coolant
/// or the standing of the spindle changes.
///
/// For each axis, with the displacement δ, the displacement r at which the workpiece's zero was
/// set, and m the smaller of the two largest offsets of the machine file:
///   wish = clamp(r − δ, ±m),   and no faster than slope
/// The envelope leads the offset there, by that slope or by its own slew, whichever is slower; what
/// it has let through comes in with the frame. In a thread, tap or probing move the slope is 0: the
/// offset is held. While a temperature is not known or not believed (sensor_watch.hpp) that the
/// axis needs, while the spindle turns faster than 1.2 times what was fitted, and while its
/// readings do not fit the model, it is held as long as a tool is in the cut; once none is, the
/// wish is 0. With unfit input the room withdraws. The slope is that of the machine file whatever
/// the forecast does: no step that would mark the surface can come from here. Where the machine
/// file gives a retract slope, that one holds instead while no tool is in the cut, nothing is fed
/// and nothing fades.
///
/// A probe reading that a frame brings is taken once, by its number. What stood there in the first
/// frame after make(), reset() or restore() is not: nobody knows with which offset it was made. A
/// reading says how far the axis is off with the offset that is in force.
///
/// After a gap of more than a minute between frames the machine counts as having stood meanwhile.
/// Online code: bounded, noexcept, no allocation after make().
class OffsetGovernor {
 public:
  struct Config {
    std::vector<kernel::machine::Axis> axes;
    kernel::machine::Thermal thermal;
    double max_offset_mm = 0.2;  ///< of the envelope
  };

  /// What became of the last reading that a frame brought.
  struct Probed {
    kernel::signal::ProbeReading reading;  ///< number 0: none yet
    /// reason none: the axis is not corrected; input_out_of_range: the machine has no such axis
    StateFilter::Verdict verdict;
  };

  struct Output {
    kernel::signal::OffsetRequest request;
    kernel::signal::AxisValues displacement_mm{};  ///< forecast; 0 for axes without passport
    kernel::signal::AxisValues sd_mm{};
    Probed probed;
  };

  struct AxisState {
    StateFilter::State filter;
    double reference_mm = 0.0;  ///< r
    double standing_mm = 0.0;   ///< offset on the machine at the last update
  };

  /// What heats the machine but for the temperatures.
  struct Running {
    double speed_rev_s = 0.0;
    double feed_mm_s = 0.0;
    bool cutting = false;
    bool coolant = false;
  };

  /// All of it but for the number of the last probe reading, which a restart forgets by intent.
  struct State {
    std::array<AxisState, kernel::signal::kMaxAxes> axis{};  ///< by the machine's axes
    Running drive;                                           ///< of the time that is pending
    double pending_s = 0.0;   ///< the filters have not been told of yet
    double turned_rev = 0.0;  ///< ∫ speed over it
    double path_mm = 0.0;     ///< ∫ path speed over it
    double time_s = 0.0;
    bool started = false;
    SensorWatch::State sensors;
    double unwatched_s = 0.0;  ///< the watch has not been told of yet
    kernel::signal::Temperatures temperature_c = kernel::signal::unknown_temperatures();
    Output last;
  };

  /// For the axes of the machine that have a thermal passport; rotary ones take no offset. Refuses
  /// passports that cannot be used and more sensors than a frame holds.
  [[nodiscard]] static kernel::outcome::Result<OffsetGovernor> make(const Config& config);
  [[nodiscard]] static kernel::outcome::Result<OffsetGovernor> make(
      const kernel::machine::Machine& machine) {
    return make({.axes = machine.axes,
                 .thermal = machine.thermal,
                 .max_offset_mm = machine.envelope.max_offset_mm});
  }

  /// One cycle. `unfit`: why the frame must not be acted on, or none. `tool_in_cut`: by what is
  /// known of the machine.
  const Output& update(const kernel::signal::Frame& frame, kernel::outcome::Reason unfit,
                       bool tool_in_cut, const kernel::signal::InForce& in_force) noexcept;

  /// The workpiece's zero has just been set: from here on only what changes is corrected.
  void zero_here() noexcept;
  /// A probe finds the axis off by `reading` from where it should be, with the offset that stands.
  /// Nothing, with reason none, for an axis that is not corrected.
  StateFilter::Verdict measure(std::size_t axis, const StateFilter::Reading& reading) noexcept;
  /// The same, taken whatever the gate says.
  void rezero(std::size_t axis, const StateFilter::Reading& reading) noexcept;

  [[nodiscard]] const Output& output() const noexcept { return state_.last; }
  [[nodiscard]] State state() const noexcept;
  /// Whatever is not finite starts over; a wish beyond the clamp is cut to it.
  void restore(const State& state) noexcept;
  /// Cold.
  void reset() noexcept;

 private:
  struct Axis {
    std::size_t index = 0;
    double max_speed_rev_s = 0.0;  ///< 0 = not known
    std::size_t ambients = 0;
    std::array<std::size_t, kMaxThermalAmbients> sensor{};  ///< in the frame
    StateFilter filter;
    double reference_mm = 0.0;
    double standing_mm = 0.0;  ///< offset on the machine
  };

  OffsetGovernor() = default;
  void probe(const kernel::signal::Frame& frame) noexcept;
  void drive_on(const kernel::signal::Frame& frame) noexcept;
  void step() noexcept;
  void step(double elapsed_s, const Running& running) noexcept;
  [[nodiscard]] Axis* find(std::size_t axis) noexcept;
  [[nodiscard]] kernel::outcome::Reason fault(const Axis& axis,
                                              const kernel::signal::Frame& frame) const noexcept;
  kernel::outcome::Reason ask(const Axis& axis, const kernel::signal::Frame& frame,
                              bool tool_in_cut, double let_through_mm) noexcept;

  std::vector<Axis> axes_;
  double max_offset_mm_ = 0.0;
  double slope_mm_s_ = 0.0;
  double retract_slope_mm_s_ = 0.0;
  State state_;  ///< `axis` and `sensors` are filled in by state() alone
  std::size_t sensors_ = 0;
  SensorWatch watch_;
  Drive drive_;  ///< what a filter is handed
  std::uint64_t probe_number_ = 0;
  bool probe_watched_ = false;  ///< a frame has been seen
};

}  // namespace steadyrest::thermal::online
