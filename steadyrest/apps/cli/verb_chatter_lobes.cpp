// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include <fmt/core.h>
#include <fmt/format.h>

#include <steadyrest/apps/cli/grid.hpp>
#include <steadyrest/apps/cli/law_options.hpp>
#include <steadyrest/apps/cli/table.hpp>
#include <steadyrest/apps/cli/verb_chatter_lobes.hpp>
#include <steadyrest/chatter/offline/lobe_map.hpp>
#include <steadyrest/chatter/offline/process_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

namespace fs = std::filesystem;
namespace offline = chatter::offline;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;
using kernel::units::rpm_from_rev_s;

constexpr double kLeastSpeed_rpm = 1e-3;

struct Options {
  std::string process;
  std::string speeds_rpm;
  std::string depths_mm;
  LawOptions law;
  std::string output;
};

/// What was made and how long it took.
struct Made {
  offline::LobeMap map;
  double seconds = 0.0;
};

fs::path border_path(const fs::path& csv) {
  return csv.extension() == ".csv" ? fs::path(csv).replace_extension(".border.csv")
                                   : fs::path(csv.string() + ".border.csv");
}

Result<void> write(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) {
    return std::unexpected(Refusal{Kind::unavailable, path.string(), 0, "cannot be written",
                                   "check the folder, the rights and the disk space"});
  }
  return {};
}

std::string map_csv(const offline::LobeMap& map) {
  std::string out = "speed_rpm,depth_mm,spectral_radius\n";
  const std::size_t depths = map.depth_mm.size();
  for (std::size_t s = 0; s < map.speed_rev_s.size(); ++s) {
    for (std::size_t d = 0; d < depths; ++d) {
      fmt::format_to(std::back_inserter(out), "{:.10g},{:.10g},{:.12g}\n",
                     rpm_from_rev_s(map.speed_rev_s[s]), map.depth_mm[d],
                     std::exp(map.log_radius[s * depths + d]));
    }
  }
  return out;
}

/// Speeds that are stable at all depths have no row.
std::string border_csv(const offline::LobeMap& map) {
  std::string out = "speed_rpm,depth_mm\n";
  for (std::size_t s = 0; s < map.speed_rev_s.size(); ++s) {
    if (map.border_mm[s]) {
      fmt::format_to(std::back_inserter(out), "{:.10g},{:.10g}\n",
                     rpm_from_rev_s(map.speed_rev_s[s]), *map.border_mm[s]);
    }
  }
  return out;
}

Result<Made> make(const offline::Process& process, const offline::LobeMapConfig& config,
                  Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  auto map = offline::lobe_map(process, config,
                               [&progress](double share) { progress.update(share, "the map"); });
  if (!map) {
    return std::unexpected(map.error());
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return Made{std::move(*map), taken.count()};
}

/// RVF is a ratio: with a period in s the law would differ from speed to speed.
Result<ChosenLaw> law_of(const Options& options, const offline::Process& process,
                         const std::vector<double>& speeds_rpm) {
  if (speeds_rpm.size() > 1 && (options.law.period_s || options.law.amplitude_rpm)) {
    return std::unexpected(
        Refusal{Kind::bad_input, "", 0, "--period-s or --amplitude-rpm over several speeds",
                "give --rvf and --rva or --amplitude-percent, which hold at each of them"});
  }
  return chosen_law(options.law, process, speeds_rpm.front());
}

Answer answer_of(const Made& made, const ChosenLaw& law, const Options& options) {
  const offline::LobeMap& map = made.map;
  std::size_t borders = 0;
  std::optional<std::size_t> deepest;
  std::optional<std::size_t> lowest;
  for (std::size_t s = 0; s < map.speed_rev_s.size(); ++s) {
    const auto& border = map.border_mm[s];
    borders += border ? 1U : 0U;
    if (border && (!deepest || *border > *map.border_mm[*deepest])) {
      deepest = s;
    }
    if (border && (!lowest || *border < *map.border_mm[*lowest])) {
      lowest = s;
    }
  }
  Answer answer;
  answer.json = {{"seconds", made.seconds},
                 {"points", map.log_radius.size()},
                 {"speeds", map.speed_rev_s.size()},
                 {"depths", map.depth_mm.size()},
                 {"border_points", borders},
                 {"output", options.output},
                 {"border_output", border_path(options.output).string()}};
  put_law(answer.json, law, map.speed_rev_s.size() == 1 ? rpm_from_rev_s(map.speed_rev_s[0]) : 0.0);
  Table table;
  table.row({"points", fmt::format("{}", map.log_radius.size())})
      .row({"time", fmt::format("{:.3g} s", made.seconds)})
      .row({"speeds with a border", fmt::format("{} of {}", borders, map.speed_rev_s.size())});
  if (lowest) {
    table.row({"lowest border", fmt::format("{:.4g} mm at {:.6g} rpm", *map.border_mm[*lowest],
                                            rpm_from_rev_s(map.speed_rev_s[*lowest]))});
    table.row({"highest border", fmt::format("{:.4g} mm at {:.6g} rpm", *map.border_mm[*deepest],
                                             rpm_from_rev_s(map.speed_rev_s[*deepest]))});
  }
  answer.text = table.text();
  return answer;
}

Outcome run(const Options& options, Progress& progress) {
  const auto process = offline::read_process(options.process);
  if (!process) {
    return refused(process.error());
  }
  const auto speeds = grid("--speeds-rpm", options.speeds_rpm, kLeastSpeed_rpm);
  const auto depths = grid("--depths-mm", options.depths_mm, 0.0);
  if (!speeds || !depths) {
    return refused(speeds ? depths.error() : speeds.error());
  }
  const auto law = law_of(options, *process, *speeds);
  if (!law) {
    return refused(law.error());
  }
  offline::LobeMapConfig config;
  for (const double speed_rpm : *speeds) {
    config.speed_rev_s.push_back(kernel::units::rev_s_from_rpm(speed_rpm));
  }
  config.depth_mm = *depths;
  config.modulation = law->modulation;
  if (auto writable = write(options.output, ""); !writable) {  // before hours of work
    return refused(writable.error());
  }
  const auto made = make(*process, config, progress);
  if (!made) {
    return refused(made.error());
  }
  if (auto done = write(options.output, map_csv(made->map)); !done) {
    return refused(done.error());
  }
  if (auto done = write(border_path(options.output), border_csv(made->map)); !done) {
    return refused(done.error());
  }
  return answer_of(*made, *law, options);
}

}  // namespace

void add_verb_chatter_lobes(Session& session) {
  CLI::App& group = session.group("chatter", "Chatter: stability of a cut");
  CLI::App& verb =
      session.verb(group, "lobes", "Stability over speed and depth, and the border of each speed",
                   "chatter lobes examples/processes/slot-922hz.toml --speeds-rpm 5000:15000:101 "
                   "--depths-mm 0:5:51 -o lobes.csv");
  auto options = std::make_shared<Options>();
  verb.add_option("process", options->process, "Process file (TOML): tool, cut and modes")
      ->required();
  verb.add_option("--speeds-rpm", options->speeds_rpm,
                  "Mean spindle speeds in rev/min as FROM:TO:STEPS")
      ->required();
  verb.add_option("--depths-mm", options->depths_mm, "Axial depths of cut as FROM:TO:STEPS")
      ->required();
  add_law_options(verb, options->law);
  verb.add_option("-o,--output", options->output,
                  "The map (CSV: speed_rpm,depth_mm,spectral_radius); the lowest border of each "
                  "speed goes to OUT.border.csv (speed_rpm,depth_mm; no row where all depths of "
                  "the map are stable)")
      ->required();
  session.on(verb, [options](Progress& progress) { return run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
