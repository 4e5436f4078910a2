// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/thermal/adapt_inputs.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::machine::Thermal;
using kernel::units::mm_from_um;

/// The level in the plan, by default the passport's.
Result<ThermalLevel> level_of(const ThermalPlanFile& plan, const Thermal& passport) {
  const double number = plan.level.value_or(passport.level);
  if (number != std::floor(number) || !(number >= 0.0) ||
      number >= static_cast<double>(passport.share.size())) {
    return refuse(
        plan.plan.file,
        fmt::format("level {} has no share; [thermal] shares in the machine file has {} entries",
                    number, passport.share.size()),
        "give the machine file that the plan was made with");
  }
  const ThermalLevel out{static_cast<std::uint32_t>(number),
                         passport.share[static_cast<std::size_t>(number)]};
  // The parts were made with k. Measured against another k they would move the level for the wrong
  // reason.
  if (plan.share && std::abs(*plan.share - out.share) > 1e-9) {
    return refuse(plan.plan.file,
                  fmt::format("the plan's k = {} differs from the machine file's {} for level {}",
                              *plan.share, out.share, out.number),
                  "make the plan again with this machine file");
  }
  return out;
}

/// The cyclogram or program that the plan was made for, needed for the gains. Without it only the
/// level can be learnt.
Result<std::optional<ThermalJob>> work_of(const AdaptOptions& options,
                                          const ThermalPlanFile& plan) {
  ThermalOptions what = options.thermal;
  if (what.cyclogram.empty() && what.program.file.empty()) {
    what.cyclogram = plan.cyclogram;
    what.program.file = plan.program;
  }
  if (what.cyclogram.empty() && what.program.file.empty()) {
    return std::optional<ThermalJob>{};
  }
  // The plan may cover only some axes of the passport.
  for (const auto& axis : plan.plan.axes) {
    what.axes.emplace_back(1, axis.letter);
  }
  auto job = thermal_job(what);
  if (!job) {
    return std::unexpected(job.error());
  }
  const double total_s = job->cyclogram.total_s();
  // The same work has the same length. The slack covers minutes that were rounded in the plan.
  if (std::abs(total_s - plan.plan.total_s) > 1.0 + 1e-4 * total_s) {
    return refuse(plan.plan.file,
                  fmt::format("the plan lasts {:.2f} min, but {} lasts {:.2f} min",
                              plan.plan.total_s / 60.0, job->cyclogram.file, total_s / 60.0),
                  "give the cyclogram or the program that the plan was made for");
  }
  return std::optional(std::move(*job));
}

/// The machine file of the command line, else the one that the plan names.
Result<void> read_machine_and_rows(const AdaptOptions& options, AdaptInputs& in) {
  in.machine = options.thermal.machine.empty() ? in.plan.machine : options.thermal.machine;
  if (in.machine.empty()) {
    return refuse(options.plan, "the plan names no machine file", "give --machine FILE");
  }
  auto passport = passport::read_thermal_passport(in.machine);
  if (!passport) {
    return std::unexpected(passport.error());
  }
  in.passport = std::move(*passport);
  // The level needs both the plan and the passport, so it is checked once both are read.
  const auto level = level_of(in.plan, in.passport);
  if (!level) {
    return std::unexpected(level.error());
  }
  in.level = *level;
  auto rows = thermal::offline::read_measured(
      options.measured, {format_of(options.format), table::stamp_of(options.started)});
  if (!rows) {
    return std::unexpected(rows.error());
  }
  in.rows = std::move(*rows);
  return {};
}

}  // namespace

/// The order matters: the plan names the machine and the work, these bring the tolerances, and only
/// then a measured part can be placed.
Result<AdaptInputs> read_adapt_inputs(AdaptOptions options) {
  AdaptInputs in;
  auto plan = read_thermal_plan(options.plan);
  if (!plan) {
    return std::unexpected(plan.error());
  }
  in.plan = std::move(*plan);
  if (const auto done = read_machine_and_rows(options, in); !done) {
    return std::unexpected(done.error());
  }
  options.thermal.machine = in.machine;
  auto work = work_of(options, in.plan);
  if (!work) {
    return std::unexpected(work.error());
  }
  in.work = std::move(*work);
  auto placed = place_parts(in.plan, in.rows, options.measured, mm_from_um(options.tolerance_um),
                            in.work ? &in.work->cyclogram : nullptr);
  if (!placed) {
    return std::unexpected(placed.error());
  }
  in.parts = std::move(*placed);
  return in;
}

}  // namespace steadyrest::apps::cli
