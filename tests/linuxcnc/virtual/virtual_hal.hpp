// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <tests/linuxcnc/hal_in_process.hpp>

#include <steadyrest/adapters/linuxcnc/hal_side.hpp>

namespace steadyrest::test::linuxcnc {

/// LinuxCNC's own realtime components, connected as a HAL file says, in virtual time: cycle() is
/// one run of the servo thread. The port has it for its HAL. Pins of what is not loaded (motion,
/// halui, joints) are the test's to set and to see; the sampler is played. One in a process.
class VirtualHal final : public adapters::linuxcnc::HalSide {
 public:
  static constexpr double kPeriod_s = 0.001;

  /// Throws std::runtime_error where LinuxCNC's modules are not installed, std::invalid_argument
  /// where a line is not understood.
  void load(const std::string& hal_text);
  /// A pin of the test's, or a signal.
  [[nodiscard]] double get(const std::string& name) const;
  void set(const std::string& name, double value);
  /// One servo period.
  void cycle();

  /// What the process's pins give their signals.
  double hold_s = 1.0;
  double rise_1_s = 2.0;

  bool read_row(std::size_t channel, adapters::linuxcnc::Row& row) noexcept override;
  adapters::linuxcnc::Inputs read_inputs() noexcept override { return {}; }
  [[nodiscard]] std::size_t waiting(std::size_t channel) const noexcept override {
    return rows_[channel].size();
  }
  void write_pins(const adapters::linuxcnc::Pins& pins) noexcept override;
  [[nodiscard]] bool offsets_connected() const noexcept override { return true; }
  [[nodiscard]] kernel::signal::AxisValues offset_in_force() const noexcept override { return {}; }
  [[nodiscard]] kernel::signal::AxisValues offset_acceleration() const noexcept override {
    return {};
  }
  /// The servo thread goes on while the port waits.
  void pause() noexcept override { cycle(); }

 private:
  using Words = std::vector<std::string>;
  void line(const Words& words);
  void loadrt(const Words& words);
  void net(const Words& words);
  void link(const std::string& pin, const std::string& signal);

  std::map<std::string, Hal::Pin> signal_;
  std::map<std::string, std::string> other_;  ///< pins of nothing that is loaded: their signal
  std::map<std::pair<int, std::string>, HalFunction> thread_;
  std::vector<HalFunction> last_;  ///< without a position
  std::array<std::array<const Hal::Pin*, adapters::linuxcnc::kMaxColumns>,
             adapters::linuxcnc::kMaxChannels>
      sampled_{};
  std::array<std::deque<adapters::linuxcnc::Row>, adapters::linuxcnc::kMaxChannels> rows_;
};

}  // namespace steadyrest::test::linuxcnc
