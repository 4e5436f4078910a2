// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include <comedilib.h>
#include <fmt/format.h>

#include <steadyrest/adapters/lines/comedi_wires.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// comedi reads and writes up to 32 lines of a subdevice at once, beginning with any of them.
namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Lines;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr std::uint32_t kAtOnce = 32;

std::unexpected<kernel::outcome::Refusal> comedi_fault(const std::string& what) {
  return unavailable(fmt::format("{}: {}", what, comedi_strerror(comedi_errno())),
                     "see comedi_board_info for the card's subdevices and lines");
}

}  // namespace

struct ComediWires::Card {
  comedi_t* device = nullptr;
  unsigned input_device = 0;
  unsigned output_device = 0;
  Range inputs;
  Range outputs;
  bool turned = false;  ///< outputs are outputs

  Card() = default;
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;
  ~Card() {
    if (device != nullptr) {
      comedi_close(device);
    }
  }

  [[nodiscard]] Result<void> check(unsigned subdevice, const Range& lines, int only) const {
    const int has = comedi_get_n_channels(device, subdevice);
    if (has < static_cast<int>(lines.first + lines.count)) {
      return unavailable(fmt::format("subdevice {} has {} lines, line {} is wanted", subdevice,
                                     std::max(0, has), lines.first + lines.count - 1),
                         "correct input_device, output_device or the lines' numbers in [lines]");
    }
    const int type = comedi_get_subdevice_type(device, subdevice);
    if (type != COMEDI_SUBD_DIO && type != only) {
      return unavailable(fmt::format("subdevice {} has no digital {}", subdevice,
                                     only == COMEDI_SUBD_DI ? "inputs" : "outputs"),
                         "correct input_device or output_device in [lines]");
    }
    return {};
  }
  [[nodiscard]] Result<void> turn(unsigned subdevice, const Range& lines,
                                  unsigned direction) const {
    // Inputs or outputs alone have no direction, and their driver refuses to be given one.
    const bool turns = comedi_get_subdevice_type(device, subdevice) == COMEDI_SUBD_DIO;
    for (std::uint32_t i = lines.first; turns && i < lines.first + lines.count; ++i) {
      if (comedi_dio_config(device, subdevice, i, direction) < 0) {
        return comedi_fault(fmt::format("line {} of subdevice {} cannot be turned to {}", i,
                                        subdevice, direction == COMEDI_INPUT ? "input" : "output"));
      }
    }
    return {};
  }
  [[nodiscard]] Result<void> exchange(unsigned subdevice, const Range& lines, bool writes,
                                      Levels& levels) const {
    for (std::uint32_t done = 0; done < lines.count; done += kAtOnce) {
      const std::uint32_t count = std::min(kAtOnce, lines.count - done);
      unsigned bits = 0;
      for (std::uint32_t i = 0; writes && i < count; ++i) {
        bits |= static_cast<unsigned>(levels[lines.first + done + i]) << i;
      }
      const unsigned mask = !writes ? 0U : count == kAtOnce ? ~0U : (1U << count) - 1U;
      if (comedi_dio_bitfield2(device, subdevice, mask, &bits, lines.first + done) < 0) {
        return comedi_fault(writes ? "the card's outputs cannot be written"
                                   : "the card's lines cannot be read");
      }
      for (std::uint32_t i = 0; !writes && i < count; ++i) {
        levels[lines.first + done + i] = (bits >> i & 1U) != 0;
      }
    }
    return {};
  }
};

ComediWires::ComediWires(std::unique_ptr<Card> card) : card_(std::move(card)) {}
ComediWires::~ComediWires() = default;

Result<std::unique_ptr<ComediWires>> ComediWires::open(const Lines& lines) {
  auto card = std::make_unique<Card>();
  card->input_device = lines.input_device;
  card->output_device = lines.output_device;
  card->inputs = inputs_of(lines);
  card->outputs = outputs_of(lines);
  card->device = comedi_open(lines.device.c_str());
  if (card->device == nullptr) {
    return comedi_fault(fmt::format("the comedi device {} cannot be opened", lines.device));
  }
  for (const auto& [subdevice, range, only] :
       {std::tuple(card->input_device, card->inputs, COMEDI_SUBD_DI),
        std::tuple(card->output_device, card->outputs, COMEDI_SUBD_DO)}) {
    if (auto there = card->check(subdevice, range, only); !there) {
      return std::unexpected(std::move(there.error()));
    }
  }
  if (auto turned = card->turn(card->input_device, card->inputs, COMEDI_INPUT); !turned) {
    return std::unexpected(std::move(turned.error()));
  }
  return std::unique_ptr<ComediWires>(new ComediWires(std::move(card)));
}

Result<void> ComediWires::read(Levels& inputs, Levels& outputs) {
  if (auto got = card_->exchange(card_->input_device, card_->inputs, false, inputs); !got) {
    return got;
  }
  return card_->exchange(card_->output_device, card_->outputs, false, outputs);
}

// The direction comes with the first write: it clears the latches of some cards, and whoever only
// looks must not take a word off that another layer has there.
Result<void> ComediWires::write(const Levels& outputs) {
  if (!card_->turned) {
    if (auto turned = card_->turn(card_->output_device, card_->outputs, COMEDI_OUTPUT); !turned) {
      return turned;
    }
    card_->turned = true;
  }
  Levels copy = outputs;
  return card_->exchange(card_->output_device, card_->outputs, true, copy);
}

}  // namespace steadyrest::adapters::lines
