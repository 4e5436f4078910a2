// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <bench/hostile/daemon/wild_port.hpp>

namespace steadyrest::bench::hostile {
namespace {

namespace signal = kernel::signal;
using Limits = std::numeric_limits<double>;

constexpr std::size_t kBurst = 25'000;  ///< more than a second of the sensor
constexpr std::size_t kMostSegments = 200;

kernel::outcome::Refusal failure() {
  return {.kind = kernel::outcome::Kind::unavailable, .file = {}, .what = {}, .to_do = {}};
}

/// All numbers of a frame that are measured.
std::array<double*, 16> numbers(signal::Frame& frame, std::size_t axis, std::size_t sensor) {
  auto& a = frame.axis[axis];
  return {&a.command_mm,
          &a.actual_mm,
          &a.following_error_mm,
          &a.edge_s,
          &frame.age_s,
          &frame.programmed_feed_mm_s,
          &frame.path_speed_mm_s,
          &frame.spindle_programmed_rev_s,
          &frame.spindle_command_rev_s,
          &frame.spindle_actual_rev_s,
          &frame.temperature_c[sensor],
          &frame.probe.displacement_mm,
          &frame.probe.sd_mm,
          &frame.path_position_mm,
          &frame.feed.effective_ratio,
          &frame.spindle.effective_ratio};
}

}  // namespace

WildPort::WildPort(kernel::port::Port& inner, const kernel::port::Capability& can,
                   const kernel::machine::Machine& machine, Dice& dice)
    : inner_(inner), can_(can), machine_(machine), dice_(dice), burst_(kBurst) {
  wild_path_.reserve(kMostSegments);
}

double WildPort::wild() noexcept {
  switch (dice_.below(4)) {
    case 0:
      return dice_.of({Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()});
    case 1:
      return dice_.of({1e300, -1e300, 1e9, -1e9, Limits::max(), Limits::lowest()});
    case 2:
      return dice_.of({Limits::denorm_min(), -Limits::denorm_min(), 0.0, -0.0, 1e-300});
    default:
      return std::bit_cast<double>(dice_.next());
  }
}

void WildPort::draw_act() {
  cycles_left_ = 1 + dice_.below(400);
  fails_ = dice_.of<std::uint64_t>({0, 0, 0, 0, 200, 10, 2});
  time_ = dice_.of<std::uint64_t>({0, 0, 0, 200, 20, 5, 2});
  panel_ = dice_.of<std::uint64_t>({0, 0, 0, 300, 60, 3});
  number_ = dice_.of<std::uint64_t>({0, 0, 0, 100, 10, 2, 1});
  whole_ = dice_.of<std::uint64_t>({0, 0, 0, 100, 10, 2});
  bursts_ = dice_.of<std::uint64_t>({0, 0, 0, 0, 50, 5});
  path_ = dice_.one_in(3) ? static_cast<int>(1 + dice_.below(4)) : 0;
  freezes_ = dice_.one_in(10);
  if (dice_.one_in(10)) {
    set_s_ = dice_.of({0.0, -5.0, 3600.0, -0.05, 0.3, 1e6, -1e6});
  }
  if (bursts_ > 0) {
    const double size = dice_.of({1.0, 1e3, 1e150, 1e-310});
    for (double& value : burst_) {
      value = dice_.one_in(1000) ? wild() : dice_.within(-size, size);
    }
  }
}

/// A path of the right size with wild numbers, for the whole act.
void WildPort::spoil_path(std::size_t segments) {
  wild_path_.resize(std::min(segments, kMostSegments));
  for (signal::PathSegment& segment : wild_path_) {
    segment = {};
    segment.geometry = dice_.one_in(2) ? signal::Geometry::arc : signal::Geometry::line;
    segment.motion = static_cast<signal::Motion>(dice_.below(9));
    const auto any = [this] { return dice_.one_in(6) ? wild() : dice_.within(-50.0, 50.0); };
    for (auto* point : {&segment.start_mm, &segment.end_mm, &segment.centre_mm, &segment.axis}) {
      for (double& value : *point) {
        value = any();
      }
    }
    for (double* value :
         {&segment.radius_mm, &segment.radius_end_mm, &segment.sweep_rad, &segment.rise_mm,
          &segment.length_mm, &segment.position_mm, &segment.feed_mm_s, &segment.speed_limit_mm_s,
          &segment.exit_speed_limit_mm_s}) {
      *value = any();
    }
  }
}

/// Wrong stamps: not finite, off by anything in either direction, standing.
void WildPort::spoil_time(signal::Frame& frame) noexcept {
  frame.time_s += set_s_;
  if (strikes(time_)) {
    switch (dice_.below(4)) {
      case 0:
        frame.time_s = wild();
        break;
      case 1:
        frame.time_s += std::pow(10.0, dice_.within(-3.0, 6.0));
        break;
      case 2:
        frame.time_s -= std::pow(10.0, dice_.within(-3.0, 6.0));
        break;
      default:
        frame.time_s = last_stamp_s_;
    }
  }
  last_stamp_s_ = frame.time_s;
}

/// The operator turns the switches; sometimes what they show is no position.
void WildPort::spoil_panel(signal::Frame& frame) noexcept {
  const auto turn = [this](signal::OverrideState& state, double& panel,
                           const kernel::machine::OverrideTable& table) {
    if (strikes(panel_) && !table.ratio.empty()) {
      panel = dice_.one_in(5)
                  ? 0.0
                  : std::min(table.ratio[dice_.below(table.ratio.size())], table.max_ratio);
    }
    state.panel_ratio = panel;
    if (strikes(panel_)) {
      state.panel_code = static_cast<std::uint32_t>(dice_.next());
      state.panel_code_known = dice_.one_in(3);
      state.panel_ratio = dice_.one_in(2) ? wild() : panel;
    }
  };
  turn(frame.feed, feed_panel_, machine_.feed_override);
  turn(frame.spindle, spindle_panel_, machine_.spindle_override);
}

void WildPort::spoil_number(signal::Frame& frame) noexcept {
  for (std::size_t i = 1 + dice_.below(3); i > 0; --i) {
    const auto all =
        numbers(frame, dice_.below(signal::kMaxAxes), dice_.below(signal::kMaxTemperatures));
    *all[dice_.below(all.size())] = wild();
  }
}

void WildPort::spoil_whole(signal::Frame& frame) noexcept {
  auto& axis = frame.axis[dice_.below(signal::kMaxAxes)];
  switch (dice_.below(9)) {
    case 0:
      frame.axis_count = static_cast<std::uint8_t>(dice_.next());
      break;
    case 1:
      axis.count = static_cast<std::int64_t>(dice_.next());
      axis.encoder_shown = dice_.one_in(2);
      break;
    case 2:
      axis.edge_direction = static_cast<std::int8_t>(dice_.next());
      break;
    case 3:
      frame.motion = static_cast<signal::Motion>(dice_.below(12));  // three that do not exist
      break;
    case 4:
      frame.path_index =
          dice_.one_in(2) ? dice_.below(1000) : static_cast<std::size_t>(dice_.next());
      break;
    case 5:
      frame.probe.number = dice_.next();
      frame.probe.axis = static_cast<std::uint8_t>(dice_.next());
      break;
    case 6:
      frame.cycle = dice_.next();
      frame.program_line = static_cast<std::uint32_t>(dice_.next());
      break;
    case 7:
      frame.feed_per_revolution = dice_.one_in(2);
      frame.speed_modulation = dice_.one_in(2);
      break;
    default:
      frame.coolant = !frame.coolant;
  }
}

/// No path, a part of it that does not hold the index, a wild one, or one that changes its length
/// in every cycle.
void WildPort::show_path(signal::Frame& frame) noexcept {
  switch (path_) {
    case 1:
      frame.path = {};
      break;
    case 2:
      frame.path = frame.path.first(std::min(frame.path.size(), dice_.below(40)));
      break;
    case 3:
      frame.path = wild_path_;
      break;
    case 4:
      frame.path = frame.path.subspan(std::min(frame.path.size(), dice_.below(1000)));
      break;
    default:
      break;
  }
}

void WildPort::show_vibration(signal::Frame& frame) noexcept {
  if (strikes(bursts_)) {
    frame.vibration = std::span(burst_).first(dice_.one_in(20) ? kBurst : dice_.below(100));
    frame.vibration_rate_hz = dice_.one_in(8) ? wild() : frame.vibration_rate_hz;
  }
}

void WildPort::note_shown(const signal::Frame& frame) noexcept {
  const auto sane = [](const signal::OverrideState& state) {
    return state.panel_code_known && state.panel_ratio >= 0.0 && state.panel_ratio <= 10.0;
  };
  if (sane(frame.feed)) {
    shown_.feed_ratio = frame.feed.panel_ratio;
  }
  if (sane(frame.spindle)) {
    shown_.spindle_ratio = frame.spindle.panel_ratio;
  }
  shown_.any = shown_.any || sane(frame.feed) || sane(frame.spindle);
}

kernel::outcome::Result<signal::Frame> WildPort::read() noexcept {
  if (before_read) {
    before_read();
  }
  auto read = inner_.read();
  if (!read) {
    return read;
  }
  signal::Frame frame = *read;
  if (behaves_) {
    frame.time_s += set_s_;
    frame.motion = signal::Motion::rapid;
    frame.feed.panel_ratio = feed_panel_;
    frame.spindle.panel_ratio = spindle_panel_;
    note_shown(frame);
    return frame;
  }
  if (cycles_left_-- == 0) {
    draw_act();
    if (path_ == 3) {
      spoil_path(frame.path.size());
    }
    frozen_ = frame;
    frozen_.time_s += set_s_;
    frozen_.path = frozen_.path.first(0);
    frozen_.vibration = {};
  }
  if (strikes(fails_)) {
    return std::unexpected(failure());
  }
  if (freezes_) {
    frame = frozen_;
    spoil_panel(frame);
    note_shown(frame);
    return frame;
  }
  spoil_time(frame);
  spoil_panel(frame);
  if (strikes(number_)) {
    spoil_number(frame);
  }
  show_path(frame);
  if (strikes(whole_)) {
    spoil_whole(frame);
  }
  show_vibration(frame);
  note_shown(frame);
  return frame;
}

kernel::outcome::Result<void> WildPort::write(const signal::Command& command) noexcept {
  if (!behaves_ && strikes(fails_)) {
    return std::unexpected(failure());
  }
  if (taken) {
    taken(command);
  }
  return inner_.write(command);
}

}  // namespace steadyrest::bench::hostile
