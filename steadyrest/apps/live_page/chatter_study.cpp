// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <oneapi/tbb/task_arena.h>
#include <sys/resource.h>
#include <unistd.h>

#include <steadyrest/apps/live_page/chatter_study.hpp>
#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/lobe_map.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/web/gate.hpp>

namespace steadyrest::apps::live_page {
namespace {

namespace offline = chatter::offline;
using kernel::outcome::Result;
using kernel::units::rpm_from_rev_s;

/// Speeds of the map that are computed in one go: between two goes it may be told to end.
constexpr std::size_t kTogether = 8;
/// Of the spindle's top speed: slower speeds have countless lobes.
constexpr double kSlowestShare = 0.2;
constexpr double kBelowPoint = 0.7;  ///< of the programmed speed, which the map shows in any case
constexpr double kDepthsOfCut = 3.0;
constexpr double kSame = 1e-6;
constexpr double kRpm = 1e-2;  ///< digits of a speed, of a depth
constexpr double kDepth_mm = 1e-4;

web::Response no_process() {
  return web::error(404, "not_found", "the layer does not know what is cut",
                    "start it with --process FILE and --depth-mm");
}

std::vector<double> even(double from, double to, std::size_t count) {
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = std::lerp(from, to, static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return out;
}

Json each_rounded(const std::vector<double>& values, double to) {
  Json out = Json::array();
  for (const double value : values) {
    out.push_back(rounded(value, to));
  }
  return out;
}

Json rpm(const std::vector<double>& rev_s) {
  std::vector<double> out(rev_s.size());
  std::ranges::transform(rev_s, out.begin(), rpm_from_rev_s);
  return each_rounded(out, kRpm);
}

}  // namespace

ChatterStudy::ChatterStudy(const Desk& desk, const Config& config) : desk_(desk), config_(config) {
  if (desk.chatter) {
    thread_ = std::thread([this] { work(); });
  }
}

ChatterStudy::~ChatterStudy() {
  {
    const std::scoped_lock lock(mutex_);
    ends_.store(true);
  }
  wake_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void ChatterStudy::look() {
  const double speed_rev_s = std::abs(desk_.asked.loop.status().spindle_programmed_rev_s);
  if (speed_rev_s > 0.0 && std::isfinite(speed_rev_s)) {
    programmed_rev_s_.store(speed_rev_s);
  }
}

web::Response ChatterStudy::answer_of(const char* key, const Work& work, Json keys) {
  if (work.done && !*work.done) {
    return web::error(422, "refused", work.done->error().what, work.done->error().to_do);
  }
  keys[key] = work.done ? **work.done : Json();
  keys["progress"] = work.done ? 1.0 : work.progress;
  return answer(keys);
}

web::Response ChatterStudy::lobes() {
  if (!desk_.chatter) {
    return no_process();
  }
  const std::scoped_lock lock(mutex_);
  lobes_.wanted = true;
  wake_.notify_all();
  return answer_of("lobes", lobes_, Json::object());
}

web::Response ChatterStudy::plan() {
  if (!desk_.chatter) {
    return no_process();
  }
  const double speed_rev_s = programmed_rev_s_.load();
  const std::scoped_lock lock(mutex_);
  if (std::abs(plan_.speed_rev_s - speed_rev_s) > kSame * speed_rev_s) {
    plan_ = {.wanted = true, .progress = 0.0, .speed_rev_s = speed_rev_s, .done = {}};
    wake_.notify_all();
  }
  return answer_of("plan", plan_, {{"programmed_rpm", rpm_from_rev_s(speed_rev_s)}});
}

void ChatterStudy::tell(Work& work, double progress) {
  const std::scoped_lock lock(mutex_);
  work.progress = progress;
}

void ChatterStudy::work() {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), config_.niceness);
  std::unique_lock lock(mutex_);
  const auto waits = [](const Work& of) { return of.wanted && !of.done; };
  while (!ends_.load()) {
    if (waits(lobes_)) {
      lock.unlock();
      auto made = make_lobes();
      lock.lock();
      lobes_.done = std::move(made);
    } else if (waits(plan_)) {
      const double speed_rev_s = plan_.speed_rev_s;
      lock.unlock();
      auto made = make_plan(speed_rev_s);
      lock.lock();
      if (plan_.speed_rev_s == speed_rev_s) {  // else another was asked for meanwhile
        plan_.done = std::move(made);
      }
    } else {
      wake_.wait(lock);
    }
  }
}

Result<Json> ChatterStudy::make_plan(double speed_rev_s) {
  if (ends_.load()) {
    return Json();
  }
  // The planner spreads its work over all cores, one of which the cycle may need.
  oneapi::tbb::task_arena alone(1);
  return alone.execute([&] {
    return desk_.chatter->plan(machine_in_force(desk_), speed_rev_s,
                               [this](double share) { tell(plan_, share); });
  });
}

Result<Json> ChatterStudy::make_lobes() {
  const auto& [process, depth_mm, acts, planner] = *desk_.chatter;
  const kernel::machine::Spindle spindle = machine_in_force(desk_).spindle;
  const double programmed_rev_s = programmed_rev_s_.load();
  double slowest_rev_s = kSlowestShare * spindle.max_rev_s;
  if (programmed_rev_s > 0.0) {
    slowest_rev_s = std::min(slowest_rev_s, kBelowPoint * programmed_rev_s);
  }
  const auto speeds =
      even(std::max(spindle.min_rev_s, slowest_rev_s), spindle.max_rev_s, config_.speeds);
  const auto depths = even(0.0, kDepthsOfCut * depth_mm, config_.depths);
  std::vector<double> log_radius;
  Json border_rpm = Json::array();
  Json border_mm = Json::array();
  for (std::size_t first = 0; first < config_.speeds && !ends_.load(); first += kTogether) {
    const auto from = speeds.begin() + static_cast<std::ptrdiff_t>(first);
    const auto left = static_cast<std::ptrdiff_t>(std::min(kTogether, config_.speeds - first));
    const auto map = offline::lobe_map(
        process,
        {.speed_rev_s = {from, from + left}, .depth_mm = depths, .modulation = {}, .threads = 1},
        {});
    if (!map) {
      return std::unexpected(map.error());
    }
    log_radius.insert(log_radius.end(), map->log_radius.begin(), map->log_radius.end());
    const bool more = first + kTogether < config_.speeds;
    const auto border =
        offline::border_line(process, {.speed_rev_s = {from, from + left + (more ? 1 : 0)},
                                       .most_depth_mm = depths.back(),
                                       .modulation = {},
                                       .threads = 1});
    if (!border) {
      return std::unexpected(border.error());
    }
    const std::size_t points = border->speed_rev_s.size() - (more ? 1 : 0);
    for (std::size_t i = 0; i < points; ++i) {
      border_rpm.push_back(rounded(rpm_from_rev_s(border->speed_rev_s[i]), kRpm));
      border_mm.push_back(border->depth_mm[i] ? rounded(*border->depth_mm[i], kDepth_mm) : Json());
    }
    tell(lobes_,
         static_cast<double>(first + kTogether) / static_cast<double>(config_.speeds + kTogether));
  }
  return Json{
      {"map",
       {{"speed_rpm", rpm(speeds)},
        {"depth_mm", each_rounded(depths, kDepth_mm)},
        {"log_radius", each_rounded(log_radius, 1e-4)}}},
      {"border", {{"speed_rpm", std::move(border_rpm)}, {"depth_mm", std::move(border_mm)}}},
      {"depth_mm", depth_mm}};
}

}  // namespace steadyrest::apps::live_page
