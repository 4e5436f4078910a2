// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/cli/thermal/adapt_inputs.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_adapt.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/edit/thermal_edit.hpp>
#include <steadyrest/passport/text/text_file.hpp>
#include <steadyrest/thermal/offline/adapt/adapt.hpp>

// Block 7 and loop D of Marusich's algorithm: the parts of a job are measured, the share k moves by
// one level, and the gains of the thermal modes are learnt where the model explains the deviations.
namespace steadyrest::apps::cli {
namespace thermal_adapt {
namespace {

using kernel::machine::Thermal;
using kernel::outcome::Reason;
using kernel::units::mm_from_um;
using kernel::units::um_from_mm;
using thermal::offline::Gains;

struct Learnt {
  std::string axis;
  Gains gains;
  std::vector<std::size_t> part;  ///< of each observation
};

/// Standard deviation of a measured part: as given, else the passport's RMS of one reading, else
/// 0.5 µm, the default of the rules.
double noise_mm(const AdaptOptions& options, double passport_mm) {
  if (options.noise_um > 0.0) {
    return mm_from_um(options.noise_um);
  }
  return passport_mm > 0.0 ? passport_mm : 0.0005;
}

/// One estimate for each axis with measured parts. A deviation is what the forecast got wrong, so
/// it is explained by the modes: deviation − (forecast − correction in force) = Σ (g_i − 1)·x_i +
/// b.
std::vector<Learnt> learn(const AdaptOptions& options, const ThermalPlanFile& plan,
                          const ThermalJob& job, const std::vector<PlacedPart>& parts) {
  std::vector<Learnt> out;
  for (std::size_t a = 0; a < plan.plan.axes.size(); ++a) {
    const auto& axis_plan = plan.plan.axes[a];
    const std::string name(1, axis_plan.letter);
    const auto axis = std::ranges::find_if(
        job.axis, [&](const auto& one) { return one.model.config().name == name; });
    Learnt learnt{.axis = name, .gains = {}, .part = {}};
    std::vector<double> time_s;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].axis == a) {
        learnt.part.push_back(i);
        time_s.push_back(parts[i].time_s);
      }
    }
    // An axis without a measured part has nothing to learn from.
    if (axis == job.axis.end() || time_s.empty()) {
      continue;
    }
    const auto& config = axis->model.config();
    const auto said =
        thermal::offline::predict(axis->model, job.cyclogram, axis->ambient_c, time_s);
    std::vector<thermal::offline::Observation> observations;
    observations.reserve(said.size());
    for (std::size_t i = 0; i < said.size(); ++i) {
      observations.push_back(
          {.deviation_mm = parts[learnt.part[i]].row->deviation_mm,
           .expected_mm = said[i].displacement_mm - mm_from_um(corrected_um(axis_plan, time_s[i])),
           .mode_mm = said[i].mode_mm});
    }
    // A part scatters by the gauge and by what the model never knew (its drift). Both together are
    // the noise of one deviation; the part's own zero may be off by the drift as well.
    thermal::offline::GainRule rule;
    rule.measuring_sd_mm = std::hypot(noise_mm(options, config.noise_mm), config.drift_mm);
    rule.bias_sd_mm = std::max(rule.bias_sd_mm, config.drift_mm);
    learnt.gains = thermal::offline::learn_gains(observations, rule);
    out.push_back(std::move(learnt));
  }
  return out;
}

bool fits(const std::vector<Learnt>& learnt) {
  return std::ranges::all_of(learnt, [](const Learnt& one) { return one.gains.fits; });
}

/// An outlier is a spoilt part or a gauge that slipped, and says nothing about the level. If the
/// model no longer fits, though, all parts look like outliers and they are the evidence.
std::vector<bool> outliers(const std::vector<Learnt>& learnt, std::size_t parts) {
  std::vector<bool> out(parts, false);
  for (const Learnt& one : learnt) {
    for (const std::size_t k : one.gains.outlier) {
      out[one.part[k]] = true;
    }
  }
  return out;
}

/// The passport with the new level, and with new gains if the model fits and enough parts support
/// them. Otherwise the old gains stay: a wrong gain is worse than a slightly stale one.
Thermal adapted(Thermal passport, std::uint32_t level, const std::vector<Learnt>& learnt) {
  passport.level = level;
  for (auto& axis : passport.axis) {
    for (const Learnt& one : learnt) {
      if (one.axis == axis.name && one.gains.fits && !one.gains.few) {
        thermal::offline::apply_gains(axis, one.gains.gain);
      }
    }
  }
  return passport;
}

/// Edits the original text, so that comments and all other sections of the machine file survive.
Result<void> write(const AdaptOptions& options, const std::string& machine,
                   const Thermal& thermal) {
  const auto text = passport::read_text(machine);
  if (!text) {
    return std::unexpected(text.error());
  }
  const auto with = passport::with_thermal(*text, machine, thermal);
  if (!with) {
    return std::unexpected(with.error());
  }
  return kernel::file::write_file(options.output, *with);
}

/// `gains_kept`: the passport's gains stay, because there are too few parts or the model does not
/// fit.
Json axes_json(const std::vector<Learnt>& learnt) {
  Json out = Json::array();
  for (const Learnt& one : learnt) {
    out.push_back({{"axis", one.axis},
                   {"gain", one.gains.gain},
                   {"gain_sd", one.gains.gain_sd},
                   {"bias_um", um_from_mm(one.gains.bias_mm)},
                   {"rms_before_um", um_from_mm(one.gains.rms_before_mm)},
                   {"rms_after_um", um_from_mm(one.gains.rms_after_mm)},
                   {"gains_kept", !one.gains.fits || one.gains.few},
                   {"fits", one.gains.fits}});
  }
  return out;
}

/// The first few outliers with their line, so that the user can look at the parts; the JSON has
/// all.
std::string text_of(const Json& outliers, bool counted) {
  constexpr std::size_t kShown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, outliers.size()); ++i) {
    const std::string part = outliers[i]["part"].get<std::string>();
    text += fmt::format("outlier: line {}{}, {:.1f} µm\n", outliers[i]["line"].get<std::size_t>(),
                        part.empty() ? "" : ", part " + part,
                        outliers[i]["deviation_um"].get<double>());
  }
  if (outliers.size() > kShown) {
    text += fmt::format("and {} more outliers\n", outliers.size() - kShown);
  }
  if (!outliers.empty()) {
    text += counted
                ? "Outliers count towards the level here: they may be right and the model wrong.\n"
                : "Outliers count towards neither the level nor the gains.\n";
  }
  return text;
}

std::string text_of(const ThermalLevel& before, const thermal::offline::LevelChoice& choice,
                    const std::vector<Learnt>& learnt, std::size_t parts, const Json& outliers) {
  Table table;
  table.row({"parts", fmt::format("{}", parts)})
      .row({"outliers", fmt::format("{}", outliers.size())})
      .row({"outside their share", fmt::format("{}", choice.outside)})
      .row({"largest error over share", fmt::format("{:.2f}", choice.largest_ratio)})
      .row({"level", fmt::format("{} (was {})", choice.level, before.number)})
      .row({"k", fmt::format("{:.6g} (was {:.6g})", choice.share, before.share)});
  std::string text = table.text() + text_of(outliers, !fits(learnt));
  if (choice.exhausted) {
    text += "The parts exceed their share even at the strictest level.\n";
  }
  for (const Learnt& one : learnt) {
    text += fmt::format("{}: gains", one.axis);
    for (std::size_t i = 0; i < one.gains.gain.size(); ++i) {
      text += fmt::format(" {:.3f} ± {:.3f}", one.gains.gain[i], one.gains.gain_sd[i]);
    }
    text += fmt::format("; common offset {:.1f} µm; error {:.1f} → {:.1f} µm RMS\n",
                        um_from_mm(one.gains.bias_mm), um_from_mm(one.gains.rms_before_mm),
                        um_from_mm(one.gains.rms_after_mm));
    if (one.gains.few) {
      text += fmt::format("{}: {} parts are too few to change its gains. They are unchanged.\n",
                          one.axis, one.part.size());
    } else if (!one.gains.fits) {
      text += fmt::format("{}: {} Its gains are unchanged.\n", one.axis,
                          kernel::outcome::sentence(Reason::thermal_model_unfit));
    }
  }
  return text;
}

/// By line of the measured file, so that the part can be found.
Json outliers_json(const std::vector<PlacedPart>& parts, const std::vector<bool>& is_outlier) {
  Json out = Json::array();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (is_outlier[i]) {
      out.push_back({{"line", parts[i].row->line},
                     {"part", parts[i].row->part},
                     {"deviation_um", um_from_mm(parts[i].row->deviation_mm)}});
    }
  }
  return out;
}

/// The next level, from all parts that count.
thermal::offline::LevelChoice choose_level(const AdaptOptions& options, const AdaptInputs& in,
                                           const std::vector<Learnt>& learnt,
                                           const std::vector<bool>& is_outlier) {
  std::vector<thermal::offline::PartError> errors;
  for (std::size_t i = 0; i < in.parts.size(); ++i) {
    if (!is_outlier[i] || !fits(learnt)) {
      errors.push_back({in.parts[i].row->deviation_mm, in.parts[i].tolerance_mm});
    }
  }
  thermal::offline::LevelRule rule;
  // One number for all parts: the gauge is the same.
  rule.measuring_sd_mm = noise_mm(options, in.passport.axis.front().noise_mm);
  return thermal::offline::next_level(in.passport.share, in.level.number, errors, rule);
}

/// Gains first, since they decide which parts are outliers; then the level from the rest.
Outcome run(const AdaptOptions& options) {
  const auto read = read_adapt_inputs(options);
  if (!read) {
    return refused(read.error());
  }
  const AdaptInputs& in = *read;
  const auto learnt = in.work ? learn(options, in.plan, *in.work, in.parts) : std::vector<Learnt>{};
  const std::vector<bool> is_outlier = outliers(learnt, in.parts.size());
  const Json left_out = outliers_json(in.parts, is_outlier);
  const auto choice = choose_level(options, in, learnt, is_outlier);
  Answer answer;
  answer.json = {
      {"level", choice.level},
      // Levels before and after: a script can undo the step.
      {"k", choice.share},
      {"level_before", in.level.number},
      {"k_before", in.level.share},
      {"parts", in.parts.size()},
      {"outside", choice.outside},
      {"largest_ratio", choice.largest_ratio},
      {"exhausted", choice.exhausted},
      {"outliers", left_out},
      {"axes", axes_json(learnt)},
      {"fits", fits(learnt)},
      {"reason", kernel::outcome::name(fits(learnt) ? Reason::none : Reason::thermal_model_unfit)}};
  answer.text = text_of(in.level, choice, learnt, in.parts.size(), left_out);
  if (!options.output.empty()) {
    const Thermal next = adapted(in.passport, choice.level, learnt);
    if (const auto written = write(options, in.machine, next); !written) {
      return refused(written.error());
    }
  }
  return answer;
}

}  // namespace
}  // namespace thermal_adapt

void add_verb_thermal_adapt(Session& session, Verb& verb) {
  auto options = std::make_shared<AdaptOptions>();
  verb.reads("plan", options->plan, "PLAN.json that the parts were made with")->required();
  verb.reads("--measured", options->measured,
             "CSV: part; transition, time_min or stamps; deviation_um (tool position minus correct "
             "position); optionally tolerance_um, axis")
      ->required();
  add_log_options(verb, options->format, "part,transition,deviation_um", false);
  verb.add_option("--started", options->started,
                  "Start of the plan's work, as 2026-11-22T23:47:06, for parts with time stamps")
      ->check([](const std::string& given) {
        return table::stamp_of(given) ? std::string{}
                                      : "is not a date and time; write 2026-11-22T23:47:06";
      });
  verb.reads("--machine", options->thermal.machine,
             "Machine file or thermal passport; default: the one the plan names");
  verb.reads("--cyclogram", options->thermal.cyclogram,
             "Cyclogram of the plan; default: the one the plan names");
  verb.reads("--program", options->thermal.program.file,
             "NC program of the plan; default: the one the plan names");
  // Temperatures and earlier work must be the plan's, or this is not the forecast that corrected
  // the parts.
  verb.add_option("--ambient", options->thermal.ambient,
                  "SENSOR=temperature in °C during the work, as for the plan");
  verb.reads("--after", options->thermal.after, "Cyclogram of earlier work, as for the plan");
  verb.add_option("--tolerance-um", options->tolerance_um, "Tolerance Δ, µm; default: the plan's")
      ->check(within(0.01, 1e5));
  verb.add_option("--noise-um", options->noise_um,
                  "Standard deviation of a measured part, µm; default: the passport's noise")
      ->check(within(0.001, 1e3));
  verb.writes("-o,--output", options->output,
              "Write the machine file (or passport) with the new level and gains",
              machine_content());
  verb.also_reads([options] { return files_of(options->plan); });
  session.on(verb, [options](Progress& /*progress*/) { return thermal_adapt::run(*options); });
}

}  // namespace steadyrest::apps::cli
