// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/nc/follow/route.hpp>

namespace steadyrest::nc::follow {

/// What is known of the commanded point's place on the program's path.
enum class Place : std::uint8_t {
  no_route,    ///< no program is known
  no_program,  ///< the control runs none
  searching,   ///< a program runs; its point is not found, or may be in several places
  off_path,    ///< found, but the control leaves the planned path here
  on_path,
  start_unseen  ///< searching where the path follows from a start that was not seen, or was another
};

/// Finds the commanded point of a running program on the program's path, by its line and its place,
/// and follows it. README.md has the law. No allocation, no lock; work bounded by the constants of
/// the source file.
class PathLocator {
 public:
  struct Config {
    double near_mm = 0.01;       ///< on the path; > 0
    double far_mm = 1.0;         ///< lost; ≥ near_mm
    bool without_lines = false;  ///< the control shows no program line: the whole path is searched
  };
  struct Output {
    Place place = Place::no_route;
    std::size_t index = 0;     ///< segment, if on_path or off_path
    double position_mm = 0.0;  ///< path length from the program's start
    double away_mm = 0.0;  ///< from the path; a radian of a rotary axis counts as ten millimetres
  };

  PathLocator() noexcept : PathLocator(Config{}) {}
  explicit PathLocator(const Config& config) noexcept : config_(config) {}

  /// The route from here on; it outlives its use. nullptr: none. The place must be found again.
  void follow(const Route* route) noexcept;
  /// Once a cycle, with the commanded positions, offsets, line, speed and program state of a frame.
  Output update(const kernel::signal::Frame& frame) noexcept;

 private:
  static constexpr std::size_t kMostTrails = 16;
  using Axes = kernel::signal::AxisValues;

  /// A place that the commanded point may be at.
  struct Trail {
    std::size_t index = 0;
    double position_mm = 0.0;
    double away_mm = 0.0;
    double born_mm = 0.0;      ///< position when it was found
    double farthest_mm = 0.0;  ///< the control does not go back
  };

  [[nodiscard]] Output output(Place place) const noexcept;
  [[nodiscard]] Output not_found() const noexcept;
  void stand(const kernel::signal::Frame& frame) noexcept;
  [[nodiscard]] bool began_at_start(const Axes& point) const noexcept;
  [[nodiscard]] bool begins_with(std::uint32_t line) const noexcept;
  void begin_search() noexcept;
  void stop() noexcept;
  /// Moves a trail along; false where the point has left it.
  [[nodiscard]] bool advance(Trail& trail, const Axes& point, double travel_mm) const noexcept;
  void advance_all(const Axes& point, double travel_mm) noexcept;
  void scan(const Axes& point, std::uint32_t line) noexcept;
  void look_around(const Axes& point, std::uint32_t line, std::size_t number) noexcept;
  [[nodiscard]] std::size_t to_scan(std::uint32_t line) const noexcept;
  void look_at(std::size_t index, const Axes& point) noexcept;
  void keep(std::size_t index, double position_mm, double away_mm) noexcept;
  [[nodiscard]] bool decided() const noexcept;
  [[nodiscard]] bool line_fits(std::uint32_t line) const noexcept;
  void check(std::uint32_t line, double travel_mm) noexcept;

  Config config_;
  const Route* route_ = nullptr;
  std::array<Trail, kMostTrails> trail_{};  ///< in the order of the path
  std::size_t trails_ = 0;
  bool found_ = false;        ///< trail_[0] is the place
  bool from_start_ = false;   ///< the program has just begun: the first of several places is right
  bool start_fits_ = false;   ///< it began where the route begins, and was not lost since
  bool passed_over_ = false;  ///< a place that follows from a start that does not fit
  bool overflow_ = false;     ///< more places than trails
  std::uint32_t scan_line_ = 0;
  std::size_t scanned_ = 0;  ///< of the line's segments
  std::uint32_t last_line_ = 0;
  double off_path_mm_ = 0.0;    ///< travelled away from the path
  double wrong_line_mm_ = 0.0;  ///< travelled with a line that does not belong here
  double time_s_ = 0.0;
  double speed_mm_s_ = 0.0;
  Axes point_{};
  bool begun_ = false;
  bool probing_ = false;  ///< where a probe touches is not on the path
  Axes stopped_{};        ///< in the last frame without a program
  Axes rest_{};           ///< where the axes last stood between two of these
  bool rested_ = false;
};

}  // namespace steadyrest::nc::follow
