// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <hal.h>
#include <rtapi.h>
#include <time.h>

#include <steadyrest/adapters/linuxcnc/hal_process.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr int kSamplerKey = 0x48534130;  ///< SAMPLER_SHMEM_KEY, channel 0
constexpr std::size_t kLongestName = 30;
constexpr double kPausesPerPeriod = 10.0;
constexpr int kVibrationChannel = 7;  ///< the last that the sampler has
constexpr std::size_t kMostReadings = 256;

/// In the HAL's shared memory, where the HAL rewrites the pointers when pins are linked.
struct SharedPins {
  hal_float_t* feed;
  hal_float_t* spindle;
  struct Axis {
    hal_float_t* offset;
    hal_float_t* path_offset;
  };
  std::array<Axis, kernel::signal::kMaxAxes> axis;
  struct Sensor {
    hal_float_t* value;
  };
  std::array<Sensor, kernel::signal::kMaxTemperatures> temperature;
  hal_float_t* probe_number;
  hal_float_t* probe_axis;
  hal_float_t* probe_displacement;
  hal_bit_t* heartbeat;
  hal_bit_t* armed;
};

std::string types_of(std::size_t channel, std::size_t axes) {
  return channel == 0 ? std::string(kStateTypes)
                      : std::string(1 + kAxisColumns * axes_in(channel, axes), 'f');
}

std::unexpected<Refusal> unavailable(std::string what, std::string to_do) {
  return std::unexpected(Refusal{
      .kind = Kind::unavailable, .file = {}, .what = std::move(what), .to_do = std::move(to_do)});
}

/// Of a signal that a HAL file set; nothing where there is none of this name. Not by a pin: linking
/// the first one would overwrite the value.
std::optional<double> value_of(const std::string& signal) {
  hal_type_t type = HAL_TYPE_UNSPECIFIED;
  hal_data_u* data = nullptr;
  bool has_writers = false;
  if (hal_get_signal_value_by_name(signal.c_str(), &type, &data, &has_writers) != 0 ||
      type != HAL_FLOAT || data == nullptr) {
    return std::nullopt;
  }
  return data->f;
}

/// The HAL prints to stderr what it does not find; here it may be missing.
class Quiet {
 public:
  Quiet() : before_(rtapi_get_msg_level()) { rtapi_set_msg_level(RTAPI_MSG_NONE); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() { rtapi_set_msg_level(before_); }

 private:
  int before_;
};

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
  Result<void> make_pins(const Config& config);
  Result<void> connect(const Config& config);
  int make_inputs(const char* name);
  void connect_inputs(const Config& config);
  Result<void> link(const Config& config, const std::string& pin);

  int component = -1;
  std::size_t attached = 0;
  std::array<hal_stream_t, kMaxChannels> stream{};
  std::array<std::array<hal_type_t, kMaxColumns>, kMaxChannels> type{};
  std::array<std::size_t, kMaxChannels> columns{};
  SharedPins* pins = nullptr;
  std::size_t offsets = 0;
  std::array<bool, kernel::signal::kMaxTemperatures> has_temperature{};
  bool has_probe = false;
  hal_stream_t vibration_stream{};
  bool has_vibration = false;
  double vibration_rate_hz = 0.0;
  kernel::signal::AxisValues offset_acceleration{};
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

Result<void> HalProcess::Hal::make_pins(const Config& config) {
  pins = static_cast<SharedPins*>(hal_malloc(static_cast<long>(sizeof(SharedPins))));
  if (pins == nullptr) {
    return unavailable("the HAL's shared memory is full", "restart LinuxCNC");
  }
  const char* name = config.name.c_str();
  int code = hal_pin_float_newf(HAL_OUT, &pins->feed, component, "%s.feed", name);
  code |= hal_pin_float_newf(HAL_OUT, &pins->spindle, component, "%s.spindle", name);
  code |= hal_pin_bit_newf(HAL_OUT, &pins->heartbeat, component, "%s.heartbeat", name);
  code |= hal_pin_bit_newf(HAL_OUT, &pins->armed, component, "%s.armed", name);
  for (std::size_t a = 0; a < config.axes; ++a) {
    const int n = static_cast<int>(a);
    code |= hal_pin_float_newf(HAL_OUT, &pins->axis[a].offset, component, "%s.offset-%d", name, n);
    code |= hal_pin_float_newf(HAL_OUT, &pins->axis[a].path_offset, component, "%s.path-offset-%d",
                               name, n);
  }
  code |= make_inputs(name);
  if (code != 0) {
    return unavailable(fmt::format("the pins of {} cannot be made ({})", name, code),
                       "give another name of the component");
  }
  *pins->feed = 1.0;
  *pins->spindle = 1.0;
  *pins->armed = false;
  return {};
}

int HalProcess::Hal::make_inputs(const char* name) {
  int code = 0;
  for (std::size_t i = 0; i < pins->temperature.size(); ++i) {
    code |= hal_pin_float_newf(HAL_IN, &pins->temperature[i].value, component, "%s.temperature-%d",
                               name, static_cast<int>(i));
  }
  code |= hal_pin_float_newf(HAL_IN, &pins->probe_number, component, "%s.probe-number", name);
  code |= hal_pin_float_newf(HAL_IN, &pins->probe_axis, component, "%s.probe-axis", name);
  code |= hal_pin_float_newf(HAL_IN, &pins->probe_displacement, component, "%s.probe-displacement",
                             name);
  return code;
}

/// A HAL without these signals has no such sensor.
void HalProcess::Hal::connect_inputs(const Config& config) {
  const Quiet quiet;
  for (std::size_t i = 0; i < has_temperature.size(); ++i) {
    has_temperature[i] = link(config, fmt::format("temperature-{}", i)).has_value();
  }
  has_probe = link(config, "probe-number") && link(config, "probe-axis") &&
              link(config, "probe-displacement");
  const auto rate_hz = value_of("layer-vibration-rate");
  vibration_rate_hz = rate_hz.value_or(0.0);
  has_vibration = rate_hz && hal_stream_attach(&vibration_stream, component,
                                               kSamplerKey + kVibrationChannel, "f") >= 0;
}

Result<void> HalProcess::Hal::link(const Config& config, const std::string& pin) {
  if (!config.replaces.empty()) {
    hal_unlink((config.replaces + "." + pin).c_str());
  }
  const std::string signal = "layer-" + pin;
  if (const int code = hal_link((config.name + "." + pin).c_str(), signal.c_str()); code != 0) {
    return unavailable(
        fmt::format("the signal {} is missing or another component drives it ({})", signal, code),
        "load layer.hal; if an earlier layer was killed, name its component as the one replaced");
  }
  return {};
}

Result<void> HalProcess::Hal::connect(const Config& config) {
  for (const char* pin : {"feed", "spindle", "heartbeat", "armed"}) {
    if (auto linked = link(config, pin); !linked) {
      return linked;
    }
  }
  connect_inputs(config);
  // A HAL without layer_offsets.hal has none of these signals.
  {
    const Quiet quiet;
    if (!link(config, "offset-0")) {
      return {};
    }
  }
  offsets = config.axes;
  for (std::size_t a = 0; a < offsets; ++a) {
    offset_acceleration[a] = value_of(fmt::format("layer-offset-share-{}", a)).value_or(0.0) *
                             value_of(fmt::format("layer-axis-acceleration-{}", a)).value_or(0.0);
    for (const char* pin : {"offset", "path-offset"}) {
      if (a == 0 && std::string_view(pin) == "offset") {
        continue;
      }
      if (auto linked = link(config, fmt::format("{}-{}", pin, a)); !linked) {
        return linked;
      }
    }
  }
  return {};
}

HalProcess::HalProcess(std::unique_ptr<Hal> hal) noexcept : hal_(std::move(hal)) {}

HalProcess::~HalProcess() {
  if (hal_->pins != nullptr) {
    write_pins(Pins{});
  }
}

Result<std::unique_ptr<HalProcess>> HalProcess::make(const Config& config) {
  if (config.name.empty() || config.name.size() > kLongestName) {
    return refuse(fmt::format("component name of {} characters (allowed: 1 to {})",
                              config.name.size(), kLongestName),
                  "give a shorter name");
  }
  auto hal = std::make_unique<Hal>();
  hal->component = hal_init(config.name.c_str());
  if (hal->component < 0) {
    return unavailable(
        fmt::format("the HAL does not take the component {} ({})", config.name, hal->component),
        "run as the user of LinuxCNC; a component that was killed keeps its name until LinuxCNC "
        "restarts: give another name and name the old one as replaced");
  }
  hal->pause_ns = std::lround(config.servo_period_s * 1e9 / kPausesPerPeriod);
  auto done = hal->attach(config.axes);
  if (done && config.writes) {
    done = hal->make_pins(config);
  }
  if (done) {
    hal_ready(hal->component);
  }
  if (done && config.writes) {
    done = hal->connect(config);
  }
  if (!done) {
    return std::unexpected(done.error());
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
  if (hal_->pins == nullptr) {
    return inputs;
  }
  const SharedPins& pins = *hal_->pins;
  for (std::size_t i = 0; i < pins.temperature.size(); ++i) {
    if (hal_->has_temperature[i]) {
      inputs.temperature_c[i] = *pins.temperature[i].value;
    }
  }
  const double number = hal_->has_probe ? *pins.probe_number : 0.0;
  const double axis = hal_->has_probe ? *pins.probe_axis : -1.0;
  if (number >= 1.0 && axis >= 0.0 && axis < static_cast<double>(kernel::signal::kMaxAxes)) {
    inputs.probe.number = static_cast<std::uint64_t>(number);
    inputs.probe.axis = static_cast<std::uint8_t>(axis);
    inputs.probe.displacement_mm = *pins.probe_displacement;
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
  if (hal_->pins == nullptr) {
    return;
  }
  *hal_->pins->feed = pins.feed;
  *hal_->pins->spindle = pins.spindle;
  for (std::size_t a = 0; a < hal_->offsets; ++a) {
    *hal_->pins->axis[a].offset = pins.offset[a];
    *hal_->pins->axis[a].path_offset = pins.path_offset[a];
  }
  // After the values: who sees the beat finds them in place.
  *hal_->pins->armed = pins.armed;
  *hal_->pins->heartbeat = pins.heartbeat;
}

double HalProcess::linear_unit_mm() const noexcept {
  return value_of("layer-unit-mm").value_or(1.0);
}

bool HalProcess::offsets_connected() const noexcept {
  return hal_->offsets > 0;
}

kernel::signal::AxisValues HalProcess::offset_acceleration() const noexcept {
  return hal_->offset_acceleration;
}

void HalProcess::pause() noexcept {
  const timespec time{.tv_sec = 0, .tv_nsec = hal_->pause_ns};
  nanosleep(&time, nullptr);
}

}  // namespace steadyrest::adapters::linuxcnc
