// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <thread>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::opcua {

/// A control behind an OPC UA server that runs a program in real time, until it goes. What the
/// built program meets on a machine.
class RealTimeControl {
 public:
  struct Seen {
    double time_s = 0.0;  ///< of the control
    bool finished = false;
    double feed_in_force = 1.0;
    double least_feed_ratio = 1.0;
    std::size_t obeyed_cycles = 0;  ///< of the interpolator, with a layer's order in force
  };

  RealTimeControl(const std::string& machine_file,
                  const std::shared_ptr<const nc::plan::PlannedPath>& path);
  ~RealTimeControl();

  /// A machine file with the server's endpoint, its user and password.
  [[nodiscard]] std::string machine_file() const;
  [[nodiscard]] Seen seen() const;

 private:
  struct Parts;
  void run(const std::stop_token& stop);

  std::unique_ptr<Parts> parts_;
  std::jthread thread_;
};

}  // namespace steadyrest::opcua
