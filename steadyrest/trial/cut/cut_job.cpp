// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/signal/arriving.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>
#include <steadyrest/trial/cut/motion_score.hpp>
#include <steadyrest/trial/cut/true_error.hpp>

// One cut of a program on the simulated machine, with or without the layer. The judge is
// independent of both: it measures the true tool, which no control can see, against the program's
// path without the layer's offsets, or against that of the program it was made from.
namespace steadyrest::trial::cut {
namespace {

using contour::online::ContourError;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Frame;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;

constexpr double kStandstillLimit_s = 600.0;
constexpr std::uint64_t kCyclesBetweenProgress = 4096;

Point first_three(const kernel::signal::AxisValues& values) {
  return {values[0], values[1], values[2]};
}

/// The piece of path that the tool is on; null if there is none.
const PathSegment* segment_of(PathView path, const ContourError::Output& error) {
  const bool on_path = error.from_path && error.foot_index < path.size();
  return on_path ? &path[error.foot_index] : nullptr;
}

/// The motion that a sample counts for: it is a cut only if the control cuts, or waits while the
/// tool arrives, and the tool is there, on each path that is asked. Just after a rapid the tool
/// still lags on the rapid's path and leaves no surface.
Motion motion_of(Motion commanded, const PathSegment* segment) {
  return commanded == Motion::feed && segment != nullptr ? segment->motion : commanded;
}

Sample sample_of(const Frame& frame, Motion tool, const sim::Truth& truth,
                 const TrueError::Output& errors, const Original* original,
                 kernel::outcome::Reason reason) {
  const PathSegment* const segment = segment_of(frame.path, errors.own);
  Motion motion = motion_of(tool, segment);
  if (original != nullptr && errors.original) {
    motion = motion_of(motion, segment_of(original->path->segments, *errors.original));
  }
  const ContourError::Output& error = errors.original ? *errors.original : errors.own;
  const bool arc = segment != nullptr && segment->geometry == kernel::signal::Geometry::arc;
  return {.time_s = frame.time_s,
          .position_mm = first_three(truth.tool_mm),
          .path_position_mm = frame.path_position_mm,
          .contour_error_mm = error.valid ? error.error_mm : 0.0,
          .tracking_error_mm = errors.own.tracking_error_mm,
          .feed_ratio = frame.feed.effective_ratio,
          .path_speed_mm_s = frame.path_speed_mm_s,
          .arc_radius_mm = arc ? segment->radius_mm : 0.0,
          .arc_length_mm = arc ? segment->length_mm : 0.0,
          .line = segment != nullptr ? segment->line : frame.program_line,
          .motion = motion,
          .reason = reason};
}

/// It lags most.
double slowest_gain_1_s(const kernel::machine::Machine& machine) {
  return std::ranges::min(machine.axes, {}, &kernel::machine::Axis::servo_gain_1_s).servo_gain_1_s;
}

/// Ten simulated minutes without path, dwell or end: the part will never be finished.
class Standstill {
 public:
  // Neither place nor line changes: a 0 % override would otherwise simulate forever.
  [[nodiscard]] bool too_long(const Frame& frame) {
    if (frame.path_position_mm != position_mm_ || frame.program_line != line_) {
      position_mm_ = frame.path_position_mm;
      line_ = frame.program_line;
      since_s_ = frame.time_s;
    }
    return frame.time_s - since_s_ > kStandstillLimit_s;
  }

 private:
  double position_mm_ = -1.0;
  std::uint32_t line_ = 0;
  double since_s_ = 0.0;
};

// For the progress display only.
double length_of(const nc::plan::PlannedPath& path) {
  return path.segments.empty() ? 0.0
                               : path.segments.back().position_mm + path.segments.back().length_mm;
}

/// The product's own layer, acting, whatever the machine file says: a trial of a layer that only
/// observes would compare nothing.
Result<std::shared_ptr<supervisor::Supervisor>> make_supervisor(
    const Job& job, const kernel::port::Capability& capability) {
  auto made = supervisor::Supervisor::make(job.believed ? *job.believed : job.machine, capability);
  if (!made) {
    return std::unexpected(made.error());
  }
  auto layer = std::make_shared<supervisor::Supervisor>(std::move(*made));
  layer->set_mode(kernel::machine::Mode::act);
  if (job.listener && !layer->listen(*job.listener)) {
    return refuse("the machine has no spindle override to act against chatter with",
                  "add [override.spindle], or use --chatter machine");
  }
  return layer;
}

/// The probe readings that the thermal room receives.
class Probed {
 public:
  explicit Probed(const kernel::machine::Machine& machine) : machine_(machine) {}

  // The reading comes one cycle after its move, so the line is that of the last probing move.
  void look(const Sample& sample, const supervisor::Supervisor& layer, Recorder& record) {
    const auto& thermal = layer.estimates().thermal;
    if (!thermal || thermal->probed.reading.number == number_) {
      return;
    }
    const auto& [reading, verdict] = thermal->probed;
    number_ = reading.number;
    record.add_probe({.time_s = sample.time_s,
                      .line = line_,
                      .axis = reading.axis < machine_.axes.size() ? machine_.axes[reading.axis].name
                                                                  : std::string{},
                      .displacement_um = kernel::units::um_from_mm(reading.displacement_mm),
                      .innovation_um = kernel::units::um_from_mm(verdict.innovation_mm),
                      .band_um = kernel::units::um_from_mm(gate_sd_ * verdict.innovation_sd_mm),
                      .reason = verdict.reason});
  }
  /// The present line; the next cycle may bring its reading.
  void pass(const Sample& sample) noexcept {
    line_ = sample.motion == kernel::signal::Motion::probe ? sample.line : line_;
  }

 private:
  const kernel::machine::Machine& machine_;
  double gate_sd_ = thermal::online::StateFilter::Config{}.gate_sd;
  std::uint64_t number_ = 0;
  std::uint32_t line_ = 0;
};

// The layer as a function of the frame, so that cut() needs no supervisor and tests can insert
// their own.
Layer layer_of(const std::shared_ptr<supervisor::Supervisor>& layer, const Job& job) {
  return [layer, choices = job.choices, now = 0.0, begun = false](Frame& frame) mutable {
    // The choice goes with the programmed speed: sent once per change.
    if (!choices.empty() && frame.spindle_programmed_rev_s != now) {
      now = frame.spindle_programmed_rev_s;
      const ChatterChoice* choice = choice_for(choices, now);
      // A speed without a choice stays as programmed; a machine without a spindle override has no
      // modulator to tell.
      [[maybe_unused]] const bool told = layer->modulate(
          choice != nullptr ? choice->modulation
                            : chatter::online::Modulation{.law = chatter::online::Law::constant});
    }
    const kernel::signal::Command command = layer->update(frame);
    if (auto* const heat = layer->thermal(); heat != nullptr && !std::exchange(begun, true)) {
      heat->zero_here();  // the simulated machine starts at the part's zero
    }
    // With the layer's estimates, so that their error can be scored.
    frame.axis = layer->frame().axis;
    return command;
  };
}

Result<std::unique_ptr<sim::SimulatedMachine>> machine_of(const Job& job) {
  return sim::SimulatedMachine::make(
      {.machine = job.machine,
       .path = job.path,
       // The operator helps only the layer: without it the switch stays where it is.
       .operator_actions = job.with_layer ? operator_for(job.choices, job.machine)
                                          : std::vector<sim::OperatorAction>{},
       .cutting = job.cutting});
}

Result<void> cut(const Job& job, sim::SimulatedMachine& machine, const Layer& layer,
                 const OnSample& on_sample, MotionScore* motion = nullptr,
                 VibrationRecord* vibration = nullptr) {
  const auto against = job.against ? job.against : Original::of_itself(job.path);
  auto error = TrueError::make(job.machine, against);
  if (!error) {
    return std::unexpected(error.error());
  }
  Standstill standstill;
  kernel::signal::Arriving arriving(slowest_gain_1_s(job.machine));
  const double length_mm = std::max(length_of(*job.path), 1e-9);
  auto reason = kernel::outcome::Reason::none;
  while (!machine.finished() || arriving.cuts_on()) {
    const bool after_end = machine.finished();
    // The judge looks in every period, the layer as often as on the real machine.
    const bool layers_turn = machine.step();
    Frame frame = machine.frame();
    job.on_frame(frame);
    if (layer && layers_turn) {
      const kernel::signal::Command command = layer(frame);
      reason = command.feed_reason;
      if (command.write) {
        if (auto written = machine.write(command); !written) {
          return std::unexpected(written.error());
        }
      }
    }
    // After the layer has seen the frame: its estimates are scored.
    if (motion != nullptr && layers_turn && !after_end) {
      motion->add(frame, machine.truth().motor_mm_s, machine.truth().motor_mm_s2);
    }
    if (vibration != nullptr && layers_turn && machine.cutting() != nullptr && !after_end) {
      vibration->add(frame.time_s, frame.spindle_actual_rev_s, machine.cutting()->cycle());
    }
    // The truth is that at the end of this cycle; the command acts in the next.
    Sample sample = sample_of(frame, arriving.update(frame.motion, frame.time_s), machine.truth(),
                              error->update(frame, machine.truth()), against.get(), reason);
    sample.after_end = after_end;
    on_sample(sample);
    if (standstill.too_long(frame)) {
      return refuse("", frame.program_line, "no motion for ten simulated minutes in this line",
                    "look for a 0 % override or a very long dwell");
    }
    if (frame.cycle % kCyclesBetweenProgress == 0) {
      job.progress(frame.path_position_mm / length_mm);
    }
  }
  return {};
}

}  // namespace

// The supervisor outlives the cut: what it heard and probed is read after each sample.
Result<Recorder> run(const Job& job) {
  auto machine = machine_of(job);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  Layer layer;
  std::shared_ptr<supervisor::Supervisor> supervisor;
  if (job.with_layer) {
    auto made = make_supervisor(job, (*machine)->capability());
    if (!made) {
      return std::unexpected(made.error());
    }
    supervisor = std::move(*made);
    layer = layer_of(supervisor, job);
  }
  Recorder record({.limit_mm = job.machine.contour.limit_mm,
                   .cycle_s = job.machine.control.interpolator_period_s});
  auto motion = MotionScore::make(job.machine.axes, layer_cycle_s(job.machine));
  if (!motion) {
    return std::unexpected(motion.error());
  }
  VibrationRecord vibration;
  Probed probed(job.machine);
  const auto done = cut(
      job, **machine, layer,
      [&](const Sample& sample) {
        record.add(sample);
        if (supervisor) {
          probed.look(sample, *supervisor, record);
          probed.pass(sample);
        }
        if (supervisor && supervisor->estimates().heard) {
          const auto& heard = *supervisor->estimates().heard;
          record.add_heard({.time_s = sample.time_s,
                            .frequency_hz = heard.frequency_hz,
                            .spindle_ratio = heard.request.ratio});
        }
      },
      layer ? &*motion : nullptr, &vibration);
  if (!done) {
    return std::unexpected(done.error());
  }
  if (layer) {
    record.set_motion(motion->figures());
  }
  if (job.cutting) {
    record.set_vibration(std::move(vibration));
  }
  return record;
}

Result<void> run(const Job& job, const Layer& layer, const OnSample& on_sample) {
  auto machine = machine_of(job);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  return cut(job, **machine, layer, on_sample);
}

}  // namespace steadyrest::trial::cut
