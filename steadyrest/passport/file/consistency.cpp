// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/core.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/file/axis_findings.hpp>
#include <steadyrest/passport/file/consistency.hpp>

// Findings concern machines that load but will disappoint: values each in range that make no sense
// together. The checks say what it costs, in µm or seconds, and what to change.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Contour;
using kernel::machine::Envelope;
using kernel::machine::Machine;
using kernel::machine::OverrideTable;

using List = std::vector<Finding>;

constexpr double kOftenLate_s = 0.1;

/// Steps are decimal fractions, so equality needs a tolerance of rounding only.
bool has_ratio(const OverrideTable& table, double ratio) {
  return std::any_of(table.ratio.begin(), table.ratio.end(),
                     [ratio](double step) { return std::abs(step - ratio) < 1e-9; });
}

/// Faults of one switch. Handing back means writing 100 %: without that step the layer could only
/// leave its own value behind. With a max_percent below its steps the control clips them: it does
/// not do what the layer writes.
void override_table(std::string_view name, const OverrideTable& table, List& out) {
  if (!has_ratio(table, 1.0)) {
    out.push_back({Severity::error, "override_100",
                   fmt::format("[override.{}] has no 100 % step: the layer has no way to hand back "
                               "the programmed value",
                               name),
                   "list every step of the switch"});
  }
  if (table.max_ratio < 1.0) {
    out.push_back({Severity::error, "override_max",
                   fmt::format("[override.{}] is clipped below 100 %", name),
                   "correct max_percent"});
  } else if (!table.ratio.empty() && table.ratio.back() > table.max_ratio * (1.0 + 1e-9)) {
    out.push_back({Severity::warning, "override_max",
                   fmt::format("[override.{}] has steps above its max_percent, which the control "
                               "clips",
                               name),
                   "correct max_percent or the steps"});
  }
}

void overrides(const Machine& machine, List& out) {
  override_table("feed", machine.feed_override, out);
  // Same codes: without [override.rapid] the rapid table is made from the feed's, and one fault is
  // enough.
  if (machine.rapid_override.code != machine.feed_override.code) {
    override_table("rapid", machine.rapid_override, out);
  }
  override_table("spindle", machine.spindle_override, out);
  if (!has_ratio(machine.feed_override, 0.0)) {
    out.push_back({Severity::warning, "override_0", "[override.feed] has no 0 % step",
                   "list it if the switch has one: the operator stops the feed with it"});
  }
}

/// Position feedback resolves one count, so a limit below two would be guessed, not held. Backlash
/// leaves the axis half of itself behind on either side of a reversal, at any feed.
void contour_limit(const Machine& machine, List& out) {
  if (!machine.contour.enabled) {
    return;
  }
  for (const Axis* axis : contouring(machine)) {
    if (machine.contour.limit_mm < 2.0 * axis->encoder.count_au) {
      out.push_back({Severity::error, "contour_limit",
                     fmt::format("the contour limit of {:.4g} µm is below the resolution of axis "
                                 "{}: one count is {:.4g} µm",
                                 kernel::units::um_from_mm(machine.contour.limit_mm), axis->name,
                                 kernel::units::um_from_mm(axis->encoder.count_au)),
                     "set limit_um to two counts or more"});
    }
    if (machine.contour.limit_mm < 0.5 * axis->backlash_au) {
      out.push_back({Severity::warning, "contour_limit",
                     fmt::format("the contour limit of {:.4g} µm is below half the backlash of "
                                 "axis {}: no feed holds it at a reversal",
                                 kernel::units::um_from_mm(machine.contour.limit_mm), axis->name),
                     "compensate the backlash in the control or raise limit_um"});
    }
  }
}

/// The envelope clamps last, whatever the rooms ask for. It must leave them room, above all 100 %,
/// because neutral is 100 %.
void envelope(const Machine& machine, List& out) {
  const Envelope& envelope = machine.envelope;
  const Contour& contour = machine.contour;
  if (contour.min_ratio > envelope.max_feed_ratio || contour.max_ratio < envelope.min_feed_ratio) {
    out.push_back({Severity::error, "envelope", "[contour] and [envelope] have no feed in common",
                   "let min_percent … max_percent overlap min_feed_percent … max_feed_percent"});
  } else if (contour.max_ratio > envelope.max_feed_ratio ||
             contour.min_ratio < envelope.min_feed_ratio) {
    out.push_back({Severity::note, "envelope", "[contour] may ask for feeds that [envelope] clamps",
                   "narrow min_percent … max_percent unless you mean that"});
  }
  if (envelope.min_feed_ratio > 1.0 || envelope.max_feed_ratio < 1.0) {
    out.push_back({Severity::error, "envelope", "[envelope] does not allow 100 % feed",
                   "let min_feed_percent … max_feed_percent contain 100"});
  }
  if (envelope.min_spindle_ratio > 1.0 || envelope.max_spindle_ratio < 1.0) {
    out.push_back({Severity::error, "envelope", "[envelope] does not allow 100 % spindle speed",
                   "let min_spindle_percent … max_spindle_percent contain 100"});
  }
  if (envelope.stale_after_s < layer_cycle_s(machine)) {
    out.push_back(
        {Severity::error, "stale",
         "stale_after_ms is shorter than one cycle of the layer: every input would be stale",
         "set stale_after_ms to several periods"});
  }
  if (machine.port == kernel::machine::PortKind::linuxcnc && envelope.late_hold_s < kOftenLate_s) {
    out.push_back({Severity::warning, "late",
                   fmt::format("late_hold_ms = {:g}: a computer without real-time priority is "
                               "often later than that, and each time the feed rises in the cut",
                               1e3 * envelope.late_hold_s),
                   "give 1000, or at least 100"});
  }
}

/// What the modulator would refuse, reported before a run: a modulation needs two speeds.
void chatter(const Machine& machine, List& out) {
  if (!machine.chatter.enabled) {
    return;
  }
  const auto& envelope = machine.envelope;
  const auto& ratio = machine.spindle_override.ratio;
  const auto within = std::count_if(ratio.begin(), ratio.end(), [&](double r) {
    return r >= envelope.min_spindle_ratio && r <= envelope.max_spindle_ratio;
  });
  if (within < 2) {
    out.push_back({Severity::error, "chatter",
                   "[chatter] is enabled, but the spindle override has fewer than two steps within "
                   "[envelope]",
                   "give [override.spindle], or set enabled = false in [chatter]"});
  }
}

/// What would leave a dead layer's word in force, or the layer blind.
void lines(const Machine& machine, List& out) {
  const auto& of = machine.lines;
  if (machine.port != kernel::machine::PortKind::lines) {
    return;
  }
  const bool beats = of.heartbeat != kernel::machine::kNoLine;
  if (of.wiring == kernel::machine::Wiring::relay && !beats && of.watchdog_s <= 0.0) {
    out.push_back({Severity::error, "lines",
                   "wiring = \"relay\" with neither an output watchdog nor a heartbeat: a dead "
                   "layer would keep the relays in",
                   "set watchdog_ms of a module that has one, or wire heartbeat to a relay that "
                   "watches its edges"});
  }
  if (of.wiring == kernel::machine::Wiring::plc &&
      of.cycle_s < 2.0 * machine.feed_override.scan_period_s) {
    out.push_back({Severity::warning, "lines",
                   "cycle_ms is shorter than two scans of the PLC, which may miss the heartbeat's "
                   "edges",
                   "set cycle_ms to twice the longest scan, or more"});
  }
  if (of.watchdog_s > 0.0 && of.watchdog_s < 2.0 * of.cycle_s + of.reply_s) {
    out.push_back(
        {Severity::warning, "lines",
         "watchdog_ms is shorter than two cycles and an answer: one slow answer would drop "
         "the outputs",
         "set it to five cycles or more, and reply_ms to what the module needs"});
  }
  if (machine.chatter.enabled && of.programmed_rev_s <= 0.0 &&
      machine.recorder.spindle_counts_rev <= 0.0) {
    out.push_back({Severity::warning, "lines",
                   "[chatter] is enabled, but no spindle speed is known: it is not modulated",
                   "give programmed_rpm, or spindle_counts_rev in [recorder]"});
  }
  if (machine.contour.enabled && !machine.recorder.fitted) {
    out.push_back({Severity::error, "lines",
                   "[contour] is enabled, but without [recorder] the lines show no positions",
                   "add [recorder], or set enabled = false in [contour]"});
  }
}

/// The spindle's override acts in threads, too; the feed's is held there by the control itself.
void threads(const Machine& machine, List& out) {
  using kernel::machine::PortKind;
  using kernel::machine::Quantity;
  const auto has = [](const auto& places, std::initializer_list<Quantity> any_of) {
    return std::ranges::any_of(places, [&](const auto& place) {
      return std::ranges::find(any_of, place.quantity) != any_of.end();
    });
  };
  const bool blind_lines = machine.port == PortKind::lines && !machine.lines.spindle.out.empty() &&
                           machine.lines.locked == kernel::machine::kNoLine;
  const bool blind_mapping =
      machine.port == PortKind::opcua &&
      has(machine.opcua.writes, {Quantity::spindle_percent, Quantity::spindle_position}) &&
      !has(machine.opcua.reads, {Quantity::motion_g, Quantity::motion_number});
  if (machine.spindle_override.ratio.size() > 1 && (blind_lines || blind_mapping)) {
    out.push_back({Severity::warning, "threads",
                   "the layer changes the spindle's override, and sees threads only while it "
                   "follows the program: another that it meets is spoilt",
                   blind_lines
                       ? "wire an output of the control that is on in threads and taps, and "
                         "name it locked in [lines]; else leave [lines.spindle] out"
                       : "map motion_g or motion_number; else write no spindle override"});
  }
}

/// Distance covered until an override acts is v·delay; only the look-ahead can act earlier.
void tempo(const Machine& machine, List& out) {
  const double delay_s = machine.feed_override.scan_period_s + machine.feed_override.dead_time_s;
  if (delay_s > 0.5) {
    out.push_back({Severity::warning, "override_delay",
                   fmt::format("a feed override takes up to {:.2f} s to act: shorter features are "
                               "corrected only from the path ahead",
                               delay_s),
                   "use a faster path to the override if there is one"});
  }
}

}  // namespace

/// All checks run: a machine file is corrected in one go, not fault by fault.
std::vector<Finding> findings(const Machine& machine) {
  List out;
  add_axis_findings(machine, out);
  overrides(machine, out);
  contour_limit(machine, out);
  envelope(machine, out);
  chatter(machine, out);
  tempo(machine, out);
  lines(machine, out);
  threads(machine, out);
  return out;
}

/// As doctor prints it.
std::string_view word(Severity severity) noexcept {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "?";
}

}  // namespace steadyrest::passport
