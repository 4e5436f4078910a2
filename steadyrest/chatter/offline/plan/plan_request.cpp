// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/chatter/offline/plan/plan_request.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr double kDepthsOver = 5.0;  ///< limit depths up to this many times the wanted one
constexpr double kDeepest_mm = 1e4;  ///< no tool cuts this deep
// Process damping grows as the waves under the flank get shorter, that is, at low speed. Ten waves
// between two teeth is a cautious threshold for the note.
constexpr double kManyWaves = 10.0;

struct Range {
  const char* what;
  double value;
  double least;
  double most;
};

std::optional<Refusal> out_of(const Range& range) {
  if (range.value >= range.least && range.value <= range.most) {
    return std::nullopt;
  }
  return bad_input(fmt::format("{} = {:.10g}; allowed: from {:g} to {:g}", range.what, range.value,
                               range.least, range.most),
                   "give a value in that range");
}

std::optional<Refusal> fault_of_options(double depth, const PlanOptions& o) {
  const Uncertainty& u = o.uncertainty;
  const std::array ranges = {
      Range{"probability in %", 100.0 * o.least_probability, 0.0, 100.0},
      Range{"largest growth", o.most_growth, 1.0, 1e300},
      Range{"slowest RVF", o.least_rvf, kSlowestPlanRvf, kFastestPlanRvf},
      Range{"number of possible cuts", static_cast<double>(u.samples), 1.0, 4096.0},
      Range{"deviation of the frequencies in %", 100.0 * u.frequency, 0.0, 10.0},
      Range{"deviation of the damping ratios in %", 100.0 * u.damping, 0.0, 100.0},
      Range{"deviation of the coefficients in %", 100.0 * u.coefficients, 0.0, 100.0}};
  for (const Range& range : ranges) {
    if (auto refusal = out_of(range)) {
      return refusal;
    }
  }
  if (o.most_depth_mm != 0.0 && !(o.most_depth_mm >= depth)) {
    return bad_input(
        fmt::format("the border search ends at {:.10g} mm, short of the wanted depth of {:.10g} mm",
                    o.most_depth_mm, depth),
        "extend the search to that depth or beyond");
  }
  for (const double rva : o.rva) {
    if (!(rva > 0.0 && rva < 1.0)) {
      return bad_input(fmt::format("RVA {} is not between 0 and 1", rva), "give e.g. 0.1");
    }
  }
  for (const double rvf : o.rvf) {
    if (!(rvf > 0.0 && rvf <= 1.0)) {
      return bad_input(fmt::format("RVF {} is not above 0 and at most 1", rvf), "give e.g. 0.1");
    }
  }
  return std::nullopt;
}

/// Frequency of the most compliant mode.
double softest_hz(const Process& process) {
  double most = 0.0;
  double out = 0.0;
  for (const Mode& mode : process.modes) {
    // Compliance at resonance, 1/(2ζk), up to a factor common to all modes.
    const double k = mode.mass_kg * mode.frequency_hz * mode.frequency_hz;
    const double way = 1.0 / (k * std::max(mode.damping_ratio, 1e-6));
    if (way > most) {
      most = way;
      out = mode.frequency_hz;
    }
  }
  return out;
}

}  // namespace

double most_depth_mm(double depth_mm, const PlanOptions& options) noexcept {
  return options.most_depth_mm > 0.0 ? options.most_depth_mm : kDepthsOver * depth_mm;
}

std::optional<Refusal> fault_of_request(const Process& process, double speed_rev_s, double depth_mm,
                                        const PlanOptions& options) {
  if (process.modes.empty()) {
    return bad_input("the process has no mode", "give at least one [[mode]]");
  }
  if (!(speed_rev_s > 0.0) || !std::isfinite(speed_rev_s) || !(depth_mm > 0.0) ||
      !std::isfinite(depth_mm)) {
    return bad_input(fmt::format("speed {} rpm and depth {} mm; both must be above 0",
                                 60.0 * speed_rev_s, depth_mm),
                     "give the programmed speed and the wanted depth");
  }
  if (depth_mm > kDeepest_mm) {
    return bad_input(fmt::format("depth {:.6g} mm; at most {:g} is allowed", depth_mm, kDeepest_mm),
                     "give the axial depth of cut in mm");
  }
  if (auto refused = beyond_reach(process, speed_rev_s, most_depth_mm(depth_mm, options))) {
    refused->to_do +=
        "; the border is searched to five times the wanted depth, or to `chatter plan "
        "--most-depth-mm`";
    return refused;
  }
  return fault_of_options(depth_mm, options);
}

std::optional<std::string> process_damping_ignored(const Process& process, double speed_rev_s) {
  const double waves =
      softest_hz(process) / (static_cast<double>(process.tool.teeth) * speed_rev_s);
  if (process.cut.process_damping_n_mm > 0.0 || waves < kManyWaves) {
    return std::nullopt;
  }
  return fmt::format(
      "{:.0f} waves between two teeth: the flank rubs on waves this short and damps them. The "
      "process file ignores that, so deeper cuts may be stable; add process_damping_N_mm to [cut]",
      waves);
}

}  // namespace steadyrest::chatter::offline
