// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <steadyrest/apps/cli/law_options.hpp>
#include <steadyrest/apps/cli/table.hpp>
#include <steadyrest/apps/cli/verb_chatter_simulate.hpp>
#include <steadyrest/apps/simulate/vibration_summary.hpp>
#include <steadyrest/chatter/offline/process_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

namespace offline = chatter::offline;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;

struct Options {
  std::string process;
  double speed_rpm = 0.0;
  double depth_mm = 0.0;
  LawOptions law;
  double seconds = 1.0;
  std::size_t every = 1;
  std::string output;
};

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Refusal cannot_write(const std::string& path) {
  return {Kind::unavailable, path, 0, std::string{"cannot be written: "} + std::strerror(errno),
          "check the folder, the rights and the disk space"};
}

Refusal not_allowed(const char* option, double value, const char* allowed) {
  return {Kind::bad_input, "", 0, fmt::format("{} {} is not {}", option, value, allowed),
          fmt::format("give a number {}", allowed)};
}

/// Steps after which the forced vibration repeats; 0 under modulation.
std::size_t repeat_of(const offline::Process& process, const simulate::CutSettings& settings) {
  const auto cut =
      sim::CuttingProcess::make({.cut = simulate::cutting_of(process, settings.depth_mm),
                                 .slowest_rev_s = settings.speed_rev_s});
  if (!cut || settings.modulation.law != chatter::online::Law::constant) {
    return 0;
  }
  const bool alike = process.even_pitch() && process.tool.runout_mm.empty();
  return alike ? cut->steps() / process.tool.teeth : cut->steps();
}

void put_row(std::FILE* file, const simulate::Moment& now) {
  const auto& cut = now.cut;
  fmt::print(file, "{:.9f},{:.9f},{:.6f},{:.9f},{:.9f},{:.6g},{:.6g},{:.6g},{:.6g},{:.9f}\n",
             now.t_s, now.angle_rad, 60.0 * now.speed_rev_s, cut.displacement_mm[0],
             cut.displacement_mm[1], cut.force_n[0], cut.force_n[1], cut.torque_n_m, cut.power_w,
             cut.chip_mm);
}

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Answer answer_of(const simulate::Summary& summary, double log_growth, std::size_t rows) {
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

Outcome cut(const offline::Process& process, const simulate::CutSettings& settings,
            const Options& options, Progress& progress) {
  const auto growth = simulate::log_growth_per_tooth(process, settings);
  if (!growth) {
    return refused(growth.error());
  }
  const File file(options.output.empty() ? nullptr : std::fopen(options.output.c_str(), "wb"));
  if (!options.output.empty() && !file) {
    return refused(cannot_write(options.output));
  }
  if (file) {
    fmt::print(file.get(),
               "t_s,angle_rad,speed_rpm,x_mm,y_mm,fx_N,fy_N,torque_Nm,power_W,chip_mm\n");
  }
  simulate::VibrationSummary summary(options.seconds, repeat_of(process, settings));
  std::size_t steps = 0;
  std::size_t rows = 0;
  const auto done =
      simulate::simulate(process, settings, options.seconds, [&](const simulate::Moment& now) {
        summary.add(now);
        if (file && steps % options.every == 0) {
          put_row(file.get(), now);
          ++rows;
        }
        if (++steps % 65536 == 0) {
          progress.update(now.t_s / options.seconds, "cutting");
        }
      });
  if (!done) {
    return refused(done.error());
  }
  if (file && (std::fflush(file.get()) != 0 || std::ferror(file.get()) != 0)) {
    return refused(cannot_write(options.output));
  }
  return answer_of(summary.summary(), *growth, rows);
}

Outcome run(const Options& options, Progress& progress) {
  if (!(options.speed_rpm > 0.0 && std::isfinite(options.speed_rpm))) {
    return refused(not_allowed("--speed-rpm", options.speed_rpm, "above 0"));
  }
  if (!(options.depth_mm > 0.0 && std::isfinite(options.depth_mm))) {
    return refused(not_allowed("--depth-mm", options.depth_mm, "above 0"));
  }
  if (!(options.seconds > 0.0 && options.seconds <= 3600.0)) {
    return refused(not_allowed("--seconds", options.seconds, "above 0 and at most 3600"));
  }
  const auto process = offline::read_process(options.process);
  if (!process) {
    return refused(process.error());
  }
  const auto law = chosen_law(options.law, *process, options.speed_rpm);
  if (!law) {
    return refused(law.error());
  }
  const simulate::CutSettings settings{
      .speed_rev_s = kernel::units::rev_s_from_rpm(options.speed_rpm),
      .depth_mm = options.depth_mm,
      .modulation = law->modulation};
  return cut(*process, settings, options, progress);
}

}  // namespace

void add_verb_chatter_simulate(Session& session) {
  CLI::App& group = session.group("chatter", "Chatter: stability of a cut");
  CLI::App& verb = session.verb(
      group, "simulate", "A cut in time: the tool may leave the material",
      "chatter simulate examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm 0.5 "
      "--seconds 0.5 -o out.csv");
  auto options = std::make_shared<Options>();
  verb.add_option("process", options->process, "Process file (TOML): tool, cut and modes")
      ->required();
  verb.add_option("--speed-rpm", options->speed_rpm, "Mean spindle speed in rev/min")->required();
  verb.add_option("--depth-mm", options->depth_mm, "Axial depth of cut")->required();
  add_law_options(verb, options->law);
  verb.add_option("--seconds", options->seconds, "Time to cut")->capture_default_str();
  verb.add_option("--every", options->every, "Write each nth step only")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("-o,--output", options->output,
                  "Write t_s, angle_rad, speed_rpm, x_mm, y_mm, fx_N, fy_N, torque_Nm, power_W and "
                  "chip_mm of each step to this file");
  session.on(verb, [options](Progress& progress) { return run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
