// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/nc/follow/path_locator.hpp>
#include <steadyrest/nc/follow/route.hpp>

namespace steadyrest::live {

/// A port of a control that does not show its path: the frames get the path of the loaded program,
/// as long as the commanded point is found on it. They get none where it is lost.
class FollowedPort final : public kernel::port::Port {
 public:
  struct Config {
    nc::follow::PathLocator::Config locator{};
    /// Commanded positions are estimates (CommandedPort): where the path is found they are put onto
    /// it, and line, feed and kind of motion are those of the path.
    bool estimated = false;
  };

  /// `machine` outlives this.
  explicit FollowedPort(kernel::port::Port& machine) noexcept : FollowedPort(machine, Config{}) {}
  FollowedPort(kernel::port::Port& machine, const Config& config) noexcept
      : machine_(machine), locator_(config.locator), estimated_(config.estimated) {}

  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return machine_.capability();
  }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
    return machine_.write(command);
  }

  /// The path from the next frame on; null: none. One thread, which is not the cycle's.
  void offer(std::shared_ptr<const nc::follow::Route> route);
  /// What the loaded program's text corrects by itself. Where the place on the path is lost, what
  /// it corrects there is not known.
  struct InText {
    bool path = false;
    bool path_unknown = false;  ///< its original is not known
    bool heat = false;
  };
  /// The same thread.
  void tell(const InText& in_text) noexcept;
  /// Any thread.
  [[nodiscard]] nc::follow::Place place() const noexcept { return place_.load(); }

 private:
  using Route = nc::follow::Route;

  void take() noexcept;
  void show_text(kernel::signal::Frame& frame) const noexcept;

  kernel::port::Port& machine_;
  nc::follow::PathLocator locator_;
  bool estimated_;
  const Route* now_ = nullptr;  ///< of the cycle
  std::atomic<nc::follow::Place> place_{nc::follow::Place::no_route};
  std::atomic<const Route*> offered_{nullptr};
  std::atomic<const Route*> used_{nullptr};  ///< the cycle may look at it
  std::vector<std::shared_ptr<const Route>> kept_;
  std::atomic<bool> path_in_text_{false};
  std::atomic<bool> original_unknown_{false};
  std::atomic<bool> heat_in_text_{false};
};

}  // namespace steadyrest::live
