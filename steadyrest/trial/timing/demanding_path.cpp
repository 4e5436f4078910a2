// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/trial/timing/demanding_path.hpp>

// A path as hard for the layer as a real program can be: arcs of several radii at two feeds, a
// zigzag of corners, a circle in CAM chords. It fills the look-ahead and makes every decision a
// search; timing on straight lines would flatter.
namespace steadyrest::trial::timing {
namespace {

using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using nc::interpret::Move;
using nc::interpret::MoveKind;

constexpr double kExtent_mm = 104.0;      ///< of the drawing, at full size
constexpr double kFastest_mm_s = 1000.0;  ///< where neither machine nor axes limit the feed
constexpr int kMostDrawings = 1000;

/// Two axes and the normal that makes the frame right-handed.
struct Plane {
  std::array<std::size_t, 2> axis;
  std::size_t normal;
};

std::optional<Plane> plane_of(const Machine& machine) {
  // G17, G18 (Z before X), G19.
  // Right-handed planes, so that a counter-clockwise arc is one on each.
  constexpr std::array<Plane, 3> kPlanes{{{.axis = {0, 1}, .normal = 2},
                                          {.axis = {2, 0}, .normal = 1},
                                          {.axis = {1, 2}, .normal = 0}}};
  for (const Plane& plane : kPlanes) {
    if (std::ranges::all_of(plane.axis, [&](std::size_t i) {
          return i < machine.axes.size() && machine.axes[i].present;
        })) {
      return plane;
    }
  }
  return std::nullopt;
}

/// Draws around the middle of the plane's travel, straight into the planner without a program's
/// text: no dialect, any axes.
class Pen {
 public:
  Pen(const Machine& machine, const Plane& plane, nc::interpret::Sink& sink)
      : plane_(plane), sink_(sink) {
    double travel_mm = kExtent_mm;
    fastest_mm_s_ = std::min(kFastest_mm_s, machine.control.max_feed_mm_s);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& axis = machine.axes[plane.axis[i]];
      middle_mm_[i] = 0.5 * (axis.min_au + axis.max_au);
      // Scaled down where the machine is small: radii and chords shrink with it.
      travel_mm = std::min(travel_mm, axis.max_au - axis.min_au);
      fastest_mm_s_ = std::min(fastest_mm_s_, axis.max_speed_au_s);
    }
    scale_ = travel_mm / kExtent_mm;
    move_.end = place(0.0, 0.0);
  }

  void feed(double share) { move_.feed_mm_s = share * fastest_mm_s_; }
  void rapid(double u, double v) { go(MoveKind::rapid, u, v); }
  void line(double u, double v) { go(MoveKind::linear, u, v); }
  /// Counter-clockwise about (u, v).
  void arc(double end_u, double end_v, double u, double v) {
    const auto centre = place(u, v);
    std::copy_n(centre.begin(), 3, move_.centre_mm.begin());
    move_.normal = {};
    move_.normal[plane_.normal] = 1.0;
    move_.turns = 1;
    go(MoveKind::arc, end_u, end_v);
  }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  [[nodiscard]] nc::interpret::Axes place(double u, double v) const {
    nc::interpret::Axes out{};
    out[plane_.axis[0]] = middle_mm_[0] + scale_ * u;
    out[plane_.axis[1]] = middle_mm_[1] + scale_ * v;
    return out;
  }
  void go(MoveKind kind, double u, double v) {
    move_.kind = kind;
    ++move_.line;
    move_.start = move_.end;
    move_.end = place(u, v);
    // No rounding of corners: the layer is meant to meet them.
    move_.path_mode = nc::interpret::PathMode::exact_path;
    if (kind != MoveKind::rapid) {
      // The chord replaces the arc's length: only a rough total is needed.
      const double du = move_.end[plane_.axis[0]] - move_.start[plane_.axis[0]];
      const double dv = move_.end[plane_.axis[1]] - move_.start[plane_.axis[1]];
      seconds_ += std::hypot(du, dv) / move_.feed_mm_s;
    }
    sink_.on_move(move_);
  }

  Plane plane_;
  nc::interpret::Sink& sink_;
  std::array<double, 2> middle_mm_{};
  double scale_ = 1.0;
  double fastest_mm_s_ = 0.0;
  double seconds_ = 0.0;
  Move move_;
};

void rounded_rectangle(Pen& pen, double a, double b, double r) {
  pen.rapid(0.0, -b);
  pen.line(a - r, -b);
  pen.arc(a, -b + r, a - r, -b + r);
  pen.line(a, b - r);
  pen.arc(a - r, b, a - r, b - r);
  pen.line(-a + r, b);
  pen.arc(-a, b - r, -a + r, b - r);
  pen.line(-a, -b + r);
  pen.arc(-a + r, -b, -a + r, -b + r);
  pen.line(0.0, -b);
}

// Forty corners 1.5 mm apart: the lag spans more than one of them.
void zigzag(Pen& pen) {
  pen.rapid(-30.0, 0.0);
  for (int i = 1; i <= 40; ++i) {
    pen.line(-30.0 + 1.5 * i, (i % 2) * 2.0);
  }
}

// A circle as CAM writes it: the look-ahead must join the chords.
void circle_in_chords(Pen& pen, double r, double chord_mm) {
  const double turn = 2.0 * std::numbers::pi;
  const int chords = static_cast<int>(std::ceil(turn * r / chord_mm));
  pen.rapid(r, 0.0);
  for (int i = 1; i <= chords; ++i) {
    const double angle = turn * i / chords;
    pen.line(r * std::cos(angle), r * std::sin(angle));
  }
}

void draw(Pen& pen) {
  for (const double share : {1.0, 0.25}) {
    pen.feed(share);
    for (const double r : {2.0, 4.0, 8.0, 12.0}) {
      rounded_rectangle(pen, 50.0, 30.0, r);
    }
    zigzag(pen);
    circle_in_chords(pen, 5.0, 0.1);
  }
}

}  // namespace

Result<std::shared_ptr<const nc::plan::PlannedPath>> demanding_path(const Machine& machine,
                                                                    double least_s) {
  const auto plane = plane_of(machine);
  if (!plane) {
    return refuse(machine.file, "the machine has fewer than two of the axes X, Y, Z",
                  "add the axes that contour together");
  }
  nc::plan::PathBuilder builder(machine);
  Pen pen(machine, *plane, builder);
  // At a very small feed one drawing lasts hours.
  for (int i = 0; i < kMostDrawings && pen.seconds() < least_s; ++i) {
    draw(pen);
  }
  auto path = builder.take();
  if (!path) {
    return std::unexpected(std::move(path.error()));
  }
  return std::make_shared<const nc::plan::PlannedPath>(std::move(*path));
}

}  // namespace steadyrest::trial::timing
