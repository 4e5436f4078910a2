// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/edit/servo_edit.hpp>
#include <steadyrest/passport/edit/text_edit.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/text/unit.hpp>

// Puts fitted gains into a machine file, line by line. Whatever the edit, the result is read back
// and must differ from the old machine in these values alone.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr std::string_view kGainKeys[] = {"servo_gain_1_s", "servo_gain_m_min_mm"};
constexpr std::string_view kForwardKey = "feed_forward";
constexpr std::string_view kLagKey = "velocity_lag_ms";
constexpr double kWrittenTo = 1e-4;  // six digits

/// `value # comment` in place of the rest of a line.
std::string value_text(double value, const std::string& comment) {
  // A comment could otherwise end the line, or the file's validity.
  std::string safe = comment;
  std::ranges::replace_if(safe, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  return fmt::format("{:.6g}{}{}", value, safe.empty() ? "" : "  # ", safe);
}

/// Only `key = value` and a comment may be on the line.
bool owns_line(std::string_view text, std::size_t from, std::size_t to, std::string_view key) {
  const std::size_t begin = text.find_last_of('\n', from) + 1;
  std::string_view before = text.substr(from == 0 ? 0 : begin, from - begin);
  before.remove_prefix(std::min(before.find_first_not_of(" \t"), before.size()));
  std::string_view behind = text.substr(to);
  behind = behind.substr(0, behind.find_first_of("\r\n"));
  behind.remove_prefix(std::min(behind.find_first_not_of(" \t"), behind.size()));
  return before.starts_with(key) && (behind.empty() || behind.front() == '#');
}

/// The edits of one axis; empty where its keys have no lines of their own.
std::optional<std::vector<Edit>> edits_of(std::string_view text, const toml::table& axis,
                                          const ServoValues& values) {
  const Places places(text);
  std::vector<Edit> out;
  const auto replace = [&](std::string_view key, const toml::node& node, const std::string& with) {
    const std::size_t from = places.at(node.source().begin);
    const std::size_t to = places.at(node.source().end);
    if (!owns_line(text, from, to, key)) {
      return false;
    }
    out.push_back({from, std::min(text.find_first_of("\r\n", to), text.size()), with});
    return true;
  };
  std::string indent;
  for (const std::string_view key : kGainKeys) {
    const toml::node* node = axis.get(key);
    if (node == nullptr) {
      continue;
    }
    if (!replace(key, *node,
                 value_text(unit_of(key).from_inner(values.gain_1_s), values.gain_comment))) {
      return std::nullopt;
    }
    const std::size_t begin = text.find_last_of('\n', out.back().from) + 1;
    indent = text.substr(begin, text.find_first_not_of(" \t", begin) - begin);
  }
  if (out.empty()) {
    return std::nullopt;
  }
  // New keys go before the gain's line end, so that a last line without one stays so.
  std::string added;
  const auto put = [&](std::string_view key, double value, const std::string& comment) {
    const toml::node* node = axis.get(key);
    if (node != nullptr) {
      return replace(key, *node, value_text(value, comment));
    }
    added += fmt::format("\n{}{} = {}", indent, key, value_text(value, comment));
    return true;
  };
  const std::size_t gain = out.size() - 1;
  if (!put(kForwardKey, values.feed_forward, values.feed_forward_comment) ||
      (values.velocity_lag_s && !put(kLagKey, unit_of(kLagKey).from_inner(*values.velocity_lag_s),
                                     values.velocity_lag_comment))) {
    return std::nullopt;
  }
  out[gain].text += with_line_ends(added, text);
  return out;
}

bool near(double a, double b) {
  return std::abs(a - b) <= kWrittenTo * std::max(1.0, std::abs(b));
}

/// The proof by the old and the new tree: the same, but for the keys of these axes.
bool changes_only(const std::string& edited, std::string_view text,
                  const std::vector<ServoValues>& values) {
  toml::table before = toml::parse(text);
  toml::table after = toml::parse(edited);
  for (const ServoValues& one : values) {
    for (const toml::table* tree : {&before, &after}) {
      // Ours: both trees are local.
      auto* axis = const_cast<toml::table*>(axis_of(*tree, one.axis));
      for (const std::string_view key : {kGainKeys[0], kGainKeys[1], kForwardKey, kLagKey}) {
        axis->erase(key);
      }
    }
  }
  return before == after;
}

Result<std::string> edited(std::string_view text, const std::string& file,
                           const std::vector<ServoValues>& values) {
  const toml::table root = toml::parse(text);
  std::vector<Edit> edits;
  for (const ServoValues& one : values) {
    const toml::table* axis = axis_of(root, one.axis);
    if (axis == nullptr) {
      return refuse(file, fmt::format("has no axis {}", one.axis),
                    "give the machine file of the machine that was recorded");
    }
    auto more = edits_of(text, *axis, one);
    if (!more) {
      return refuse(file, static_cast<std::size_t>(axis->source().begin.line),
                    fmt::format("the servo gain of axis {} is not on its own line", one.axis),
                    "write [[axis]] as a section with one key in a line");
    }
    edits.insert(edits.end(), more->begin(), more->end());
  }
  std::string out = applied(text, edits);
  const auto machine = parse(out, file);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  const auto has = [&machine](const ServoValues& one) {
    const auto axis = std::ranges::find(machine->axes, one.axis, &Axis::name);
    return axis != machine->axes.end() && near(axis->servo_gain_1_s, one.gain_1_s) &&
           near(axis->feed_forward, one.feed_forward) &&
           near(axis->velocity_lag_s, one.velocity_lag_s.value_or(axis->velocity_lag_s));
  };
  if (!std::ranges::all_of(values, has) || !changes_only(out, text, values)) {
    return refuse(file, "putting the gains in would change something else", "put them in by hand");
  }
  return out;
}

}  // namespace

Result<std::string> with_servo(std::string_view text, const std::string& file,
                               const std::vector<ServoValues>& values) {
  if (const auto machine = parse(text, file); !machine) {
    return std::unexpected(machine.error());
  }
  // toml++ throws; that ends here.
  try {
    return edited(text, file, values);
  } catch (const std::exception& error) {
    return refuse(file, fmt::format("not editable: {}", error.what()), "put the gains in by hand");
  }
}

}  // namespace steadyrest::passport
