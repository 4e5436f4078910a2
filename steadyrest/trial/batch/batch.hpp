// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/plan/time/cyclogram.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

/// A batch of parts on the simulated machine, for hours: what heat does to them, and what the two
/// ways of correcting it leave.
namespace steadyrest::trial::batch {

/// The ways a part can be made.
enum class Way : std::uint8_t {
  without,  ///< nobody corrects
  text,     ///< each part's plan written into its program's text
  online    ///< the axes moved by the layer while the program runs as it is
};
inline constexpr std::size_t kWays = 3;

/// One day's work. It begins cold; there the part's zero is set.
struct Job {
  kernel::machine::Machine machine;  ///< its passport is the model; the truth is sim/thermal_growth
  std::string program;
  nc::interpret::Config config;
  std::vector<nc::plan::Transition> cyclogram;  ///< of the program
  nc::rewrite::Settings settings;
  std::uint32_t parts = 12;
  double pause_s = 120.0;         ///< after each part; the spindle stands
  double break_s = 0.0;           ///< besides, after every `break_after` parts
  std::uint32_t break_after = 0;  ///< 0 = no break
  double tolerance_mm = 0.010;    ///< Δ; Δ_k = k·Δ with the machine file's share in force
  /// Called now and then with the share of the work that is done, 0 … 1.
  std::function<void(double share)> progress = [](double) {};
};

/// The distance of the tool from where it should be by heat and correction, over the feed moves.
struct Error {
  double largest_mm = 0.0;
  double rms_mm = 0.0;
};

struct Part {
  double start_s = 0.0;
  std::array<Error, kWays> error{};
  double at_end_mm = 0.0;        ///< displacement of the first axis when it is finished
  std::size_t corrections = 0;   ///< written into its text
  std::vector<double> probe_mm;  ///< displacement by the probe before it, axis by axis
};

/// What a plot of the day shows, for the first corrected axis.
struct Point {
  double time_s = 0.0;
  std::uint32_t part = 0;  ///< from 1; 0 in a pause
  bool cutting = false;
  double displacement_mm = 0.0;
  std::array<double, kWays> left_mm{};  ///< with what the way has done
  double model_mm = 0.0;                ///< what the layer believes
  double model_sd_mm = 0.0;
  double room_c = 0.0;
};

struct Batch {
  std::vector<std::string> axis;  ///< that are corrected
  std::vector<Part> part;
  std::array<Error, kWays> error{};
  double band_mm = 0.0;  ///< Δ_k
  double program_s = 0.0;
  double total_s = 0.0;
  std::vector<Point> point;  ///< every 20 s

  /// How many times smaller than without.
  [[nodiscard]] double improvement(Way way) const noexcept;
  /// Parts whose largest error is above that without correction.
  [[nodiscard]] std::size_t worse(Way way) const noexcept;
};

/// Thermal states step in closed form once a second by the program's cyclogram, so that hours take
/// less than a second. Before each part but the first the probe reads each axis. In the text, the
/// state filter takes the readings (thermal/online/state_filter); on line they come to the layer
/// with its frames, and the offset counts that its envelope has let through (acting_layer).
///
/// Refused: a machine without a thermal passport or none of whose displacements is an axis, what
/// the planner and nc/rewrite refuse.
[[nodiscard]] kernel::outcome::Result<Batch> run(const Job& job);

}  // namespace steadyrest::trial::batch
