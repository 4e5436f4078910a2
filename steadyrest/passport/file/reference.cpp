// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/passport/file/reference.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>
#include <steadyrest/passport/text/text_check.hpp>

// Writes docs/machine-file.md from the schema, the same table that reads the files, so the page
// cannot promise a key that does not exist. A test compares it with the file in docs/.
namespace steadyrest::passport {
namespace {

std::string as_code(std::string_view text) {
  return fmt::format("`\"{}\"`", text);
}

/// Range and default of one field as the page shows them, in the file's unit. The default comes
/// from a fresh struct: there is no second list.
template <class S>
struct Describe {
  const Key<S>& key;
  S standard{};  // the struct's own defaults: there is no second list

  std::string range;
  std::string standard_value;

  // The range is in the key's own unit, as the user writes it.
  void between(std::string_view before) {
    range = fmt::format("{}{} … {}", before, shown(key.min), shown(key.max));
  }
  void operator()(double S::* field) {
    between("");
    const double value = standard.*field;
    // An infinite default means that there is no limit.
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
    standard_value = as_code(standard.*field);
  }
  void operator()(std::vector<double> S::* /*field*/) { between("list of "); }
  void operator()(std::vector<std::uint32_t> S::* /*field*/) { between("list of whole numbers "); }
  // The allowed words as written in the file.
  void operator()(const Choice<S>& field) {
    for (const std::string_view word : field.words) {
      range += range.empty() ? "" : ", ";
      range += as_code(word);
    }
    standard_value = as_code(field.words[field.get(standard)]);
  }
};

/// What the page shows in the column "default".
template <class S>
std::string default_of(const Key<S>& key, const Describe<S>& described) {
  if (key.need == Need::mandatory) {
    return "**mandatory**";
  }
  // binary_max_percent has a default in the struct that means "not given".
  if (described.standard_value.empty() || key.name == "binary_max_percent") {
    return "—";
  }
  return described.standard_value;
}

/// One line per key, in the schema's order. Keys only for linear or only for rotary axes say so
/// first.
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

/// A heading, the purpose of the section, and its table.
template <class S>
std::string section(std::string_view head, std::string_view text, std::span<const Key<S>> keys) {
  return fmt::format("\n## {}\n{}\n{}", head, text, rows(keys));
}

constexpr std::string_view kOpening =
    R"(<!-- Made from steadyrest/passport/keys/schema.cpp; do not edit. `cmake --build --preset release --target machine_reference` writes it. -->
# The machine file

One TOML file is the machine's passport. A simulated and a real machine read the same file; only `port` differs, and
`sim` is the simulated machine, `linuxcnc` a running LinuxCNC (in builds that have found its library). Start from one of [`examples/machines/`](../examples/machines) and check yours with

    steadyrest doctor --machine examples/machines/vmc-840d.toml

A key's name ends in its unit. Where a quantity has keys in two units, give one of them. A key without a default is mandatory.
A key that is misspelt, has the wrong unit or type, is out of range, repeated, or contradicts another is refused with file, line,
the value seen, what is allowed and what to do. Nothing is repaired silently. `inf` and `nan` are never allowed: if there is no
limit, leave the key out. UTF-8, at most {} MB.
)";

std::string port_sections() {
  std::string out;
  out += section("`[lines]`",
                 "\nDigital lines between panel and control, for `port = \"lines\"`; "
                 "[how they are wired](wiring.md).\n",
                 lines_keys());
  out +=
      section("`[lines.feed]`, `[lines.spindle]`", "\nThe wires of one override.\n", wires_keys());
  out += section("`[recorder]`",
                 "\nEncoders read by a recorder, for `port = \"lines\"`; "
                 "[its protocol](../steadyrest/adapters/lines/README.md).\n",
                 recorder_keys());
  out += section("`[opcua]`",
                 "\nA control behind its OPC UA server, for `port = \"opcua\"`; "
                 "[how it is connected](opcua.md).\n",
                 opcua_keys());
  return out;
}

}  // namespace

std::string reference_page() {
  std::string out = fmt::format(fmt::runtime(kOpening), kMaxFileBytes >> 20U);
  // The order here is the order of the page, and of the example files.
  out += section("Top level", "\nThese come before any section.\n", top_keys());
  out += section("`[control]`", "\nHow the control plans motion. Mandatory.\n", control_keys());
  out += section("`[program]`",
                 "\nWhat the control's own configuration makes of a program: every verb that reads "
                 "one with this machine file reads it so.\n",
                 program_keys());
  out +=
      "\n## `[program.words]`\n\n"
      "What the machine builder's own words do, for programs that have them: `M50 = \"none\"`. A "
      "key "
      "is a letter with its\nnumber (`M50`, `H12`, `G187`), or the name of a subprogram "
      "(`L_TIME`); small and capital letters are the same.\n"
      "A word with P, Q and other letters that belong to nothing else in its block takes these "
      "with "
      "it. `program words` writes\nthe section for a folder of programs.\n\n"
      "| value | meaning |\n|---|---|\n"
      "| `\"none\"` | no axis moves, and the program goes on |\n"
      "| `\"stop\"` | the axes come to rest first |\n"
      "| `\"dwell 0.5\"` | they come to rest, and stand for so many seconds |\n"
      "| `\"moves X Z\"` | it moves these axes; where they end is not known until the program says "
      "it |\n"
      "| `\"opaque\"` | it may do anything; so does a word that is not understood |\n";
  out +=
      section("`[[axis]]`",
              "\nOnce for each axis: at least two, at most eight counting X, Y and Z. A machine "
              "without X, Y or Z (a lathe has\nno Y) gets an ideal stand-in that does not move.\n",
              axis_keys());
  out += section("`[axis.encoder]`", "\nBelow its `[[axis]]`.\n", encoder_keys());
  out += section("`[axis.friction]`",
                 "\nBelow its `[[axis]]`. f(v) = sign(v)·(coulomb + (breakaway − "
                 "coulomb)·exp(−(v/stribeck)²)) "
                 "+ viscous·v, each as\nforce over moved mass.\n",
                 friction_keys());
  out += section(
      "`[override.feed]`, `[override.rapid]`, `[override.spindle]`",
      "\nThe override switches of this machine. Read them from its control; never copy them from "
      "another machine.\n`[override.feed]` is mandatory and needs `percent` or "
      "`binary_max_percent`. Without `[override.rapid]` the feed\nswitch also acts on rapids, but "
      "never above 100 %; without `[override.spindle]` the spindle stays at 100 %. Steps of\nequal "
      "percent are allowed (unused positions); Gray codes of neighbours differ in one bit.\n",
      override_keys());
  out += section("`[spindle]`", "", spindle_keys());
  out += section("`[contour]`", "\nThe limits of contour correction.\n", contour_keys());
  out +=
      section("`[chatter]`",
              "\nSpindle-speed modulation against chatter. If `enabled` is true the program may "
              "use the two M words;\notherwise they are refused like any other unknown M word.\n",
              chatter_keys());
  out += section(
      "`[compensation]`",
      "\nHow `program compensate` writes corrections into programs for this machine. The blocks it "
      "writes, and why, are in\n[nc/rewrite](../steadyrest/nc/rewrite/README.md). Options on the "
      "command line take precedence.\n",
      compensation_keys());
  out += section("`[thermal]`",
                 "\nThermal behaviour. The law is in [thermal](../steadyrest/thermal/README.md); "
                 "`thermal fit` writes the sections below\nfrom a log.\n",
                 thermal_keys());
  out += section("`[[thermal.axis]]`", "\nOnce for each axis that drifts.\n", thermal_axis_keys());
  out += section("`[[thermal.axis.mode]]`",
                 "\nBelow its axis, one to four: x' = (G(n) − x)/τ. The displacement is the sum of "
                 "the modes.\n",
                 thermal_mode_keys());
  out += section("`[[thermal.axis.ambient]]`",
                 "\nBelow its axis, at most 64: the surroundings add gain·(lagged temperature − "
                 "reference).\n",
                 thermal_ambient_keys());
  out += section("`[envelope]`", "\nThe last step before any write. It is always on.\n",
                 envelope_keys());
  out += section("`[simulation]`", "\nUsed only by the simulated machine.\n", simulation_keys());
  out += port_sections();
  return out;
}

}  // namespace steadyrest::passport
