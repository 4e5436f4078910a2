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

/// Asks for the offsets that counter the machine's present displacement, cycle by cycle.
///
/// The forecast follows the machine, not the cyclogram: the frames' own time, spindle speed, path
/// speed and temperatures. A pause of the job is thus a pause of its heat. These inputs are handed
/// on once a second, speed and feed as means, and whenever cutting, coolant or spindle standstill
/// changes.
///
/// For each axis, with the displacement δ, the displacement plus the offset on the machine when the
/// workpiece's zero was set, r, and m the smaller of the two largest offsets of the machine file:
///   wish = clamp(r − δ, ±m),   at most as fast as slope
/// The envelope leads the offset there, at that slope or at its own slew, whichever is slower; what
/// it let pass comes in with the frame. In a thread, tap or probing move the slope is 0: the offset
/// is held. It is also held while a tool is in the cut if a temperature that the axis needs is
/// unknown or not believed (sensor_watch.hpp), if the spindle turns faster than 1.2 times the
/// fitted speed, or if its readings do not fit the model; once no tool is in the cut, the wish is
/// then 0. With unfit input the room withdraws. The slope is the machine file's whatever the
/// forecast does: no step that would mark the surface can come from here. A retract slope in the
/// machine file applies instead while no tool is in the cut, nothing is fed and nothing fades.
///
/// A probe reading in a frame is taken once, by its number. A reading already present in the first
/// frame after make(), reset() or restore() is ignored: nobody knows which offset it was made with.
/// A reading is the axis's error with the offset in force.
///
/// After a gap of more than a minute between frames the machine counts as stopped in between. Runs
/// in the cycle: bounded, noexcept, no allocation after make().
class OffsetGovernor {
 public:
  struct Config {
    std::vector<kernel::machine::Axis> axes;
    kernel::machine::Thermal thermal;
    double max_offset_mm = 0.2;  ///< the envelope's
  };

  /// What became of the last reading in a frame.
  struct Probed {
    kernel::signal::ProbeReading reading;  ///< number 0: none yet
    /// reason none: the axis is not corrected; input_out_of_range: the machine has no such axis
    StateFilter::Verdict verdict;
  };

  /// What the filters were given, summed up since the start: the cyclogram is its course.
  struct Fed {
    double time_s = 0.0;
    double turned_rev = 0.0;  ///< either way
    double path_mm = 0.0;
    double cut_s = 0.0;  ///< in feed moves
    double coolant_s = 0.0;
  };

  struct Output {
    kernel::signal::OffsetRequest request;
    kernel::signal::AxisValues displacement_mm{};  ///< forecast; 0 for axes without passport
    kernel::signal::AxisValues sd_mm{};
    Probed probed;
    Fed fed;
  };

  struct AxisState {
    StateFilter::State filter;
    double reference_mm = 0.0;  ///< r
    double applied_mm = 0.0;    ///< offset on the machine at the last update
  };

  /// What heats the machine, except for the temperatures.
  struct Running {
    double speed_rev_s = 0.0;
    double feed_mm_s = 0.0;
    bool cutting = false;
    bool coolant = false;
  };

  /// All of it except the number of the last probe reading, which a restart forgets on purpose.
  struct State {
    std::array<AxisState, kernel::signal::kMaxAxes> axis{};  ///< by the machine's axes
    Running drive;                                           ///< of the pending time
    double pending_s = 0.0;                                  ///< not yet passed to the filters
    double turned_rev = 0.0;                                 ///< ∫ speed over it
    double path_mm = 0.0;                                    ///< ∫ path speed over it
    double time_s = 0.0;
    bool started = false;
    SensorWatch::State sensors;
    double unwatched_s = 0.0;  ///< not yet passed to the watch
    kernel::signal::Temperatures temperature_c = kernel::signal::unknown_temperatures();
    Output last;
  };

  /// For the machine's axes with a thermal passport; rotary ones take no offset. Refuses unusable
  /// passports and more sensors than a frame holds.
  [[nodiscard]] static kernel::outcome::Result<OffsetGovernor> make(const Config& config);
  [[nodiscard]] static kernel::outcome::Result<OffsetGovernor> make(
      const kernel::machine::Machine& machine) {
    return make({.axes = machine.axes,
                 .thermal = machine.thermal,
                 .max_offset_mm = machine.envelope.max_offset_mm});
  }

  /// One cycle. `unfit`: why the frame must not be acted on, or none. `tool_in_cut`: by the state
  /// of the machine.
  const Output& update(const kernel::signal::Frame& frame, kernel::outcome::Reason unfit,
                       bool tool_in_cut, const kernel::signal::InForce& in_force) noexcept;

  /// The workpiece's zero has just been set: only changes from here on are corrected.
  void zero_here() noexcept;
  /// A probe finds the axis off by `reading` from its proper place, with the offset in force. Does
  /// nothing, with reason none, for an axis that is not corrected.
  StateFilter::Verdict measure(std::size_t axis, const StateFilter::Reading& reading) noexcept;
  /// The same, ignoring the gate.
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
    double applied_mm = 0.0;  ///< offset on the machine
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
  State state_;  ///< only state() fills in `axis` and `sensors`
  std::size_t sensors_ = 0;
  SensorWatch watch_;
  Drive drive_;  ///< input of a filter
  std::uint64_t probe_number_ = 0;
  bool probe_watched_ = false;  ///< a frame has been seen
};

}  // namespace steadyrest::thermal::online
