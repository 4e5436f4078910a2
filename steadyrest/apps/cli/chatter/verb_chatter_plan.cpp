// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/verb_chatter_plan.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/chatter/plan_page.hpp>
#include <steadyrest/chatter/offline/depth/best_speeds.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace chatter_plan {
namespace {

namespace offline = chatter::offline;
namespace units = kernel::units;
using chatter::online::Law;
using offline::Alternative;
using offline::PlanDecision;

/// ± 2σ: 95 % of what the natural frequencies may really be.
constexpr double kSigmas = 2.0;  ///< of the frequencies, within which a best speed holds its depth

/// Defaults are what a careful tap test and a handbook give: frequency to 0.5 %, damping and
/// cutting coefficients to 10 %.
struct Options {
  std::string process;
  std::string machine;
  double speed_rpm = 0.0;
  double depth_mm = 0.0;
  double probability_percent = 95.0;
  double frequency_percent = 0.5;
  double damping_percent = 10.0;
  double coefficient_percent = 10.0;
  std::vector<std::string> laws;
  bool laws_only = false;
  bool leave_speed_band = false;
  offline::PlanOptions plan;
  std::string report;
};

/// JSON has neither NaN nor infinity; both mean that there is no number.
Json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

/// Override steps in per cent, as the switch is labelled.
Json percents(const std::vector<double>& ratios) {
  Json out = Json::array();
  for (const double ratio : ratios) {
    // Six digits are enough and keep 0.85·100 from printing as 85.00000000000001.
    out.push_back(1e-6 * std::round(1e6 * units::percent_from_ratio(ratio)));
  }
  return out;
}

bool is_law(const Alternative& a) {
  return a.modulation.law != Law::constant;
}

/// T = 60/(n·RVF) s with n in rev/min.
double period_s(const Alternative& a, double speed_rpm) {
  return 60.0 / (speed_rpm * a.modulation.rvf);
}

/// The keys that the decision and every alternative share, so that a script reads both alike.
void put(Json& json, const Alternative& a, double speed_rpm) {
  json["override_percent"] = percents(a.demand.written_ratio);
  json["law"] = chatter::online::name(a.modulation.law);
  json["rva"] = is_law(a) ? a.modulation.rva : 0.0;
  json["rvf"] = is_law(a) ? a.modulation.rvf : 0.0;
  json["limit_depth_mm"] = or_null(a.limit_depth_mm);
  json["probability"] = or_null(a.probability);
  json["peak_growth"] = or_null(a.peak_growth);
  json["log_radius"] = or_null(a.log_radius);
  json["written_log_radius"] = or_null(a.written_log_radius);
  json["speed_rpm"] = speed_rpm * a.ratio;
  json["amplitude_rpm"] = is_law(a) ? a.modulation.rva * speed_rpm : 0.0;
  json["period_s"] = is_law(a) ? Json(period_s(a, speed_rpm)) : Json(nullptr);
}

Json to_json(const offline::Plan& plan, const Options& options) {
  Json out;
  out["decision"] = offline::name(plan.decision);
  put(out, plan.chosen, options.speed_rpm);
  out["depth_mm"] = options.depth_mm;
  out["most_depth_mm"] = plan.most_depth_mm;
  out["likely_depth_mm"] =
      // The depth that would work matters only when nothing works at the intended one.
      plan.decision == PlanDecision::nothing ? Json(plan.likely_depth_mm) : Json(nullptr);
  out["helping_override_percent"] =
      plan.helping_ratio ? percents({*plan.helping_ratio})[0] : Json(nullptr);
  out["chatter_frequency_hz"] = or_null(plan.chatter_frequency_hz);
  out["notes"] = plan.notes;
  out["alternatives"] = Json::array();
  for (const Alternative& a : plan.alternatives) {
    Json one;
    // A rejected alternative keeps its numbers and its reasons: the user sees how close it came.
    put(one, a, options.speed_rpm);
    one["stable"] = a.stable;
    one["growth_is_lower_bound"] = a.growth_is_lower_bound;
    one["reasons"] = a.reasons;
    out["alternatives"].push_back(std::move(one));
  }
  return out;
}

/// One speed from each lobe, for a new S word.
using BestSpeeds = std::vector<offline::BestSpeed>;

/// A null depth means stable as deep as the search went.
Json json_of(const BestSpeeds& best) {
  Json out = Json::array();
  for (const offline::BestSpeed& one : best) {
    out.push_back({{"speed_rpm", units::rpm_from_rev_s(one.speed_rev_s)},
                   {"limit_depth_mm", or_null(one.limit_depth_mm)},
                   {"sure_depth_mm", or_null(one.sure_depth_mm)}});
  }
  return out;
}

/// The speeds to program, best first. They need a new S word, so they are listed apart from the
/// override steps, which work on the program as it is.
std::string text_of(const BestSpeeds& best, const Options& options, double most_depth_mm) {
  if (best.empty()) {
    return "";
  }
  const auto depth = [&](const std::optional<double>& limit) {
    return limit ? fmt::format("{:.3f}", *limit) : fmt::format("> {:.3g}", most_depth_mm);
  };
  Table table({"best spindle speeds", "border, mm",
               fmt::format("border within ±{:.3g} %, mm", kSigmas * options.frequency_percent)});
  for (const offline::BestSpeed& one : best) {
    table.row({fmt::format("{:.0f} rpm", units::rpm_from_rev_s(one.speed_rev_s)),
               depth(one.limit_depth_mm), depth(one.sure_depth_mm)});
  }
  return "\n" + table.text();
}

/// A constant speed reads as an override step, a law as amplitude and period in the units of the
/// drive.
std::string choice_words(const Alternative& a, double speed_rpm) {
  if (!is_law(a)) {
    return fmt::format("{:.4g} % = {:.0f} rpm", units::percent_from_ratio(a.ratio),
                       speed_rpm * a.ratio);
  }
  return fmt::format("{} ±{:.4g} % = ±{:.0f} rpm every {:.3g} s",
                     chatter::online::name(a.modulation.law),
                     units::percent_from_ratio(a.modulation.rva), speed_rpm * a.modulation.rva,
                     period_s(a, speed_rpm));
}

/// Empty: not computed, because the alternative failed a cheaper test. Infinite: stable as deep as
/// the search went.
std::string limit_text(const Alternative& a, double most_depth_mm) {
  return !a.limit_depth_mm                  ? "–"
         : std::isfinite(*a.limit_depth_mm) ? fmt::format("{:.3f}", *a.limit_depth_mm)
                                            : fmt::format("> {:.3g}", most_depth_mm);
}

/// A law whose dominant vibration already grows too much is rejected on that one; the worst of all
/// vibrations then grows at least as much.
std::string growth_text(const Alternative& a) {
  return a.peak_growth
             ? fmt::format("{}{:.3g}", a.growth_is_lower_bound ? "≥ " : "", *a.peak_growth)
             : "–";
}

/// ln ρ; −∞ and numbers that were not computed are a dash.
std::string log_text(const std::optional<double>& log_radius) {
  return log_radius && std::isfinite(*log_radius) ? fmt::format("{:.3g}", *log_radius) : "–";
}

/// The decision as an instruction to the operator.
std::string headline(const offline::Plan& plan, const Options& options) {
  const std::string choice = choice_words(plan.chosen, options.speed_rpm);
  switch (plan.decision) {
    case PlanDecision::keep:
      return fmt::format("Keep the programmed speed: {}", choice);
    case PlanDecision::constant:
      return fmt::format("Set the spindle override to {}", choice);
    case PlanDecision::law:
      return fmt::format("Modulate the spindle speed: {}", choice);
    case PlanDecision::nothing:
      // With --laws-only a step may still solve the problem, and the user should hear of it.
      if (plan.helping_ratio) {
        return fmt::format("No law helps at {:.4g} mm; a constant {:.4g} % = {:.0f} rpm does",
                           options.depth_mm, units::percent_from_ratio(*plan.helping_ratio),
                           options.speed_rpm * *plan.helping_ratio);
      }
      return fmt::format("Nothing helps at {:.4g} mm", options.depth_mm);
  }
  return {};
}

/// The table of all alternatives first, then each rejection with its reason, then the planner's
/// notes.
std::string for_people(const offline::Plan& plan, const Options& options) {
  std::string out = headline(plan, options) + "\n\n";
  Table table(
      {"choice", "border, mm", "stable cuts, %", "growth", "ln ρ", "as written", "verdict"});
  for (const Alternative& a : plan.alternatives) {
    table.row({choice_words(a, options.speed_rpm), limit_text(a, plan.most_depth_mm),
               a.probability ? fmt::format("{:.0f}", 100.0 * *a.probability) : "–", growth_text(a),
               log_text(a.log_radius), log_text(a.written_log_radius),
               a.accepted() ? "good" : "no"});
  }
  out += table.text() + "\n";
  for (const Alternative& a : plan.alternatives) {
    for (const std::string& reason : a.reasons) {
      out += fmt::format("{}: {}\n", choice_words(a, options.speed_rpm), reason);
    }
  }
  out += plan.notes.empty() ? "" : "\n";
  for (const std::string& note : plan.notes) {
    out += note + "\n";
  }
  return out;
}

/// Order of the work: the files, the options into the planner's units, the plan at the programmed
/// speed, then the best speeds of the whole spindle range as an alternative to reprogramming.
Outcome run(Options options, Progress& progress) {
  const auto process = offline::read_process_all_faults(options.process);
  if (!process) {
    return std::unexpected(process.error());
  }
  const auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  offline::PlanOptions& plan = options.plan;
  if (!options.laws.empty()) {
    plan.laws.clear();
  }
  for (const std::string& word : options.laws) {
    const auto law = chatter::online::law_of(word);
    if (!law || *law == Law::constant) {
      return refused(bad_input(fmt::format("--laws: {} is not a law", word),
                               "choose from triangle, sine, square, pulse, stop, random"));
    }
    plan.laws.push_back(*law);
  }
  plan.least_probability = units::ratio_from_percent(options.probability_percent);
  plan.uncertainty.frequency = units::ratio_from_percent(options.frequency_percent);
  plan.uncertainty.damping = units::ratio_from_percent(options.damping_percent);
  plan.uncertainty.coefficients = units::ratio_from_percent(options.coefficient_percent);
  plan.try_steps = !options.laws_only;
  plan.drive.keep_speed_band = !options.leave_speed_band;
  plan.progress = [&progress](double share, std::string_view what) {
    progress.update(share, what);
  };
  const auto found = offline::plan(*process, *machine, units::rev_s_from_rpm(options.speed_rpm),
                                   options.depth_mm, plan);
  if (!found) {
    return refused(found.error());
  }
  progress.update(1.0, "the best spindle speeds");
  const auto best = offline::best_speeds(
      *process, {.min_rev_s = machine->spindle.min_rev_s,
                 .max_rev_s = machine->spindle.max_rev_s,
                 .most_depth_mm = found->most_depth_mm,
                 .tolerance_ratio = std::min(0.2, kSigmas * plan.uncertainty.frequency)});
  if (!best) {
    return refused(best.error());
  }
  Answer answer;
  answer.json = to_json(*found, options);
  answer.json["best_speeds"] = json_of(*best);
  answer.text = for_people(*found, options) + text_of(*best, options, found->most_depth_mm);
  if (!options.report.empty()) {
    const auto page = page::plan_page(answer.json, *process, *machine,
                                      units::rev_s_from_rpm(options.speed_rpm), *found);
    if (!page) {
      return refused(page.error());
    }
    put_report(answer, options.report, *page);
  }
  return answer;
}

/// The uncertainties are those of a measurement, one standard deviation each; the planner draws
/// possible cuts from them.
void add_options(Verb& verb, Options& o) {
  verb.reads("PROCESS", o.process, "Process file (TOML): tool, cut, modes")->required();
  verb.also_reads([&o] { return offline::response_files(o.process); });
  add_machine_option(verb, o.machine);
  verb.add_option("--speed-rpm", o.speed_rpm, "Programmed spindle speed")->required();
  verb.add_option("--depth-mm", o.depth_mm, "Depth of cut you want")->required();
  verb.add_option("--probability-percent", o.probability_percent,
                  "Share of the possible cuts that must be stable")
      ->capture_default_str();
  verb.add_option("--frequency-sigma-percent", o.frequency_percent,
                  "Standard deviation of the natural frequencies")
      ->capture_default_str();
  verb.add_option("--damping-sigma-percent", o.damping_percent,
                  "Standard deviation of the damping ratios")
      ->capture_default_str();
  verb.add_option("--coefficient-sigma-percent", o.coefficient_percent,
                  "Standard deviation of Kt and of Kr")
      ->capture_default_str();
  verb.add_option("--samples", o.plan.uncertainty.samples, "Number of possible cuts")
      ->capture_default_str();
  verb.add_option("--seed", o.plan.uncertainty.seed, "Seed for the possible cuts")
      ->capture_default_str();
  verb.add_option("--growth", o.plan.most_growth,
                  "Largest growth of a vibration within one period of the law, as a factor")
      ->capture_default_str();
  verb.add_option("--most-depth-mm", o.plan.most_depth_mm,
                  "Search borders down to this depth; default: five times --depth-mm");
  verb.add_option("--laws", o.laws,
                  "Laws to try: triangle,sine,square,pulse,stop,random; default: all but random")
      ->delimiter(',');
  // Where the literature has a symbol (RVA, RVF) the option is called by it, and the help says what
  // it is.
  verb.add_option("--rva", o.plan.rva,
                  "Amplitudes over mean speed; default: from the override's steps")
      ->delimiter(',');
  verb.add_option("--rvf", o.plan.rvf,
                  "Law frequencies over rotation frequency; default: those the drive can follow")
      ->delimiter(',');
  verb.add_option("--least-rvf", o.plan.least_rvf, "Slowest law to try")->capture_default_str();
  verb.add_flag("--laws-only", o.laws_only, "Plan a law even if an override step is enough");
  verb.add_flag("--leave-speed-band", o.leave_speed_band,
                "Allow laws to leave the tolerance band of the control's speed monitor");
  verb.reports(o.report);
}

}  // namespace
}  // namespace chatter_plan

void add_verb_chatter_plan(Session& session, Verb& verb) {
  auto options = std::make_shared<chatter_plan::Options>();
  chatter_plan::add_options(verb, *options);
  session.on(verb, [options](Progress& progress) { return chatter_plan::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
