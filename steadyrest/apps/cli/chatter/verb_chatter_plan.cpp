// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/plan_answer.hpp>
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

PlannedCut cut_of(const Options& options) {
  return {.speed_rpm = options.speed_rpm, .depth_mm = options.depth_mm};
}

/// One speed from each lobe, for a new S word.
using BestSpeeds = std::vector<offline::BestSpeed>;

Json or_null(const std::optional<double>& depth_mm) {
  return depth_mm && std::isfinite(*depth_mm) ? Json(*depth_mm) : Json(nullptr);
}

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

/// The table of all alternatives first, then each rejection with its reason, then the planner's
/// notes.
std::string for_people(const offline::Plan& plan, const Options& options) {
  std::string out = plan_headline(plan, cut_of(options)) + "\n\n";
  Table table(
      {"choice", "border, mm", "stable cuts, %", "growth", "ln ρ", "as written", "verdict"});
  for (const Alternative& a : plan.alternatives) {
    table.row({plan_choice(a, options.speed_rpm), limit_text(a, plan.most_depth_mm),
               a.probability ? fmt::format("{:.0f}", 100.0 * *a.probability) : "–", growth_text(a),
               log_text(a.log_radius), log_text(a.written_log_radius),
               a.accepted() ? "good" : "no"});
  }
  out += table.text() + "\n";
  for (const Alternative& a : plan.alternatives) {
    for (const std::string& reason : a.reasons) {
      out += fmt::format("{}: {}\n", plan_choice(a, options.speed_rpm), reason);
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
  answer.json = plan_json(*found, cut_of(options));
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
