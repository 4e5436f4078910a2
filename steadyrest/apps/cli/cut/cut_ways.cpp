// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_ways.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli::cut {

using kernel::machine::Machine;
using kernel::units::um_from_mm;
using trial::cut::CurvePoint;
using trial::cut::Figures;
using trial::cut::Way;
using trial::cut::WayFigures;

namespace {

constexpr std::array kCurveLimits_um = {5.0, 10.0, 20.0, 50.0};

const char* words_of(Way way) {
  switch (way) {
    case Way::alone:
      return "as programmed";
    case Way::setting:
      return "setting of the control";
    case Way::text:
      return "corrected text";
    case Way::text_held:
      return "corrected text, limit held";
    case Way::text_feeds:
      return "lower feeds in the text";
    case Way::feed_override:
      return "feed override";
    case Way::path_offsets:
      return "path offsets";
    case Way::changed:
      return "changed program";
    case Way::changed_feed_override:
      return "changed, with feed override";
    case Way::changed_path_offsets:
      return "changed, with path offsets";
  }
  return "";
}

const Machine& layer_machine(const Setup& setup) {
  return setup.believed ? *setup.believed : setup.machine;
}

/// The layer's machine file as one without path offsets.
Machine override_alone(const Setup& setup) {
  Machine machine = layer_machine(setup);
  machine.envelope.max_path_offset_mm = 0.0;
  return machine;
}

std::vector<std::string> row_of(const std::string& name, const Figures& figures) {
  const double share = figures.samples == 0 ? 0.0
                                            : static_cast<double>(figures.samples_over_limit) /
                                                  static_cast<double>(figures.samples);
  return {name, fmt::format("{:.2f} s", figures.cycle_time_s),
          fmt::format("{:.1f} µm", um_from_mm(figures.contour_error_max_mm)),
          fmt::format("{:.1f} µm", um_from_mm(figures.contour_error_rms_mm)),
          fmt::format("{:.2f} %", kernel::units::percent_from_ratio(share))};
}

}  // namespace

void add_ways_options(Verb& verb, WaysOptions& options) {
  CLI::Option* const quick =
      verb.add_flag("--quick", options.quick,
                    "Cut the part twice alone, without and with the layer: no corrected text, no "
                    "other setting of the control");
  verb.add_flag("--all", options.all,
                "Work out every way for programs of over 15 minutes or 20000 blocks, too")
      ->excludes(quick);
  verb.add_flag("--ways", options.ways,
                "Compare the ways where that is not done by itself: of a changed program, with "
                "--process, --batch or --record");
  verb.add_flag(
      "--curve", options.curve,
      "With the ways, the feed override at limits of 5, 10, 20 and 50 µm as well as at the "
      "machine's own: what accuracy costs in time. Up to four more cuts");
}

bool permits_offsets(const Setup& setup) {
  return setup.machine.envelope.max_path_offset_mm > 0.0 &&
         layer_machine(setup).envelope.max_path_offset_mm > 0.0;
}

std::vector<Further> further_runs(const Setup& setup, const PathPointer& path, bool changed,
                                  const WaysOptions& options) {
  std::vector<Further> out;
  const auto ask = [&](Way way, double curve_limit_um, std::string what,
                       std::optional<Machine> believed) {
    out.push_back({.way = way,
                   .curve_limit_um = curve_limit_um,
                   .get = way == Way::feed_override ? "the layer, by feed override"
                                                    : "the layer, by path offsets",
                   .asked = {.what = std::move(what),
                             .path = path,
                             .with_layer = true,
                             .believed = std::move(believed)}});
  };
  // Of a program that is not changed, `cut` has made the run with the layer.
  if (changed || permits_offsets(setup)) {
    ask(Way::feed_override, 0.0, "cutting with feed override", override_alone(setup));
  }
  if (changed && permits_offsets(setup)) {
    ask(Way::path_offsets, 0.0, "cutting with path offsets", std::nullopt);
  }
  if (options.curve) {
    for (const double limit_um : kCurveLimits_um) {
      Machine machine = override_alone(setup);
      // The feed override at the machine's own limit is a way already.
      if (std::abs(limit_um - um_from_mm(machine.contour.limit_mm)) < 1e-6) {
        continue;
      }
      machine.contour.limit_mm = kernel::units::mm_from_um(limit_um);
      ask(Way::feed_override, limit_um, fmt::format("cutting at a limit of {} µm", limit_um),
          std::move(machine));
    }
  }
  return out;
}

void Ways::sort() {
  std::ranges::sort(ways, {}, &WayFigures::way);
  std::ranges::sort(curve, {}, &CurvePoint::limit_um);
}

std::string put_ways(Answer& answer, const Ways& ways, double limit_mm) {
  if (ways.ways.empty()) {
    return {};
  }
  answer.json["ways"] = Json::array();
  answer.json["curve"] = Json::array();
  Table table({"way", "cycle time", "largest error", "RMS",
               fmt::format("over {:.4g} µm", um_from_mm(limit_mm))});
  for (const WayFigures& way : ways.ways) {
    answer.json["ways"].push_back(page::to_object(way));
    table.row(row_of(words_of(way.way), way.figures));
  }
  for (const CurvePoint& point : ways.curve) {
    answer.json["curve"].push_back(page::to_object(point));
    table.row(row_of(fmt::format("feed override for {:g} µm", point.limit_um), point.figures));
  }
  return "\n" + table.text();
}

}  // namespace steadyrest::apps::cli::cut
