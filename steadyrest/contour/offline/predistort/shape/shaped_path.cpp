// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/contour/offline/predistort/shape/shaped_path.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>

namespace steadyrest::contour::offline {
namespace {

/// Hands moves on without the tolerance by which the control rounds the corners between chords:
/// these roundings are too small to be led around, and in space they could not be written.
class WithoutSmallRounding final : public nc::interpret::Sink {
 public:
  explicit WithoutSmallRounding(nc::interpret::Sink& to) : to_(to) {}
  void on_move(const nc::interpret::Move& move) override {
    if (move.path_mode != nc::interpret::PathMode::continuous || move.path_tolerance_mm <= 0.0 ||
        move.path_tolerance_mm > kSmall_mm) {
      to_.on_move(move);
      return;
    }
    nc::interpret::Move exact = move;
    exact.path_mode = nc::interpret::PathMode::exact_path;
    to_.on_move(exact);
  }
  void on_event(const nc::interpret::Event& event) override { to_.on_event(event); }

 private:
  static constexpr double kSmall_mm = 0.1;
  nc::interpret::Sink& to_;
};

}  // namespace

kernel::outcome::Result<nc::plan::PlannedPath> shaped_path(const std::string& file,
                                                           const nc::interpret::Config& config,
                                                           kernel::machine::Machine machine) {
  machine.control.merge_share = 0.0;
  return nc::plan::plan_moves(machine, file, [&](nc::interpret::Sink& sink) {
    WithoutSmallRounding moves(sink);
    return nc::interpret::run_file(file, config, moves);
  });
}

}  // namespace steadyrest::contour::offline
