// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/motion/verb_motion_bench.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/motion/bench_page.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/motion/offline/bench/benchmark.hpp>
#include <steadyrest/motion/offline/bench/estimator_choice.hpp>
#include <steadyrest/motion/offline/bench/requirement.hpp>

// All estimators on exactly known motions, against each other, against LinuxCNC's own encoder
// component, and against the limits of physics. The project's own figures come from the same table.
namespace steadyrest::apps::cli {
namespace motion_bench {
namespace {

namespace fs = std::filesystem;
namespace offline = motion::offline;
using offline::BenchRow;

struct Options {
  offline::BenchConfig bench;
  std::string recorded;
  std::string peer;
  std::string csv;
  std::string page;
};

/// The second table: where the source's required accuracy is met, and where no estimator can meet
/// it.
fs::path requirement_path(const fs::path& csv) {
  return fs::path(csv).replace_extension(".requirement.csv");
}

/// The table and the requirement.
std::vector<PlannedFile> table_files(const std::string& csv) {
  return {{csv, csv_content("a benchmark table (CSV)", {"scene,estimator,limits,ticks,"})},
          {requirement_path(csv).string(),
           csv_content("a requirement table (CSV)", {"speed_mm_s,clock_s,line_error_counts,"})}};
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "–";
}

/// A figure next to its target, so that a miss shows in the table.
std::string against(double value, double target) {
  if (!std::isfinite(target)) {
    return number(value);
  }
  return fmt::format("{} {} {}", number(value), value <= target ? "≤" : ">", number(target));
}

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.6g} %", 100.0 * share) : "–";
}

/// One line per scene and estimator: error against the required one, gain over differences of
/// counts, and whether stated bounds hold.
std::string people_table(const offline::Benchmark& benchmark) {
  Table table({"scene, estimator", "v, mm/s", "gain", "a, mm/s²", "gain", "within bound",
               "bound/RMS v", "a", "ns/tick", "ns/edge"});
  for (const BenchRow& row : benchmark.rows) {
    // How far the stated bound is above the real error: near 1 it would often be broken, far above
    // it would be useless.
    const auto ratio = [](const offline::ErrorFigures& e) {
      return number(e.bound_rms_at_speed / e.rms_at_speed);
    };
    table.row({fmt::format("{}, {}{}", row.scene, row.estimator, row.limits ? " + limits" : ""),
               against(row.velocity.rms, row.target_velocity_mm_s), number(row.velocity_gain),
               against(row.acceleration.rms, row.target_acceleration_mm_s2),
               number(row.acceleration_gain), percent(row.velocity.coverage), ratio(row.velocity),
               ratio(row.acceleration), number(row.ns_per_tick), number(row.ns_per_edge)});
  }
  std::string out = table.text();
  for (const std::string& note : benchmark.notes) {
    out += note + "\n";
  }
  return out;
}

/// All figures of all rows, unrounded.
Json rows_json(const offline::Benchmark& benchmark) {
  Json out = Json::array();
  for (const BenchRow& row : benchmark.rows) {
    out.push_back({{"scene", row.scene},
                   {"estimator", row.estimator},
                   {"limits", row.limits},
                   {"ticks", row.ticks},
                   {"velocity_mm_s",
                    page::to_figures(row.velocity, row.velocity_gain, row.velocity_efficiency)},
                   {"acceleration_mm_s2", page::to_figures(row.acceleration, row.acceleration_gain,
                                                           row.acceleration_efficiency)},
                   {"contradictions", row.contradictions},
                   {"ns_per_tick", row.ns_per_tick},
                   {"ns_per_edge", row.ns_per_edge},
                   {"target_velocity_mm_s", row.target_velocity_mm_s},
                   {"target_acceleration_mm_s2", row.target_acceleration_mm_s2}});
  }
  return out;
}

/// Writes the requested tables and hands the page to the session; returns the names. The
/// requirement takes long, so nothing is computed when nothing is written.
Result<Json> write_files(const Options& options, const offline::Benchmark& benchmark,
                         std::vector<Page>& pages, Progress& progress) {
  Json files = Json::array();
  if (options.csv.empty() && options.page.empty()) {
    return files;
  }
  auto requirement = offline::requirement_table(
      {}, [&progress](double share) { progress.update(share, "the requirement"); });
  if (!requirement) {
    return std::unexpected(requirement.error());
  }
  std::vector<kernel::file::FileText> out;
  if (!options.csv.empty()) {
    out.push_back({options.csv, offline::to_csv(benchmark)});
    out.push_back({requirement_path(options.csv).string(), offline::to_csv(*requirement)});
  }
  if (!options.page.empty()) {
    const auto data = page::page_data(benchmark, std::move(*requirement));
    if (!data) {
      return std::unexpected(data.error());
    }
    pages.push_back({.folder = {}, .file = options.page, .data = page::to_page(*data)});
  }
  // Both tables or none.
  if (const auto written = kernel::file::write_files(out); !written) {
    return std::unexpected(written.error());
  }
  for (const kernel::file::FileText& one : out) {
    files.push_back(one.file);
  }
  if (!options.page.empty()) {
    files.push_back(options.page);
  }
  return files;
}

/// The scenes first, the tables after them: a misspelt estimator is refused at once.
Outcome run(Options options, Progress& progress) {
  options.bench.recorded_folder = options.recorded;
  options.bench.peer = options.peer;
  const auto benchmark = offline::run_benchmark(
      options.bench,
      [&progress](double share, std::string_view what) { progress.update(share, what); });
  if (!benchmark) {
    return refused(benchmark.error());
  }
  Answer answer;
  const auto files = write_files(options, *benchmark, answer.pages, progress);
  if (!files) {
    return refused(files.error());
  }
  answer.json = {{"rows", rows_json(*benchmark)}, {"notes", benchmark->notes}, {"files", *files}};
  answer.text = people_table(*benchmark);
  return answer;
}

}  // namespace
}  // namespace motion_bench

void add_verb_motion_bench(Session& session, Verb& verb) {
  auto options = std::make_shared<motion_bench::Options>();
  verb.add_option("--scenes", options->bench.scenes,
                  "Scenes or families of scenes, separated by commas: sine, sine-line, "
                  "sine-line-calibrated, s-curve, flywheel, dither, reversal, constant, jitter, "
                  "lost, clock, recorded; default: all")
      ->delimiter(',');
  verb.add_option("--estimators", options->bench.estimators,
                  fmt::format("Any of {}; default: all",
                              fmt::join(motion::offline::estimator_names(), ",")))
      ->delimiter(',');
  verb.reads("--recorded", options->recorded,
             "Folder with the recorded logs (k50m.csv or k50m.csv.gz, …)");
  verb.reads("--linuxcnc", options->peer,
             "Program that runs LinuxCNC's encoder component: steadyrest_encoder_peer");
  verb.add_option("--phases", options->bench.phases,
                  "Number of start positions within a count for the S-curve")
      ->capture_default_str();
  verb.writes("-o,--output", options->csv,
              "Write the table to this CSV, with the requirement next to it",
              motion_bench::table_files);
  verb.writes_page("--page", options->page, "Write everything to this HTML page");
  session.on(verb, [options](Progress& progress) { return motion_bench::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
