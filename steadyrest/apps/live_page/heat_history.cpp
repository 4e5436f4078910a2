// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <utility>

#include <steadyrest/apps/live_page/heat_history.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Machine;
using kernel::machine::ThermalAxis;
using kernel::units::um_from_mm;

constexpr double kEvery_s = 10.0;
constexpr std::size_t kMost = 4320;  ///< of twelve hours

Json modes_json(const ThermalAxis& axis) {
  Json out = Json::array();
  for (const kernel::machine::ThermalMode& mode : axis.mode) {
    const double most_mm = mode.level_mm.empty() ? 0.0 : *std::ranges::max_element(mode.level_mm);
    out.push_back({{"amplitude_um", mode.level_mm.empty() ? Json() : Json(um_from_mm(most_mm))},
                   {"time_constant_min", mode.tau_s / kMinute_s}});
  }
  return out;
}

/// The place of a thermal passport's axis among the machine's; as many as these: none.
std::size_t place_of(const Machine& machine, const ThermalAxis& axis) {
  const auto at = std::ranges::find(machine.axes, axis.name, &kernel::machine::Axis::name);
  return static_cast<std::size_t>(at - machine.axes.begin());
}

}  // namespace

void HeatHistory::update(double now_s) {
  if (now_s < next_s_) {
    return;
  }
  next_s_ = now_s + kEvery_s;
  const steadyrest::live::LiveStatus status = desk_.asked.loop.status();
  if (!status.heat_on) {
    return;
  }
  const std::scoped_lock lock(mutex_);
  entries_.push_back({.time_s = status.time_s, .status = status});
  if (entries_.size() > kMost) {
    entries_.pop_front();
  }
}

web::Response HeatHistory::show() const {
  const Machine machine = machine_in_force(desk_);
  const auto& thermal = machine.thermal;
  Json passports = Json::array();
  Json axes = Json::array();
  Json times = Json::array();
  const std::scoped_lock lock(mutex_);
  for (const Entry& entry : entries_) {
    times.push_back(entry.time_s);
  }
  for (const ThermalAxis& axis : thermal.axis) {
    passports.push_back({{"axis", axis.name}, {"modes", modes_json(axis)}});
    const std::size_t place = place_of(machine, axis);
    if (place >= machine.axes.size()) {
      continue;
    }
    Json one = {{"name", axis.name},
                {"displacement_um", Json::array()},
                {"sd_um", Json::array()},
                {"offset_um", Json::array()}};
    for (const Entry& entry : entries_) {
      one["displacement_um"].push_back(um_from_mm(entry.status.axis[place].displacement_mm));
      one["sd_um"].push_back(um_from_mm(entry.status.axis[place].displacement_sd_mm));
      one["offset_um"].push_back(um_from_mm(entry.status.offset_mm[place]));
    }
    axes.push_back(std::move(one));
  }
  const bool has_share = thermal.level < thermal.share.size();
  Json thermal_json = {{"share_k", has_share ? Json(thermal.share[thermal.level]) : Json()},
                       {"passports", std::move(passports)},
                       {"history", {{"t_s", std::move(times)}, {"axes", std::move(axes)}}},
                       {"next", nullptr},
                       {"readings", Json::array()}};
  return answer({{"thermal", std::move(thermal_json)}});
}

}  // namespace steadyrest::apps::live_page
