// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/nc/plan/check/reach.hpp>
#include <steadyrest/nc/rewrite/tube/used_travel.hpp>

namespace steadyrest::nc::rewrite {
namespace {

/// Positions are sums of rounded numbers.
constexpr double kSumRounding_mm = 1e-6;

std::string sentence(char letter, double to_mm, double end_mm, double own_mm) {
  return fmt::format(
      "takes {} to {:.4f} mm, past the end of its travel at {:g} mm; the original goes to {:.4f} "
      "mm (machine coordinates)",
      letter, to_mm, end_mm, own_mm);
}

}  // namespace

void UsedTravel::add(const interpret::Move& move, std::uint32_t line) noexcept {
  if (move.kind == interpret::MoveKind::dwell) {
    return;
  }
  for (std::size_t i = 0; i < kAxes; ++i) {
    const plan::Reach reach = plan::reach_of(move, i);
    if (reach.low_mm < low_[i].mm) {
      low_[i] = {.mm = reach.low_mm, .line = line};
    }
    if (reach.high_mm > high_[i].mm) {
      high_[i] = {.mm = reach.high_mm, .line = line};
    }
  }
}

std::optional<TravelFault> travel_fault(std::span<const kernel::machine::Axis> axes,
                                        const UsedTravel& original, const UsedTravel& changed) {
  constexpr std::string_view kLetters = "XYZ";
  for (const kernel::machine::Axis& axis : axes) {
    const std::size_t i =
        axis.name.size() == 1 ? kLetters.find(axis.name[0]) : std::string_view::npos;
    if (i == std::string_view::npos || axis.rotary) {
      continue;
    }
    const auto& high = changed.high(i);
    if (high.mm > std::max(axis.max_au, original.high(i).mm) + kSumRounding_mm) {
      return TravelFault{high.line,
                         sentence(kLetters[i], high.mm, axis.max_au, original.high(i).mm)};
    }
    const auto& low = changed.low(i);
    if (low.mm < std::min(axis.min_au, original.low(i).mm) - kSumRounding_mm) {
      return TravelFault{low.line, sentence(kLetters[i], low.mm, axis.min_au, original.low(i).mm)};
    }
  }
  return std::nullopt;
}

}  // namespace steadyrest::nc::rewrite
