// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/plan/drive_limits.hpp>
#include <steadyrest/chatter/offline/plan/uncertainty.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Which spindle override, or which law of it, keeps a cut stable on a machine.
///
/// An alternative is accepted when the cut is stable from depth 0 up to the wanted one, when the
/// share of possible cuts (Uncertainty) that are stable at the wanted depth reaches
/// `least_probability`, when the drive and the override can follow it, and for a law when a
/// vibration grows by at most `most_growth` on its way (see Stability), both under the law and
/// under the staircase that the override makes of it.
///   keep      100 % is accepted.
///   constant  else the accepted override step with the highest probability; of equals (within 1.5
///             samples) the one nearest to 100 %, then the faster.
///   law       else the smallest amplitude that has an accepted law; among laws of that amplitude
///             the highest probability, then the smallest growth.
///   nothing   else.
/// Amplitudes are distances of override steps from 100 %; of each law the frequencies from the
/// highest that the drive can follow down to `least_rvf` are tried, the fastest first, because slow
/// laws let vibrations grow; they are rounded to a whole number of tooth passes in a period.
/// Sources: Seguy et al., IJAMT 48 (2010) 883, for laws; growth: Sexton, Stone (1980).
namespace steadyrest::chatter::offline {

enum class PlanDecision : std::uint8_t { keep, constant, law, nothing };

/// One way to run the cut.
struct Alternative {
  Modulation modulation;  ///< Law::constant for an override step
  double ratio = 1.0;     ///< mean speed over the programmed one
  DriveDemand demand;
  bool stable = false;                   ///< at the wanted depth, with the given figures
  std::optional<double> limit_depth_mm;  ///< lowest border, infinity: none up to most_depth_mm;
                                         ///< empty: not computed
  std::optional<double> probability;     ///< share of possible cuts that are stable
  std::optional<double> peak_growth;
  std::optional<double> log_radius;  ///< of a law: ln ρ over its period, for the ideal law
  /// The same with the machine's real speed (override_course); only for laws that pass everything
  /// else.
  std::optional<double> written_log_radius;
  bool growth_is_lower_bound = false;  ///< enough to reject the alternative
  std::vector<std::string> reasons;    ///< why it is rejected; empty: accepted

  [[nodiscard]] bool accepted() const noexcept { return reasons.empty(); }
};

struct PlanOptions {
  double least_probability = 0.95;  ///< 0 … 1
  double most_growth = 20.0;        ///< ≥ 1
  double most_depth_mm = 0.0;  ///< limit depths are sought up to here; 0: five times the wanted
  double least_rvf = 0.01;     ///< slowest law tried, > 0
  Uncertainty uncertainty;
  DriveLimits::Options drive;
  std::vector<online::Law> laws{online::Law::triangle, online::Law::sine, online::Law::square,
                                online::Law::pulse, online::Law::stop};
  std::vector<double> rva;  ///< empty: from the override's steps
  std::vector<double> rvf;  ///< empty: see above
  bool try_steps = true;    ///< false: only laws
  std::function<void(double share, std::string_view what)> progress;  ///< from one thread
};

struct Plan {
  PlanDecision decision = PlanDecision::nothing;
  Alternative chosen;  ///< the programmed speed when nothing helps
  std::vector<Alternative>
      alternatives;  ///< steps by ratio, then the best of each law and amplitude
  double most_depth_mm = 0.0;
  double likely_depth_mm = 0.0;  ///< when nothing helps: the depth, to 1 % of the wanted one, that
                                 ///< the alternative with the deepest border reaches with the
                                 ///< probability asked for
  std::optional<double> helping_ratio;  ///< laws alone were asked for and none helps: the override
                                        ///< step that would
  std::optional<double> chatter_frequency_hz;  ///< at the programmed speed when unstable
  std::vector<std::string> notes;              ///< for the user, in words
};

/// Refuses a speed or depth that is not above 0, options out of range and a process without modes.
[[nodiscard]] kernel::outcome::Result<Plan> plan(const Process& process,
                                                 const kernel::machine::Machine& machine,
                                                 double programmed_rev_s, double depth_mm,
                                                 const PlanOptions& options);

[[nodiscard]] const char* name(PlanDecision decision) noexcept;

}  // namespace steadyrest::chatter::offline
