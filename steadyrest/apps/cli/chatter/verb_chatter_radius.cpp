// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/cut_point_options.hpp>
#include <steadyrest/apps/cli/chatter/stability_answer.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_radius.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/chatter/growth_page.hpp>
#include <steadyrest/chatter/offline/cycle/growth_course.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>

namespace steadyrest::apps::cli {
namespace chatter_radius {
namespace {

namespace offline = chatter::offline;

/// One point of the stability map with everything known about it: radius, kind, frequency, worst
/// growth.
struct Options {
  CutPointOptions cut;
  std::string report;
};

/// How long growth is followed.
struct Passes {
  std::size_t count = 0;
  const char* name = "";
};

Answer answer_of(const CutPointOptions& options, const ChosenLaw& law,
                 const offline::Stability& found, const Passes& passes) {
  Answer answer;
  Json& json = answer.json;
  put_stability(json, found);
  json["log_radius_per_pass"] = found.log_radius_per_pass;
  json["peak_growth"] = found.peak_growth;
  json["frequency_step_hz"] = found.frequency_step_hz;
  json["passes"] = found.passes;
  json["law_periods"] = found.law_periods;
  json["speed_rpm"] = options.speed_rpm;
  json["depth_mm"] = options.depth_mm;
  put_law(json, law, options.speed_rpm);

  Table table;
  table.row({"cut", found.stable ? std::string("stable")
                                 : fmt::format("unstable ({})", offline::name(found.type))});
  // ρ is per tooth pass at constant speed, as published tables have it, and per modulation period
  // under a law; the two must not be compared.
  const bool constant = law.modulation.law == chatter::online::Law::constant;
  table.row({constant ? "spectral radius per pass" : "spectral radius per modulation period",
             fmt::format("{:.6g}", std::exp(found.log_radius))});
  table.row({"its logarithm", fmt::format("{:.6g}", found.log_radius)});
  // Passes, not periods: at constant speed there is no period to speak of.
  table.row({fmt::format("worst growth within {} {}", passes.count, passes.name),
             fmt::format("{:.4g}", found.peak_growth)});
  // Under modulation the dominant vibration is e^{λt}·p(t): its multiplier fixes the frequency only
  // up to multiples of 1/T, hence the comb of lines.
  if (found.frequency_hz) {
    table.row({"frequency", constant
                                ? fmt::format("{:.1f} Hz", *found.frequency_hz)
                                : fmt::format("{:.1f} Hz, with lines {:.3g} Hz apart around it",
                                              *found.frequency_hz, found.frequency_step_hz)});
  }
  answer.text = table.text() + "speed: " + law_text(law, options.speed_rpm) + "\n";
  return answer;
}

/// The map of one period is made once; radius, kind and growth all come from it.
Outcome run(const Options& options, Progress& progress) {
  const auto cut = cut_point(options.cut);
  if (!cut) {
    return std::unexpected(cut.error());
  }
  progress.update(0.0, "one point");
  auto cycle = offline::DelayCycle::make(cut->process, {.speed_rev_s = cut->speed_rev_s,
                                                        .modulation = cut->law.modulation,
                                                        .course = {},
                                                        .most_depth_mm = cut->depth_mm});
  if (!cycle) {
    return refused(cycle.error());
  }
  cycle->set_depth(cut->depth_mm);
  auto found = offline::stability(*cycle, {.frequency = true});
  const auto courses = offline::growth_courses(*cycle);
  // ρ < 1 alone is not enough under slow modulation: a vibration may grow a thousandfold within the
  // period before it dies. The worst of the courses is what the report plots, so the number comes
  // from there too.
  found.peak_growth = offline::worst(courses).peak();
  const bool teeth =
      cut->process.cut.operation == offline::Operation::milling && cut->process.even_pitch();
  Answer answer =
      answer_of(options.cut, cut->law, found,
                {offline::growth_window(*cycle), teeth ? "tooth passes" : "revolutions"});
  if (!options.report.empty()) {
    const offline::SpeedProfile speed(cut->speed_rev_s, cut->law.modulation);
    put_report(answer, options.report,
               page::growth_page(answer.json, cut->process, *cycle, speed, courses));
  }
  return answer;
}

}  // namespace
}  // namespace chatter_radius

void add_verb_chatter_radius(Session& session, Verb& verb) {
  auto options = std::make_shared<chatter_radius::Options>();
  add_cut_point_options(verb, options->cut);
  verb.reports(options->report);
  session.on(verb,
             [options](Progress& progress) { return chatter_radius::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
