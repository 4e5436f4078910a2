// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <bench/hostile/variant.hpp>

namespace steadyrest::bench::hostile {
namespace {

constexpr std::size_t kMostSteps = 256;  // of a byte

std::vector<double> repeated(const std::vector<double>& ratio, Dice& dice) {
  const std::size_t seldom = dice.of<std::size_t>({1, 1, 3, 10});
  std::vector<double> out;
  // Each value has its step: a panel above the highest one would be of another switch.
  std::size_t spare = kMostSteps - std::min(kMostSteps, ratio.size());
  for (const double step : ratio) {
    const std::size_t more = std::min(spare, dice.one_in(seldom) ? dice.below(5) : 0);
    spare -= more;
    out.insert(out.end(), 1 + more, step);
  }
  return out;
}

/// Of few values or of many, 0 among them or not.
std::vector<double> filled(Dice& dice) {
  const std::size_t values = 1 + dice.below(dice.of<std::size_t>({2, 20, 300}));
  const double low = dice.of({0.0, 0.0, 0.3});
  std::vector<double> some(values);
  for (double& value : some) {
    value = dice.within(low, 1.3);
  }
  some.front() = 1.0;  // where the panel begins
  std::vector<double> out(kMostSteps);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = i == 0 ? low : some[i % some.size()];
  }
  std::ranges::sort(out);
  return out;
}

void give_codes(kernel::machine::OverrideTable& table, Dice& dice) {
  if (table.coding == kernel::machine::Coding::gray) {
    table.code.clear();  // those of the positions
    return;
  }
  table.code.resize(table.ratio.size());
  for (std::size_t i = 0; i < table.code.size(); ++i) {
    table.code[i] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = table.code.size(); i > 1 && dice.one_in(2); --i) {
    std::swap(table.code[i - 1], table.code[dice.below(i)]);
  }
}

}  // namespace

void vary_steps(kernel::machine::OverrideTable& table, Dice& dice) {
  if (table.ratio.empty()) {
    return;
  }
  const std::vector<double> before = table.ratio;
  switch (dice.below(8)) {
    case 0:
      table.ratio = {dice.of({1.0, before[dice.below(before.size())], before.back()})};
      table.ratio.front() = std::max(table.ratio.front(), 0.05);
      break;
    case 1:
      table.ratio = filled(dice);
      break;
    case 2:
    case 3:
    case 4:
      table.ratio = repeated(before, dice);
      break;
    case 5:
      table.max_ratio = dice.of({0.6, 1.0, 1.1});
      break;
    default:
      break;
  }
  give_codes(table, dice);
}

void repeat_steps(kernel::machine::OverrideTable& table, Dice& dice) {
  table.ratio = repeated(table.ratio, dice);
  give_codes(table, dice);
}

void vary(kernel::machine::Machine& m, Dice& dice) {
  for (auto* table : {&m.feed_override, &m.spindle_override}) {
    vary_steps(*table, dice);
    table->layer_may_exceed_panel = dice.one_in(4);
    if (table->coding == kernel::machine::Coding::gray) {
      table->latched_word = dice.one_in(2);
    }
    if (dice.one_in(3)) {
      table->scan_period_s = dice.of({0.0, 0.002, 0.01, 0.05});
    }
  }
  if (dice.one_in(2)) {
    m.envelope.feed_fall_1_s = dice.of({0.5, 2.0, 10.0, 100.0});
    m.envelope.feed_rise_1_s = dice.of({0.2, 1.0, 5.0, 50.0});
    m.envelope.spindle_slew_1_s = dice.of({0.5, 2.0, 10.0});
    m.envelope.offset_slew_mm_s = dice.of({0.01, 0.05, 1.0});
  }
  m.envelope.max_path_offset_mm = dice.of({0.0, 0.1, 0.5});
  m.envelope.path_offset_slew_mm_s = dice.of({1.0, 50.0});
  m.mode = dice.of({kernel::machine::Mode::observe, kernel::machine::Mode::advise,
                    kernel::machine::Mode::act, kernel::machine::Mode::act});
  m.contour.enabled = false;
}

void vary_limits(kernel::machine::Machine& m, Dice& dice) {
  m.envelope.max_offset_mm = dice.of({0.0, 0.02, 0.2, 0.3});
  m.envelope.max_path_offset_mm = dice.of({0.0, 0.05, 0.1, 0.5});
}

}  // namespace steadyrest::bench::hostile
