// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/sim/heat/thermal_growth.hpp>
#include <steadyrest/trial/batch/acting_layer.hpp>
#include <steadyrest/trial/batch/batch.hpp>
#include <steadyrest/trial/batch/believed_axis.hpp>
#include <steadyrest/trial/batch/text_shifts.hpp>

// A batch second by second: the true machine grows, the belief about it is updated along with it,
// and three ways of cutting (uncorrected, corrected text, layer on line) are judged on the same
// growth. Before each part the probe measures and a new text is written, as in a shop.
namespace steadyrest::trial::batch {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kStep_s = 1.0;
constexpr std::uint64_t kStepsOfPoint = 20;

/// Largest value and RMS, over the cutting seconds only.
class Sum {
 public:
  void add(double error_mm) noexcept {
    largest_mm_ = std::max(largest_mm_, error_mm);
    squares_ += error_mm * error_mm;
    ++count_;
  }
  [[nodiscard]] Error error() const noexcept {
    return {.largest_mm = largest_mm_,
            .rms_mm = count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0};
  }

 private:
  double largest_mm_ = 0.0;
  double squares_ = 0.0;
  std::size_t count_ = 0;
};

/// Transitions in sequence, queried in ascending time; no search from the start.
class Clockwork {
 public:
  explicit Clockwork(const std::vector<nc::plan::Transition>& cyclogram) : cyclogram_(cyclogram) {}
  const nc::plan::Transition* at(double time_s) noexcept {
    while (now_ < cyclogram_.size() &&
           time_s >= cyclogram_[now_].start_s + cyclogram_[now_].seconds) {
      ++now_;
    }
    return now_ < cyclogram_.size() ? &cyclogram_[now_] : nullptr;
  }

 private:
  const std::vector<nc::plan::Transition>& cyclogram_;
  std::size_t now_ = 0;
};

class Day {
 public:
  Day(const Job& job, sim::ThermalGrowth growth, ActingLayer layer, std::vector<BelievedAxis> axes,
      Trace original)
      : job_(job),
        growth_(std::move(growth)),
        layer_(std::move(layer)),
        axes_(std::move(axes)),
        original_(std::move(original)),
        cyclogram_(thermal::offline::cyclogram_of(job.cyclogram, job.program)) {
    for (const BelievedAxis& axis : axes_) {
      out_.axis.push_back(axis.name());
    }
    const kernel::machine::Thermal& thermal = job.machine.thermal;
    out_.band_mm = thermal.share[thermal.level] * job.tolerance_mm;
    out_.program_s = cyclogram_.total_s();
    layer_.begin(growth_.read_room_c());
  }

  Result<Batch> run() {
    for (number_ = 1; number_ <= job_.parts; ++number_) {
      if (auto done = part(); !done) {
        return std::unexpected(done.error());
      }
      const bool is_break = job_.break_after > 0 && number_ % job_.break_after == 0;
      if (number_ < job_.parts) {
        rest(job_.pause_s + (is_break ? job_.break_s : 0.0));
      }
      job_.progress(static_cast<double>(number_) / job_.parts);
    }
    for (std::size_t way = 0; way < kWays; ++way) {
      out_.error[way] = whole_[way].error();
    }
    out_.total_s = growth_.time_s();
    return std::move(out_);
  }

 private:
  Result<void> part() {
    Part now;
    now.start_s = growth_.time_s();
    for (BelievedAxis& axis : axes_) {
      // The zero has just been set before the first part. One reading for all: text and layer must
      // learn from the same measurement.
      now.probe_mm.push_back(
          number_ == 1 ? 0.0 : growth_.read_probe_mm(growth_.displacement_mm(axis.index())));
      if (number_ > 1) {
        axis.measure(now.probe_mm.back());
        // The probe finds what the offset has left. The belief is about the growth alone, the probe
        // finds growth and offset together.
        layer_.probe(axis.row(), now.probe_mm.back() + offset_mm(axis),
                     job_.machine.simulation.probe_noise_mm);
      }
    }
    const auto text = corrected();
    if (!text) {
      return std::unexpected(text.error());
    }
    now.corrections = text->insertions;
    cut(*text, now);
    now.at_end_mm = growth_.displacement_mm(axes_.front().index());
    out_.part.push_back(std::move(now));
    return {};
  }

  /// This part's text, from the present belief.
  Result<ShiftedProgram> corrected() const {
    nc::rewrite::Plan plan;
    plan.file = job_.program;
    plan.total_s = out_.program_s;
    for (const BelievedAxis& axis : axes_) {
      auto steps = axis.plan(cyclogram_, job_.tolerance_mm);
      if (!steps) {
        return std::unexpected(steps.error());
      }
      if (!steps->steps.empty()) {
        plan.axes.push_back(*std::move(steps));
      }
    }
    // Nothing leaves the band: the program stays unchanged.
    if (plan.axes.empty()) {
      return ShiftedProgram{.shift = {}, .total_s = original_.total_s, .insertions = 0};
    }
    return shifted_program(job_.program, original_, plan, job_.config, job_.machine, job_.settings);
  }

  void cut(const ShiftedProgram& text, Part& now) {
    Clockwork clockwork(job_.cyclogram);
    std::array<Sum, kWays> sums;
    std::size_t shift = 0;
    const auto steps = static_cast<std::uint64_t>(std::ceil(out_.program_s / kStep_s));
    for (std::uint64_t i = 0; i < steps; ++i) {
      const double time_s = (static_cast<double>(i) + 1.0) * kStep_s;
      // The middle of the second decides to which transition it belongs.
      const nc::plan::Transition* transition = clockwork.at(time_s - 0.5 * kStep_s);
      const bool cuts = transition != nullptr && transition->load() == nc::plan::Load::cutting;
      step(transition, cuts);
      // A correction acts from the move that carries it.
      while (shift < text.shift.size() && text.shift[shift].time_s <= time_s) {
        ++shift;
      }
      const auto left = errors(shift > 0 ? text.shift[shift - 1].mm : nc::interpret::Axes{});
      if (cuts) {
        for (std::size_t way = 0; way < kWays; ++way) {
          sums[way].add(left[way]);
          whole_[way].add(left[way]);
        }
      }
      note(shift > 0 ? text.shift[shift - 1].mm : nc::interpret::Axes{}, cuts);
    }
    for (std::size_t way = 0; way < kWays; ++way) {
      now.error[way] = sums[way].error();
    }
  }

  // Spindle off: the machine cools. Part 0 in the trace marks the pause.
  void rest(double seconds) {
    const auto steps = static_cast<std::uint64_t>(std::round(seconds / kStep_s));
    const std::uint32_t part = std::exchange(number_, 0U);
    for (std::uint64_t i = 0; i < steps; ++i) {
      step(nullptr, false);
      note({}, false);
    }
    number_ = part;
  }

  /// One second of the machine and of the belief about it.
  void step(const nc::plan::Transition* transition, bool cuts) {
    const double speed_rev_s = transition != nullptr ? transition->speed_rev_s : 0.0;
    const double feed_mm_s = transition != nullptr ? transition->path_speed_mm_s() : 0.0;
    const double share = cuts ? transition->cut_share() : 0.0;
    const bool coolant = transition != nullptr && transition->coolant;
    // The reading before the step: the one a control would have at that time.
    const double room_c = growth_.read_room_c();
    growth_.update(
        {.speed_rev_s = speed_rev_s, .feed_mm_s = feed_mm_s, .cutting = share, .coolant = coolant});
    for (BelievedAxis& axis : axes_) {
      axis.update(kStep_s,
                  {.speed_rev_s = speed_rev_s,
                   .feed_mm_s = feed_mm_s,
                   .cutting = cuts,
                   .cutting_share = share,
                   .coolant = coolant},
                  room_c);
    }
    layer_.pass({.speed_rev_s = speed_rev_s,
                 .feed_mm_s = feed_mm_s,
                 .cutting = share,
                 .coolant = coolant,
                 .room_c = room_c});
    ++step_;
  }

  [[nodiscard]] double offset_mm(const BelievedAxis& axis) const noexcept {
    return layer_.offset_mm(axis.row());
  }

  // The length of the error vector; with a correction, of the remainder.
  std::array<double, kWays> errors(const nc::interpret::Axes& text_mm) const {
    std::array<double, kWays> squares{};
    for (const BelievedAxis& axis : axes_) {
      const double grown = growth_.displacement_mm(axis.index());
      squares[0] += grown * grown;
      squares[1] += std::pow(grown + text_mm[axis.column()], 2);
      squares[2] += std::pow(grown + offset_mm(axis), 2);
    }
    for (double& value : squares) {
      value = std::sqrt(value);
    }
    return squares;
  }

  void note(const nc::interpret::Axes& text_mm, bool cuts) {
    if (step_ % kStepsOfPoint != 0) {
      return;
    }
    const BelievedAxis& axis = axes_.front();
    const double grown = growth_.displacement_mm(axis.index());
    out_.point.push_back(
        {.time_s = growth_.time_s(),
         .part = number_,
         .cutting = cuts,
         .displacement_mm = grown,
         .left_mm = {grown, grown + text_mm[axis.column()], grown + offset_mm(axis)},
         .model_mm = axis.displacement_mm(),
         .model_sd_mm = axis.sd_mm(),
         .room_c = growth_.room_c()});
  }

  const Job& job_;
  sim::ThermalGrowth growth_;
  ActingLayer layer_;
  std::vector<BelievedAxis> axes_;
  Trace original_;
  thermal::offline::Cyclogram cyclogram_;
  Batch out_;
  std::array<Sum, kWays> whole_;
  std::uint32_t number_ = 0;
  std::uint64_t step_ = 0;
};

Result<std::vector<BelievedAxis>> believed(const Job& job) {
  std::vector<BelievedAxis> out;
  // Displacements that no axis can correct (a tilt) stay in the machine file.
  for (std::size_t i = 0; i < job.machine.thermal.axis.size(); ++i) {
    const std::string& name = job.machine.thermal.axis[i].name;
    const bool moved = std::ranges::any_of(
        job.machine.axes, [&](const auto& axis) { return axis.present && axis.name == name; });
    if (!moved) {
      continue;
    }
    auto axis = BelievedAxis::make(job.machine, i);
    if (!axis) {
      return std::unexpected(axis.error());
    }
    out.push_back(*std::move(axis));
  }
  if (out.empty()) {
    return refuse(
        job.machine.file, "the machine file has no [[thermal.axis]] for any of its axes",
        "add [[thermal.axis]] with the name of an axis: `steadyrest thermal fit` writes it");
  }
  return out;
}

}  // namespace

double Batch::improvement(Way way) const noexcept {
  // A zero error would make the improvement infinite.
  return error[0].largest_mm / std::max(error[static_cast<std::size_t>(way)].largest_mm, 1e-9);
}

// A correction that makes a single part worse has failed there, however good the mean.
std::size_t Batch::worse(Way way) const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(part, [&](const Part& p) {
    return p.error[static_cast<std::size_t>(way)].largest_mm > p.error[0].largest_mm;
  }));
}

// Only axes that can be corrected are judged.
Result<Batch> run(const Job& job) {
  auto axes = believed(job);
  if (!axes) {
    return std::unexpected(axes.error());
  }
  auto growth = sim::ThermalGrowth::make(
      {.passport = job.machine.thermal, .simulation = job.machine.simulation, .period_s = kStep_s});
  if (!growth) {
    return std::unexpected(growth.error());
  }
  auto original = trace(job.program, job.config, job.machine);
  if (!original) {
    return std::unexpected(original.error());
  }
  auto layer = ActingLayer::make(job.machine);
  if (!layer) {
    return std::unexpected(layer.error());
  }
  return Day(job, *std::move(growth), *std::move(layer), *std::move(axes), *std::move(original))
      .run();
}

}  // namespace steadyrest::trial::batch
