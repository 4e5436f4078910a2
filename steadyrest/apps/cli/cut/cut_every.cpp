// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_best.hpp>
#include <steadyrest/apps/cli/cut/cut_every.hpp>
#include <steadyrest/apps/cli/program/ahead/over_lines.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/program/ahead/setting_words.hpp>
#include <steadyrest/contour/offline/predict/paired.hpp>
#include <steadyrest/contour/offline/settings/settings.hpp>
#include <steadyrest/trial/cut/comparison.hpp>

namespace steadyrest::apps::cli::cut {
namespace {

using trial::cut::Recorder;
using trial::cut::Way;
using trial::cut::WayFigures;

constexpr double kLong_s = 900.0;
constexpr std::size_t kManySegments = 20'000;
constexpr std::size_t kMostSettings = 2;

/// One way with its record, as long as it may be the best.
struct CutWay {
  Way way = Way::alone;
  Recorder record;
  const Corrected* text = nullptr;
};

RunPath run_path(const Corrected& text) {
  return {.path = *text.path,
          .original = *text.against->path,
          .map = contour::offline::paired(*text.path, text.against->pairing),
          .origin = text.origin};
}

/// The program as it is, judged as its cut is: by `own`, Original::of_itself().
RunPath run_path(const nc::plan::PlannedPath& path, const trial::cut::Original* own,
                 const std::vector<std::uint32_t>& same) {
  return {.path = path,
          .original = own != nullptr ? *own->path : path,
          .map = own != nullptr ? contour::offline::paired(path, own->pairing)
                                : contour::offline::same_path(path),
          .origin = same};
}

/// What the servo model leaves over the limit in the best way. `text`: null: as programmed.
Result<std::vector<contour::offline::OverLine>> over_of(const Setup& setup, const PathPointer& path,
                                                        const CorrectedWays& corrected,
                                                        const Corrected* text) {
  const std::vector<std::uint32_t> same;
  const auto own = text == nullptr ? trial::cut::Original::of_itself(path) : nullptr;
  const RunPath run = text != nullptr ? run_path(*text) : run_path(*path, own.get(), same);
  const auto found = std::ranges::find(corrected.ways, Way::text_held, &Corrected::way);
  std::optional<RunPath> held;
  if (found != corrected.ways.end() && &*found != text) {
    held.emplace(run_path(*found));
  }
  return over_lines(setup.machine, corrected.blocks, run, held ? &*held : nullptr,
                    setup.machine.contour.limit_mm);
}

}  // namespace

bool is_long(const nc::plan::PlannedPath& path, const trial::cut::Figures& now) {
  return path.segments.size() > kManySegments || now.cycle_time_s > kLong_s;
}

Result<EveryWay> cut_every(const Setup& setup, const CorrectTask& task, const PathPointer& path,
                           const Recorder& with, CutRuns& runs, std::vector<WayFigures>& ways,
                           Progress& progress) {
  progress.update(0.05, "trying settings of the control");
  auto settings =
      contour::offline::cheapest_settings(setup.machine, *path, setup.machine.contour.limit_mm);
  if (!settings) {
    return std::unexpected(settings.error());
  }
  settings->resize(std::min(settings->size(), kMostSettings));
  for (const auto& setting : *settings) {
    const auto cut = runs.run(
        {.what = "cutting with another setting", .path = path, .machine = setting.machine});
    if (!cut) {
      return std::unexpected(cut.error());
    }
    ways.push_back({Way::setting, cut->figures(), setting_words(setting)});
  }
  CorrectedWays corrected = corrected_ways(task, progress);
  std::vector<CutWay> cuts;
  for (const Corrected& text : corrected.ways) {
    auto cut =
        runs.run({.what = "cutting a corrected text", .path = text.path, .against = text.against});
    if (!cut) {
      return std::unexpected(cut.error());
    }
    ways.push_back({text.way, cut->figures(), text.command});
    cuts.push_back({text.way, std::move(*cut), &text});
  }
  EveryWay out{.best = best_of(ways),
               .best_run = {},
               .over_limit = {},
               .not_possible = std::move(corrected.not_possible)};
  const auto& best = out.best.same_time;
  const auto found = std::ranges::find(cuts, best ? best->way : Way::alone, &CutWay::way);
  const Corrected* text = found == cuts.end() ? nullptr : found->text;
  if (best) {
    out.best_run = trial::cut::run_of(text == nullptr ? with : found->record);
  }
  if (best && text == nullptr) {
    return out;  // the layer decides as it cuts
  }
  const auto over = over_of(setup, path, corrected, text);
  if (!over) {
    return std::unexpected(over.error());
  }
  std::ranges::transform(*over, std::back_inserter(out.over_limit), [&](const auto& one) {
    return in_words(one, setup.machine.contour.limit_mm);
  });
  return out;
}

}  // namespace steadyrest::apps::cli::cut
