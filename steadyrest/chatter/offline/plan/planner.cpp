// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/plan/alternative_check.hpp>
#include <steadyrest/chatter/offline/plan/plan_request.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/plan/same.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Constant steps come before laws: on the slot benchmark 110 % allows 2.77 mm against 0.41 mm at
// 100 %, and the best laws of ±20 % about as much. A constant step also spares the drive. Laws
// follow by rising amplitude, and the first amplitude with an accepted law ends the search: a
// larger one only loads the drive more.
namespace steadyrest::chatter::offline {
namespace {

using kernel::machine::Machine;
using kernel::units::kInfinity;
using online::Law;

constexpr std::size_t kMostAmplitudes = 12;
constexpr std::size_t kMostJudged = 3;  ///< frequencies of one law and amplitude
constexpr double kNextFrequency = 1.45;
constexpr double kStepsShare = 0.2;  ///< of the progress
constexpr double kTie = 1.5;         ///< samples

class Planner {
 public:
  Planner(const Process& process, const Machine& machine, double speed, double depth,
          const PlanOptions& options)
      : process_(process),
        machine_(machine),
        speed_(speed),
        depth_(depth),
        options_(options),
        limits_(machine, process, depth, options.drive) {
    out_.most_depth_mm = most_depth_mm(depth, options);
  }

  Plan run();

 private:
  void steps(const AlternativeCheck& check);
  [[nodiscard]] const Alternative* best_step() const;
  void laws(const AlternativeCheck& check);
  [[nodiscard]] std::vector<double> amplitudes() const;
  [[nodiscard]] std::vector<double> frequencies(Modulation law) const;
  [[nodiscard]] Alternative best_of(const AlternativeCheck& check, Modulation law) const;
  void choose(PlanDecision decision, const Alternative& chosen);
  void explain(const AlternativeCheck& check);
  void explain_nothing(const AlternativeCheck& check);
  void note(std::string text) { out_.notes.push_back(std::move(text)); }
  void progress(double share, std::string_view what) const {
    if (options_.progress) {
      options_.progress(share, what);
    }
  }

  const Process& process_;
  const Machine& machine_;
  double speed_;
  double depth_;
  const PlanOptions& options_;
  DriveLimits limits_;
  Plan out_;
};

Plan Planner::run() {
  const AlternativeCheck check(process_, machine_, speed_, depth_, out_.most_depth_mm, options_);
  progress(0.0, "override steps");
  steps(check);
  const auto same = std::ranges::find_if(
      out_.alternatives, [](const Alternative& a) { return std::abs(a.ratio - 1.0) < kSame; });
  choose(PlanDecision::nothing, *same);
  if (same->accepted() && options_.try_steps) {
    out_.decision = PlanDecision::keep;
  } else if (const Alternative* best = best_step(); best != nullptr && options_.try_steps) {
    choose(PlanDecision::constant, *best);
  } else {
    laws(check);
  }
  if (out_.decision == PlanDecision::nothing && !options_.try_steps) {
    const Alternative* step = best_step();
    out_.helping_ratio = step != nullptr ? std::optional(step->ratio) : std::nullopt;
  }
  explain(check);
  progress(1.0, "done");
  return std::move(out_);
}

void Planner::choose(PlanDecision decision, const Alternative& chosen) {
  out_.decision = decision;
  out_.chosen = chosen;
}

void Planner::steps(const AlternativeCheck& check) {
  std::vector<double> ratios = limits_.writable(speed_);
  if (std::ranges::none_of(ratios, [](double r) { return std::abs(r - 1.0) < kSame; })) {
    // The programmed speed is checked even if the table has no 100 % step: the others are compared
    // with it.
    ratios.push_back(1.0);
  }
  std::ranges::sort(ratios);
  out_.alternatives.resize(ratios.size());
  tbb::parallel_for(std::size_t{0}, ratios.size(), [&](std::size_t i) {
    Alternative& a = out_.alternatives[i];
    a.ratio = ratios[i];
    a.demand = limits_.constant(speed_, a.ratio);
    check.step(a);
  });
}

const Alternative* Planner::best_step() const {
  double highest = 0.0;
  for (const Alternative& a : out_.alternatives) {
    highest = a.accepted() ? std::max(highest, *a.probability) : highest;
  }
  // Shares that differ by a sample or so count as equal: so few samples cannot tell them apart.
  const double tie = kTie / static_cast<double>(options_.uncertainty.samples);
  const Alternative* best = nullptr;
  for (const Alternative& a : out_.alternatives) {
    if (!a.accepted() || *a.probability < highest - tie) {
      continue;
    }
    // Ratios rise: of two at the same distance the later is the faster.
    if (best == nullptr || std::abs(a.ratio - 1.0) <= std::abs(best->ratio - 1.0) + kSame) {
      best = &a;
    }
  }
  return best;
}

std::vector<double> Planner::amplitudes() const {
  std::vector<double> out = options_.rva;
  if (out.empty()) {
    for (const double ratio : limits_.writable(speed_)) {
      const double rva = std::abs(ratio - 1.0);
      // The override can only write the distances of its steps from 100 %, no amplitude in between.
      if (rva > kSame && rva < 0.95) {
        out.push_back(rva);
      }
    }
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end(), [](double a, double b) { return b - a < kSame; }),
            out.end());
  if (out.size() > kMostAmplitudes) {  // a fine table: evenly thinned, the greatest stays
    std::vector<double> thin;
    for (std::size_t i = 1; i <= kMostAmplitudes; ++i) {
      thin.push_back(out[i * out.size() / kMostAmplitudes - 1]);
    }
    out = std::move(thin);
  }
  return out;
}

/// RVFs that the drive can follow, the fastest first, each with a whole number of passes per
/// period.
std::vector<double> Planner::frequencies(Modulation law) const {
  const double per_rev = process_.even_pitch() ? static_cast<double>(process_.tool.teeth) : 1.0;
  std::vector<double> wanted = options_.rvf;
  if (wanted.empty()) {
    const auto most = limits_.most_rvf(speed_, law, options_.least_rvf, kFastestPlanRvf);
    if (!most) {
      return {};
    }
    // The fastest first: slow laws let a vibration grow within the period.
    for (double rvf = *most; rvf >= options_.least_rvf * (1.0 - kSame); rvf /= kNextFrequency) {
      wanted.push_back(rvf);
    }
  }
  std::vector<double> out;
  for (const double rvf : wanted) {
    // A whole number of passes per period, rounded to the slower side, which is easier on the
    // drive; otherwise the solver has no principal period.
    const double rounded = per_rev / std::max(1.0, std::ceil(per_rev / rvf - 1e-6));
    law.rvf = rounded;
    if ((out.empty() || out.back() != rounded) && limits_.modulated(speed_, law).possible()) {
      out.push_back(rounded);
    }
  }
  return out;
}

/// For one law at one amplitude the fastest accepted frequency, else the one that came nearest.
Alternative Planner::best_of(const AlternativeCheck& check, Modulation law) const {
  const std::vector<double> rvf = frequencies(law);
  Alternative out;
  if (rvf.empty()) {
    law.rvf = options_.rvf.empty() ? options_.least_rvf : *std::ranges::min_element(options_.rvf);
    out.modulation = law;
    out.demand = limits_.modulated(speed_, law);
    for (const DriveViolation& violation : out.demand.violations) {
      out.reasons.push_back(violation.reason);
    }
    return out;
  }
  double least = kInfinity;
  std::size_t judged = 0;
  for (const double f : rvf) {
    law.rvf = f;
    Alternative a;
    a.modulation = law;
    a.demand = limits_.modulated(speed_, law);
    const double log_radius = check.log_radius(a);
    const bool first_stable = a.stable && !out.stable;
    if (a.stable) {
      check.judge(a);
      ++judged;
    }
    if (a.accepted()) {
      check.limit(a);
    }
    if (a.accepted()) {
      return a;
    }
    if (first_stable || (!out.stable && log_radius < least)) {
      least = log_radius;
      out = a;
    }
    // Slower ones grow more: after a few stable frequencies have been rejected, the rest is not
    // worth the time.
    if (judged == kMostJudged) {
      break;
    }
  }
  check.limit(out);
  return out;
}

void Planner::laws(const AlternativeCheck& check) {
  const std::vector<double> rva = amplitudes();
  for (std::size_t k = 0; k < rva.size(); ++k) {
    progress(kStepsShare +
                 (1.0 - kStepsShare) * static_cast<double>(k) / static_cast<double>(rva.size()),
             "speed laws");
    std::vector<Alternative> found(options_.laws.size());
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
      Modulation law;
      law.law = options_.laws[i];
      law.rva = rva[k];
      law.rvf = options_.least_rvf;
      found[i] = best_of(check, law);
    });
    const Alternative* best = nullptr;
    for (const Alternative& a : found) {
      const auto better = [&](const Alternative& than) {
        return *a.probability != *than.probability ? *a.probability > *than.probability
                                                   : *a.peak_growth < *than.peak_growth;
      };
      if (a.accepted() && (best == nullptr || better(*best))) {
        best = &a;
      }
    }
    if (best != nullptr) {
      choose(PlanDecision::law, *best);
    }
    out_.alternatives.insert(out_.alternatives.end(), found.begin(), found.end());
    if (best != nullptr) {
      return;
    }
  }
}

std::string words(const Alternative& a) {
  return a.modulation.law == Law::constant
             ? fmt::format("a constant {:.4g} %", 100.0 * a.ratio)
             : fmt::format("a {} law of ±{:.3g} %, RVF {:.3g}", online::name(a.modulation.law),
                           100.0 * a.modulation.rva, a.modulation.rvf);
}

void Planner::explain_nothing(const AlternativeCheck& check) {
  if (out_.helping_ratio) {
    note(fmt::format(
        "no law helps at {:.4g} mm; a constant {:.4g} % does, but only laws were asked for", depth_,
        100.0 * *out_.helping_ratio));
    return;
  }
  const Alternative* deepest = nullptr;
  for (const Alternative& a : out_.alternatives) {
    if (a.demand.possible() && a.limit_depth_mm &&
        (deepest == nullptr || *a.limit_depth_mm > *deepest->limit_depth_mm)) {
      deepest = &a;
    }
  }
  if (deepest != nullptr) {
    out_.likely_depth_mm = check.likely_depth_mm(*deepest);
    note(
        fmt::format("nothing helps at {:.4g} mm; the deepest border is {:.4g} mm, with {}; up to "
                    "{:.3g} mm it is stable for {:.0f} % of the possible cuts",
                    depth_, *deepest->limit_depth_mm, words(*deepest), out_.likely_depth_mm,
                    100.0 * options_.least_probability));
  }
  if (out_.chatter_frequency_hz) {
    // Waves between two teeth. A law breaks their rhythm when it shifts them by about half a
    // wave, hence the 50 % over them.
    const double per_pass =
        *out_.chatter_frequency_hz / (static_cast<double>(process_.tool.teeth) * speed_);
    note(
        fmt::format("the {:.0f} Hz vibration makes {:.2f} waves between two teeth; a law that "
                    "breaks its rhythm needs an amplitude of about {:.0f} %",
                    *out_.chatter_frequency_hz, per_pass, 50.0 / per_pass));
  }
}

/// Adds the notes.
void Planner::explain(const AlternativeCheck& check) {
  if (auto ignored = process_damping_ignored(process_, speed_)) {
    note(std::move(*ignored));
  }
  if (out_.decision == PlanDecision::keep) {
    return;
  }
  DelayCycle::Config config;
  config.speed_rev_s = speed_;
  config.most_depth_mm = depth_;
  if (const auto found = stability_at(process_, config, {.frequency = true});
      found && !found->stable) {
    out_.chatter_frequency_hz = found->frequency_hz;
  }
  if (out_.decision == PlanDecision::nothing) {
    explain_nothing(check);
    return;
  }
  const double highest = out_.chosen.demand.written_ratio.empty()
                             ? out_.chosen.ratio
                             : out_.chosen.demand.written_ratio.back();
  if (highest > 1.0 + kSame && !machine_.spindle_override.layer_may_exceed_panel) {
    note(fmt::format(
        "the spindle override on the panel must be {:.4g} % or more: the layer may not exceed it",
        100.0 * highest));
  }
  if (out_.decision == PlanDecision::law && machine_.spindle_override.dead_time_s > 0.0) {
    note(
        fmt::format("the override acts {:.0f} ms late: the law is shifted by that, and a "
                    "withdrawal takes that much longer",
                    1e3 * machine_.spindle_override.dead_time_s));
  }
}

}  // namespace

kernel::outcome::Result<Plan> plan(const Process& process, const Machine& machine,
                                   double programmed_rev_s, double depth_mm,
                                   const PlanOptions& options) {
  if (auto refusal = fault_of_request(process, programmed_rev_s, depth_mm, options)) {
    return std::unexpected(std::move(*refusal));
  }
  return Planner(process, machine, programmed_rev_s, depth_mm, options).run();
}

const char* name(PlanDecision decision) noexcept {
  switch (decision) {
    case PlanDecision::keep:
      return "keep";
    case PlanDecision::constant:
      return "constant";
    case PlanDecision::law:
      return "law";
    case PlanDecision::nothing:
      return "nothing";
  }
  return "nothing";
}

}  // namespace steadyrest::chatter::offline
