// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/kernel/override/table.hpp>

// What each code means is machine data: 11010 is 100 % on one 840D, 70 % on a DMG panel. A table is
// checked once, here; afterwards only an unknown code can fail a look-up.
namespace steadyrest::kernel::override {
namespace {

using Check = std::optional<outcome::Refusal>;

// Ascending order makes "the next step" the neighbour in ratio as well as in code.
Check check_ratios(const std::vector<double>& ratio) {
  if (ratio.empty()) {
    return outcome::bad_input("an override table has no steps",
                              "list the ratio of each switch position");
  }
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    if (!std::isfinite(ratio[i]) || ratio[i] < 0.0) {
      return outcome::bad_input(
          fmt::format("override step {} has ratio {}; allowed: a finite ratio ≥ 0", i, ratio[i]),
          "correct the value");
    }
    if (i > 0 && ratio[i] < ratio[i - 1]) {
      return outcome::bad_input(
          fmt::format("override step {} has ratio {}, less than {} of the step before", i, ratio[i],
                      ratio[i - 1]),
          "list the steps in rising order");
    }
  }
  return std::nullopt;
}

// A Gray table whose neighbours differ in two bits is a typing error, and a dangerous one.
Check check_codes(const Table::Config& config) {
  const auto& code = config.code;
  if (code.size() != config.ratio.size()) {
    return outcome::bad_input(
        fmt::format("an override table has {} ratios and {} codes", config.ratio.size(),
                    code.size()),
        "give each step one code, or a Gray table none for the codes of positions 1, 2, 3 …");
  }
  if (config.coding != machine::Coding::gray) {
    return std::nullopt;
  }
  for (std::size_t i = 1; i < code.size(); ++i) {
    const int bits = std::popcount(code[i] ^ code[i - 1]);
    if (bits != 1) {
      return outcome::bad_input(
          fmt::format("Gray codes {:05b} and {:05b} of override steps {} and {} differ "
                      "in {} bits; neighbours differ in exactly one",
                      code[i - 1], code[i], i - 1, i, bits),
          "correct the codes, or say that the coding is binary");
    }
  }
  return std::nullopt;
}

Check check_scalars(const Table::Config& config) {
  if (std::isnan(config.max_ratio) || config.max_ratio <= 0.0) {
    return outcome::bad_input(
        fmt::format("max_ratio of an override is {}; allowed: > 0", config.max_ratio),
        "give the ratio at which the control clips");
  }
  for (const double time_s : {config.scan_period_s, config.dead_time_s}) {
    if (!std::isfinite(time_s) || time_s < 0.0) {
      return outcome::bad_input(
          fmt::format("a time of an override table is {} s; allowed: finite and ≥ 0", time_s),
          "correct the scan period and the dead time");
    }
  }
  return std::nullopt;
}

// SINUMERIK's switches: Gray code of the position, counted from 1 (0 is an open cable).
std::vector<std::uint32_t> position_codes(std::size_t steps) {
  std::vector<std::uint32_t> code(steps);
  for (std::size_t i = 0; i < steps; ++i) {
    code[i] = sinumerik_code(i);
  }
  return code;
}

}  // namespace

outcome::Result<Table> Table::make(const Config& config) {
  Config filled = config;
  if (filled.code.empty() && filled.coding == machine::Coding::gray) {
    filled.code = position_codes(filled.ratio.size());
  }
  for (const Check& check :
       {check_ratios(filled.ratio), check_codes(filled), check_scalars(filled)}) {
    if (check) {
      return std::unexpected(*check);
    }
  }
  Table table;
  double before = -1.0;
  for (double& ratio : filled.ratio) {
    // Nobody can ask for what the control clips.
    ratio = std::min(ratio, filled.max_ratio);
    // The same within rounding is the same to the last bit: queries compare exactly.
    ratio = ratio - before <= kRatioTolerance ? before : ratio;
    before = ratio;
  }
  for (std::size_t i = 0; i < filled.code.size(); ++i) {
    table.by_code_.push_back({.code = filled.code[i], .step = static_cast<std::uint32_t>(i)});
  }
  // Sorted by code, so that a look-up in the cycle is a binary search without allocation.
  std::ranges::sort(table.by_code_, {}, &CodeEntry::code);
  const auto twin = std::ranges::adjacent_find(table.by_code_, {}, &CodeEntry::code);
  if (twin != table.by_code_.end()) {
    return outcome::refuse(fmt::format("override steps {} and {} have the same code {:#b}",
                                       twin->step, (twin + 1)->step, twin->code),
                           "give each step its own code");
  }
  table.ratio_ = std::move(filled.ratio);
  table.code_ = std::move(filled.code);
  table.coding_ = filled.coding;
  table.scan_period_s_ = filled.scan_period_s;
  table.dead_time_s_ = filled.dead_time_s;
  table.latched_word_ = filled.latched_word;
  table.layer_may_exceed_panel_ = filled.layer_may_exceed_panel;
  return table;
}

double Table::ratio(std::size_t step) const noexcept {
  assert(step < ratio_.size());
  return ratio_[step];
}

std::uint32_t Table::code(std::size_t step) const noexcept {
  assert(step < code_.size());
  return code_[step];
}

std::optional<std::size_t> Table::step_of_code(std::uint32_t code) const noexcept {
  const auto entry = std::ranges::lower_bound(by_code_, code, {}, &CodeEntry::code);
  if (entry == by_code_.end() || entry->code != code) {
    return std::nullopt;
  }
  return entry->step;
}

// With the tolerance, 0.7 computed as 1 − 0.3 finds 0.7, not the step below.
std::optional<std::size_t> Table::floor_step(double ratio) const noexcept {
  if (std::isnan(ratio)) {
    return std::nullopt;
  }
  const auto above = std::ranges::upper_bound(ratio_, ratio + kRatioTolerance);
  if (above == ratio_.begin()) {
    return std::nullopt;
  }
  // Of equal steps the lowest, so that a search always gives the same code.
  const auto lowest = std::ranges::lower_bound(ratio_, *(above - 1));
  return static_cast<std::size_t>(lowest - ratio_.begin());
}

std::optional<std::size_t> Table::ceil_step(double ratio) const noexcept {
  if (std::isnan(ratio)) {
    return std::nullopt;
  }
  const auto step = std::ranges::lower_bound(ratio_, ratio - kRatioTolerance);
  if (step == ratio_.end()) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(step - ratio_.begin());
}

std::optional<std::size_t> Table::nearest_step(double ratio) const noexcept {
  const auto below = floor_step(ratio);
  const auto above = ceil_step(ratio);
  if (!below || !above) {
    return below ? below : above;
  }
  // A tie goes to the lower step: the safe side for a feed.
  return ratio - ratio_[*below] <= ratio_[*above] - ratio ? below : above;
}

Table::Run Table::equal_steps(std::size_t step) const noexcept {
  const auto run = std::ranges::equal_range(ratio_, ratio(step));
  return {.first = static_cast<std::size_t>(run.begin() - ratio_.begin()),
          .last = static_cast<std::size_t>(run.end() - ratio_.begin()) - 1};
}

}  // namespace steadyrest::kernel::override
