// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <bench/hostile/dice.hpp>
#include <bench/hostile/hostile_port.hpp>
#include <bench/hostile/hunt.hpp>
#include <bench/hostile/offset_watch.hpp>
#include <bench/hostile/override_watch.hpp>

#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::bench::hostile {

/// One supervisor on one variant of a machine, act by act, until something breaks.
class Scene {
 public:
  Scene(const kernel::machine::Machine& machine, std::uint64_t seed);

  [[nodiscard]] Tally run(int acts);

 private:
  void act();
  void wish();
  void events();
  void settle_on_a_wish();
  void settle_on_observe();
  void let_pass(double real_s);
  void restart(double away_s);
  void reload();
  void other_limits();
  [[nodiscard]] kernel::signal::AxisValues limits(bool available, double max_mm) const;
  void cycle();
  void know();
  void check_write();
  void check_mode(bool has_command, const kernel::signal::Command& command);
  void broken(const std::string& what);
  [[nodiscard]] bool in_thread() const;

  Dice dice_;
  std::uint64_t seed_;
  kernel::machine::Machine machine_;
  kernel::port::Capability can_;
  double cycle_s_ = 0.001;
  double watchdog_s_ = 0.1;
  std::optional<supervisor::Supervisor> layer_;
  std::optional<HostilePort> port_;
  std::optional<OverrideWatch> feed_;
  std::optional<OverrideWatch> spindle_;
  std::optional<OffsetWatch> offset_;
  std::optional<OffsetWatch> path_offset_;
  std::vector<kernel::signal::FeedRequest> feed_wish_;
  std::vector<kernel::signal::SpindleRequest> spindle_wish_;
  std::vector<kernel::signal::OffsetRequest> offset_wish_;
  std::vector<kernel::signal::OffsetRequest> path_offset_wish_;
  kernel::machine::Mode wanted_{};
  bool may_write_ = false;
  bool unsure_ = true;  ///< whether the layer knows of a thread
  double unheard_s_ = 0.0;
  double idle_s_ = 0.0;
  bool was_clean_ = false;
  kernel::signal::Motion shown_{};  ///< by two clean frames, one after the other
  kernel::signal::Motion last_{};
  bool cut_ = false;
  std::uint64_t heartbeat_ = 0;
  Tally tally_;
};

}  // namespace steadyrest::bench::hostile
