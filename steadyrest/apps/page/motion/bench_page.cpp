// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include <steadyrest/apps/page/motion/bench_page.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/scene/score.hpp>

// Data of the benchmark's page: the table, two traces that show what the figures mean, and the
// source's own figures for comparison.
namespace steadyrest::apps::page {

namespace offline = motion::offline;
using kernel::outcome::refuse;
using kernel::outcome::Result;

namespace {

/// Differences of counts are "before", our first estimator "after", on the first record of a scene.
Result<std::vector<motion::online::Estimate>> estimates(std::string_view name,
                                                        const offline::BenchScene& scene) {
  auto estimator = offline::make_estimator(name, scene.setup);
  if (!estimator) {
    return std::unexpected(estimator.error());
  }
  return offline::run(**estimator, scene.records.front());
}

/// Scenes are made on demand; only the named one is.
Result<offline::BenchScene> scene_named(const std::string& name) {
  for (const offline::SceneChoice& choice : offline::bench_scenes({"", 1})) {
    if (choice.name == name) {
      return choice.make();
    }
  }
  return refuse("there is no scene \"" + name + "\"", "choose another");
}

}  // namespace

Result<Trace> trace(const std::string& name) {
  const auto scene = scene_named(name);
  if (!scene) {
    return std::unexpected(scene.error());
  }
  const auto before = estimates("difference", *scene);
  const auto after = estimates(offline::estimator_names().front(), *scene);
  if (!before || !after) {
    return std::unexpected(before ? after.error() : before.error());
  }
  Trace out;
  out.name = name;
  // The first phase only: a trace shows one record.
  const offline::Record& record = scene->records.front();
  for (std::size_t k = 0; k < record.ticks.size(); ++k) {
    out.t_s.push_back(record.ticks[k].t_s);
    out.true_velocity_mm_s.push_back(record.truth[k].velocity_mm_s);
    out.true_acceleration_mm_s2.push_back(record.truth[k].acceleration_mm_s2);
    out.difference_velocity_mm_s.push_back((*before)[k].velocity_mm_s);
    out.difference_acceleration_mm_s2.push_back((*before)[k].acceleration_mm_s2);
    out.velocity_mm_s.push_back((*after)[k].velocity_mm_s);
    out.velocity_bound_mm_s.push_back((*after)[k].velocity_bound_mm_s);
    out.acceleration_mm_s2.push_back((*after)[k].acceleration_mm_s2);
    out.acceleration_bound_mm_s2.push_back((*after)[k].acceleration_bound_mm_s2);
  }
  return out;
}

/// Cheap compared with the benchmark itself: two scenes and a few closed forms.
Result<PageData> page_data(offline::Benchmark benchmark,
                           std::vector<offline::RequirementRow> requirement) {
  PageData out;
  out.benchmark = std::move(benchmark);
  out.requirement = std::move(requirement);
  // An S-curve is what axes do; the flywheel is the source's own experiment (fig. 2).
  for (const char* scene : {"s-curve", "flywheel"}) {
    auto made = trace(scene);
    if (!made) {
      return std::unexpected(made.error());
    }
    out.traces.push_back(std::move(*made));
  }
  constexpr double kCount_mm = 0.001;
  // The cycles of the source's figures 3 a and b; figure 5 has its 300 kHz and 10 mm lead.
  constexpr std::array kCycles_hz{1000.0, 2000.0, 2500.0};
  auto figure_3a = offline::figure_3a(kCount_mm, kCycles_hz);
  auto figure_3b = offline::figure_3b(kCount_mm, kCycles_hz);
  auto figure_5 = offline::figure_5(300'000.0, 10.0);
  if (!figure_3a || !figure_3b || !figure_5) {
    return std::unexpected(!figure_3a   ? figure_3a.error()
                           : !figure_3b ? figure_3b.error()
                                        : figure_5.error());
  }
  out.figure_3a = std::move(*figure_3a);
  out.figure_3b = std::move(*figure_3b);
  out.figure_5 = std::move(*figure_5);
  return out;
}

}  // namespace steadyrest::apps::page
