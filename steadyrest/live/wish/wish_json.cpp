// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/kernel/machine/chatter.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/live/wish/wish_json.hpp>

namespace steadyrest::live {
namespace {

using chatter::online::ModulationRange;
using kernel::machine::Machine;
using kernel::outcome::Reason;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using supervisor::Wish;
using supervisor::WishOutcome;

/// As far as any offset of a machine file goes: a larger error is no matter of heat.
constexpr ModulationRange kDisplacement_um{-1e4, 1e4};
constexpr ModulationRange kSd_um{0.0, 1e3};
constexpr std::size_t kMostShown = 40;

Result<double> number(const Json& keys, const char* name, const ModulationRange& range) {
  const auto at = keys.find(name);
  const bool given = at != keys.end() && at->is_number();
  if (const double value = given ? at->get<double>() : 0.0; given && range.holds(value)) {
    return value;
  }
  return refuse(fmt::format("`{}` {}; allowed: {:g} … {:g}", name,
                            at == keys.end() ? "is missing"
                            : given          ? shown(*at) + " is out of range"
                                             : shown(*at) + " is no number",
                            range.least, range.most),
                fmt::format("give `{}` in that range", name));
}

/// The author's words as a record keeps them: one line.
supervisor::ShortText<64> author_of(std::string_view author) {
  std::string words(author);
  std::ranges::replace_if(
      words, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, '?');
  return supervisor::ShortText<64>(words);
}

/// Those that a reading can correct.
std::vector<std::string> measurable(const Machine& machine) {
  std::vector<std::string> out;
  for (const kernel::machine::Axis& axis : machine.axes) {
    if (!axis.rotary &&
        std::ranges::find(machine.thermal.axis, axis.name, &kernel::machine::ThermalAxis::name) !=
            machine.thermal.axis.end()) {
      out.push_back(axis.name);
    }
  }
  return out;
}

/// Its number among the machine's axes.
Result<std::size_t> axis_of(const Json& keys, const Machine& machine) {
  const Json name = keys.value("axis", Json());
  const auto allowed = measurable(machine);
  if (!name.is_string() || std::ranges::find(allowed, name.get<std::string>()) == allowed.end()) {
    return refuse(fmt::format("the axis {} has no thermal model; allowed: {}", shown(name),
                              fmt::join(allowed, ", ")),
                  "name one of these as `axis`");
  }
  const auto at =
      std::ranges::find(machine.axes, name.get<std::string>(), &kernel::machine::Axis::name);
  return static_cast<std::size_t>(at - machine.axes.begin());
}

std::unexpected<kernel::outcome::Refusal> room_off(const char* room) {
  return refuse(fmt::format("the {} room is off in the machine file", room),
                fmt::format("set enabled = true in [{}]", room));
}

}  // namespace

std::string shown(const Json& value) {
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= kMostShown ? text : text.substr(0, kMostShown) + "…";
}

Json modulation_json(const chatter::online::Modulation& modulation) {
  return {{"law", chatter::online::name(modulation.law)},
          {"amplitude_ratio", modulation.amplitude_ratio},
          {"period_s", modulation.period_s},
          {"mean_ratio", modulation.mean_ratio}};
}

Result<Wish> modulation_wish(const Json& keys, const Machine& machine, std::string_view author) {
  if (!machine.chatter.enabled) {
    return room_off("chatter");
  }
  const Json name = keys.value("law", Json());
  const auto law =
      name.is_string() ? chatter::online::law_of(name.get<std::string>()) : std::nullopt;
  if (!law) {
    return refuse(fmt::format("the law {} is not known; allowed: {}", shown(name),
                              fmt::join(kernel::machine::kSpeedLawNames, ", ")),
                  "give one of these as `law`");
  }
  const auto amplitude = number(keys, "amplitude_ratio", chatter::online::kAmplitudeRatio);
  const auto period = number(keys, "period_s", chatter::online::kPeriod_s);
  const auto mean = number(keys, "mean_ratio", chatter::online::kMeanRatio);
  for (const auto* const value : {&amplitude, &period, &mean}) {
    if (!*value) {
      return std::unexpected(value->error());
    }
  }
  return Wish{.what = chatter::online::Modulation{.law = *law,
                                                  .amplitude_ratio = *amplitude,
                                                  .period_s = *period,
                                                  .mean_ratio = *mean,
                                                  .seed = machine.chatter.seed},
              .author = author_of(author)};
}

Result<Wish> measured_wish(const Json& keys, const Machine& machine, std::string_view author) {
  if (!machine.thermal.enabled) {
    return room_off("thermal");
  }
  const auto axis = axis_of(keys, machine);
  if (!axis) {
    return std::unexpected(axis.error());
  }
  const auto displacement = number(keys, "displacement_um", kDisplacement_um);
  const auto sd = number(keys, "sd_um", kSd_um);
  if (!displacement || !sd) {
    return std::unexpected(displacement ? sd.error() : displacement.error());
  }
  return Wish{
      .what = supervisor::Measured{.axis = *axis,
                                   .name = supervisor::ShortText<16>(machine.axes[*axis].name),
                                   .displacement_mm = kernel::units::mm_from_um(*displacement),
                                   .sd_mm = kernel::units::mm_from_um(*sd)},
      .author = author_of(author)};
}

Result<WishOutcome> granted(std::optional<WishOutcome> outcome) {
  if (!outcome) {
    return refuse("the loop does not cycle: nothing was changed",
                  "see whether the layer still runs");
  }
  switch (*outcome) {
    case WishOutcome::taken:
    case WishOutcome::rejected:
      return *outcome;
    case WishOutcome::room_off:
      return refuse("the room is off in the running layer",
                    "give the machine file an override of the spindle, or a thermal model");
    case WishOutcome::no_model:
      return refuse("the axis has no thermal model in the running layer", "name another axis");
    case WishOutcome::listening:
      return refuse("the layer listens for chatter and chooses the speed itself",
                    "start it with --chatter machine, which only listens");
    case WishOutcome::out_of_range:
      break;
  }
  return refuse("a value is out of range", "see the ranges in the interface's description");
}

Json verdict_json(WishOutcome outcome) {
  const bool taken = outcome == WishOutcome::taken;
  const Reason reason = taken ? Reason::thermal_reading_taken : Reason::thermal_reading_outlier;
  return {{"taken", taken},
          {"reason", kernel::outcome::name(reason)},
          {"sentence", kernel::outcome::sentence(reason)}};
}

}  // namespace steadyrest::live
