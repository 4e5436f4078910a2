// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <steadyrest/apps/cli/chatter/cut_point_options.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_simulate.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/page/chatter/cut_recorder.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/trial/vibration/vibration_summary.hpp>

// A cut in the time domain: teeth, regeneration, modes, and a tool that may leave the material. The
// linear theory says when a vibration grows; only the simulation says how large it gets, and what
// force, power and wall error come with it.
namespace steadyrest::apps::cli {
namespace chatter_simulate {
namespace {

namespace offline = chatter::offline;
using kernel::file::OutputFile;

constexpr const char* kHead =
    "t_s,angle_rad,speed_rpm,x_mm,y_mm,fx_N,fy_N,torque_Nm,power_W,chip_mm\n";

struct Options {
  CutPointOptions cut;
  double seconds = 1.0;
  std::size_t every = 1;
  std::string output;
  std::string report;
};

/// Steps after which the forced vibration repeats: a tooth pass, or a revolution where teeth differ
/// by pitch or runout. Under modulation no fixed number of time steps does, hence 0. The mean over
/// all repeats is the forced vibration; what is left is chatter.
std::size_t repeat_of(const offline::Process& process,
                      const trial::vibration::CutSettings& settings) {
  const auto cut =
      sim::CuttingProcess::make({.cut = trial::vibration::cutting_of(process, settings.depth_mm),
                                 .slowest_rev_s = settings.speed_rev_s});
  if (!cut || settings.modulation.law != chatter::online::Law::constant) {
    return 0;
  }
  const bool alike = process.even_pitch() && process.tool.runout_mm.empty();
  return alike ? cut->steps() / process.tool.teeth : cut->steps();
}

/// Positions to 1e-9 mm: growth is read off small differences.
void put_row(std::string& row, const trial::vibration::Moment& now) {
  const auto& cut = now.cut;
  row.clear();
  fmt::format_to(std::back_inserter(row),
                 "{:.9f},{:.9f},{:.6f},{:.9f},{:.9f},{:.6g},{:.6g},{:.6g},{:.6g},{:.9f}\n", now.t_s,
                 now.angle_rad, 60.0 * now.speed_rev_s, cut.displacement_mm[0],
                 cut.displacement_mm[1], cut.force_n[0], cut.force_n[1], cut.torque_n_m,
                 cut.power_w, cut.chip_mm);
}

/// A figure that this cut does not have is null.
Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Frequency of the chatter. At constant speed it comes from the simulated cut itself; under
/// modulation its lines smear, and the dominant multiplier of the linear map gives it.
std::optional<double> frequency_hz(const offline::Process& process,
                                   const trial::vibration::CutSettings& settings,
                                   const trial::vibration::Summary& summary) {
  if (settings.modulation.law == chatter::online::Law::constant) {
    return summary.frequency_hz;
  }
  offline::DelayCycle::Config config;
  config.speed_rev_s = settings.speed_rev_s;
  config.modulation = settings.modulation;
  config.most_depth_mm = settings.depth_mm;
  const auto found = offline::stability_at(process, config, {.frequency = true});
  return found ? found->frequency_hz : std::nullopt;
}

/// Stable or not comes from the growth of an infinitesimal vibration. The amplitude cannot tell:
/// once the tool leaves the cut, chatter settles at a finite size. Chatter frequency only for a cut
/// that chatters; forced amplitude only at constant speed, where it can be told apart.
Answer answer_of(const trial::vibration::Summary& summary, double log_growth, std::size_t rows) {
  Answer answer;
  const bool stable = log_growth < 0.0;
  answer.json = {{"peak_um", summary.peak_um},
                 {"growth_per_tooth", std::exp(log_growth)},
                 {"stable", stable},
                 {"forced_um", number(summary.forced_um)},
                 {"chatter_rms_um", number(summary.rest_rms_um)},
                 {"chatter_frequency_hz", stable ? Json(nullptr) : number(summary.frequency_hz)},
                 {"force_peak_N", summary.force_peak_n},
                 {"power_peak_W", summary.power_peak_w},
                 {"wall_error_um", number(summary.wall_error_um)},
                 {"wall_range_um", number(summary.wall_range_um)},
                 {"rows", rows}};
  Table table;
  table.row({"cut", stable ? "stable" : "chatters"})
      .row({"growth of a small vibration per tooth", fmt::format("{:.6g}", std::exp(log_growth))})
      .row({"largest displacement", fmt::format("{:.2f} µm", summary.peak_um)});
  if (summary.forced_um) {
    table.row({"forced amplitude", fmt::format("{:.2f} µm", *summary.forced_um)});
  }
  if (summary.frequency_hz && !stable) {
    table.row({"chatter frequency", fmt::format("{:.1f} Hz", *summary.frequency_hz)});
  }
  table.row({"largest force", fmt::format("{:.1f} N", summary.force_peak_n)});
  answer.text = table.text();
  return answer;
}

/// Every nth step as CSV; nothing without a path.
class Steps {
 public:
  static Result<Steps> make(const std::string& path, std::size_t every) {
    Steps out;
    out.every_ = every;
    if (path.empty()) {
      return out;
    }
    auto file = OutputFile::open(path);
    if (!file) {
      return std::unexpected(std::move(file.error()));
    }
    out.file_.emplace(std::move(*file));
    out.file_->write(kHead);
    return out;
  }

  void add(const trial::vibration::Moment& now) {
    if (file_ && seen_++ % every_ == 0) {
      put_row(row_, now);
      file_->write(row_);
      ++rows_;
    }
  }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] Result<void> finish() { return file_ ? file_->commit() : Result<void>{}; }

 private:
  std::optional<OutputFile> file_;
  std::string row_;
  std::size_t every_ = 1;
  std::size_t seen_ = 0;
  std::size_t rows_ = 0;
};

Outcome cut(const CutPoint& point, const Options& options, Progress& progress) {
  const trial::vibration::CutSettings settings{.speed_rev_s = point.speed_rev_s,
                                               .depth_mm = point.depth_mm,
                                               .modulation = point.law.modulation};
  // The linearised growth first: it is short and refuses impossible cuts.
  const auto growth = trial::vibration::log_growth_per_tooth(point.process, settings);
  if (!growth) {
    return refused(growth.error());
  }
  auto steps = Steps::make(options.output, options.every);
  if (!steps) {
    return refused(steps.error());
  }
  page::CutRecorder recorder(options.seconds, settings.speed_rev_s);
  trial::vibration::VibrationSummary summary(options.seconds, repeat_of(point.process, settings));
  std::size_t done = 0;
  // One pass over the steps feeds everything, because hours of steps would not fit in memory.
  const auto sink = [&](const trial::vibration::Moment& now) {
    summary.add(now);
    steps->add(now);
    if (!options.report.empty()) {
      recorder.add(now);
    }
    if (++done % 65536 == 0) {
      progress.update(now.t_s / options.seconds, "cutting");
    }
  };
  if (auto cut = trial::vibration::simulate(point.process, settings, options.seconds, sink); !cut) {
    return refused(cut.error());
  }
  if (auto written = steps->finish(); !written) {
    return refused(written.error());
  }
  trial::vibration::Summary made = summary.summary();
  // A stable cut has no chatter frequency.
  if (*growth >= 0.0) {
    made.frequency_hz = frequency_hz(point.process, settings, made);
  }
  Answer answer = answer_of(made, *growth, steps->rows());
  answer.json["speed_rpm"] = options.cut.speed_rpm;
  answer.json["depth_mm"] = point.depth_mm;
  put_law(answer.json, point.law, options.cut.speed_rpm);
  if (!options.report.empty()) {
    put_report(answer, options.report, page::simulate_page(answer.json, point.process, recorder));
  }
  return answer;
}

/// An hour is millions of tooth passes; longer is a typing error.
Outcome run(const Options& options, Progress& progress) {
  if (!(options.seconds > 0.0 && options.seconds <= 3600.0)) {
    return refused(not_allowed("--seconds", options.seconds, "above 0 and at most 3600"));
  }
  const auto point = cut_point(options.cut);
  if (!point) {
    return std::unexpected(point.error());
  }
  return cut(*point, options, progress);
}

}  // namespace
}  // namespace chatter_simulate

void add_verb_chatter_simulate(Session& session, Verb& verb) {
  auto options = std::make_shared<chatter_simulate::Options>();
  add_cut_point_options(verb, options->cut);
  verb.add_option("--seconds", options->seconds, "Length of the cut")->capture_default_str();
  CLI::Option* steps =
      verb.writes("-o,--output", options->output,
                  "Write t_s, angle_rad, speed_rpm, x_mm, y_mm, fx_N, fy_N, torque_Nm, power_W and "
                  "chip_mm for each step to this file",
                  csv_content("the steps of a cut (CSV)", {chatter_simulate::kHead}));
  verb.add_option("--every", options->every, "Write only every Nth step")
      ->check(within(1, 1e9))
      ->capture_default_str()
      ->needs(steps);
  verb.reports(options->report);
  session.on(verb,
             [options](Progress& progress) { return chatter_simulate::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
