// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include <steadyrest/adapters/lines/comedi_wires.hpp>
#include <steadyrest/adapters/lines/gpio_wires.hpp>
#include <steadyrest/adapters/lines/modbus_wires.hpp>
#include <steadyrest/adapters/lines/wires.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::kNoLine;
using kernel::machine::Lines;
using kernel::machine::LinesKind;
using kernel::outcome::Result;

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> lines) {
  std::erase(lines, kNoLine);
  std::ranges::sort(lines);
  const auto twice = std::ranges::unique(lines);
  lines.erase(twice.begin(), twice.end());
  return lines;
}

Range range_of(const std::vector<std::uint32_t>& lines) {
  return lines.empty() ? Range()
                       : Range{.first = lines.front(), .count = lines.back() - lines.front() + 1};
}

template <class Kind>
Result<std::unique_ptr<Wires>> opened(Result<std::unique_ptr<Kind>> made) {
  if (!made) {
    return std::unexpected(std::move(made.error()));
  }
  return std::unique_ptr<Wires>(std::move(*made));
}

}  // namespace

std::vector<std::uint32_t> input_lines(const Lines& lines) {
  std::vector<std::uint32_t> all = {lines.running, lines.cutting, lines.locked, lines.modulate};
  all.insert(all.end(), lines.feed.panel.begin(), lines.feed.panel.end());
  all.insert(all.end(), lines.spindle.panel.begin(), lines.spindle.panel.end());
  return sorted(std::move(all));
}

std::vector<std::uint32_t> output_lines(const Lines& lines) {
  std::vector<std::uint32_t> all = {lines.heartbeat, lines.feed.mask, lines.spindle.mask};
  all.insert(all.end(), lines.feed.out.begin(), lines.feed.out.end());
  all.insert(all.end(), lines.spindle.out.begin(), lines.spindle.out.end());
  return sorted(std::move(all));
}

Range inputs_of(const Lines& lines) {
  return range_of(input_lines(lines));
}

Range outputs_of(const Lines& lines) {
  return range_of(output_lines(lines));
}

std::uint32_t word_of(const Levels& levels, std::span<const std::uint32_t> lines,
                      bool inverted) noexcept {
  std::uint32_t word = 0;
  for (std::size_t bit = 0; bit < lines.size(); ++bit) {
    const bool on = lines[bit] < kMostLines && levels[lines[bit]] != inverted;
    word |= static_cast<std::uint32_t>(on) << bit;
  }
  return word;
}

void put_word(std::uint32_t word, std::span<const std::uint32_t> lines, bool inverted,
              Levels& levels) noexcept {
  for (std::size_t bit = 0; bit < lines.size(); ++bit) {
    if (lines[bit] < kMostLines) {
      levels[lines[bit]] = ((word >> bit & 1U) != 0) != inverted;
    }
  }
}

Result<std::unique_ptr<Wires>> open_wires(const Lines& lines) {
  switch (lines.kind) {
    case LinesKind::gpio:
      return opened(GpioWires::open(lines));
    case LinesKind::comedi:
      return opened(ComediWires::open(lines));
    case LinesKind::modbus_tcp:
    case LinesKind::modbus_rtu:
      break;
  }
  return opened(ModbusWires::make(lines));
}

}  // namespace steadyrest::adapters::lines
