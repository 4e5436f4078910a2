// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/apps/page/cut/report.hpp>

// The page of `cut`. Columns instead of objects, values rounded to a useful precision: a trace of
// minutes stays within a few megabytes.
namespace steadyrest::apps::page {
namespace {

using trial::cut::CurvePoint;
using trial::cut::Figures;
using trial::cut::HeldBy;
using trial::cut::MotionFigures;
using trial::cut::OverrideStep;
using trial::cut::ProbeFigures;
using trial::cut::ReasonTime;
using trial::cut::ReportData;
using trial::cut::Run;
using trial::cut::TracePoint;
using trial::cut::VibrationFigures;
using trial::cut::VibrationPoint;
using trial::cut::Way;
using trial::cut::WayFigures;
using trial::cut::WorstLine;

/// Rounded to a decimal place, so that the double's shortest text is short. nlohmann-json writes
/// non-finite values as null.
double rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

Json to_object(const Figures& figures) {
  return {{"cycle_time_s", figures.cycle_time_s},
          {"cutting_time_s", figures.cutting_time_s},
          {"contour_error_max_mm", figures.contour_error_max_mm},
          {"contour_error_rms_mm", figures.contour_error_rms_mm},
          {"tracking_error_max_mm", figures.tracking_error_max_mm},
          {"over_limit_s", figures.over_limit_s},
          {"samples", figures.samples},
          {"samples_over_limit", figures.samples_over_limit},
          {"override_changes", figures.override_changes}};
}

/// Which rule gave the feed that would hold the limit on a line. Words for the page's table.
std::string_view name_of(HeldBy by) {
  switch (by) {
    case HeldBy::closed_form:
      return "closed form";
    case HeldBy::record:
      return "record";
    case HeldBy::driven:
      return "driven";
  }
  return "";
}

/// A figure that does not exist (no finished wall in this cut) is null.
Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Of one cut. `unforced` is what does not repeat from tooth to tooth: chatter.
Json to_object(const VibrationFigures& v) {
  return {{"vibration_rms_um", v.rms_um},
          {"vibration_peak_um", v.peak_um},
          {"unforced_rms_um", v.unforced_rms_um},
          {"force_peak_n", v.force_peak_n},
          {"power_peak_w", v.power_peak_w},
          {"chip_peak_um", v.chip_peak_um},
          {"surface_error_um", or_null(v.surface_error_um)},
          {"surface_range_um", or_null(v.surface_range_um)}};
}

/// Over time, in stretches; three decimals of a micrometre are beyond any sensor.
Json to_object(const std::vector<VibrationPoint>& course) {
  constexpr double kThousandths = 1e3;
  constexpr double kTenths = 1e1;
  Json time = Json::array();
  Json peak = Json::array();
  Json unforced = Json::array();
  Json speed = Json::array();
  for (const VibrationPoint& p : course) {
    time.push_back(rounded(p.time_s, kThousandths));
    peak.push_back(rounded(p.peak_um, kThousandths));
    unforced.push_back(rounded(p.unforced_um, kThousandths));
    speed.push_back(rounded(p.speed_rpm, kTenths));
  }
  return {{"time_s", std::move(time)},
          {"peak_um", std::move(peak)},
          {"unforced_um", std::move(unforced)},
          {"speed_rpm", std::move(speed)}};
}

/// One array per quantity: a tenth of the size of one object per sample.
template <class Value>
Json column(const std::vector<TracePoint>& trace, Value value) {
  Json::array_t out;
  out.reserve(trace.size());
  for (const TracePoint& point : trace) {
    out.emplace_back(value(point));
  }
  return out;
}

/// The trace of one cut. `line` leads back to the program, `cutting` tells feed from rapids.
Json to_object(const std::vector<TracePoint>& trace) {
  constexpr double kTenThousandths = 1e4;
  constexpr double kHundredths = 1e2;
  constexpr double kTenths = 1e1;
  const auto real = [&trace](auto member, double per_unit) {
    return column(trace, [=](const TracePoint& p) { return rounded(p.*member, per_unit); });
  };
  const auto axis = [&trace](std::size_t i) {
    return column(
        trace, [=](const TracePoint& p) { return rounded(p.position_mm.at(i), kTenThousandths); });
  };
  return {
      {"time_s", real(&TracePoint::time_s, kTenThousandths)},
      {"path_mm", real(&TracePoint::path_mm, kTenThousandths)},
      {"x_mm", axis(0)},
      {"y_mm", axis(1)},
      {"z_mm", axis(2)},
      {"contour_error_um", real(&TracePoint::contour_error_um, kHundredths)},
      {"tracking_error_um", real(&TracePoint::tracking_error_um, kHundredths)},
      {"override_percent", real(&TracePoint::override_percent, kHundredths)},
      {"feed_mm_min", real(&TracePoint::feed_mm_min, kTenths)},
      {"line", column(trace, [](const TracePoint& p) { return p.line; })},
      {"cutting", column(trace, [](const TracePoint& p) { return p.cutting ? 1 : 0; })},
  };
}

/// The reasons with the time that each was in force: why the layer acted as it did.
Json to_object(const Run& run) {
  Json reasons = Json::array();
  for (const ReasonTime& entry : run.reasons) {
    reasons.push_back({{"reason", kernel::outcome::name(entry.reason)},
                       {"sentence", kernel::outcome::sentence(entry.reason)},
                       {"seconds", entry.seconds}});
  }
  Json out = {{"figures", to_object(run.figures)},
              {"reasons", std::move(reasons)},
              {"trace", to_object(run.trace)}};
  if (run.vibration) {
    out["vibration"] = {{"figures", to_object(*run.vibration)},
                        {"course", to_object(run.vibration_course)}};
  }
  return out;
}

/// A reading of the probe and what became of it, with the sentence of its reason.
Json to_object(const ProbeFigures& p) {
  return {{"time_s", p.time_s},
          {"line", p.line},
          {"axis", p.axis},
          {"displacement_um", p.displacement_um},
          {"innovation_um", p.innovation_um},
          {"band_um", p.band_um},
          {"reason", kernel::outcome::name(p.reason)},
          {"sentence", kernel::outcome::sentence(p.reason)}};
}

/// The lines with the largest errors, and the feed at which each would have kept the limit.
Json to_object(const WorstLine& w) {
  constexpr double kTenths = 1e1;
  constexpr double kHundredths = 1e2;
  constexpr double kTenThousandths = 1e4;
  return {{"line", w.line},
          {"text", w.text},
          {"without_um", rounded(w.without_um, kHundredths)},
          {"with_um", rounded(w.with_um, kHundredths)},
          {"feed_without_mm_min", rounded(w.feed_without_mm_min, kTenths)},
          {"feed_with_mm_min", rounded(w.feed_with_mm_min, kTenths)},
          {"radius_mm", rounded(w.radius_mm, kTenThousandths)},
          {"hold_feed_mm_min", rounded(w.hold_feed_mm_min, kTenths)},
          {"held_by", name_of(w.held_by)}};
}

/// Public: scripts and the page tell the ways by it.
std::string_view name_of(Way way) {
  switch (way) {
    case Way::alone:
      return "alone";
    case Way::setting:
      return "setting";
    case Way::text:
      return "text";
    case Way::text_held:
      return "text_held";
    case Way::text_feeds:
      return "text_feeds";
    case Way::feed_override:
      return "feed_override";
    case Way::path_offsets:
      return "path_offsets";
    case Way::changed:
      return "changed";
    case Way::changed_feed_override:
      return "changed_feed_override";
    case Way::changed_path_offsets:
      return "changed_path_offsets";
  }
  return "";
}

}  // namespace

Json to_object(const WayFigures& way) {
  Json out = {{"way", name_of(way.way)}};
  out.update(to_object(way.figures));
  if (!way.get.empty()) {
    out["get"] = way.get;
  }
  return out;
}

Json to_object(const trial::cut::BestWays& best) {
  const auto or_null = [](const auto& way) { return way ? to_object(*way) : Json(nullptr); };
  return {{"same_time", or_null(best.same_time)},
          {"any_time", or_null(best.any_time)},
          {"setting", or_null(best.setting)}};
}

Json to_object(const trial::cut::OverLimitLine& over) {
  return {{"line", over.line},
          {"error_um", rounded(over.error_um, 1e2)},
          {"reason", over.reason},
          {"cure", over.cure.empty() ? Json(nullptr) : Json(over.cure)}};
}

Json to_object(const CurvePoint& point) {
  Json out = {{"limit_um", rounded(point.limit_um, 1e6)}};
  out.update(to_object(point.figures));
  return out;
}

Json to_object(const MotionFigures& figures) {
  return {{"axis", figures.axis},
          {"velocity_rms_mm_s", figures.velocity_rms_mm_s},
          {"acceleration_rms_mm_s2", figures.acceleration_rms_mm_s2},
          {"difference_velocity_rms_mm_s", figures.difference_velocity_rms_mm_s},
          {"difference_acceleration_rms_mm_s2", figures.difference_acceleration_rms_mm_s2},
          {"velocity_coverage_ratio", figures.velocity_coverage_ratio},
          {"acceleration_coverage_ratio", figures.acceleration_coverage_ratio}};
}

/// The same figures for --json, so that page and script cannot differ.
std::string to_json(const VibrationFigures& vibration) {
  return to_object(vibration).dump();
}

/// The order of the keys is fixed, so that the same data give the same bytes.
Json to_page(const ReportData& data) {
  Json table = Json::array();
  for (const OverrideStep& step : data.override_table) {
    table.push_back({{"code", step.code}, {"percent", rounded(step.percent, 1e6)}});
  }
  const auto list = [](const auto& values) {
    Json out = Json::array();
    for (const auto& value : values) {
      out.push_back(to_object(value));
    }
    return out;
  };
  Json page = page_head("steadyrest-report/1");
  page.update({{"program", data.program},
               {"machine", data.machine},
               {"strategy", data.strategy},
               {"limit_um", rounded(data.limit_um, 1e6)},
               {"override_table", std::move(table)},
               {"without", to_object(data.without)},
               {"with", to_object(data.with)},
               {"worst_lines", list(data.worst_lines)},
               {"motion", list(data.motion)},
               {"probes", list(data.probes)},
               {"ways", list(data.ways)},
               {"curve", list(data.curve)}});
  if (data.best.same_time || data.best.setting) {
    page["best"] = to_object(data.best);
    page["over_limit"] = list(data.over_limit);
  }
  if (!data.best_run.trace.empty()) {
    page["best_run"] = to_object(data.best_run);
  }
  if (!data.against.empty()) {
    page["against"] = data.against;
  }
  return page;
}

}  // namespace steadyrest::apps::page
