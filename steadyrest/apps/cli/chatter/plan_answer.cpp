// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/plan_answer.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

namespace offline = chatter::offline;
namespace units = kernel::units;
using chatter::online::Law;
using offline::Alternative;
using offline::PlanDecision;

/// JSON has neither NaN nor infinity; both mean that there is no number.
Json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

/// Override steps in per cent, as the switch is labelled.
Json percents(const std::vector<double>& ratios) {
  Json out = Json::array();
  for (const double ratio : ratios) {
    // Six digits are enough and keep 0.85·100 from printing as 85.00000000000001.
    out.push_back(1e-6 * std::round(1e6 * units::percent_from_ratio(ratio)));
  }
  return out;
}

bool is_law(const Alternative& a) {
  return a.modulation.law != Law::constant;
}

/// T = 60/(n·RVF) s with n in rev/min.
double period_s(const Alternative& a, double speed_rpm) {
  return 60.0 / (speed_rpm * a.modulation.rvf);
}

/// The keys that the decision and every alternative share, so that a script reads both alike.
void put(Json& json, const Alternative& a, double speed_rpm) {
  json["override_percent"] = percents(a.demand.written_ratio);
  json["law"] = chatter::online::name(a.modulation.law);
  json["rva"] = is_law(a) ? a.modulation.rva : 0.0;
  json["rvf"] = is_law(a) ? a.modulation.rvf : 0.0;
  json["limit_depth_mm"] = or_null(a.limit_depth_mm);
  json["probability"] = or_null(a.probability);
  json["peak_growth"] = or_null(a.peak_growth);
  json["log_radius"] = or_null(a.log_radius);
  json["written_log_radius"] = or_null(a.written_log_radius);
  json["speed_rpm"] = speed_rpm * a.ratio;
  json["amplitude_rpm"] = is_law(a) ? a.modulation.rva * speed_rpm : 0.0;
  json["period_s"] = is_law(a) ? Json(period_s(a, speed_rpm)) : Json(nullptr);
}

}  // namespace

Json plan_json(const offline::Plan& plan, const PlannedCut& cut) {
  Json out;
  out["decision"] = offline::name(plan.decision);
  put(out, plan.chosen, cut.speed_rpm);
  out["depth_mm"] = cut.depth_mm;
  out["most_depth_mm"] = plan.most_depth_mm;
  out["likely_depth_mm"] =
      // The depth that would work matters only when nothing works at the intended one.
      plan.decision == PlanDecision::nothing ? Json(plan.likely_depth_mm) : Json(nullptr);
  out["helping_override_percent"] =
      plan.helping_ratio ? percents({*plan.helping_ratio})[0] : Json(nullptr);
  out["chatter_frequency_hz"] = or_null(plan.chatter_frequency_hz);
  out["notes"] = plan.notes;
  out["alternatives"] = Json::array();
  for (const Alternative& a : plan.alternatives) {
    Json one;
    // A rejected alternative keeps its numbers and its reasons: the user sees how close it came.
    put(one, a, cut.speed_rpm);
    one["stable"] = a.stable;
    one["growth_is_lower_bound"] = a.growth_is_lower_bound;
    one["reasons"] = a.reasons;
    out["alternatives"].push_back(std::move(one));
  }
  return out;
}

/// A constant speed reads as an override step, a law as amplitude and period in the units of the
/// drive.
std::string plan_choice(const Alternative& a, double speed_rpm) {
  if (!is_law(a)) {
    return fmt::format("{:.4g} % = {:.0f} rpm", units::percent_from_ratio(a.ratio),
                       speed_rpm * a.ratio);
  }
  return fmt::format("{} ±{:.4g} % = ±{:.0f} rpm every {:.3g} s",
                     chatter::online::name(a.modulation.law),
                     units::percent_from_ratio(a.modulation.rva), speed_rpm * a.modulation.rva,
                     period_s(a, speed_rpm));
}

/// The decision as an instruction to the operator.
std::string plan_headline(const offline::Plan& plan, const PlannedCut& cut) {
  const std::string choice = plan_choice(plan.chosen, cut.speed_rpm);
  switch (plan.decision) {
    case PlanDecision::keep:
      return fmt::format("Keep the programmed speed: {}", choice);
    case PlanDecision::constant:
      return fmt::format("Set the spindle override to {}", choice);
    case PlanDecision::law:
      return fmt::format("Modulate the spindle speed: {}", choice);
    case PlanDecision::nothing:
      // With --laws-only a step may still solve the problem, and the user should hear of it.
      if (plan.helping_ratio) {
        return fmt::format("No law helps at {:.4g} mm; a constant {:.4g} % = {:.0f} rpm does",
                           cut.depth_mm, units::percent_from_ratio(*plan.helping_ratio),
                           cut.speed_rpm * *plan.helping_ratio);
      }
      return fmt::format("Nothing helps at {:.4g} mm", cut.depth_mm);
  }
  return {};
}

}  // namespace steadyrest::apps::cli
