// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <steadyrest/thermal/offline/plan/curve.hpp>
#include <steadyrest/thermal/offline/plan/plan.hpp>
#include <steadyrest/trial/batch/believed_axis.hpp>

// What a shop that plans in the text knows of an axis: the passport, the probe's readings, and the
// filter that combines them. Never the simulation's truth.
namespace steadyrest::trial::batch {

using kernel::outcome::Result;
using thermal::online::StateFilter;
using thermal::online::ThermalModel;

namespace {

constexpr std::string_view kLetters = "XYZABCUVW";
/// How wrong a passport may be before readings prove it: 20 % of its levels.
constexpr double kGainSd = 0.2;

}  // namespace

Result<BelievedAxis> BelievedAxis::make(const kernel::machine::Machine& machine,
                                        std::size_t index) {
  auto filter = StateFilter::make({.axis = machine.thermal.axis[index], .gain_sd_ratio = kGainSd});
  if (!filter) {
    return std::unexpected(filter.error());
  }
  return BelievedAxis(machine, index, *std::move(filter));
}

BelievedAxis::BelievedAxis(const kernel::machine::Machine& machine, std::size_t index,
                           StateFilter filter)
    : passport_(machine.thermal.axis[index]),
      limits_(machine.thermal),
      index_(index),
      column_(kLetters.find(passport_.name)),
      row_(static_cast<std::size_t>(
          std::ranges::find(machine.axes, passport_.name, &kernel::machine::Axis::name) -
          machine.axes.begin())),
      probe_sd_mm_(machine.simulation.probe_noise_mm),
      filter_(std::move(filter)) {
  // The limits without the axes, which are of no use here.
  limits_.axis.clear();
}

void BelievedAxis::update(double elapsed_s, thermal::online::Drive drive, double room_c) noexcept {
  drive.ambient_c.fill(room_c);
  if (!std::exchange(started_, true)) {
    // The surroundings have settled; the zero is there.
    zero_mm_ = filter_.update(0.0, drive);
  }
  filter_.update(elapsed_s, drive);
}

void BelievedAxis::measure(double displacement_mm) noexcept {
  // The probe counts from the part's zero, the model from cold.
  filter_.measure({.displacement_mm = displacement_mm + zero_mm_, .sd_mm = probe_sd_mm_});
}

// The product's own planner, on the model and state as believed now.
Result<nc::rewrite::AxisPlan> BelievedAxis::plan(const thermal::offline::Cyclogram& cyclogram,
                                                 double tolerance_mm) const {
  // The levels as scaled by the readings, and the present bias. The plan looks ahead, so what the
  // readings have taught must go into the model that it runs.
  // ahead.
  kernel::machine::ThermalAxis scaled = passport_;
  for (kernel::machine::ThermalMode& mode : scaled.mode) {
    for (double& level : mode.level_mm) {
      level *= filter_.gain();
    }
    for (double& coefficient : mode.polynomial_mm) {
      coefficient *= filter_.gain();
    }
    mode.feed_s *= filter_.gain();
  }
  auto model = ThermalModel::make(scaled);
  if (!model) {
    return std::unexpected(model.error());
  }
  model->restore(filter_.model().state());
  auto curve = thermal::offline::curve_of(*model, cyclogram);
  // A model that has seen no temperature is at 0; so is the zero then.
  const double beside_mm = displacement_mm() - curve.at(0.0);
  for (auto& piece : curve.piece) {
    piece.displacement_mm.push_back({beside_mm, 0.0});
  }
  const auto planned = thermal::offline::plan_corrections(passport_.name, curve, cyclogram,
                                                          {.tolerance_mm = tolerance_mm,
                                                           .share = limits_.share[limits_.level],
                                                           .max_offset_mm = limits_.max_offset_mm});
  if (!planned) {
    return std::unexpected(planned.error());
  }
  nc::rewrite::AxisPlan out{.letter = passport_.name.front(), .index = column_, .steps = {}};
  double time_s = 0.0;
  double sum_um = 0.0;
  for (const auto& row : planned->transition) {
    for (std::size_t j = 0; j < row.interval_s.size(); ++j) {
      if (row.delta_mm[j] != 0.0) {
        // Steps are changes in the plan; the program gets the whole offset each time.
        sum_um += row.delta_mm[j] * 1e3;
        out.steps.push_back({.time_s = time_s, .displacement_um = sum_um});
      }
      time_s += row.interval_s[j];
    }
  }
  return out;
}

}  // namespace steadyrest::trial::batch
