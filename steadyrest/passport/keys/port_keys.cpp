// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include <steadyrest/passport/keys/choice.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// Keys of the ports that reach a control by lines or by a network.
namespace steadyrest::passport {
namespace {

using kernel::machine::Lines;
using kernel::machine::OverrideWires;
using kernel::machine::Recorder;
using std::string_view;

constexpr std::array<string_view, 4> kKinds = {"modbus_tcp", "modbus_rtu", "gpio", "comedi"};
constexpr std::array<string_view, 3> kParities = {"none", "even", "odd"};
constexpr std::array<string_view, 3> kWirings = {"relay", "plc", "through"};
constexpr std::array<string_view, 3> kRecorders = {"serial", "gpio", "counter"};
constexpr double kMostLines = 1023;
constexpr double kLastAddress = 65535;

/// How the lines are reached.
std::vector<Key<Lines>> reach_keys() {
  return {
      Key<Lines>{
          "kind", choice<Lines, &Lines::kind>(kKinds), 0, 0,
          "How the lines are reached: a Modbus module by network or serial line, Linux GPIO, "
          "or a comedi card.",
          Need::mandatory},
      Key<Lines>{"address", &Lines::address, 1, 255,
                 "modbus_tcp: `HOST` or `HOST:PORT`; the port is 502 by default."},
      Key<Lines>{"device", &Lines::device, 1, 255,
                 "modbus_rtu: the serial device; gpio: the chip, `/dev/gpiochip0`; comedi: "
                 "`/dev/comedi0`."},
      Key<Lines>{"unit", &Lines::unit, 0, 247, "Modbus: the module's unit number."},
      Key<Lines>{"baud", &Lines::baud, 1200, 4000000, "modbus_rtu: bits per second."},
      Key<Lines>{"parity", choice<Lines, &Lines::parity>(kParities), 0, 0, "modbus_rtu: parity."},
      Key<Lines>{"registers", &Lines::registers, 0, 0,
                 "Modbus: the module shows its lines as 16-bit registers (functions 4, 3 and 16), "
                 "not as discrete inputs and coils (2, 1 and 15)."},
      Key<Lines>{"first_input", &Lines::first_input, 0, kLastAddress,
                 "Modbus: address of input 0, or of the register with it."},
      Key<Lines>{"first_output", &Lines::first_output, 0, kLastAddress,
                 "Modbus: address of output 0, or of the register with it."},
      Key<Lines>{"output_copy", &Lines::output_copy, 0, kLastAddress,
                 "Modbus: address at which the outputs are read back; by default `first_output`."},
      Key<Lines>{"input_device", &Lines::input_device, 0, 255,
                 "comedi: the subdevice of the inputs."},
      Key<Lines>{"output_device", &Lines::output_device, 0, 255,
                 "comedi: the subdevice of the outputs."},
      Key<Lines>{"wiring", choice<Lines, &Lines::wiring>(kWirings), 0, 0,
                 "What is between outputs and control: change-over relays, the machine's PLC, "
                 "or nothing (docs/wiring.md)."},
      Key<Lines>{"cycle_ms", &Lines::cycle_s, 1, 1000,
                 "The layer reads and writes the lines this often."},
      Key<Lines>{"reply_ms", &Lines::reply_s, 1, 10000, "Longest wait for the module's answer."},
  };
}

/// What is on them, and what drops them.
std::vector<Key<Lines>> signal_keys() {
  return {
      Key<Lines>{"heartbeat", &Lines::heartbeat, 0, kMostLines,
                 "Output that changes in each cycle of the layer while it acts."},
      Key<Lines>{"running", &Lines::running, 0, kMostLines, "Input: a program runs."},
      Key<Lines>{"cutting", &Lines::cutting, 0, kMostLines,
                 "Input: the axes move at a programmed feed (G1 … G3), not at rapid."},
      Key<Lines>{"locked", &Lines::locked, 0, kMostLines,
                 "Input: threading or tapping, the overrides must not move."},
      Key<Lines>{"locked_inverted", &Lines::locked_inverted, 0, 0,
                 "That input is off in a thread and on elsewhere, so that a broken wire holds the "
                 "overrides."},
      Key<Lines>{
          "locked_hold_ms", &Lines::locked_hold_s, 0, 60000,
          "A thread counts as going on for this long after `locked` goes off: longer than the "
          "way back between two passes, which must be cut at one speed."},
      Key<Lines>{"modulate", &Lines::modulate, 0, kMostLines,
                 "Input: the program asks for spindle speed modulation (an M function)."},
      Key<Lines>{"programmed_rpm", &Lines::programmed_rev_s, 0, 1e6,
                 "Spindle speed that the program asks for (S), where no encoder on the recorder "
                 "shows it; 0: not known, and no law of speed acts."},
      Key<Lines>{"dropped_after_ms", &Lines::dropped_after_s, 0, 60000,
                 "What drops the layer's word when it falls silent, if not the module's watchdog: "
                 "the time of the watchdog relay, or the PLC's limit for the heartbeat."},
      Key<Lines>{"watchdog_ms", &Lines::watchdog_s, 0, 60000,
                 "The module drops its outputs when it has not been written for this long; 0: it "
                 "has no output watchdog."},
      Key<Lines>{"watchdog_registers", &Lines::watchdog_registers, 0, kLastAddress,
                 "Modbus: registers that set that watchdog, address and value in turn. They are "
                 "written and read back before the first write of each connection.",
                 Need::optional, For::any, 32},
      Key<Lines>{"watchdog_reset", &Lines::watchdog_reset, 0, kLastAddress,
                 "Modbus: what clears an expired watchdog, address and value in turn, also "
                 "repeatedly. Written before `watchdog_registers`, and when a reading is answered "
                 "with exception 4; a module that refuses it is not at fault.",
                 Need::optional, For::any, 32},
  };
}

}  // namespace

std::span<const Key<Lines>> lines_keys() noexcept {
  static const std::vector<Key<Lines>> kKeys = [] {
    auto keys = reach_keys();
    std::ranges::copy(signal_keys(), std::back_inserter(keys));
    return keys;
  }();
  return kKeys;
}

std::span<const Key<OverrideWires>> wires_keys() noexcept {
  static const std::array kKeys = {
      Key<OverrideWires>{"panel", &OverrideWires::panel, 0, kMostLines,
                         "Inputs that carry the panel's word, lowest bit first.", Need::mandatory,
                         For::any, 16},
      Key<OverrideWires>{"out", &OverrideWires::out, 0, kMostLines,
                         "Outputs for the layer's word, lowest bit first, as many as `panel`.",
                         Need::mandatory, For::any, 16},
      Key<OverrideWires>{"mask", &OverrideWires::mask, 0, kMostLines,
                         "Output that puts the layer's word in force: the relays' coils, or the "
                         "PLC's mask bit. Mandatory but for wiring = \"through\"."},
      Key<OverrideWires>{"panel_inverted", &OverrideWires::panel_inverted, 0, 0,
                         "A 1 of the panel's word is a low level."},
      Key<OverrideWires>{"out_inverted", &OverrideWires::out_inverted, 0, 0,
                         "A 1 of the layer's word is a low level."},
  };
  return kKeys;
}

std::span<const Key<Recorder>> recorder_keys() noexcept {
  static const std::array kKeys = {
      Key<Recorder>{"kind", choice<Recorder, &Recorder::kind>(kRecorders), 0, 0,
                    "How the encoders are read: a microcontroller on a serial line, lines of a "
                    "Linux GPIO chip, or the kernel's counters."},
      Key<Recorder>{"device", &Recorder::device, 1, 255,
                    "serial: the serial device; gpio: the chip, `/dev/gpiochip0`."},
      Key<Recorder>{"baud", &Recorder::baud, 9600, 4000000,
                    "serial: bits per second; USB ignores it."},
      Key<Recorder>{"inputs", &Recorder::inputs, 0, kMostLines,
                    "Two for each encoder, the axes in their order, then the spindle. gpio: the "
                    "lines of its channels A and B; counter: the numbers of its counter and count, "
                    "`0, 1` for counter0/count1.",
                    Need::optional, For::any, 18},
      Key<Recorder>{"start_mm", &Recorder::start_mm, -1e5, 1e5,
                    "Positions of the axes when the layer starts, one for each `[[axis]]`; by "
                    "default 0: start it with the machine at its reference point.",
                    Need::optional, For::any, 8},
      Key<Recorder>{"spindle_counts_rev", &Recorder::spindle_counts_rev, 0, 1e7,
                    "Counts of the spindle's encoder in one turn, after ×4 decoding; 0: it has no "
                    "encoder."},
  };
  return kKeys;
}

}  // namespace steadyrest::passport
