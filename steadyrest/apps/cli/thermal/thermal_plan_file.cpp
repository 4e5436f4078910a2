// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <utility>

#include <nlohmann/json.hpp>

#include <steadyrest/apps/cli/thermal/thermal_plan_file.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// The rewriter's reader supplies the plan's own keys. This file adds what `thermal plan` noted
// about its making, so that `thermal adapt` need not be given it again.
namespace steadyrest::apps::cli {

using kernel::outcome::refuse;
using kernel::outcome::Result;

using PlanJson = nlohmann::ordered_json;  // read_plan() has checked its shape

namespace {

/// Files in a plan are named relative to the plan, so that the folder can be moved as a whole.
std::string beside(const std::string& plan, const std::string& named) {
  const std::filesystem::path path(named);
  return named.empty() || path.is_absolute()
             ? named
             : (std::filesystem::path(plan).parent_path() / path).generic_string();
}

}  // namespace

/// Parsed twice: once as the rewriter does it, with all its checks, once for the notes, which may
/// be missing in a plan written by hand.
Result<ThermalPlanFile> read_thermal_plan(const std::string& path) {
  const auto text = nc::rewrite::read_plan_text(path);
  if (!text) {  // a wrong path is the caller's mistake, whatever the reason
    return refuse(path, text.error().what,
                  "give the path of a plan (JSON): thermal plan -o writes it");
  }
  auto plan = nc::rewrite::parse_plan(*text, path);
  if (!plan) {
    return std::unexpected(plan.error());
  }
  ThermalPlanFile out;
  out.plan = std::move(*plan);
  try {
    const PlanJson json = PlanJson::parse(*text);
    out.machine = beside(path, json.value("machine", ""));
    out.cyclogram = beside(path, json.value("cyclogram", ""));
    out.program = beside(path, json.value("program", ""));
    out.tolerance_um = json.value("tolerance_um", 0.0);
    if (json.contains("level")) {
      out.level = json["level"].get<double>();
    }
    if (json.contains("k")) {
      out.share = json["k"].get<double>();
    }
    // One axis: `transitions` on the top level. Several: all axes have the same transitions, so the
    // first one's will do for the ends.
    const PlanJson& rows =
        json.contains("transitions") ? json["transitions"] : json["axes"].front()["transitions"];
    double now_s = 0.0;
    for (const PlanJson& row : rows) {
      // t_min holds interval durations that sum to the transition; the running sum gives its end.
      for (const PlanJson& minutes : row["t_min"]) {
        now_s += 60.0 * minutes.get<double>();
      }
      out.transition.push_back({row.value("name", ""), now_s});
    }
  } catch (const PlanJson::exception&) {
    return refuse(path, "a note has the wrong type",
                  "write level, k and tolerance_um as numbers and file names as strings");
  }
  return out;
}

std::vector<std::string> files_of(const std::string& plan) {
  std::vector<std::string> out;
  if (const auto read = read_thermal_plan(plan)) {
    for (const std::string* file : {&read->machine, &read->cyclogram, &read->program}) {
      if (!file->empty()) {
        out.push_back(*file);
      }
    }
  }
  return out;
}

/// δ_j applies from the START of interval j on, and `displacement_um` is the running sum.
double corrected_um(const nc::rewrite::AxisPlan& axis, double time_s) {
  double sum = 0.0;
  for (const auto& step : axis.steps) {
    if (step.time_s <= time_s) {
      sum = step.displacement_um;
    }
  }
  return sum;
}

}  // namespace steadyrest::apps::cli
