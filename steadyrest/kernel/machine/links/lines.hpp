// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace steadyrest::kernel::machine {

/// How the input and output lines are reached.
enum class LinesKind : std::uint8_t { modbus_tcp, modbus_rtu, gpio, comedi };
enum class Parity : std::uint8_t { none, even, odd };

/// What stands between the module's outputs and the control (docs/wiring.md).
enum class Wiring : std::uint8_t {
  relay,   ///< change-over relays: without the mask output the panel is connected by metal
  plc,     ///< the machine's PLC takes the lower of panel and layer while the heartbeat goes on
  through  ///< nothing: the layer passes the panel's word on
};

/// A line that is not wired.
inline constexpr std::uint32_t kNoLine = std::numeric_limits<std::uint32_t>::max();

/// The wires of one override: numbers of inputs and outputs, the word's lowest bit first.
struct OverrideWires {
  std::vector<std::uint32_t> panel;  ///< inputs
  std::vector<std::uint32_t> out;    ///< outputs; empty: this override is not wired
  std::uint32_t mask = kNoLine;      ///< output: the layer's word, not the panel's, is in force
  bool panel_inverted = false;       ///< a 1 of the word is a low level
  bool out_inverted = false;

  friend bool operator==(const OverrideWires&, const OverrideWires&) = default;
};

/// Digital inputs and outputs between the operator's panel and the control.
struct Lines {
  LinesKind kind = LinesKind::modbus_tcp;
  std::string address;  ///< modbus_tcp: `HOST` or `HOST:PORT`
  std::string device;   ///< modbus_rtu: serial device; gpio: chip; comedi: device file
  std::uint32_t unit = 1;
  std::uint32_t baud = 19200;
  Parity parity = Parity::even;
  bool registers = false;           ///< Modbus: the module shows its lines as registers, 16 a piece
  std::uint32_t first_input = 0;    ///< Modbus: address of input 0 (of its register)
  std::uint32_t first_output = 0;   ///< likewise of output 0
  std::uint32_t output_copy = 0;    ///< Modbus: address at which the outputs are read back
  std::uint32_t input_device = 0;   ///< comedi: subdevice
  std::uint32_t output_device = 1;  ///< likewise
  Wiring wiring = Wiring::relay;
  double cycle_s = 0.01;  ///< the layer reads and writes the lines this often
  double reply_s = 0.05;  ///< longest wait for the module's answer
  OverrideWires feed;
  OverrideWires spindle;
  std::uint32_t heartbeat = kNoLine;  ///< output: changes with each cycle of the layer
  std::uint32_t running = kNoLine;    ///< input: a program runs
  std::uint32_t cutting = kNoLine;    ///< input: feed motion (G1–G3)
  std::uint32_t locked = kNoLine;     ///< input: threading or tapping
  bool locked_inverted = false;       ///< that input is off there: a broken wire holds
  double locked_hold_s = 3.0;         ///< a thread goes on for so long after it, between passes
  std::uint32_t modulate = kNoLine;   ///< input: the program asks for speed modulation
  double programmed_rev_s = 0.0;      ///< S of the program, where no encoder shows it; 0: not known
  double dropped_after_s =
      0.0;                  ///< a watchdog relay or the PLC drops the word sooner; 0: it does not
  double watchdog_s = 0.0;  ///< the module drops its outputs after this time; 0: it has no watchdog
  /// Registers that set it: address and value in turn, written and read back before the first write
  /// of each connection.
  std::vector<std::uint32_t> watchdog_registers;
  /// Written before them, not read back and not missed: what clears a watchdog that has expired.
  std::vector<std::uint32_t> watchdog_reset;

  friend bool operator==(const Lines&, const Lines&) = default;
};

/// How the encoders are read: a microcontroller on a serial line, GPIO lines, the kernel's
/// counters.
enum class RecorderKind : std::uint8_t { serial, gpio, counter };

/// Encoders by a recorder of their own, where the control shows no positions.
struct Recorder {
  bool fitted = false;  ///< there is one
  RecorderKind kind = RecorderKind::serial;
  std::string device;  ///< serial: its line; gpio: the chip
  /// Two for each encoder. gpio: lines of channels A and B; counter: numbers of the counter and of
  /// its count.
  std::vector<std::uint32_t> inputs;
  std::uint32_t baud = 2000000;   ///< of a real serial line; USB ignores it
  std::vector<double> start_mm;   ///< of all axes when the layer starts; none: 0
  double spindle_counts_rev = 0;  ///< counts of the spindle's encoder in a turn; 0: it has none

  friend bool operator==(const Recorder&, const Recorder&) = default;
};

}  // namespace steadyrest::kernel::machine
