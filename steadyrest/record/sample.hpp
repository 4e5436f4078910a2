// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::record {

/// Vibration readings that one frame may bring: 50 kHz at a cycle of 5 ms.
inline constexpr std::size_t kMaxVibration = 256;

/// One cycle: what came in, what was decided. A plain value; `frame.path`, `frame.original`
/// and `frame.vibration` own nothing.
struct Sample {
  std::uint64_t number = 0;    ///< counts the cycles of the run, lost ones too, from 0
  std::uint32_t path = 0;      ///< number of the frame's path in the record; 0: none
  std::uint32_t original = 0;  ///< likewise of the path that its text corrects
  std::uint32_t vibrations = 0;
  kernel::signal::Frame frame;
  kernel::signal::Command command;
  std::array<double, kMaxVibration> vibration{};
};

/// What happened between two samples.
enum class EventKind : std::uint8_t {
  mode,         ///< the mode wanted from here on; the text is its word
  unread,       ///< the port could not read: a cycle without a frame
  undelivered,  ///< the port did not take the command of the sample before
  note,         ///< anything else, for people
  reload,       ///< another machine file from here on; the text is the whole file
  wish          ///< what somebody asked of the rooms; the text has its values exactly
};

struct Event {
  std::uint64_t before = 0;  ///< number of the sample that follows
  double time_s = 0.0;       ///< of the last frame
  EventKind kind = EventKind::note;
  std::string text;
};

/// What is known when a run begins: all that a replay needs beside the samples.
struct RunInfo {
  // Designated initialisers may leave these out.
  // NOLINTBEGIN(readability-redundant-member-init)
  std::string start_utc = {};  ///< ISO 8601; the writer fills in an empty one
  std::string version = {};    ///< of Steadyrest; the writer fills it in
  std::string machine = {};    ///< its name
  std::string machine_text = {};
  std::string program = {};  ///< its name
  std::string program_text = {};
  std::string listener = {};  ///< how the layer hears chatter, as its maker wrote it; empty: not
  double cycle_s = 0.0;
  kernel::port::Capability capability = {};
  // NOLINTEND(readability-redundant-member-init)
};

/// Where a record stands.
struct Totals {
  std::uint64_t samples = 0;  ///< in the file
  std::uint64_t dropped = 0;  ///< samples and events that were lost: a ring was full
  bool closed = false;        ///< the run ended in order; else the writer was killed, or still runs
};

}  // namespace steadyrest::record
