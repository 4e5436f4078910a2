// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <vector>

#include <steadyrest/apps/page/chatter/lobes_page.hpp>
#include <steadyrest/apps/page/chatter/plan_page.hpp>

// The lobes at constant speed behind the planner's alternatives.
namespace steadyrest::apps::page {
namespace {

namespace offline = chatter::offline;
using kernel::outcome::Result;

/// Enough points for a smooth picture. A point under a law costs far more than one at constant
/// speed, so its border starts from fewer.
constexpr std::size_t kSpeeds = 241;
constexpr std::size_t kDepths = 101;
constexpr std::size_t kLawSpeeds = 41;
constexpr double kBeyond = 0.05;  ///< of the programmed speed, on both sides of the steps

std::vector<double> even(double from, double to, std::size_t count) {
  std::vector<double> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return out;
}

/// The speeds to show: all steps that may be requested, and a margin.
struct Range {
  double low_rev_s;
  double high_rev_s;
};
Range range_of(const std::vector<Step>& steps, double programmed_rev_s) {
  Range out{programmed_rev_s, programmed_rev_s};
  for (const Step& step : steps) {
    out.low_rev_s = std::min(out.low_rev_s, step.speed_rev_s);
    out.high_rev_s = std::max(out.high_rev_s, step.speed_rev_s);
  }
  // Never down to 0, where the lobes pile up.
  out.low_rev_s = std::max(out.low_rev_s - kBeyond * programmed_rev_s, 0.5 * out.low_rev_s);
  out.high_rev_s += kBeyond * programmed_rev_s;
  return out;
}

/// The border at this law over the range of the steps.
Result<offline::BorderLine> border_under(const offline::Process& process, const Range& range,
                                         std::size_t speeds, double most_depth_mm,
                                         const offline::Modulation& modulation) {
  return offline::border_line(process,
                              {.speed_rev_s = even(range.low_rev_s, range.high_rev_s, speeds),
                               .most_depth_mm = most_depth_mm,
                               .modulation = modulation});
}

}  // namespace

/// The plan has chosen already; this only draws the map around the choice.
Result<Json> plan_page(const Json& answer, const offline::Process& process,
                       const kernel::machine::Machine& machine, double programmed_rev_s,
                       const offline::Plan& plan) {
  auto steps = override_steps(process, machine, programmed_rev_s, plan.most_depth_mm, {});
  const Range range = range_of(steps, programmed_rev_s);
  auto map = offline::lobe_map(process,
                               {.speed_rev_s = even(range.low_rev_s, range.high_rev_s, kSpeeds),
                                .depth_mm = even(0.0, plan.most_depth_mm, kDepths),
                                .modulation = {}},
                               {});
  if (!map) {
    return std::unexpected(map.error());
  }
  auto border = border_under(process, range, kSpeeds, plan.most_depth_mm, {});
  if (!border) {
    return std::unexpected(border.error());
  }
  LobesPage lobes{std::move(*map), std::move(*border), {}, std::move(steps)};
  if (plan.chosen.modulation.law != chatter::online::Law::constant) {
    auto under =
        border_under(process, range, kLawSpeeds, plan.most_depth_mm, plan.chosen.modulation);
    if (!under) {
      return std::unexpected(under.error());
    }
    lobes.others.push_back({"under the chosen law", std::move(*under)});
  }
  Json page = chatter_head("plan", process.name, answer);
  page["machine"] = machine.name;
  put_lobes(page, lobes);
  return page;
}

}  // namespace steadyrest::apps::page
