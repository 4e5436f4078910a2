// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/passport/file/reference.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>
#include <steadyrest/passport/text/text_check.hpp>

namespace steadyrest::passport {
namespace {

std::string quoted(std::string_view text) {
  return fmt::format("`\"{}\"`", text);
}

/// Range and default of one field, as the page shows them.
template <class S>
struct Describe {
  const Key<S>& key;
  S standard{};  // the struct's own defaults: there is no second list

  std::string range;
  std::string standard_value;

  void between(std::string_view before) {
    range = fmt::format("{}{} … {}", before, shown(key.min), shown(key.max));
  }
  void operator()(double S::* field) {
    between("");
    const double value = standard.*field;
    standard_value = std::isfinite(value) ? shown(unit_of(key.name).from_inner(value)) : "no limit";
  }
  void operator()(bool S::* field) {
    range = "`true`, `false`";
    standard_value = standard.*field ? "`true`" : "`false`";
  }
  template <class Integer>
    requires std::is_integral_v<Integer> && (!std::is_same_v<Integer, bool>)
  void operator()(Integer S::* field) {
    between("whole number ");
    standard_value = fmt::format("{}", standard.*field);
  }
  void operator()(std::string S::* field) {
    range = key.min == key.max ? fmt::format("{} character", shown(key.max))
                               : fmt::format("{} … {} characters", shown(key.min), shown(key.max));
    standard_value = quoted(standard.*field);
  }
  void operator()(std::vector<double> S::* /*field*/) { between("list of "); }
  void operator()(std::vector<std::uint32_t> S::* /*field*/) { between("list of whole numbers "); }
  void operator()(const Choice<S>& field) {
    for (const std::string_view word : field.words) {
      range += range.empty() ? "" : ", ";
      range += quoted(word);
    }
    standard_value = quoted(field.words[field.get(standard)]);
  }
};

template <class S>
std::string default_of(const Key<S>& key, const Describe<S>& described) {
  if (key.need == Need::mandatory) {
    return "**mandatory**";
  }
  if (described.standard_value.empty() || key.name == "binary_max_percent") {
    return "—";
  }
  return described.standard_value;
}

template <class S>
std::string rows(std::span<const Key<S>> keys) {
  std::string out = "| key | unit | allowed | default | meaning |\n|--|--|--|--|--|\n";
  for (const Key<S>& key : keys) {
    Describe<S> described{key, {}, {}, {}};
    std::visit(described, key.field);
    const std::string_view unit = unit_of(key.name).shown;
    const std::string_view kind = key.axes == For::linear   ? "Linear axis. "
                                  : key.axes == For::rotary ? "Rotary axis. "
                                                            : "";
    out += fmt::format("| `{}` | {} | {} | {} | {}{} |\n", key.name, unit.empty() ? "—" : unit,
                       described.range, default_of(key, described), kind, key.meaning);
  }
  return out;
}

template <class S>
std::string section(std::string_view head, std::string_view text, std::span<const Key<S>> keys) {
  return fmt::format("\n## {}\n{}\n{}", head, text, rows(keys));
}

constexpr std::string_view kOpening =
    R"(<!-- Made from steadyrest/passport/keys/schema.cpp; do not edit. `cmake --build --preset release --target machine_reference` writes it. -->
# The machine file

One TOML file is the machine's passport. Whatever the machine is reached through reads the same file; `port` is the
only difference, and `sim`, the simulated machine, the only one so far. Start from one of [`examples/machines/`](../examples/machines) and check yours with

    steadyrest doctor --machine examples/machines/vmc-840d.toml

A key's name ends in its unit. Where a quantity has keys in two units, give one of them. What has no default is mandatory;
what is misspelt, has the wrong unit or type, is out of range, repeated, or contradicts another value is refused with file, line,
the value seen, what is allowed and what to do. Nothing is repaired silently. `inf` and `nan` are never allowed: where there is no
limit, leave the key out. UTF-8, at most {} MB.
)";

}  // namespace

std::string reference_page() {
  std::string out = fmt::format(fmt::runtime(kOpening), kMaxFileBytes >> 20U);
  out += section("Top level", "\nStands above all sections.\n", top_keys());
  out += section("`[control]`", "\nHow the control plans motion. Mandatory.\n", control_keys());
  out += section(
      "`[[axis]]`",
      "\nOnce for each axis, at least two, at most eight with X, Y and Z counted. A machine "
      "without X, Y or Z (a\nlathe's Y) gets an ideal stand-in that cannot move.\n",
      axis_keys());
  out += section("`[axis.encoder]`", "\nBelow its `[[axis]]`.\n", encoder_keys());
  out += section("`[axis.friction]`",
                 "\nBelow its `[[axis]]`. f(v) = sign(v)·(coulomb + (breakaway − "
                 "coulomb)·exp(−(v/stribeck)²)) "
                 "+ viscous·v, each as\nforce over moved mass.\n",
                 friction_keys());
  out += section(
      "`[override.feed]`, `[override.rapid]`, `[override.spindle]`",
      "\nThe override switches as this machine has them: read them from the control, never from "
      "another machine.\n`[override.feed]` is mandatory and needs `percent` or "
      "`binary_max_percent`. "
      "Without `[override.rapid]` the feed\nswitch acts on rapids, never above 100 %; without "
      "`[override.spindle]` the spindle stays at 100 %. Steps of equal percent\nare allowed "
      "(unused positions); Gray codes of neighbours differ in one bit.\n",
      override_keys());
  out += section("`[spindle]`", "", spindle_keys());
  out +=
      section("`[contour]`", "\nWhat the correction of contour errors may do.\n", contour_keys());
  out += section("`[chatter]`",
                 "\nHow the spindle's speed is modulated against chatter. With `enabled` the "
                 "program may\nhold the two M words; without it they are refused like any other "
                 "unknown M word.\n",
                 chatter_keys());
  out += section("`[compensation]`",
                 "\nHow `program compensate` writes corrections into the programs of this machine: "
                 "[nc/rewrite](../steadyrest/nc/rewrite/README.md)\nhas the texts and the "
                 "reasons. The command line may say otherwise.\n",
                 compensation_keys());
  out +=
      section("`[thermal]`",
              "\nWhat heat does to the machine: [thermal](../steadyrest/thermal/README.md) has the "
              "law.\n`thermal fit` writes the sections below from a log.\n",
              thermal_keys());
  out += section("`[[thermal.axis]]`", "\nOnce for each displaced axis.\n", thermal_axis_keys());
  out += section("`[[thermal.axis.mode]]`",
                 "\nBelow its axis: x' = (G(n) − x)/τ, the displacement is the sum. One to four.\n",
                 thermal_mode_keys());
  out += section("`[[thermal.axis.ambient]]`",
                 "\nBelow its axis: what the surroundings add, gain·(lagged temperature − "
                 "reference). At most four.\n",
                 thermal_ambient_keys());
  out += section("`[envelope]`", "\nThe last step before any write. It cannot be switched off.\n",
                 envelope_keys());
  out += section("`[simulation]`", "\nFor the simulated machine alone.\n", simulation_keys());
  return out;
}

}  // namespace steadyrest::passport
