// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <steadyrest/adapters/lines/other_client.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::kNoLine;
using kernel::machine::Lines;
using kernel::machine::Wiring;
using kernel::outcome::Result;

constexpr double kLeast_s = 0.3;
constexpr double kCycles = 4.0;

struct Reading {
  Levels inputs;
  Levels outputs;
};

Result<Reading> read(Wires& wires) {
  Reading out;
  if (auto got = wires.read(out.inputs, out.outputs); !got) {
    return std::unexpected(std::move(got.error()));
  }
  return out;
}

/// A mask that is on; empty: none.
std::string mask_on(const Lines& lines, const Levels& outputs) {
  for (const std::uint32_t mask : {lines.feed.mask, lines.spindle.mask}) {
    if (lines.wiring != Wiring::through && mask < kMostLines && outputs[mask]) {
      return fmt::format("output {}, a mask, is on: a layer acts on this module", mask);
    }
  }
  return {};
}

/// A watchdog takes the masks off, or all outputs; who passes the panel on follows it.
bool is_excused(const Lines& lines, const Reading& before, const Reading& now) {
  const auto ours = output_lines(lines);
  const bool dropped = std::ranges::none_of(ours, [&](auto one) { return now.outputs[one]; });
  const bool released =
      !mask_on(lines, before.outputs).empty() && mask_on(lines, now.outputs).empty();
  const bool turned = lines.wiring == Wiring::through && now.inputs != before.inputs;
  return dropped || released || turned;
}

}  // namespace

Result<std::string> other_client(Wires& wires, const Lines& lines,
                                 const std::function<void()>& pause) {
  auto before = read(wires);
  if (!before) {
    return std::unexpected(before.error());
  }
  const bool beats = lines.heartbeat != kNoLine;
  const bool waits = !beats && !mask_on(lines, before->outputs).empty();
  const double watch_s = std::max(kLeast_s, kCycles * lines.cycle_s);
  const double until_s =
      wires.now_s() + (waits ? std::max(watch_s, 2.0 * lines.watchdog_s) : watch_s);
  const auto watched = beats ? std::vector{lines.heartbeat} : output_lines(lines);
  while (wires.now_s() < until_s) {
    pause();
    const auto now = read(wires);
    if (!now) {
      return std::unexpected(now.error());
    }
    const auto line = std::ranges::find_if(
        watched, [&](auto one) { return now->outputs[one] != before->outputs[one]; });
    if (line != watched.end() && !is_excused(lines, *before, *now)) {
      return fmt::format(
          "output {} changes though this program writes nothing: a layer acts on "
          "this module",
          *line);
    }
    before = now;
  }
  return beats ? std::string() : mask_on(lines, before->outputs);
}

}  // namespace steadyrest::adapters::lines
