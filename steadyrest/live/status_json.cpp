// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/live/status_json.hpp>

namespace steadyrest::live {
namespace {

using kernel::machine::Mode;
using kernel::signal::AxisValues;
using kernel::units::rpm_from_rev_s;
using kernel::units::um_from_mm;

constexpr std::array<std::string_view, 3> kModes = {"observe", "advise", "act"};
constexpr double kPercent = 100.0;
constexpr double kUs_s = 1e6;
/// In the order of Detector::Kind.
constexpr std::array<const char*, 4> kKinds = {"none", "forced", "hopf", "flip"};
/// In the order of signal::Motion.
constexpr std::array<const char*, 9> kMotions = {
    "idle", "rapid", "feed", "thread", "tap", "probe", "dwell", "tool_change", "spindle_wait"};
constexpr std::array<const char*, 4> kOf = {"feed", "spindle", "offset", "path_offset"};

Json offsets(const AxisValues& mm) {
  Json out = Json::array();
  for (const double value : mm) {
    out.push_back(um_from_mm(value));
  }
  return out;
}

/// The words of `chatter detect`.
Json line_json(const LiveChatter& chatter) {
  const auto& line = chatter.line;
  if (!(line.frequency_hz > 0.0)) {
    return nullptr;
  }
  return {{"frequency_hz", line.frequency_hz},
          {"nearest_order", line.order > 0.0 ? Json(std::llround(line.order)) : Json(nullptr)},
          {"order_folded", line.folded},
          {"from_order_hz", line.off_hz},
          {"from_order_sd_hz", line.sd_hz},
          {"forced", chatter.forced}};
}

Json mode_json(const LiveChatter& chatter) {
  if (!(chatter.mode_hz > 0.0)) {
    return nullptr;
  }
  return {{"frequency_hz", chatter.mode_hz},
          {"off_hz", chatter.line.frequency_hz - chatter.mode_hz}};
}

Json chatter_json(const LiveChatter& chatter) {
  if (!chatter.listens) {
    return nullptr;
  }
  const auto known = [](double value) { return value > 0.0 ? Json(value) : Json(nullptr); };
  return {{"chatter", chatter.chatters},
          {"kind", kKinds[static_cast<std::size_t>(chatter.kind)]},
          {"frequency_hz", chatter.chatters ? known(chatter.frequency_hz) : Json(nullptr)},
          {"level", chatter.level},
          {"threshold", known(chatter.threshold)},
          {"before", known(chatter.before)},
          {"better_spindle_percent",
           chatter.better_ratio == 1.0 ? Json(nullptr) : Json(kPercent * chatter.better_ratio)},
          {"events", chatter.events},
          {"chatter_s", chatter.chatter_s},
          {"line", line_json(chatter)},
          {"nearest_mode", mode_json(chatter)},
          {"confidence", chatter.chatters ? Json(chatter.confidence) : Json(nullptr)},
          {"spindle_rpm", known(rpm_from_rev_s(chatter.speed_rev_s))},
          {"spindle_sd_rpm", known(rpm_from_rev_s(chatter.speed_rev_s * chatter.speed_sd))},
          {"clips", chatter.clips}};
}

}  // namespace

std::string_view word(Mode mode) noexcept {
  return kModes[static_cast<std::size_t>(mode)];
}

std::optional<Mode> mode_of(std::string_view word) noexcept {
  const auto* const at = std::ranges::find(kModes, word);
  return at == kModes.end() ? std::nullopt : std::optional(static_cast<Mode>(at - kModes.begin()));
}

Json status_json(const LiveStatus& status) {
  Json out;
  out["mode"] = word(status.mode_in_force);
  out["mode_wanted"] = word(status.mode_wanted);
  out["cycles"] = status.cycles;
  out["overruns"] = status.overruns;
  out["time_s"] = status.time_s;
  out["motion"] = kMotions[static_cast<std::size_t>(status.motion)];
  out["cutting"] = kernel::signal::in_cut(status.motion);
  out["program_line"] = status.program_line;
  out["contour_error_um"] =
      status.error_known ? Json(um_from_mm(status.contour_error_mm)) : Json(nullptr);
  out["contour_limit_um"] = um_from_mm(status.contour_limit_mm);
  out["feed_percent"] = kPercent * status.feed_ratio;
  out["feed_panel_percent"] = kPercent * status.feed_panel_ratio;
  out["feed_effective_percent"] = kPercent * status.feed_effective_ratio;
  out["spindle_percent"] = kPercent * status.spindle_ratio;
  out["spindle_effective_percent"] = kPercent * status.spindle_effective_ratio;
  out["modulation"] = status.modulation ? modulation_json(*status.modulation) : Json(nullptr);
  out["offset_um"] = offsets(status.offset_mm);
  out["path_offset_um"] = offsets(status.path_offset_mm);
  out["reasons"] = Json::array();
  for (std::size_t i = 0; i < kOf.size(); ++i) {
    out["reasons"].push_back({{"of", kOf[i]},
                              {"reason", kernel::outcome::name(status.reasons[i])},
                              {"sentence", kernel::outcome::sentence(status.reasons[i])}});
  }
  out["chatter"] = chatter_json(status.chatter);
  out["port_fault"] =
      status.port_fault ? Json(std::string(status.port_words.data())) : Json(nullptr);
  return out;
}

Json reload_json(const ReloadStatus& status) {
  if (status.number == 0) {
    return nullptr;
  }
  return {{"number", status.number},
          {"utc", status.utc},
          {"outcome", status.taken ? "taken" : "refused"},
          {"words", status.words}};
}

Json figures_json(const LoopFigures& figures) {
  Json out;
  out["cycles"] = figures.cycles;
  out["overruns"] = figures.overruns;
  out["work_p50_us"] = kUs_s * figures.work.quantile_s(0.5);
  out["work_p999_us"] = kUs_s * figures.work.quantile_s(0.999);
  out["lateness_p999_us"] = kUs_s * figures.lateness.quantile_s(0.999);
  out["over_limit_s"] = figures.over_limit_s;
  if (figures.listens) {
    out["chatter_events"] = figures.chatter_events;
    out["chatter_s"] = figures.chatter_s;
  }
  out["port_faults"] = figures.port_faults;
  out["last_fault"] = figures.last_fault.empty() ? Json() : Json(figures.last_fault);
  out["ended_in_fault"] = figures.ended_in_fault;
  out["handed_back"] = figures.handed_back;
  out["reasons"] = Json::object();
  const auto all = kernel::outcome::reasons();
  for (std::size_t i = 0; i < std::min(all.size(), figures.by_reason.size()); ++i) {
    if (figures.by_reason[i] > 0) {
      out["reasons"][std::string(all[i].name)] = figures.by_reason[i];
    }
  }
  return out;
}

}  // namespace steadyrest::live
