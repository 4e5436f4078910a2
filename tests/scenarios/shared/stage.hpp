// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <bench/hostile/offset_watch.hpp>
#include <bench/hostile/override_watch.hpp>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::scenarios {

/// Twenty turns of R 10 mm at F4000: the layer must slow them down. The spindle warms the machine,
/// so an offset is in force too.
inline const std::string kCircles =
    "G17 G90 G94 G71\nS3000 M3\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=19 F4000\nG0 Z10\nM30\n";

/// One cycle of the loop.
struct Cycle {
  kernel::signal::Frame frame;  ///< as the layer was shown it, without path and vibration
  bool read = false;
  std::optional<kernel::signal::Command> written;  ///< that the machine took
  live::LiveStatus status;                         ///< what a client sees afterwards

  /// The ratio that the layer lets through: the masked word's, else the panel's.
  [[nodiscard]] double feed_ratio() const {
    return written && written->feed_masks_panel ? written->feed_ratio : frame.feed.panel_ratio;
  }
  [[nodiscard]] bool masks() const { return written && written->feed_masks_panel; }
};

/// The whole layer in its loop on a simulated 840D with contour and thermal rooms on, while a
/// script spoils what passes between them. The machine's side judges every written command by the
/// rules of bench/hostile: table, panel, clamp, slew.
class Stage {
 public:
  enum class Link { good, no_read, no_write, ignored };
  struct Config {
    // NOLINTBEGIN(readability-redundant-member-init)
    std::string program = kCircles;
    std::vector<sim::OperatorAction> operator_actions = {};
    // NOLINTEND(readability-redundant-member-init)
    double max_path_offset_mm = 0.0;
    kernel::machine::Mode mode = kernel::machine::Mode::act;
  };

  explicit Stage(const Config& config);
  Stage() : Stage(Config{}) {}
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// In cycle n, counted from 0.
  std::function<void(std::size_t, kernel::signal::Frame&)> show;  ///< instead of the true frame
  std::function<Link(std::size_t)> link;
  std::function<void(std::size_t, live::Loop&)> wish;

  /// So many cycles in the mode, and what handing back takes; fails the running test where the
  /// machine's side finds a law broken or the loop ends early. Once for each stage.
  void run(std::size_t cycles);

  [[nodiscard]] const std::vector<Cycle>& log() const { return log_; }
  [[nodiscard]] const live::LoopFigures& figures() const { return figures_; }
  [[nodiscard]] const kernel::machine::Machine& machine() const { return machine_; }
  [[nodiscard]] std::uint32_t feed_code(double ratio) const;
  [[nodiscard]] bool machine_finished() const { return inner_->finished(); }

  /// The largest rise of the feed ratio from one cycle to the next in [from, to).
  [[nodiscard]] double largest_rise(std::size_t from, std::size_t to) const;
  /// Cycles in [from, to) whose status names this reason for the feed.
  [[nodiscard]] std::size_t named(kernel::outcome::Reason reason, std::size_t from,
                                  std::size_t to) const;

 private:
  class Port;

  void begin_cycle();
  void judge(const kernel::signal::Command& command);
  void broken(const std::string& what);

  kernel::machine::Machine machine_;
  std::unique_ptr<sim::SimulatedMachine> inner_;
  std::unique_ptr<bench::hostile::OverrideWatch> feed_;
  std::unique_ptr<bench::hostile::OffsetWatch> offset_;
  std::unique_ptr<bench::hostile::OffsetWatch> path_offset_;
  kernel::machine::Mode mode_;
  live::Loop* loop_ = nullptr;
  double unheard_s_ = 0.0;
  std::vector<Cycle> log_;
  live::LoopFigures figures_;
  std::string broken_;
};

/// The machine stands where it is, with nothing to do.
void stand(kernel::signal::Frame& frame, const kernel::signal::Frame& since);

}  // namespace steadyrest::scenarios
