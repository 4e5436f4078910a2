// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/chatter/offline/response/uff_units.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/table/text.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

// Specific data types of universal file dataset 58.
constexpr int kUnknown = 0;
constexpr int kGeneral = 1;
constexpr int kDisplacement = 8;
constexpr int kVelocity = 11;
constexpr int kAcceleration = 12;
constexpr int kForce = 13;
constexpr int kFrequency = 18;

constexpr double kNewton_per_lbf = 4.4482216152605;
constexpr double kNewton_per_kgf = 9.80665;
constexpr double kSame = 1e-3;  // dataset 164 may be written with few digits

struct Named {
  std::string_view name;
  double size;
};
constexpr std::array kLengths = {Named{"m", 1e3},    Named{"cm", 10.0},   Named{"mm", 1.0},
                                 Named{"um", 1e-3},  Named{"in", 25.4},   Named{"inch", 25.4},
                                 Named{"ft", 304.8}, Named{"mil", 0.0254}};
constexpr std::array kForces = {Named{"n", 1.0},
                                Named{"newton", 1.0},
                                Named{"kn", 1e3},
                                Named{"lbf", kNewton_per_lbf},
                                Named{"lb", kNewton_per_lbf},
                                Named{"kgf", kNewton_per_kgf},
                                Named{"kp", kNewton_per_kgf}};
constexpr std::array kFrequencies = {Named{"hz", 1.0},
                                     Named{"hertz", 1.0},
                                     Named{"1/s", 1.0},
                                     Named{"khz", 1e3},
                                     Named{"rpm", 1.0 / 60.0},
                                     Named{"1/min", 1.0 / 60.0},
                                     Named{"cpm", 1.0 / 60.0},
                                     Named{"r/min", 1.0 / 60.0},
                                     Named{"rev/min", 1.0 / 60.0},
                                     Named{"rad/s", 1.0 / kernel::units::kTurn},
                                     Named{"rads/s", 1.0 / kernel::units::kTurn}};

std::optional<double> size_of(std::span<const Named> list, std::string_view name) {
  const auto found = std::ranges::find(list, name, &Named::name);
  return found == list.end() ? std::nullopt : std::optional(found->size);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

/// The unit in one spelling: `m/s2`, `um`. Where the field of units is empty, the words in the
/// label's brackets.
std::string unit_of(const UffAxis& axis) {
  std::string out = axis.unit;
  const std::size_t open = axis.label.find_first_of("([");
  const std::size_t close = axis.label.find_last_of(")]");
  if (out.empty() && open != std::string::npos && close != std::string::npos && open < close) {
    out = axis.label.substr(open + 1, close - open - 1);
  }
  out = table::lower(out);
  replace_all(out, "\xC2\xB5", "u");  // µ of UTF-8, of Greek, of cp1252
  replace_all(out, "\xCE\xBC", "u");
  replace_all(out, "\xB5", "u");
  replace_all(out, "\xC2\xB2", "2");
  replace_all(out, "\xB2", "2");
  for (const std::string_view gone : {" ", "^", "**", "(", ")", "[", "]"}) {
    replace_all(out, gone, "");
  }
  replace_all(out, "sec", "s");
  replace_all(out, "/s/s", "/s2");
  return out;
}

struct Kind {
  int kind;
  int order;
  std::string_view per;
};
constexpr std::array kResponses = {Kind{kDisplacement, 0, ""}, Kind{kVelocity, 1, "/s"},
                                   Kind{kAcceleration, 2, "/s2"}};

/// mm, mm/s or mm/s² per unit of the label, if it is one.
std::optional<double> labelled(const Kind& kind, std::string unit) {
  if (kind.order == 2 && unit == "g") {
    return kGravity_mm_s2;
  }
  if (!unit.ends_with(kind.per)) {
    return std::nullopt;
  }
  unit.resize(unit.size() - kind.per.size());
  return size_of(kLengths, unit);
}

std::string shown_unit(const UffAxis& axis) {
  return table::shown(axis.unit.empty() ? axis.label : axis.unit);
}

/// The label's size, checked against dataset 164, or the one of dataset 164, or SI.
Result<double> decided(const UffFunction& function, const UffAxis& axis,
                       std::optional<double> label, double si, double by_164) {
  if (!function.units) {
    return label.value_or(si);
  }
  const bool plain_si = std::abs(by_164 - si) <= kSame * si;
  if (label && !plain_si && std::abs(*label - by_164) > kSame * by_164) {
    return refuse(
        std::string(), axis.line,
        fmt::format("the unit is \"{}\", but dataset 164 in line {} says {:.6g} to the SI "
                    "unit (\"{}\")",
                    shown_unit(axis), function.units->line, si / by_164, function.units->name),
        "export again in SI units");
  }
  return label.value_or(by_164);
}

}  // namespace

Result<double> hz_of(const UffFunction& function) {
  const UffAxis& axis = function.abscissa;
  const std::string unit = unit_of(axis);
  const auto hz = unit.empty() ? std::optional(1.0) : size_of(kFrequencies, unit);
  const bool named = !unit.empty() && hz && (axis.kind == kUnknown || axis.kind == kGeneral);
  if (axis.kind != kFrequency && !named) {
    return refuse(std::string(), axis.line,
                  fmt::format("abscissa of type {}; frequency is {}", axis.kind, kFrequency),
                  "export over frequency in Hz");
  }
  if (!hz) {
    return refuse(std::string(), axis.line,
                  fmt::format("abscissa in \"{}\"; allowed: Hz, kHz, rad/s, rpm", shown_unit(axis)),
                  "export over frequency in Hz");
  }
  return *hz;
}

Result<UffScale> scale_of(const UffFunction& function) {
  const auto possible = [](double factor) { return factor >= 1e-9 && factor <= 1e9; };
  if (function.units && (!possible(function.units->per_m) || !possible(function.units->per_n))) {
    return refuse(std::string(), function.units->line + 1,
                  "dataset 164 (units) has no factors of length and force above 0",
                  "export again in SI units");
  }
  const UffAxis& top = function.numerator;
  const UffAxis& bottom = function.denominator;
  const auto kind = std::ranges::find(kResponses, top.kind, &Kind::kind);
  const std::string unit = unit_of(top);
  const auto size = kind == kResponses.end() ? std::nullopt : labelled(*kind, unit);
  if (kind == kResponses.end() || (!size && !unit.empty())) {
    return refuse(std::string(), top.line,
                  fmt::format("ordinate of type {} in \"{}\"; allowed: displacement (8), velocity "
                              "(11) and acceleration (12) in m, cm, mm, um, in, ft, their rates, g",
                              top.kind, shown_unit(top)),
                  "export with SI units");
  }
  const std::string force_unit = unit_of(bottom);
  const auto force = size_of(kForces, force_unit);
  if (bottom.kind != kForce || (!force && !force_unit.empty())) {
    return refuse(
        std::string(), bottom.line,
        fmt::format("denominator of type {} in \"{}\"; allowed: force (13) in N, kN, lbf, "
                    "kgf",
                    bottom.kind, shown_unit(bottom)),
        "export the response to a force");
  }
  constexpr double kMmPerM = 1e3;
  const UffUnits units = function.units.value_or(UffUnits{});
  const auto mm = decided(function, top, size, kMmPerM, kMmPerM / units.per_m);
  if (!mm) {
    return std::unexpected(mm.error());
  }
  const auto newton = decided(function, bottom, force, 1.0, 1.0 / units.per_n);
  if (!newton) {
    return std::unexpected(newton.error());
  }
  return UffScale{*mm / *newton, kind->order};
}

}  // namespace steadyrest::chatter::offline
