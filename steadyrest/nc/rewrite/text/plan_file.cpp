// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include <steadyrest/kernel/file/json_object.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/nearest.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using Json = nlohmann::json;
using kernel::outcome::bad_input;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

// Bounds of a plausible plan: a wrong unit (seconds for minutes, millimetres for micrometres) must
// not pass.

constexpr std::size_t kLargestFile = 1U << 24U;
constexpr std::size_t kMostTransitions = 100'000;
constexpr double kLongest_min = 30.0 * 24.0 * 60.0;
constexpr double kLargest_um = 10'000.0;
/// Axes that end this close together count as ending together: the plan's maker may have rounded
/// each interval.
constexpr double kSameTime_s = 1e-3;

/// The first four are read; the others are the plan maker's own remarks and have no effect here.
constexpr std::array<std::string_view, 19> kRootKeys = {
    "machine",      "axis",    "axes",        "transitions",    "made_by", "program",  "level",
    "tolerance_um", "share",   "k",           "cyclogram",      "date",    "passport", "max_um",
    "note",         "seconds", "residual_um", "uncertainty_um", "sd_um"};
constexpr std::array<std::string_view, 4> kTransitionKeys = {"n", "t_min", "delta_um", "name"};

class PlanReader {
 public:
  explicit PlanReader(const std::string& path) { plan_.file = path; }

  Result<Plan> read(std::string_view text) {
    if (!parse(text) || !root()) {
      return std::unexpected(refusal_);
    }
    return std::move(plan_);
  }

 private:
  bool refuse(std::string what, std::string to_do, std::size_t line = 0) {
    refusal_ = bad_input(plan_.file, line, std::move(what), std::move(to_do));
    return false;
  }
  bool refuse_key(const std::string& key, std::string what, std::string to_do) {
    return refuse("`" + key + "`: " + std::move(what), std::move(to_do));
  }

  bool parse(std::string_view text) {
    if (text.size() > kLargestFile) {
      return refuse("more than 16 MiB; this is not a plan", "give the JSON file of a plan");
    }
    // JSON allows a key twice, and most readers silently take the last. The parser's events reveal
    // it.
    std::vector<std::set<std::string>> keys;
    std::string twice;
    const auto watch = [&](int /*depth*/, Json::parse_event_t event, Json& parsed) {
      if (event == Json::parse_event_t::object_start) {
        keys.emplace_back();
      } else if (event == Json::parse_event_t::object_end) {
        keys.pop_back();
      } else if (event == Json::parse_event_t::key &&
                 !keys.back().insert(parsed.get<std::string>()).second) {
        twice = parsed.get<std::string>();
      }
      return true;
    };
    json_ = Json::parse(text, watch, false);
    if (const auto fault = json_.is_discarded() ? kernel::file::json_fault(text) : std::nullopt) {
      return refuse(fault->what, "write the plan as JSON; see nc/rewrite/README.md", fault->line);
    }
    return twice.empty() || refuse_key(twice, "a key that appears twice", "keep one of them");
  }

  // Either `transitions` for one axis or `axes` for several; any other key must be one that plan
  // makers are known to write.
  bool root() {
    if (!json_.is_object()) {
      return refuse("not an object", "write {\"axis\": \"Z\", \"transitions\": […]}");
    }
    const bool one = json_.contains("transitions");
    const bool several = json_.contains("axes");
    for (const auto& [key, value] : json_.items()) {
      if (key == "machine") {
        if (!value.is_string()) {
          return refuse_key(key, "not a text", "name the machine file");
        }
        plan_.machine = value.get<std::string>();
      } else if (std::ranges::find(kRootKeys, key) == kRootKeys.end()) {
        return refuse_key(
            key, "an unknown key",
            kernel::outcome::meant(key, kRootKeys, "remove it, or see nc/rewrite/README.md"));
      }
    }
    // Two lists could contradict each other.
    if (one == several || (several && json_.contains("axis"))) {
      return refuse("needs either `transitions` (with `axis`) or `axes`", "write one of the two");
    }
    if (one) {
      const Json letter = json_.value("axis", Json("Z"));
      return axis("axis", letter, "transitions", json_["transitions"]);
    }
    const Json& axes = json_["axes"];
    if (!axes.is_object() || axes.empty()) {
      return refuse_key("axes", "not an object of axes", R"(write {"Z": {"transitions": […]}, …})");
    }
    for (const auto& [letter, value] : axes.items()) {
      const std::string key = "axes." + letter;
      if (!value.is_object() || value.size() != 1 || !value.contains("transitions")) {
        return refuse_key(key, "not an object with the one key `transitions`",
                          "write that key alone");
      }
      if (!axis(key, Json(letter), key + ".transitions", value["transitions"])) {
        return false;
      }
    }
    return true;
  }

  bool axis(const std::string& key, const Json& letter, const std::string& list_key,
            const Json& list) {
    constexpr std::string_view kLinear = "XYZUVW";
    if (!letter.is_string() || letter.get<std::string>().size() != 1 ||
        kLinear.find(letter.get<std::string>()[0]) == std::string_view::npos) {
      return refuse_key(key, "not a linear axis", "write one letter of X Y Z U V W");
    }
    AxisPlan made;
    made.letter = letter.get<std::string>()[0];
    made.index = interpret::kAxisLetters.find(made.letter);
    if (!list.is_array() || list.empty() || list.size() > kMostTransitions) {
      return refuse_key(list_key, "not a list of transitions (1 to 100000)",
                        R"(write [{"n": 1, "t_min": [60], "delta_um": [0]}])");
    }
    // Sums carry over from transition to transition: a tool change does not reset the thermal
    // displacement.
    double now_s = 0.0;
    double sum_um = 0.0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!transition(list_key + "[" + std::to_string(i) + "]", list[i], made, now_s, sum_um)) {
        return false;
      }
    }
    // Corrections of all axes share the program's time.
    if (!plan_.axes.empty() && std::abs(now_s - plan_.total_s) > kSameTime_s) {
      return refuse_key(list_key, "lasts longer or shorter than the axis before it",
                        "give all axes the same total time");
    }
    plan_.total_s = now_s;
    plan_.axes.push_back(std::move(made));
    return true;
  }

  bool transition(const std::string& key, const Json& one, AxisPlan& made, double& now_s,
                  double& sum_um) {
    if (!one.is_object()) {
      return refuse_key(key, "not an object", R"(write {"n": 1, "t_min": [60], "delta_um": [0]})");
    }
    for (const auto& [name, value] : one.items()) {
      if (name != "n" && name != "t_min" && name != "delta_um" &&
          !(name == "name" && value.is_string())) {
        return refuse_key(
            key + "." + name, "an unknown key",
            kernel::outcome::meant(name, kTransitionKeys, "use n, t_min, delta_um and name"));
      }
    }
    for (const char* name : {"n", "t_min", "delta_um"}) {
      if (!one.contains(name)) {
        return refuse_key(key + "." + name, "missing",
                          "every transition has n, t_min and delta_um");
      }
    }
    if (!one["n"].is_number_integer() || one["n"].get<double>() < 1.0 ||
        one["n"].get<double>() > 1e6) {
      return refuse_key(key + ".n", "not a number of intervals", "write a whole number from 1");
    }
    const auto n = one["n"].get<std::size_t>();
    std::vector<double> minutes;
    std::vector<double> deltas;
    if (!numbers(key + ".t_min", one["t_min"], n, minutes) ||
        !numbers(key + ".delta_um", one["delta_um"], n, deltas)) {
      return false;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::string at = "[" + std::to_string(i) + "]";
      if (!(minutes[i] > 0.0 && minutes[i] <= kLongest_min)) {
        return refuse_key(key + ".t_min" + at, "not a duration",
                          "write minutes above 0, at most 43200");
      }
      // The displacement so far counts at the START of the interval (Marusich's R = {n; t; δ}).
      sum_um += deltas[i];
      if (!(std::abs(deltas[i]) <= kLargest_um && std::abs(sum_um) <= kLargest_um)) {
        return refuse_key(key + ".delta_um" + at, "far beyond a thermal displacement",
                          "write micrometres, at most 10000 in total");
      }
      // A zero step would only use up a safe place.
      if (deltas[i] != 0.0) {
        made.steps.push_back({now_s, sum_um});
      }
      now_s += minutes[i] * 60.0;
    }
    return now_s <= kLongest_min * 60.0 ||
           refuse_key(key, "the plan lasts longer than 30 days", "check the unit: minutes");
  }

  bool numbers(const std::string& key, const Json& list, std::size_t n, std::vector<double>& out) {
    if (!list.is_array() || list.size() != n ||
        !std::ranges::all_of(list, [](const Json& value) { return value.is_number(); })) {
      return refuse_key(key, "not a list of n numbers", "write " + std::to_string(n) + " numbers");
    }
    out = list.get<std::vector<double>>();
    return true;
  }

  Plan plan_;
  Json json_;
  Refusal refusal_;
};

}  // namespace

Result<Plan> parse_plan(std::string_view text, const std::string& path) {
  return PlanReader(path).read(text);
}

Result<std::string> read_plan_text(const std::string& path) {
  if (std::error_code unknown; std::filesystem::is_directory(path, unknown)) {
    return std::unexpected(
        Refusal{Kind::unavailable, path, 0, "is a folder", "give the path of a plan"});
  }
  std::ifstream in(path, std::ios::binary);
  std::string text;
  if (in) {
    // One byte more than allowed shows a file that is too large without reading all of it.
    text.resize(kLargestFile + 1);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
  }
  if (!in.is_open() || in.bad()) {
    return std::unexpected(Refusal{Kind::unavailable, path, 0, "cannot be read",
                                   "check the path and the permissions"});
  }
  return text;
}

Result<Plan> read_plan(const std::string& path) {
  const auto text = read_plan_text(path);
  return text ? parse_plan(*text, path) : std::unexpected(text.error());
}

}  // namespace steadyrest::nc::rewrite
