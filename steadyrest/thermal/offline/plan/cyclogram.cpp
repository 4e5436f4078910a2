// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <exception>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/passport/keys/section_reader.hpp>
#include <steadyrest/passport/text/text_check.hpp>
#include <steadyrest/passport/text/text_file.hpp>
#include <steadyrest/thermal/offline/plan/cyclogram.hpp>

// Two sources of the same list of transitions: a process engineer's file, or a program's own timing
// (cyclogram_of). drive_of() turns a transition into the inputs of the law.
namespace steadyrest::thermal::offline {

using kernel::outcome::Result;
using passport::Choice;
using passport::Faults;
using passport::Key;
using passport::line_of;
using passport::Need;
using passport::SectionReader;

namespace {

constexpr std::array<std::string_view, 3> kLoads = {"standing", "running", "cutting"};
// By index: the words are in the order of the enumerators of Load.
constexpr Choice<Transition> kLoad = {
    kLoads, [](Transition& t, std::size_t i) { t.load = static_cast<Load>(i); },
    [](const Transition& t) { return static_cast<std::size_t>(t.load); }};

std::span<const Key<Transition>> keys() noexcept {
  static const std::array kKeys = {
      Key<Transition>{"name", &Transition::name, 0, 80, "Name in reports."},
      Key<Transition>{"minutes", &Transition::minutes, 0, 1e6, "Duration.", Need::mandatory},
      Key<Transition>{"speed_rpm", &Transition::speed_rev_s, -1e6, 1e6,
                      "Spindle speed; 0 when stopped.", Need::mandatory},
      Key<Transition>{"feed_mm_min", &Transition::feed_mm_s, 0, 1e6,
                      "Mean speed along the path, including rapids and standstill."},
      Key<Transition>{"load", kLoad, 0, 0, "Kind of work."},
      Key<Transition>{"cutting_percent", &Transition::cutting_share, 0, 100,
                      "Share of its time in feed moves, if the load is cutting."},
      Key<Transition>{"coolant", &Transition::coolant, 0, 0, "Coolant is on."},
      Key<Transition>{"tolerance_um", &Transition::tolerance_mm, 0.001, 1e6,
                      "Tolerance of the work in it; default: the plan's."},
      Key<Transition>{"tool", &Transition::tool, 0, 1e9, "Tool number."},
      Key<Transition>{"line", &Transition::line, 0, 4e9, "Program line where it begins."},
  };
  return kKeys;
}

// The top level has two keys; a misspelt one is reported with the nearest existing one.
void read_tree(const toml::table& root, Cyclogram& out, Faults& faults) {
  for (const auto& [name, node] : root) {
    if (name.str() == "resolution_min") {
      double minutes = 0.0;
      const passport::ValueReader read(faults, "resolution_min", 0.0, 60.0, 1);
      out.resolution_s = read.number(node, minutes) ? 60.0 * minutes : 0.0;
    } else if (name.str() != "transition") {
      faults.add(line_of(name.source()), fmt::format("a cyclogram has no key {}", name.str()),
                 kernel::outcome::meant(
                     name.str(), std::array<std::string_view, 2>{"resolution_min", "transition"},
                     "remove it; a cyclogram has resolution_min and [[transition]]"));
    }
  }
  const toml::node* node = root.get("transition");
  const toml::array* list = node != nullptr ? node->as_array() : nullptr;
  // A program of many short tool changes has hundreds; a file with more than the bound is no
  // cyclogram.
  if (list == nullptr || list->size() > kMostTransitions) {
    faults.add(node != nullptr ? line_of(node->source()) : 0,
               list == nullptr ? std::string{"there is no [[transition]]"}
                               : fmt::format("there are {} transitions", list->size()),
               fmt::format("write 1 … {} [[transition]]", kMostTransitions));
    return;
  }
  for (const toml::node& element : *list) {
    const toml::table* table = element.as_table();
    if (table == nullptr) {
      faults.add(line_of(element.source()), "transition is not a section",
                 "write [[transition]] on a separate line, with its keys below");
      return;
    }
    Transition transition;
    SectionReader<Transition>(faults, keys(), "[[transition]]").read(*table, transition);
    // Minutes at the border, seconds inside.
    transition.seconds = 60.0 * transition.minutes;
    out.transition.push_back(std::move(transition));
  }
  // Single transitions of zero length are allowed: a program may change its tool twice in a row.
  if (faults.list.empty() && !(out.total_s() > 0.0)) {
    faults.add(0, "the cyclogram has no duration", "give the transitions their minutes");
  }
}

}  // namespace

double Cyclogram::total_s() const noexcept {
  double sum = 0.0;
  for (const Transition& t : transition) {
    sum += t.seconds;
  }
  return sum;
}

Result<Cyclogram> parse_cyclogram(std::string_view text, const std::string& file) {
  // The text check is the machine file's; only its advice must mention cyclograms.
  if (auto refusal = passport::unfit_text(text)) {
    refusal->file = file;
    // Wording meant for a machine file.
    if (text.size() > passport::kMaxFileBytes) {
      refusal->what = fmt::format("larger than {} MB; a cyclogram has a few kB",
                                  passport::kMaxFileBytes >> 20U);
      refusal->to_do = "give a cyclogram, not a program or a log";
    } else if (text.find_first_not_of(" \n\r\t") == std::string_view::npos) {
      refusal->to_do = "give a cyclogram (TOML), like examples/paper-thermal/cyclogram.toml";
    }
    return std::unexpected(std::move(*refusal));
  }
  Cyclogram out;
  out.file = file;
  Faults faults{file, {}};
  try {
    const toml::table root = toml::parse(text);
    read_tree(root, out, faults);
  } catch (const toml::parse_error& error) {
    faults.add(line_of(error.source()), std::string(error.description().substr(0, 200)),
               "correct the TOML text at this place");
  } catch (const std::exception& error) {
    faults.add(0, fmt::format("cannot be read: {}", error.what()), "give a valid cyclogram");
  }
  if (!faults.list.empty()) {
    return std::unexpected(std::move(faults.list.front()));
  }
  return out;
}

Result<Cyclogram> read_cyclogram(const std::string& path) {
  auto text = passport::read_text(path);
  if (!text) {
    text.error().to_do = "give the path of a cyclogram (TOML)";
    return std::unexpected(std::move(text.error()));
  }
  return parse_cyclogram(*text, path);
}

Cyclogram cyclogram_of(std::span<const nc::plan::Transition> transitions, const std::string& file) {
  Cyclogram out;
  out.file = file;
  for (const nc::plan::Transition& t : transitions) {
    Transition made;
    made.minutes = t.seconds / 60.0;
    made.seconds = t.seconds;
    made.speed_rev_s = t.speed_rev_s;
    // The mean over the whole transition, rapids and standstill included: drives heat all the time.
    made.feed_mm_s = t.path_speed_mm_s();
    made.load = static_cast<Load>(t.load());
    made.cutting_share = t.cut_share();
    made.coolant = t.coolant;
    made.tool = static_cast<std::uint32_t>(t.tool);
    made.line = t.line;
    out.transition.push_back(std::move(made));
  }
  return out;
}

online::Drive drive_of(const Transition& transition) noexcept {
  online::Drive drive;
  drive.speed_rev_s = transition.speed_rev_s;
  drive.feed_mm_s = transition.feed_mm_s;
  drive.cutting = transition.load == Load::cutting;
  drive.cutting_share = transition.cutting_share;
  drive.coolant = transition.coolant;
  // A cyclogram contains no room data: the caller fills in temperatures, or they stay as they are.
  drive.ambient_c.fill(std::numeric_limits<double>::quiet_NaN());
  return drive;
}

}  // namespace steadyrest::thermal::offline
