// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include <steadyrest/apps/live_page/heat_history.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Machine;
using kernel::machine::ThermalAxis;
using kernel::units::um_from_mm;

constexpr double kEvery_s = 10.0;
constexpr std::size_t kMost = 4320;   ///< of twelve hours
constexpr std::size_t kShown = 1080;  ///< points of a plot
constexpr std::size_t kLately = 60;   ///< ten minutes, that the forecast repeats
constexpr double kTime_s = 1e-3;      ///< digits of a time
constexpr std::size_t kMostReadings = 50;
constexpr double kOutlook_s = 3600.0;  ///< of the forecast

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

Json passports_json(const Machine& machine) {
  Json out = Json::array();
  for (const ThermalAxis& axis : machine.thermal.axis) {
    out.push_back({{"axis", axis.name}, {"modes", modes_json(axis)}});
  }
  return out;
}

Json outlook_json(const std::optional<Outlook>& outlook, const Machine& machine) {
  if (!outlook) {
    return nullptr;
  }
  Json axes = Json::array();
  for (const Outlook::Axis& axis : outlook->axis) {
    Json one = {{"name", machine.axes[axis.index].name},
                {"displacement_um", Json::array()},
                {"sd_um", Json::array()},
                {"offset_um", Json::array()}};
    for (std::size_t i = 0; i < outlook->in_s.size(); ++i) {
      one["displacement_um"].push_back(micrometres(axis.displacement_mm[i]));
      one["sd_um"].push_back(micrometres(axis.sd_mm[i]));
      one["offset_um"].push_back(micrometres(axis.offset_mm[i]));
    }
    axes.push_back(std::move(one));
  }
  return {{"of_last_s", outlook->again_s}, {"in_s", outlook->in_s}, {"axes", std::move(axes)}};
}

Json move_json(const Correction& move, const Machine& machine) {
  return {{"axis", move.axis < machine.axes.size() ? machine.axes[move.axis].name : ""},
          {"from_um", micrometres(move.from_mm)},
          {"to_um", micrometres(move.to_mm)}};
}

Json corrections_json(const Corrections& done, const std::optional<Outlook>& outlook,
                      const Machine& machine) {
  Json before = Json::array();
  for (const Correction& move : done.list()) {
    Json one = move_json(move, machine);
    one["t_s"] = rounded(move.to_s, kTime_s);
    before.push_back(std::move(one));
  }
  Json after = Json::array();
  for (const Correction& move : outlook ? outlook->to_come : std::vector<Correction>()) {
    Json one = move_json(move, machine);
    one["in_s"] = rounded(move.from_s, kTime_s);
    after.push_back(std::move(one));
  }
  return {{"step_um", um_from_mm(Corrections::kStep_mm)},
          {"done", std::move(before)},
          {"to_come", std::move(after)}};
}

Json next_json(const std::optional<Outlook>& outlook, const Machine& machine) {
  if (!outlook || outlook->to_come.empty()) {
    return nullptr;
  }
  const Correction& next = outlook->to_come.front();
  return {{"axis", machine.axes[next.axis].name},
          {"offset_um", micrometres(next.to_mm)},
          {"change_um", micrometres(next.to_mm - next.from_mm)},
          {"in_s", rounded(next.from_s, kTime_s)}};
}

}  // namespace

void HeatHistory::add_reading(Json reading) {
  reading["t_s"] = rounded(desk_.asked.loop.status().time_s, kTime_s);
  const std::scoped_lock lock(mutex_);
  readings_.push_back(std::move(reading));
  if (readings_.size() > kMostReadings) {
    readings_.pop_front();
  }
}

void HeatHistory::update(double now_s) {
  const steadyrest::live::LiveStatus status = desk_.asked.loop.status();
  const steadyrest::live::HeatNow& now = desk_.tap.heat();
  const std::scoped_lock lock(mutex_);
  if (!status.heat_on) {
    now_.on = false;
    return;
  }
  if (now.time_s != now_.time_s || now.on != now_.on) {
    now_ = now;
  }
  corrects_ = status.mode_in_force != kernel::machine::Mode::observe;
  corrections_.see(status.time_s, status.offset_mm, status.axis_count);
  note(now_s, status);
}

void HeatHistory::note(double now_s, const steadyrest::live::LiveStatus& status) {
  if (now_s < next_s_) {
    return;
  }
  next_s_ = now_s + kEvery_s;
  Entry entry{.time_s = status.time_s, .offset_mm = status.offset_mm, .fed = status.heat_fed};
  for (std::size_t i = 0; i < status.axis_count; ++i) {
    entry.displacement_mm[i] = status.axis[i].displacement_mm;
    entry.sd_mm[i] = status.axis[i].displacement_sd_mm;
  }
  entries_.push_back(entry);
  if (entries_.size() > kMost) {
    entries_.pop_front();
  }
}

/// What the thermal room was given between two entries; 0 seconds if it was restarted in between.
Stretch HeatHistory::between(const Entry& from, const Entry& to) {
  const double seconds = to.fed.time_s - from.fed.time_s;
  if (!(seconds > 0.0)) {
    return {};
  }
  return {.seconds = seconds,
          .speed_rev_s = (to.fed.turned_rev - from.fed.turned_rev) / seconds,
          .feed_mm_s = (to.fed.path_mm - from.fed.path_mm) / seconds,
          .cut_share = (to.fed.cut_s - from.fed.cut_s) / seconds,
          .coolant_share = (to.fed.coolant_s - from.fed.coolant_s) / seconds};
}

HeatHistory::Seen HeatHistory::seen() const {
  const std::scoped_lock lock(mutex_);
  Seen out{.entries = {},
           .lately = {},
           .corrections = corrections_,
           .now = now_,
           .corrects = corrects_,
           .readings = Json(readings_)};
  // Every n-th from the newest on: sums of what the room was given lose nothing between them.
  const std::size_t stride = (entries_.size() + kShown - 1) / kShown;
  for (std::size_t back = 0; back < entries_.size(); back += stride) {
    out.entries.push_back(entries_[entries_.size() - 1 - back]);
  }
  std::ranges::reverse(out.entries);
  const std::size_t first = entries_.size() - std::min(entries_.size(), kLately + 1);
  for (std::size_t i = first + 1; i < entries_.size(); ++i) {
    if (const Stretch stretch = between(entries_[i - 1], entries_[i]); stretch.seconds > 0.0) {
      out.lately.push_back(stretch);
    }
  }
  return out;
}

Json HeatHistory::history_json(const std::vector<Entry>& entries, const Machine& machine) {
  Json times = Json::array();
  for (const Entry& entry : entries) {
    times.push_back(rounded(entry.time_s, kTime_s));
  }
  Json axes = Json::array();
  for (const ThermalAxis& axis : machine.thermal.axis) {
    const std::size_t place = place_of(machine, axis);
    if (place >= std::min(machine.axes.size(), kernel::signal::kMaxAxes)) {
      continue;
    }
    Json one = {{"name", axis.name},
                {"displacement_um", Json::array()},
                {"sd_um", Json::array()},
                {"offset_um", Json::array()}};
    for (const Entry& entry : entries) {
      one["displacement_um"].push_back(micrometres(entry.displacement_mm[place]));
      one["sd_um"].push_back(micrometres(entry.sd_mm[place]));
      one["offset_um"].push_back(micrometres(entry.offset_mm[place]));
    }
    axes.push_back(std::move(one));
  }
  return {{"t_s", std::move(times)}, {"axes", std::move(axes)}};
}

Json HeatHistory::cyclogram_json(const std::vector<Entry>& entries) {
  Json out = {{"t_s", Json::array()},
              {"speed_rpm", Json::array()},
              {"feed_mm_min", Json::array()},
              {"cutting_percent", Json::array()},
              {"coolant_percent", Json::array()}};
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const Stretch did = between(entries[i - 1], entries[i]);
    const auto known = [&](double value) {
      return did.seconds > 0.0 ? rounded(value, 0.01) : Json();
    };
    out["t_s"].push_back(rounded(entries[i].time_s, kTime_s));
    out["speed_rpm"].push_back(known(kMinute_s * did.speed_rev_s));
    out["feed_mm_min"].push_back(known(kMinute_s * did.feed_mm_s));
    out["cutting_percent"].push_back(known(kPercent * did.cut_share));
    out["coolant_percent"].push_back(known(kPercent * did.coolant_share));
  }
  return out;
}

web::Response HeatHistory::show() const {
  const Machine machine = machine_in_force(desk_);
  const auto& thermal = machine.thermal;
  const Seen seen = this->seen();
  const auto ahead =
      outlook(machine, seen.now, seen.lately, seen.corrects, seen.corrections, kOutlook_s);
  const bool has_share = thermal.level < thermal.share.size();
  Json thermal_json = {{"share_k", has_share ? Json(thermal.share[thermal.level]) : Json()},
                       {"passports", passports_json(machine)},
                       {"history", history_json(seen.entries, machine)},
                       {"cyclogram", cyclogram_json(seen.entries)},
                       {"outlook", outlook_json(ahead, machine)},
                       {"corrections", corrections_json(seen.corrections, ahead, machine)},
                       {"next", next_json(ahead, machine)},
                       {"readings", seen.readings}};
  thermal_json.update(switched_off_json(desk_.asked.loop.status()));
  return answer({{"thermal", std::move(thermal_json)}});
}

}  // namespace steadyrest::apps::live_page
