// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tests/opcua/sync_actions.hpp>

#include <steadyrest/adapters/opcua/wire.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>
#include <steadyrest/sim/machine_body.hpp>

namespace steadyrest::opcua {

/// A control of the simulated machine with STEADYREST.SPF in it: in each interpolator cycle the
/// actions run on the state of the cycle before, then the interpolator moves on with the override
/// that they leave. Its clock is its own; nothing here knows the time of day.
class ControlSide final : public Variables {
 public:
  struct Config {
    kernel::machine::Machine machine;
    std::shared_ptr<const nc::plan::PlannedPath> path;
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::vector<sim::OperatorAction> operator_actions = {};
    double order_delay_s = 0.0;  ///< from the server to the R parameters
    std::string program = "CIRCLE.MPF";
  };

  explicit ControlSide(const Config& config);

  /// One interpolator period.
  void step();
  [[nodiscard]] double time_s() const noexcept { return frame_.time_s; }
  [[nodiscard]] bool finished() const noexcept { return interpolator_.finished(); }

  // The server's side: what its nodes show now, and what was written to them.
  [[nodiscard]] bool has(const std::string& node) const;
  [[nodiscard]] adapters::opcua::Answer::Value show(const std::string& node);
  void write(const std::string& node, const std::vector<double>& values);

  // What a judge may see.
  [[nodiscard]] const kernel::signal::Frame& frame() const noexcept { return frame_; }
  [[nodiscard]] const sim::Truth& truth() const noexcept { return body_.truth(); }
  [[nodiscard]] double panel_ratio() const noexcept { return panel_; }
  /// Feed override in force, layer and panel.
  [[nodiscard]] double feed_in_force() const noexcept { return panel_ * ovr_; }
  [[nodiscard]] bool obeys() { return r(static_cast<int>(work_) + 3) > 0.0; }
  [[nodiscard]] double offset_mm(std::size_t axis) const noexcept { return offset_[axis]; }
  [[nodiscard]] std::size_t actions() const noexcept { return text_.count(); }
  /// A block search tests the program.
  bool searches = false;
  /// RESET: PROG_EVENT.SPF calls the actions' program again.
  void reset() { text_.start(*this); }
  /// Orders from now on do not reach the R parameters.
  void drop_orders() noexcept { due_.clear(); }

  double& r(int number) override;
  double read(const std::string& name) override;
  void write(const std::string& name, double value) override;

 private:
  struct Due {
    double time_s = 0.0;
    int first = 0;
    std::vector<double> values;
  };
  struct Range {
    int first = 0;
    std::size_t count = 1;
    bool array = false;
  };
  [[nodiscard]] static bool range_of(const std::string& node, Range& out);
  [[nodiscard]] std::size_t axis_of(const std::string& name) const;

  kernel::machine::Machine machine_;
  std::uint32_t work_;
  double delay_s_;
  std::string program_;
  SyncActions text_;
  SyncActions power_up_;
  std::shared_ptr<const nc::plan::PlannedPath> planned_;
  sim::MachineBody body_;
  nc::plan::Interpolator interpolator_;
  std::vector<double> r_ = std::vector<double>(1000, 0.0);
  std::deque<Due> due_;
  double panel_ = 1.0;
  double spindle_panel_ = 1.0;
  double ovr_ = 1.0;          ///< $AC_OVR of the last cycle
  double spindle_ovr_ = 1.0;  ///< $AA_OVR[S1]
  kernel::signal::AxisValues offset_{};
  std::uint64_t beats_ = 0;
  kernel::signal::Frame frame_;
};

}  // namespace steadyrest::opcua
