// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>

#include <fmt/core.h>
#include <fmt/format.h>

#include <steadyrest/apps/cli/chatter/verb_chatter_fit.hpp>
#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/page/chatter/fit_page.hpp>
#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/chatter/offline/response/mode_fit.hpp>
#include <steadyrest/kernel/file/output_file.hpp>

namespace steadyrest::apps::cli {
namespace chatter_fit {
namespace {

// A tap test gives H(f) at the tool tip. The fit turns it into the [[mode]] sections that a process
// file takes (the law is in chatter/offline/response/mode_fit.hpp).
namespace offline = chatter::offline;

struct Options {
  std::vector<std::string> files;
  std::string axis;
  std::string output;
  std::string report;
  offline::ModeFitConfig fit;
  LogOptions format;
};

/// Sections for a process file. Eight digits of frequency: the border moves with the frequency and
/// its flanks are steep, so nothing may be lost by printing.
std::string modes_toml(const offline::ModeFit& fit, const Options& options) {
  std::string out =
      fmt::format("# Fitted by steadyrest chatter fit: {} {}, residual {:.3g} %\n",
                  fit.modes.size(), fit.modes.size() == 1 ? "mode" : "modes", 100.0 * fit.residual);
  for (const offline::FittedMode& mode : fit.modes) {
    fmt::format_to(std::back_inserter(out),
                   "\n[[mode]]\naxis = \"{}\"\nfrequency_hz = {:#.8g}\ndamping_ratio = {:#.6g}\n"
                   "mass_kg = {:#.6g}\n",
                   options.axis, mode.frequency_hz, mode.damping_ratio, mode.mass_kg);
  }
  return out;
}

/// Modes, and how well they describe the measurement: residual, noise, and the criterion for each
/// order tried.
Answer answer_of(const offline::ModeFit& fit, const Options& options) {
  Answer answer;
  Json modes = Json::array();
  Table table({"mode", "Hz", "damping", "kg", "N/µm"});
  for (const offline::FittedMode& mode : fit.modes) {
    modes.push_back({{"axis", options.axis},
                     {"frequency_hz", mode.frequency_hz},
                     {"damping_ratio", mode.damping_ratio},
                     {"mass_kg", mode.mass_kg},
                     // N/mm to N/µm.
                     {"stiffness_N_um", 1e-3 * mode.stiffness_n_mm}});
    table.row({options.axis, fmt::format("{:.2f}", mode.frequency_hz),
               fmt::format("{:.3f} %", 100.0 * mode.damping_ratio),
               fmt::format("{:.4g}", mode.mass_kg),
               fmt::format("{:.4g}", 1e-3 * mode.stiffness_n_mm)});
  }
  answer.json = {{"modes", modes},
                 {"order", fit.modes.size()},
                 {"residual", fit.residual},
                 {"noise_ratio", fit.noise_ratio},
                 {"noise_um_N", 1e3 * fit.noise_mm_n},
                 {"criterion", fit.criterion},
                 {"points", fit.points}};
  answer.text = table.text() + fmt::format("residual: {:.3g} % of the response (RMS), {} points\n",
                                           100.0 * fit.residual, fit.points);
  return answer;
}

/// Below 0.8 the usual advice is to repeat the tap: a double hit, too soft a tip, or noise.
constexpr double kLowCoherence = 0.8;

/// What each file holds and how good it is. An accelerometer gives accelerance; each integration
/// divides by iω, so displacement follows after one (velocity) or two (acceleration).
void put_response(Answer& answer, const std::string& file, const offline::Frf& frf) {
  constexpr std::array kMeasured = {"displacement", "velocity", "acceleration"};
  const auto order = static_cast<std::size_t>(frf.measured_order);
  Json one = {{"file", file}, {"measured", kMeasured[order]}, {"points", frf.frequency_hz.size()}};
  if (order > 0) {
    answer.text += fmt::format("{}: {} per force, converted to displacement by {}\n", file,
                               kMeasured[order], order == 1 ? "1/(iω)" : "−1/ω²");
  }
  if (!frf.coherence.empty()) {
    const auto low =
        std::ranges::count_if(frf.coherence, [](double c) { return c < kLowCoherence; });
    one["coherence_low_points"] = low;
    one["coherence_min"] = *std::ranges::min_element(frf.coherence);
    if (low > 0) {
      answer.text += fmt::format("{}: coherence below {} at {} of {} points\n", file, kLowCoherence,
                                 low, frf.coherence.size());
    }
  }
  one["notes"] = frf.notes;
  for (const std::string& note : frf.notes) {
    answer.text += fmt::format("{}: {}\n", file, note);
  }
  answer.json["responses"].push_back(std::move(one));
}

/// The page's legend needs one name per curve: a universal file may hold several responses, which
/// are numbered.
page::Json page_of(const Json& answer, const Options& options, const offline::ModeFit& fit,
                   const std::vector<offline::Frf>& responses) {
  const auto name_of = [](const std::string& file) {
    return std::filesystem::path(file).filename().string();
  };
  page::FitPage page{.title = name_of(options.files.front()), .axis = options.axis, .measured = {}};
  std::map<std::string, int> seen;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const std::string name = name_of(answer["responses"][i]["file"].get<std::string>());
    const int count = ++seen[name];
    page.measured.push_back(
        {count == 1 ? name : fmt::format("{}, {}", name, count), &responses[i]});
  }
  return page::fit_page(answer, page, fit, options.fit);
}

/// All responses of all files count as measurements of one point in one direction.
Outcome run(const Options& options) {
  std::vector<offline::Frf> responses;
  Answer said;
  said.json["responses"] = Json::array();
  for (const std::string& file : options.files) {
    auto read = offline::read_frf(file, format_of(options.format));
    if (!read) {
      return refused(read.error());
    }
    for (offline::Frf& frf : *read) {
      put_response(said, file, frf);
      responses.push_back(std::move(frf));
    }
  }
  const auto fit = offline::fit_modes(responses, options.fit);
  if (!fit) {
    return refused(fit.error());
  }
  // The file first, then the report: the modes are the result that was asked for.
  if (!options.output.empty()) {
    if (auto written = kernel::file::write_file(options.output, modes_toml(*fit, options));
        !written) {
      return refused(written.error());
    }
  }
  Answer answer = answer_of(*fit, options);
  answer.json.update(said.json);
  answer.text += said.text;
  if (!options.report.empty()) {
    put_report(answer, options.report, page_of(answer.json, options, *fit, responses));
  }
  return answer;
}

}  // namespace
}  // namespace chatter_fit

void add_verb_chatter_fit(Session& session, Verb& verb) {
  auto options = std::make_shared<chatter_fit::Options>();
  verb.reads("frf", options->files,
             "Responses at one point in one direction: CSV (frequency_hz, real and imag or "
             "magnitude and phase, coherence if recorded; displacement, velocity or acceleration "
             "per N, unit in the header) or universal file format 58")
      ->required();
  verb.add_option("--axis", options->axis, "Direction of measurement: x or y")
      ->required()
      ->check(CLI::IsMember({"x", "y"}));
  verb.add_option("--modes", options->fit.order,
                  "Number of modes, 1 … 16; chosen by the criterion by default")
      ->check(within(1, 16));
  add_log_options(verb, options->format, "frequency_hz,real_um_N,imag_um_N", false);
  verb.add_option("--from-hz", options->fit.least_frequency_hz,
                  "Ignore everything below this frequency");
  verb.add_option("--to-hz", options->fit.most_frequency_hz,
                  "Ignore everything above this frequency");
  verb.writes("-o,--output", options->output,
              "Write the modes to this file (TOML: [[mode]] sections for a process file)",
              toml_content("a file with nothing but modes (TOML: [[mode]])", {"mode"}));
  verb.reports(options->report);
  session.on(verb, [options](Progress& /*progress*/) { return chatter_fit::run(*options); });
}

}  // namespace steadyrest::apps::cli
