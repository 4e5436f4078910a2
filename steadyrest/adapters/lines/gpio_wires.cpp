// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gpiod.h>

#include <steadyrest/adapters/lines/gpio_wires.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Lines;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr const char* kConsumer = "steadyrest";

bool request_as_is(gpiod_line_bulk& lines) {
  const gpiod_line_request_config config{
      .consumer = kConsumer, .request_type = GPIOD_LINE_REQUEST_DIRECTION_AS_IS, .flags = 0};
  return gpiod_line_request_bulk(&lines, &config, nullptr) == 0;
}

std::unexpected<kernel::outcome::Refusal> gpio_fault(const std::string& what) {
  return unavailable(fmt::format("{}: {}", what, std::strerror(errno)),
                     "see gpioinfo for the chip's lines and who uses them");
}

}  // namespace

/// The lines of one chip, given back when it goes.
struct GpioWires::Taken {
  gpiod_chip* chip = nullptr;
  std::vector<unsigned> inputs;
  std::vector<unsigned> outputs;
  gpiod_line_bulk in{};
  gpiod_line_bulk out{};
  bool has_in = false;
  bool has_out = false;
  bool driven = false;  ///< the outputs are outputs

  Taken() = default;
  Taken(const Taken&) = delete;
  Taken& operator=(const Taken&) = delete;
  ~Taken() {
    if (has_in) {
      gpiod_line_release_bulk(&in);
    }
    if (has_out) {
      gpiod_line_release_bulk(&out);
    }
    if (chip != nullptr) {
      gpiod_chip_close(chip);
    }
  }
};

GpioWires::GpioWires(std::unique_ptr<Taken> taken) : taken_(std::move(taken)) {}
GpioWires::~GpioWires() = default;

/// Outputs are left as they are until something is written.
Result<std::unique_ptr<GpioWires>> GpioWires::open(const Lines& lines) {
  auto taken = std::make_unique<Taken>();
  taken->inputs = input_lines(lines);
  taken->outputs = output_lines(lines);
  if (std::max(taken->inputs.size(), taken->outputs.size()) > GPIOD_LINE_BULK_MAX_LINES) {
    return unavailable("a GPIO chip takes at most 64 lines at once", "wire fewer lines");
  }
  taken->chip = gpiod_chip_open_lookup(lines.device.c_str());
  if (taken->chip == nullptr) {
    return gpio_fault(fmt::format("the GPIO chip {} cannot be opened", lines.device));
  }
  if (!taken->inputs.empty()) {
    const auto count = static_cast<unsigned>(taken->inputs.size());
    taken->has_in =
        gpiod_chip_get_lines(taken->chip, taken->inputs.data(), count, &taken->in) == 0 &&
        gpiod_line_request_bulk_input(&taken->in, kConsumer) == 0;
    if (!taken->has_in) {
      return gpio_fault(fmt::format("inputs {} cannot be taken from {}",
                                    fmt::join(taken->inputs, ", "), lines.device));
    }
  }
  if (!taken->outputs.empty()) {
    const auto count = static_cast<unsigned>(taken->outputs.size());
    taken->has_out =
        gpiod_chip_get_lines(taken->chip, taken->outputs.data(), count, &taken->out) == 0 &&
        request_as_is(taken->out);
    if (!taken->has_out) {
      return gpio_fault(fmt::format("outputs {} cannot be taken from {}",
                                    fmt::join(taken->outputs, ", "), lines.device));
    }
  }
  return std::unique_ptr<GpioWires>(new GpioWires(std::move(taken)));
}

Result<void> GpioWires::read(Levels& inputs, Levels& outputs) {
  std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
  if (taken_->has_in && gpiod_line_get_value_bulk(&taken_->in, values.data()) != 0) {
    return gpio_fault("the GPIO inputs cannot be read");
  }
  for (std::size_t i = 0; i < taken_->inputs.size(); ++i) {
    inputs[taken_->inputs[i]] = values.at(i) != 0;
  }
  if (taken_->has_out && gpiod_line_get_value_bulk(&taken_->out, values.data()) != 0) {
    return gpio_fault("the GPIO outputs cannot be read back");
  }
  for (std::size_t i = 0; i < taken_->outputs.size(); ++i) {
    outputs[taken_->outputs[i]] = values.at(i) != 0;
  }
  return {};
}

Result<void> GpioWires::write(const Levels& outputs) {
  std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
  for (std::size_t i = 0; i < taken_->outputs.size(); ++i) {
    values.at(i) = outputs[taken_->outputs[i]] ? 1 : 0;
  }
  const auto put = [&] {
    return taken_->driven ? gpiod_line_set_value_bulk(&taken_->out, values.data())
                          : gpiod_line_set_direction_output_bulk(&taken_->out, values.data());
  };
  if (taken_->has_out && put() != 0) {
    return gpio_fault("the GPIO outputs cannot be written");
  }
  taken_->driven = true;
  return {};
}

}  // namespace steadyrest::adapters::lines
