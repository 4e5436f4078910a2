// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/live/wish/wish_words.hpp>
#include <steadyrest/supervisor/wish_text.hpp>

namespace steadyrest::live {
namespace {

using chatter::online::Modulation;
using supervisor::Measured;
using supervisor::WishOutcome;

constexpr double kPercent = 100.0;
constexpr double kMinute_s = 60.0;

std::string words_of(const Modulation& m) {
  const std::string mean =
      fmt::format("mean {:.4g} % of the programmed speed", kPercent * m.mean_ratio);
  if (m.law == chatter::online::Law::constant) {
    return fmt::format("set the modulation: constant, {}", mean);
  }
  const std::string swing = m.amplitude_rev_s > 0.0
                                ? fmt::format("{:.4g} rpm", kMinute_s * m.amplitude_rev_s)
                                : fmt::format("{:.4g} %", kPercent * m.amplitude_ratio);
  return fmt::format("set the modulation: {}, ±{}, period {:.4g} s, {}",
                     chatter::online::name(m.law), swing, m.period_s, mean);
}

std::string words_of(const Measured& m) {
  const std::string sd =
      m.sd_mm > 0.0 ? fmt::format(", sd {:.4g} µm", kernel::units::um_from_mm(m.sd_mm)) : "";
  return fmt::format("entered a measured size: {} is {:+.4g} µm off{}", m.name.view(),
                     kernel::units::um_from_mm(m.displacement_mm), sd);
}

std::string_view words_of(WishOutcome outcome) {
  switch (outcome) {
    case WishOutcome::taken:
      return "";
    case WishOutcome::rejected:
      return "; rejected: too far from the forecast";
    case WishOutcome::room_off:
      return "; refused: the room is off";
    case WishOutcome::no_model:
      return "; refused: the axis has no thermal model";
    case WishOutcome::out_of_range:
      return "; refused: out of range";
    case WishOutcome::listening:
      return "; refused: the layer listens and chooses the speed itself";
  }
  return "";
}

}  // namespace

std::string wish_words(std::string_view text) {
  const auto recorded = supervisor::wish_of(text);
  if (!recorded) {
    return std::string(text);
  }
  const auto& wish = recorded->wish;
  const auto* const modulation = std::get_if<Modulation>(&wish.what);
  const auto* const measured = std::get_if<Measured>(&wish.what);
  return fmt::format("{} {}{}", wish.author.view(),
                     modulation != nullptr ? words_of(*modulation)
                     : measured != nullptr ? words_of(*measured)
                                           : "",
                     words_of(recorded->outcome));
}

}  // namespace steadyrest::live
