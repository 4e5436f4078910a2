// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <steadyrest/apps/page/chatter/lobes_page.hpp>
#include <steadyrest/apps/page/shared/json_numbers.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/depth/zero_order.hpp>
#include <steadyrest/chatter/offline/plan/drive_limits.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// Stability lobes: the map thinned to what a screen shows, the borders whole.
namespace steadyrest::apps::page {
namespace {

namespace offline = chatter::offline;
using kernel::outcome::Result;
using kernel::units::rpm_from_rev_s;
using offline::LobeMap;
using offline::Process;

constexpr std::size_t kMostSpeeds = 400;
constexpr std::size_t kMostDepths = 250;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// At most `most` evenly spaced indices out of `count`, including both ends, so that the map keeps
/// its range.
std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  const std::size_t n = std::min(count, most);
  std::vector<std::size_t> out;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back(n == 1 ? 0 : i * (count - 1) / (n - 1));
  }
  return out;
}

/// The values at the thinned indices.
std::vector<double> picked(const std::vector<double>& values, std::size_t most) {
  std::vector<double> out;
  for (const std::size_t i : thinned(values.size(), most)) {
    out.push_back(values[i]);
  }
  return out;
}

std::vector<double> in_rpm(std::vector<double> speed_rev_s) {
  std::ranges::transform(speed_rev_s, speed_rev_s.begin(), rpm_from_rev_s);
  return speed_rev_s;
}

/// Stable at all depths: NaN here, null in the page, a gap in the line.
std::vector<double> or_nan(const std::vector<std::optional<double>>& values) {
  std::vector<double> out;
  out.reserve(values.size());
  for (const auto& value : values) {
    out.push_back(value.value_or(kNaN));
  }
  return out;
}

/// Zero order (Altintas, Budak 1995) averages the cutting forces over a revolution: straight teeth
/// of even pitch in milling, no process damping. It is a sketch to compare with and never decides.
bool sketch_applies(const Process& process) {
  return process.cut.operation == offline::Operation::milling && process.even_pitch() &&
         process.tool.helix_rad == 0.0 && process.cut.process_damping_n_mm == 0.0;
}

Json map_json(const LobeMap& map) {
  const auto speeds = thinned(map.speed_rev_s.size(), kMostSpeeds);
  const auto depths = thinned(map.depth_mm.size(), kMostDepths);
  std::vector<double> log_radius;
  for (const std::size_t s : speeds) {
    for (const std::size_t d : depths) {
      log_radius.push_back(map.log_radius[s * map.depth_mm.size() + d]);
    }
  }
  return {{"speed_rpm", in_rpm(picked(map.speed_rev_s, kMostSpeeds))},
          {"depth_mm", picked(map.depth_mm, kMostDepths)},
          {"log_radius", short_numbers(log_radius)}};
}

}  // namespace

/// Under a law, the border at constant speed shows the law's benefit.
Result<std::vector<Border>> other_borders(const Process& process, const LobeMap& map,
                                          const offline::BorderLine& border,
                                          const offline::Modulation& modulation) {
  std::vector<Border> out;
  if (modulation.law != chatter::online::Law::constant) {
    // Thinned like the map: this border is refined again between its points.
    auto constant =
        offline::border_line(process, {.speed_rev_s = picked(map.speed_rev_s, kMostSpeeds),
                                       .most_depth_mm = map.depth_mm.back(),
                                       .modulation = {}});
    if (!constant) {
      return std::unexpected(constant.error());
    }
    out.push_back({"constant speed", std::move(*constant)});
  }
  if (sketch_applies(process)) {
    Border sketch{"zero-order sketch", {.speed_rev_s = border.speed_rev_s, .depth_mm = {}}};
    for (const double speed : border.speed_rev_s) {
      sketch.line.depth_mm.push_back(offline::zero_order_limit_mm(process, speed));
    }
    out.push_back(std::move(sketch));
  }
  return out;
}

/// The border at each step that may be written, under the same law as the map.
std::vector<Step> override_steps(const Process& process, const kernel::machine::Machine& machine,
                                 double programmed_rev_s, double most_depth_mm,
                                 const offline::Modulation& modulation) {
  const offline::DriveLimits limits(machine, process, most_depth_mm, {});
  std::vector<Step> out;
  for (const double ratio : limits.writable(programmed_rev_s)) {
    const double speed = ratio * programmed_rev_s;
    const auto limit = offline::limit_depth_mm(process, speed, modulation, most_depth_mm);
    if (limit) {  // the planner reports the steps that the solver does not reach
      out.push_back({ratio, speed, *limit});
    }
  }
  return out;
}

/// A step without a limit is stable to the bottom of the map.
void put_lobes(Json& page, const LobesPage& lobes) {
  page["map"] = map_json(lobes.map);
  page["border"] = {{"speed_rpm", in_rpm(lobes.border.speed_rev_s)},
                    {"depth_mm", or_nan(lobes.border.depth_mm)}};
  page["others"] = Json::array();
  for (const Border& other : lobes.others) {
    page["others"].push_back({{"name", other.name},
                              {"speed_rpm", short_numbers(in_rpm(other.line.speed_rev_s))},
                              {"depth_mm", short_numbers(or_nan(other.line.depth_mm))}});
  }
  page["steps"] = Json::array();
  for (const Step& step : lobes.steps) {
    page["steps"].push_back(
        {{"percent", short_number(kernel::units::percent_from_ratio(step.ratio))},
         {"speed_rpm", short_number(rpm_from_rev_s(step.speed_rev_s))},
         {"limit_depth_mm", step.limit_depth_mm ? Json(*step.limit_depth_mm) : Json(nullptr)}});
  }
}

/// The page of `chatter lobes`; the plan's page takes the same columns.
Json lobes_page(const Json& answer, const Process& process, const LobesPage& lobes) {
  Json page = chatter_head("lobes", process.name, answer);
  put_lobes(page, lobes);
  return page;
}

}  // namespace steadyrest::apps::page
