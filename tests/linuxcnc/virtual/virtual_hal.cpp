// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <dlfcn.h>
#include <tests/linuxcnc/virtual/virtual_hal.hpp>

#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::test::linuxcnc {
namespace {

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line.substr(0, line.find('#')));
  std::vector<std::string> out;
  for (std::string word; in >> word;) {
    if (word != "=>") {
      out.push_back(word);
    }
  }
  return out;
}

constexpr std::size_t kMostRows = 4000;

double number_of(const Hal::Pin& pin) {
  return std::visit([](auto value) { return static_cast<double>(value); }, pin);
}

/// A module's parameter, as rtapi_app fills it in before the module starts.
template <class T>
T* parameter(void* module, const std::string& name) {
  auto* const place = static_cast<T**>(dlsym(module, ("rtapi_info_address_" + name).c_str()));
  if (place == nullptr) {
    throw std::runtime_error("no parameter " + name);
  }
  return *place;
}

}  // namespace

void VirtualHal::loadrt(const Words& words) {
  const std::string& component = words.at(1);
  if (component == "sampler") {
    return;
  }
  const std::string file = "/usr/lib/linuxcnc/modules/" + component + ".so";
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) {
    throw std::runtime_error(file + " is not installed");
  }
  const std::size_t equals = words.at(2).find('=');
  const std::string key = words[2].substr(0, equals);
  static std::deque<std::string> names;  // the module keeps the address
  if (key == "names") {
    *parameter<char*>(module, key) = names.emplace_back(words[2].substr(equals + 1)).data();
  } else {
    *parameter<int>(module, key) = std::stoi(words[2].substr(equals + 1));
  }
  const auto start = reinterpret_cast<int (*)()>(dlsym(module, "rtapi_app_main"));
  if (start == nullptr || start() != 0) {
    throw std::runtime_error(component + " does not start");
  }
}

/// The first pin of a signal gives it its value, as hal_link() does.
void VirtualHal::link(const std::string& pin, const std::string& signal) {
  const Hal::Pin* const own = hal().find(pin);
  if (own == nullptr) {
    other_[pin] = signal;
    const Hal::Pin& value = signal_.try_emplace(signal, 0.0).first->second;
    unsigned channel = 0;
    unsigned at = 0;
    if (std::sscanf(pin.c_str(), "sampler.%u.pin.%u", &channel, &at) == 2) {
      sampled_.at(channel).at(at) = &value;
    }
    return;
  }
  const bool typed = signal_.contains(signal) && signal_[signal].index() == own->index();
  if (!typed) {
    signal_[signal] = *own;
  }
  std::visit([&](auto& value) { hal().link(pin, &value); }, signal_[signal]);
}

void VirtualHal::net(const Words& words) {
  for (std::size_t i = 2; i < words.size(); ++i) {
    // Pins of nothing that is loaded have no type: the signal gets that of the loaded ones.
    if (hal().find(words[i]) != nullptr) {
      link(words[i], words[1]);
    }
  }
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (hal().find(words[i]) == nullptr) {
      link(words[i], words[1]);
    }
  }
}

void VirtualHal::line(const Words& words) {
  if (words[0] == "loadrt") {
    loadrt(words);
  } else if (words[0] == "addf") {
    if (words[1].starts_with("sampler.")) {
      return;
    }
    const HalFunction function = hal().function(words[1]);
    if (words.size() > 3) {
      thread_[{std::stoi(words[3]), words[1]}] = function;
    } else {
      last_.push_back(function);
    }
  } else if (words[0] == "net") {
    net(words);
  } else if (words[0] == "newsig") {
    signal_.try_emplace(words[1], 0.0);
  } else if (words[0] == "sets") {
    set(words[1], words[2].starts_with("[") ? 0.0 : std::stod(words[2]));
  } else if (words[0] == "setp") {
    if (!words[1].starts_with("axis.")) {
      hal().set(words[1], std::stod(words[2]));
    }
  } else {
    throw std::out_of_range("no such command");
  }
}

void VirtualHal::load(const std::string& hal_text) {
  std::istringstream lines(hal_text);
  for (std::string text; std::getline(lines, text);) {
    const Words words = words_of(text);
    try {
      if (!words.empty()) {
        line(words);
      }
    } catch (const std::out_of_range&) {
      throw std::invalid_argument("not understood: " + text);
    }
  }
}

double VirtualHal::get(const std::string& name) const {
  const auto other = other_.find(name);
  return number_of(signal_.at(other == other_.end() ? name : other->second));
}

void VirtualHal::set(const std::string& name, double value) {
  const auto other = other_.find(name);
  std::visit(
      [&](auto& variable) {
        variable = static_cast<std::remove_reference_t<decltype(variable)>>(value);
      },
      signal_.at(other == other_.end() ? name : other->second));
}

void VirtualHal::cycle() {
  constexpr std::int64_t kPeriod_ns = 1'000'000;
  for (const auto& [position, function] : thread_) {
    function(kPeriod_ns);
  }
  for (const HalFunction& function : last_) {
    function(kPeriod_ns);
  }
  for (std::size_t channel = 0; channel < rows_.size(); ++channel) {
    if (rows_[channel].size() >= kMostRows) {
      continue;  // as the sampler's queue: what comes is lost
    }
    adapters::linuxcnc::Row& row = rows_[channel].emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = sampled_[channel][i] == nullptr ? 0.0 : number_of(*sampled_[channel][i]);
    }
  }
}

bool VirtualHal::read_row(std::size_t channel, adapters::linuxcnc::Row& row) noexcept {
  if (rows_[channel].empty()) {
    return false;
  }
  row = rows_[channel].front();
  rows_[channel].pop_front();
  return true;
}

void VirtualHal::write_pins(const adapters::linuxcnc::Pins& pins) noexcept {
  set("layer-hold", hold_s);
  set("layer-rise", rise_1_s);
  set("layer-feed", pins.feed);
  set("layer-spindle", pins.spindle);
  for (std::size_t i = 0; i < 3; ++i) {
    set("layer-offset-" + std::to_string(i), pins.offset[i]);
    set("layer-path-offset-" + std::to_string(i), pins.path_offset[i]);
  }
  set("layer-armed", pins.armed ? 1.0 : 0.0);
  set("layer-heartbeat", pins.heartbeat ? 1.0 : 0.0);
}

}  // namespace steadyrest::test::linuxcnc
