// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/page/chatter/chatter_page.hpp>
#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/lobe_map.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::page {

/// A border to compare with.
struct Border {
  std::string name;
  chatter::offline::BorderLine line;
};

/// An override step of the machine.
struct Step {
  double ratio = 1.0;
  double speed_rev_s = 0.0;
  std::optional<double> limit_depth_mm;  ///< empty: stable at all depths of the map
};

struct LobesPage {
  chatter::offline::LobeMap map;
  chatter::offline::BorderLine border;
  std::vector<Border> others;
  std::vector<Step> steps;
};

/// Borders for comparison with the map's, at the speeds of `border` or refined as it is: under a
/// modulation the one at constant speed; the zero-order sketch of constant speed where it applies
/// (milling, straight teeth, even pitch, no process damping).
[[nodiscard]] kernel::outcome::Result<std::vector<Border>> other_borders(
    const chatter::offline::Process& process, const chatter::offline::LobeMap& map,
    const chatter::offline::BorderLine& border, const chatter::offline::Modulation& modulation);

/// The steps that may be written at this programmed speed, each with its border up to the map's
/// greatest depth, without those out of reach.
[[nodiscard]] std::vector<Step> override_steps(const chatter::offline::Process& process,
                                               const kernel::machine::Machine& machine,
                                               double programmed_rev_s, double most_depth_mm,
                                               const chatter::offline::Modulation& modulation);

/// The columns of the lobes: `map` (at most 400 speeds × 250 depths of it), `border` (whole, null
/// where all depths are stable), `others`, `steps`.
void put_lobes(Json& page, const LobesPage& lobes);

/// The page of `chatter lobes`.
[[nodiscard]] Json lobes_page(const Json& answer, const chatter::offline::Process& process,
                              const LobesPage& lobes);

}  // namespace steadyrest::apps::page
