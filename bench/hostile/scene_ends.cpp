// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include <bench/hostile/scene.hpp>
#include <fmt/format.h>

// How scenes must end: with a wish in force, or with nothing of the layer left.
namespace steadyrest::bench::hostile {
namespace {

constexpr double kLargestLimit_mm = 0.3;  ///< of vary_limits()

}  // namespace

namespace signal = kernel::signal;
using kernel::machine::Mode;
using kernel::outcome::Reason;
using signal::Motion;

/// Liveness: after long enough with good input a wish is in force, whatever happened before. A
/// layer that always stays neutral would pass every safety rule.
void Scene::settle_on_a_wish() {
  if (!feed_ || !can_.feed_override || port_->outage > 0) {
    return;
  }
  port_->behave(Motion::feed);
  wanted_ = Mode::act;
  layer_->set_mode(wanted_);
  may_write_ = true;
  spindle_wish_.clear();
  offset_wish_.clear();
  path_offset_wish_.clear();
  const double wished = dice_.within(0.05, 0.9);
  feed_wish_ = {{signal::Room::contour, wished, Reason::contour_limit}};
  // Twice the longest way, 0.2 s for the neutral times after a fault, 40 cycles of slack.
  const auto cycles =
      static_cast<std::size_t>((2.0 * feed_->longest_way_s() + 0.2) / cycle_s_) + 40;
  for (std::size_t i = 0; i < cycles && tally_.broken == 0; ++i) {
    cycle();
  }
  // The lowest value that a wish can reach: the envelope's minimum, floored to a step, and one step
  // of tolerance.
  const double least = feed_->floor(machine_.envelope.min_feed_ratio) + feed_->widest_step();
  const double most = std::max(wished, std::min(least, feed_->panel()));
  if (tally_.broken == 0 && !(feed_->in_force() <= most + kTolerance)) {
    broken(fmt::format("ends: a wish of {:g} for {} cycles, in force is {:g}, panel {:g}", wished,
                       cycles, feed_->in_force(), feed_->panel()));
  }
}

/// The other liveness rule: with good input, no cut and mode observe, nothing of the layer remains.
void Scene::settle_on_observe() {
  if (port_->outage > 0) {
    return;
  }
  port_->behave(dice_.of({Motion::idle, Motion::rapid, Motion::tool_change}));
  wanted_ = dice_.of({Mode::observe, Mode::advise});
  layer_->set_mode(wanted_);
  double for_s = 2.0 + kLargestLimit_mm / machine_.envelope.offset_slew_mm_s;
  for (const auto* watch : {&feed_, &spindle_}) {
    for_s = *watch ? std::max(for_s, 2.0 * (*watch)->longest_way_s()) : for_s;
  }
  const auto cycles = static_cast<std::size_t>(for_s / cycle_s_) + 40;
  for (std::size_t i = 0; i < cycles && tally_.broken == 0; ++i) {
    cycle();
    if (!port_->taken && i > 40 && !may_write_) {
      return;
    }
  }
  if (tally_.broken == 0 && may_write_) {
    broken(fmt::format(
        "ends: observe for {} cycles of good input without a cut, and it still writes", cycles));
  }
}

}  // namespace steadyrest::bench::hostile
