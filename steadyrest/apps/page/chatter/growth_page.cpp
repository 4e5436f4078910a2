// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/apps/page/chatter/growth_page.hpp>
#include <steadyrest/apps/page/shared/json_numbers.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// How far a vibration grows in the course of the law's period.
namespace steadyrest::apps::page {
namespace {

namespace offline = chatter::offline;
using kernel::units::kTurn;
using offline::DelayCycle;
using offline::GrowthCourse;
using offline::SpeedProfile;

constexpr std::size_t kSpeedPoints = 1200;
constexpr double kBesideJump = 1e-9;  ///< of the law's period

/// A course has one value per pass boundary, its start included.
std::size_t end_pass(const GrowthCourse& course) {
  return course.start_pass + course.log_growth.size() - 1;
}

/// The growth is known at pass boundaries; the speed profile gives their times.
Json course_json(const GrowthCourse& course, const DelayCycle& cycle, const SpeedProfile& speed) {
  std::vector<double> time_s;
  for (std::size_t pass = course.start_pass; pass <= end_pass(course); ++pass) {
    time_s.push_back(speed.time_s(static_cast<double>(pass) * cycle.pass_rad()));
  }
  return {{"start_pass", course.start_pass},
          {"time_s", short_numbers(time_s)},
          {"log_growth", short_numbers(course.log_growth)}};
}

/// Even angles, and both sides of every jump: otherwise a square law would be drawn with slopes.
Json speed_json(const SpeedProfile& speed, double last_rad) {
  std::vector<double> angle_rad;
  for (std::size_t i = 0; i <= kSpeedPoints; ++i) {
    angle_rad.push_back(last_rad * static_cast<double>(i) / static_cast<double>(kSpeedPoints));
  }
  for (double period = 0.0; !speed.constant() && period < last_rad; period += speed.period_rad()) {
    for (const double corner : speed.corners_rad()) {
      const double beside = kBesideJump * speed.period_rad();
      angle_rad.push_back(std::max(0.0, period + corner - beside));
      angle_rad.push_back(period + corner + beside);
    }
  }
  std::ranges::sort(angle_rad);
  std::vector<double> time_s;
  std::vector<double> speed_rpm;
  for (const double angle : angle_rad) {
    time_s.push_back(speed.time_s(angle));
    speed_rpm.push_back(kernel::units::rpm_from_rev_s(speed.speed_rad_s(angle) / kTurn));
  }
  return {{"time_s", short_numbers(time_s)}, {"speed_rpm", short_numbers(speed_rpm)}};
}

}  // namespace

/// The growth from several starting passes, and below it the speed that causes it.
Json growth_page(const Json& answer, const offline::Process& process, const DelayCycle& cycle,
                 const SpeedProfile& speed, const std::vector<GrowthCourse>& courses) {
  Json page = chatter_head("growth", process.name, answer);
  // The course with the greatest peak is drawn in front.
  const GrowthCourse& most = offline::worst(courses);
  std::size_t last = 0;
  page["courses"] = Json::array();
  for (const GrowthCourse& course : courses) {
    page["courses"].push_back(course_json(course, cycle, speed));
    last = std::max(last, end_pass(course));
  }
  page["worst"] = &most - courses.data();
  page["law_period_s"] = speed.constant() ? Json(nullptr) : Json(speed.time_s(speed.period_rad()));
  page["pass_s"] = cycle.period_s() / static_cast<double>(cycle.passes());
  page["speed"] = speed_json(speed, static_cast<double>(last) * cycle.pass_rad());
  return page;
}

}  // namespace steadyrest::apps::page
