// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <steadyrest/apps/page/shared/json_numbers.hpp>
#include <steadyrest/apps/page/thermal/thermal_page.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::page {
namespace {

using kernel::units::rpm_from_rev_s;
using kernel::units::um_from_mm;
using thermal::offline::Cyclogram;
using thermal::offline::ForecastPoint;
using thermal::offline::Load;

/// A column of the points, to six digits.
template <class Points, class Value>
Json column(const Points& points, Value value) {
  std::vector<double> out;
  out.reserve(points.size());
  for (const auto& point : points) {
    out.push_back(value(point));
  }
  return short_numbers(out);
}

/// The cyclogram as the page's background: what the machine did, and when.
Json transitions_json(const Cyclogram& cyclogram) {
  Json out = Json::array();
  double start_s = 0.0;
  for (const auto& t : cyclogram.transition) {
    out.push_back({{"name", t.name},
                   {"start_min", start_s / 60.0},
                   {"minutes", t.seconds / 60.0},
                   {"speed_rpm", short_number(rpm_from_rev_s(t.speed_rev_s))},
                   {"cutting", t.load == Load::cutting}});
    start_s += t.seconds;
  }
  return out;
}

/// From the start of the work, as the plan counts.
Json course_json(const Course& course) {
  const double zero_mm = course.point.empty() ? 0.0 : course.point.front().displacement_mm;
  return {
      {"axis", course.name},
      {"t_min", column(course.point, [](const ForecastPoint& p) { return p.time_s / 60.0; })},
      {"displacement_um",
       column(course.point,
              [&](const ForecastPoint& p) { return um_from_mm(p.displacement_mm - zero_mm); })},
      {"sd_um", column(course.point, [](const ForecastPoint& p) { return um_from_mm(p.sd_mm); })}};
}

/// δ_j applies from the start of interval j; totals continue across transitions, as the control's
/// offset does.
void put_corrections(Json& out, const Course& course, double share) {
  out["corrections"] = Json::array();
  out["bands"] = Json::array();
  double time_s = 0.0;
  double total_mm = 0.0;
  for (const auto& row : course.corrections.transition) {
    const double start_s = time_s;
    for (std::size_t j = 0; j < row.interval_s.size(); ++j) {
      if (row.delta_mm[j] != 0.0) {
        total_mm += row.delta_mm[j];
        out["corrections"].push_back({{"t_min", short_number(time_s / 60.0)},
                                      {"delta_um", short_number(um_from_mm(row.delta_mm[j]))},
                                      {"total_um", short_number(um_from_mm(total_mm))}});
      }
      time_s += row.interval_s[j];
    }
    out["bands"].push_back({{"from_min", start_s / 60.0},
                            {"to_min", time_s / 60.0},
                            {"tolerance_um", short_number(um_from_mm(row.tolerance_mm))},
                            {"band_um", short_number(um_from_mm(share * row.tolerance_mm))}});
  }
}

}  // namespace

/// The head of every thermal page; the folder means nothing to a reader.
Json thermal_head(std::string_view kind, std::string_view file, const Json& answer) {
  Json page = page_head("steadyrest-thermal/1");
  const std::string title = std::filesystem::path(file).filename().string();
  page.update({{"kind", kind}, {"title", title}, {"answer", answer}});
  return page;
}

/// Displacements over the transitions that cause them.
Json forecast_page(const Json& answer, const Cyclogram& cyclogram,
                   const std::vector<Course>& courses) {
  Json page = thermal_head("forecast", cyclogram.file, answer);
  page["transitions"] = transitions_json(cyclogram);
  page["courses"] = Json::array();
  for (const Course& course : courses) {
    page["courses"].push_back(course_json(course));
  }
  return page;
}

/// The paper's figures 4 and 5: displacement with and without correction, the band k·Δ of each
/// transition, and the staircase of corrections.
Json plan_page(const Json& answer, const Cyclogram& cyclogram, const std::vector<Course>& courses,
               double share) {
  Json page = thermal_head("plan", cyclogram.file, answer);
  page["transitions"] = transitions_json(cyclogram);
  page["courses"] = Json::array();
  for (const Course& course : courses) {
    Json one = course_json(course);
    put_corrections(one, course, share);
    page["courses"].push_back(std::move(one));
  }
  return page;
}

/// The three ways side by side over the batch, with the model's forecast, its band and the room.
Json batch_page(const Json& answer, std::string_view program, const trial::batch::Batch& made) {
  using trial::batch::Point;
  Json page = thermal_head("batch", program, answer);
  page["axis"] = made.axis.front();
  page["course"] = {
      {"t_min", column(made.point, [](const Point& p) { return p.time_s / 60.0; })},
      {"part", column(made.point, [](const Point& p) { return static_cast<double>(p.part); })},
      {"without_um", column(made.point, [](const Point& p) { return um_from_mm(p.left_mm[0]); })},
      {"text_um", column(made.point, [](const Point& p) { return um_from_mm(p.left_mm[1]); })},
      {"online_um", column(made.point, [](const Point& p) { return um_from_mm(p.left_mm[2]); })},
      {"model_um", column(made.point, [](const Point& p) { return um_from_mm(p.model_mm); })},
      {"model_sd_um", column(made.point, [](const Point& p) { return um_from_mm(p.model_sd_mm); })},
      {"room_c", column(made.point, [](const Point& p) { return p.room_c; })}};
  return page;
}

}  // namespace steadyrest::apps::page
