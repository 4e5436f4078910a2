// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <hal.h>
#include <rtapi.h>
#include <time.h>
#include <unistd.h>

#include <steadyrest/adapters/linuxcnc/hal_pins.hpp>
#include <steadyrest/adapters/linuxcnc/hal_process.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr int kSamplerKey = 0x48534130;  ///< SAMPLER_SHMEM_KEY, channel 0
constexpr std::size_t kLongestName = 20;
constexpr double kPausesPerPeriod = 10.0;
constexpr int kVibrationChannel = 7;  ///< the last that the sampler has
constexpr std::size_t kMostReadings = 256;

std::string types_of(std::size_t channel, std::size_t axes) {
  return channel == 0 ? std::string(kStateTypes)
                      : std::string(1 + kAxisColumns * axes_in(channel, axes), 'f');
}

}  // namespace

struct HalProcess::Hal {
  Hal() = default;
  Hal(const Hal&) = delete;
  Hal& operator=(const Hal&) = delete;
  ~Hal() {
    for (std::size_t c = 0; c < attached; ++c) {
      hal_stream_detach(&stream[c]);
    }
    if (has_vibration) {
      hal_stream_detach(&vibration_stream);
    }
    if (component > 0) {
      hal_exit(component);
    }
  }

  Result<void> attach(std::size_t axes);
  Result<void> connect();

  int component = -1;
  std::size_t attached = 0;
  std::array<hal_stream_t, kMaxChannels> stream{};
  std::array<std::array<hal_type_t, kMaxColumns>, kMaxChannels> type{};
  std::array<std::size_t, kMaxChannels> columns{};
  std::optional<HalPins> pins;
  hal_stream_t vibration_stream{};
  bool has_vibration = false;
  double vibration_rate_hz = 0.0;
  /// Level of the heartbeat when this process began: a killed layer's stays, and the first beat
  /// must be seen with the first word.
  bool first_level = false;
  std::array<double, kMostReadings> vibration{};
  long pause_ns = 100'000;
};

Result<void> HalProcess::Hal::attach(std::size_t axes) {
  for (std::size_t c = 0; c < channels_of(axes); ++c) {
    const std::string types = types_of(c, axes);
    const int key = kSamplerKey + static_cast<int>(c);
    const int code = hal_stream_attach(&stream[c], component, key, types.c_str());
    if (code < 0) {
      return unavailable(
          fmt::format("sampler channel {} with the pins {} is not there ({})", c, types, code),
          "start LinuxCNC with layer.hal as a HALFILE, for as many axes as the machine file has");
    }
    ++attached;
    if (const int pins_there = hal_stream_element_count(&stream[c]);
        std::cmp_not_equal(pins_there, types.size())) {
      return unavailable(
          fmt::format(
              "sampler channel {} has {} pins, not {}: layer.hal is for another number of axes", c,
              pins_there, types.size()),
          fmt::format("run steadyrest linuxcnc setup for this configuration, or name its machine "
                      "file; this one has {} axes",
                      axes));
    }
    columns[c] = types.size();
    for (std::size_t i = 0; i < types.size(); ++i) {
      type[c][i] = hal_stream_element_type(&stream[c], static_cast<int>(i));
    }
    // What was sampled before this process came is old.
    std::array<hal_stream_data, kMaxColumns + 1> row{};
    unsigned number = 0;
    for (int i = hal_stream_depth(&stream[c]); i > 0; --i) {
      hal_stream_read(&stream[c], row.data(), &number);
    }
  }
  return {};
}

Result<void> HalProcess::Hal::connect() {
  if (auto connected = pins->connect(); !connected) {
    return connected;
  }
  const auto rate_hz = signal_value("layer-vibration-rate");
  vibration_rate_hz = rate_hz.value_or(0.0);
  has_vibration = rate_hz && hal_stream_attach(&vibration_stream, component,
                                               kSamplerKey + kVibrationChannel, "f") >= 0;
  return {};
}

HalProcess::HalProcess(std::unique_ptr<Hal> hal) noexcept : hal_(std::move(hal)) {}

// The offset against heat stays as after a kill: what is left of it may not jump out in the cut.
HalProcess::~HalProcess() {
  if (hal_->pins) {
    Pins pins;
    pins.offset = offset_in_force();
    write_pins(pins);
  }
}

Result<std::unique_ptr<HalProcess>> HalProcess::make(const Config& config) {
  if (config.name.empty() || config.name.size() > kLongestName) {
    return refuse(fmt::format("component name of {} characters (allowed: 1 to {})",
                              config.name.size(), kLongestName),
                  "give a shorter name");
  }
  auto hal = std::make_unique<Hal>();
  // One name for each process: that of a killed one is taken until LinuxCNC ends.
  const std::string component = fmt::format("{}-{}", config.name, ::getpid());
  hal->component = hal_init(component.c_str());
  if (hal->component < 0) {
    return unavailable(
        fmt::format("the HAL does not take the component {} ({})", component, hal->component),
        "run as the user of LinuxCNC");
  }
  hal->pause_ns = std::lround(config.servo_period_s * 1e9 / kPausesPerPeriod);
  // The pins first: samples that this process takes are missing in a layer that runs.
  if (config.writes) {
    auto pins = HalPins::make(config.name, config.axes, hal->component);
    if (!pins) {
      return std::unexpected(std::move(pins.error()));
    }
    hal->pins.emplace(std::move(*pins));
  }
  if (auto attached = hal->attach(config.axes); !attached) {
    return std::unexpected(std::move(attached.error()));
  }
  hal_ready(hal->component);
  if (auto connected = hal->pins ? hal->connect() : Result<void>(); !connected) {
    return std::unexpected(std::move(connected.error()));
  }
  if (hal->pins) {
    // oneshot counts the cycle that starts it.
    hal->pins->values().hold->f = config.hold_s + config.servo_period_s;
    hal->pins->values().rise->f = config.rise_1_s;
    hal->first_level = hal->pins->values().heartbeat->b;
  }
  return std::unique_ptr<HalProcess>(new HalProcess(std::move(hal)));
}

bool HalProcess::read_row(std::size_t channel, Row& row) noexcept {
  hal_stream_t* stream = &hal_->stream[channel];
  if (!hal_stream_readable(stream)) {
    return false;
  }
  std::array<hal_stream_data, kMaxColumns + 1> data{};
  unsigned number = 0;
  if (hal_stream_read(stream, data.data(), &number) < 0) {
    return false;
  }
  for (std::size_t i = 0; i < hal_->columns[channel]; ++i) {
    switch (hal_->type[channel][i]) {
      case HAL_BIT:
        row[i] = data[i].b ? 1.0 : 0.0;
        break;
      case HAL_S32:
        row[i] = data[i].s;
        break;
      case HAL_U32:
        row[i] = data[i].u;
        break;
      default:
        row[i] = data[i].f;
        break;
    }
  }
  return true;
}

Inputs HalProcess::read_inputs() noexcept {
  Inputs inputs;
  if (!hal_->pins) {
    return inputs;
  }
  const PinValues& pins = hal_->pins->values();
  for (std::size_t i = 0; i < pins.temperature.size(); ++i) {
    if (hal_->pins->has_temperature(i)) {
      inputs.temperature_c[i] = pins.temperature[i]->f;
    }
  }
  const double number = hal_->pins->has_probe() ? pins.probe_number->f : 0.0;
  const double axis = hal_->pins->has_probe() ? pins.probe_axis->f : -1.0;
  if (number >= 1.0 && axis >= 0.0 && axis < static_cast<double>(kernel::signal::kMaxAxes)) {
    inputs.probe.number = static_cast<std::uint64_t>(number);
    inputs.probe.axis = static_cast<std::uint8_t>(axis);
    inputs.probe.displacement_mm = pins.probe_displacement->f;
  }
  if (hal_->has_vibration) {
    std::size_t count = 0;
    hal_stream_data row{};
    unsigned ignored = 0;
    while (count < hal_->vibration.size() && hal_stream_readable(&hal_->vibration_stream) &&
           hal_stream_read(&hal_->vibration_stream, &row, &ignored) >= 0) {
      hal_->vibration[count++] = row.f;
    }
    inputs.vibration = std::span<const double>(hal_->vibration).first(count);
    inputs.vibration_rate_hz = hal_->vibration_rate_hz;
  }
  return inputs;
}

std::size_t HalProcess::waiting(std::size_t channel) const noexcept {
  return static_cast<std::size_t>(std::max(hal_stream_depth(&hal_->stream[channel]), 0));
}

void HalProcess::write_pins(const Pins& pins) noexcept {
  if (!hal_->pins) {
    return;
  }
  const PinValues& at = hal_->pins->values();
  at.feed->f = pins.feed;
  at.spindle->f = pins.spindle;
  for (std::size_t a = 0; a < hal_->pins->offsets(); ++a) {
    at.axis[a].offset->f = pins.offset[a];
    at.axis[a].path_offset->f = pins.path_offset[a];
  }
  // After the values: who sees the beat finds them in place.
  at.armed->b = pins.armed;
  at.heartbeat->b = pins.heartbeat != hal_->first_level;
}

double HalProcess::vibration_rate_hz() const noexcept {
  return hal_->has_vibration ? hal_->vibration_rate_hz : 0.0;
}

double HalProcess::linear_unit_mm() const noexcept {
  return signal_value("layer-unit-mm").value_or(1.0);
}

bool HalProcess::offsets_connected() const noexcept {
  return hal_->pins && hal_->pins->offsets() > 0;
}

kernel::signal::AxisValues HalProcess::offset_in_force() const noexcept {
  kernel::signal::AxisValues out{};
  for (std::size_t a = 0; hal_->pins && a < hal_->pins->offsets(); ++a) {
    out[a] = hal_->pins->values().axis[a].offset->f;
  }
  return out;
}

kernel::signal::AxisValues HalProcess::offset_acceleration() const noexcept {
  kernel::signal::AxisValues out{};
  for (std::size_t a = 0; hal_->pins && a < hal_->pins->offsets(); ++a) {
    out[a] = signal_value(fmt::format("layer-offset-share-{}", a)).value_or(0.0) *
             signal_value(fmt::format("layer-axis-acceleration-{}", a)).value_or(0.0);
  }
  return out;
}

void HalProcess::pause() noexcept {
  const timespec time{.tv_sec = 0, .tv_nsec = hal_->pause_ns};
  nanosleep(&time, nullptr);
}

}  // namespace steadyrest::adapters::linuxcnc
