// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <time.h>

#include <steadyrest/adapters/linuxcnc/hal_pins.hpp>
#include <steadyrest/adapters/linuxcnc/process_identity.hpp>
#include <steadyrest/adapters/linuxcnc/sample.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr int kLongestWait_ms = 2000;

hal_data_u* value_of_pin(const std::string& name) {
  hal_type_t type{};
  hal_data_u* value = nullptr;
  bool connected = false;
  return hal_get_pin_value_by_name(name.c_str(), &type, &value, &connected) == 0 ? value : nullptr;
}

hal_data_u* value_of_signal(const std::string& name) {
  hal_type_t type{};
  hal_data_u* value = nullptr;
  bool written = false;
  return hal_get_signal_value_by_name(name.c_str(), &type, &value, &written) == 0 ? value : nullptr;
}

/// No heartbeat, and the watchdog has seen it: nothing of a killed layer's ratios is in force. The
/// servo thread of a busy computer may take longer than the watchdog's 20 ms.
bool let_go(const hal_data_u& heartbeat) {
  const hal_data_u* const alive = value_of_signal("layer-alive");
  const bool before = heartbeat.b;
  for (int i = 0; alive != nullptr && alive->b; ++i) {
    if (heartbeat.b != before || i == kLongestWait_ms) {
      return false;
    }
    const timespec time{.tv_sec = 0, .tv_nsec = 1'000'000};
    nanosleep(&time, nullptr);
  }
  return true;
}

}  // namespace

std::optional<double> signal_value(const std::string& name) {
  const hal_data_u* const value = value_of_signal(name);
  return value != nullptr ? std::optional(value->f) : std::nullopt;
}

std::vector<HalPins::Pin> HalPins::list() const {
  PinValues& at = *values_;
  std::vector<Pin> pins = {{"feed", HAL_FLOAT, HAL_OUT, &at.feed},
                           {"spindle", HAL_FLOAT, HAL_OUT, &at.spindle},
                           {"heartbeat", HAL_BIT, HAL_OUT, &at.heartbeat},
                           {"armed", HAL_BIT, HAL_OUT, &at.armed},
                           {"hold", HAL_FLOAT, HAL_OUT, &at.hold},
                           {"rise", HAL_FLOAT, HAL_OUT, &at.rise},
                           {"process", HAL_U32, HAL_OUT, &at.process},
                           {"process-start", HAL_U32, HAL_OUT, &at.process_start},
                           {"probe-number", HAL_FLOAT, HAL_IN, &at.probe_number},
                           {"probe-axis", HAL_FLOAT, HAL_IN, &at.probe_axis},
                           {"probe-displacement", HAL_FLOAT, HAL_IN, &at.probe_displacement}};
  for (std::size_t a = 0; a < axes_; ++a) {
    PinValues::Axis& axis = at.axis[a];
    pins.push_back({fmt::format("offset-{}", a), HAL_FLOAT, HAL_OUT, &axis.offset});
    pins.push_back({fmt::format("path-offset-{}", a), HAL_FLOAT, HAL_OUT, &axis.path_offset});
  }
  for (std::size_t i = 0; i < at.temperature.size(); ++i) {
    pins.push_back({fmt::format("temperature-{}", i), HAL_FLOAT, HAL_IN, &at.temperature[i]});
  }
  return pins;
}

Result<HalPins> HalPins::make(const std::string& name, std::size_t axes, int component) {
  HalPins pins(name, axes);
  if (value_of_pin(name + ".process") != nullptr) {
    pins.found_.resize(1);
    pins.values_ = pins.found_.data();
  } else {
    pins.values_ = static_cast<PinValues*>(hal_malloc(static_cast<long>(sizeof(PinValues))));
    if (pins.values_ == nullptr) {
      return unavailable("the HAL's shared memory is full", "restart LinuxCNC");
    }
    *pins.values_ = {};
    for (const Pin& pin : pins.list()) {
      const std::string full = name + "." + pin.name;
      if (const int code = hal_pin_new(full.c_str(), pin.type, pin.direction,
                                       reinterpret_cast<void**>(pin.value), component);
          code != 0) {
        return unavailable(fmt::format("the pin {} cannot be made ({})", full, code),
                           "see whether another layer starts; else restart LinuxCNC");
      }
    }
    pins.begin();
  }
  if (auto found = pins.find(); !found) {
    return std::unexpected(std::move(found.error()));
  }
  if (auto claimed = pins.claim(); !claimed) {
    return std::unexpected(std::move(claimed.error()));
  }
  return pins;
}

/// Linked as the first pin that drives a signal, a pin gives it its value: an offset that an
/// earlier layer left would jump to 0.
void HalPins::begin() {
  values_->feed->f = kNoCeiling;
  values_->spindle->f = 1.0;
  values_->hold->f = signal_value("layer-hold").value_or(0.0);
  values_->rise->f = signal_value("layer-rise").value_or(0.0);
  for (std::size_t a = 0; a < axes_; ++a) {
    const hal_data_u* const left = value_of_signal(fmt::format("layer-offset-{}", a));
    values_->axis[a].offset->f = left != nullptr ? left->f : 0.0;
  }
}

/// The HAL does not know of this process's pointers to the pins of a killed one.
Result<void> HalPins::find() {
  if (found_.empty()) {
    return {};
  }
  for (const Pin& pin : list()) {
    const std::string full = name_ + "." + pin.name;
    *pin.value = value_of_pin(full);
    if (*pin.value == nullptr) {
      return unavailable(fmt::format("a layer that was killed left no pin {}", full),
                         "restart LinuxCNC: the layer was another version or had fewer axes");
    }
  }
  return {};
}

Result<void> HalPins::claim() {
  const PinValues& at = *values_;
  const ProcessIdentity self = this_process();
  std::uint32_t before = at.process->u;
  const auto taken = [&](std::uint32_t by) {
    return unavailable(
        fmt::format("a layer runs on this LinuxCNC: the pins {}.* are process {}'s", name_, by),
        "stop it first");
  };
  if (!found_.empty() && (runs({.number = before, .start = at.process_start->u}))) {
    return taken(before);
  }
  if (!found_.empty() && !let_go(*at.heartbeat)) {
    return unavailable("the watchdog of layer.hal still has a heartbeat of another layer",
                       "stop that layer; see whether LinuxCNC's servo thread runs");
  }
  // Of two that start at once the first has them. Until its time is there its number counts alone.
  at.process_start->u = 0;
  if (!__atomic_compare_exchange_n(&at.process->u, &before, self.number, false, __ATOMIC_SEQ_CST,
                                   __ATOMIC_SEQ_CST)) {
    return taken(before);
  }
  at.process_start->u = self.start;
  return {};
}

Result<void> HalPins::link(const std::string& pin) {
  const std::string signal = "layer-" + pin;
  // The HAL itself would say on stderr that a sensor's signal is missing.
  if (value_of_signal(signal) == nullptr ||
      hal_link((name_ + "." + pin).c_str(), signal.c_str()) != 0) {
    return unavailable(
        fmt::format("the signal {} is missing or another component drives it", signal),
        "load layer.hal (an older one: set it up again), and disconnect what else drives its "
        "signals");
  }
  return {};
}

Result<void> HalPins::connect() {
  for (const char* pin : {"feed", "spindle", "heartbeat", "armed", "hold", "rise"}) {
    if (auto linked = link(pin); !linked) {
      return linked;
    }
  }
  // A HAL without these signals has no such sensor.
  for (std::size_t i = 0; i < has_temperature_.size(); ++i) {
    has_temperature_[i] = link(fmt::format("temperature-{}", i)).has_value();
  }
  has_probe_ = link("probe-number") && link("probe-axis") && link("probe-displacement");
  if (auto linked = connect_offsets(); !linked) {
    return linked;
  }
  return find();
}

Result<void> HalPins::connect_offsets() {
  // A HAL without layer_offsets.hal has none of these signals.
  if (!link("offset-0")) {
    return {};
  }
  for (std::size_t a = 0; a < axes_; ++a) {
    for (const char* pin : {"offset", "path-offset"}) {
      if (auto linked = link(fmt::format("{}-{}", pin, a)); !linked) {
        return linked;
      }
    }
  }
  offsets_ = axes_;
  return {};
}

}  // namespace steadyrest::adapters::linuxcnc
