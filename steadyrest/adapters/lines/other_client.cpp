// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/adapters/lines/other_client.hpp>
#include <steadyrest/kernel/link/event.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Lines;
using kernel::machine::Wiring;
using kernel::outcome::Result;

constexpr double kLeast_s = 0.3;
constexpr double kCycles = 4.0;
constexpr double kPause_s = 0.005;

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

std::string mask_on(const Lines& lines, const Levels& outputs) {
  if (lines.wiring != Wiring::through) {
    for (const std::uint32_t mask : {lines.feed.mask, lines.spindle.mask}) {
      if (mask < kMostLines && outputs[mask]) {
        return fmt::format("output {}, a mask, is on: a layer acts on this module", mask);
      }
    }
  }
  return {};
}

}  // namespace

Result<std::string> other_client(Wires& wires, const Lines& lines) {
  const auto first = read(wires);
  if (!first) {
    return std::unexpected(first.error());
  }
  const double until_s = wires.now_s() + std::max(kLeast_s, kCycles * lines.cycle_s);
  std::string seen = mask_on(lines, first->outputs);
  while (seen.empty() && wires.now_s() < until_s) {
    kernel::link::Event().wait(kPause_s);
    const auto now = read(wires);
    if (!now) {
      return std::unexpected(now.error());
    }
    if (lines.wiring == Wiring::through && now->inputs != first->inputs) {
      break;  // who passes the panel on changes the outputs with it
    }
    seen = mask_on(lines, now->outputs);
    const Levels changed = now->outputs ^ first->outputs;
    for (const std::uint32_t line : output_lines(lines)) {
      if (seen.empty() && changed[line]) {
        seen = fmt::format(
            "output {} changes though this program writes nothing: a layer acts on "
            "this module",
            line);
      }
    }
  }
  return seen;
}

}  // namespace steadyrest::adapters::lines
