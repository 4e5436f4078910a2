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

/// A batch of parts on the simulated machine over hours: what heat does to them, and what each of
/// the two corrections leaves.
namespace steadyrest::trial::batch {

/// The ways of making a part.
enum class Way : std::uint8_t {
  without,  ///< nobody corrects
  text,     ///< each part's plan written into its program's text
  online    ///< the axes moved by the layer while the program runs as it is
};
inline constexpr std::size_t kWays = 3;

/// One day's work. It starts cold, and the part's zero is set then.
struct Job {
  kernel::machine::Machine machine;  ///< its passport is the model; the truth is sim/thermal_growth
  std::string program;
  nc::interpret::Config config;
  std::vector<nc::plan::Transition> cyclogram;  ///< of the program
  nc::rewrite::Settings settings;
  std::uint32_t parts = 12;
  double pause_s = 120.0;         ///< after each part; spindle stopped
  double break_s = 0.0;           ///< additional, after every `break_after` parts
  std::uint32_t break_after = 0;  ///< 0 = no break
  double tolerance_mm = 0.010;    ///< Δ; Δ_k = k·Δ with the machine file's share in force
  /// Called now and then with the share of the work done, 0 … 1.
  std::function<void(double share)> progress = [](double) {};
};

/// The tool's distance from its proper place by heat and correction, over the feed moves.
struct Error {
  double largest_mm = 0.0;
  double rms_mm = 0.0;
};

struct Part {
  double start_s = 0.0;
  std::array<Error, kWays> error{};
  double at_end_mm = 0.0;        ///< displacement of the first axis at the part's end
  std::size_t corrections = 0;   ///< written into its text
  std::vector<double> probe_mm;  ///< displacement by the probe before it, axis by axis
};

/// The data of the day's plot, for the first corrected axis.
struct Point {
  double time_s = 0.0;
  std::uint32_t part = 0;  ///< from 1; 0 in a pause
  bool cutting = false;
  double displacement_mm = 0.0;
  std::array<double, kWays> left_mm{};  ///< after the way's correction
  double model_mm = 0.0;                ///< the layer's belief
  double model_sd_mm = 0.0;
  double room_c = 0.0;
};

struct Batch {
  std::vector<std::string> axis;  ///< corrected axes
  std::vector<Part> part;
  std::array<Error, kWays> error{};
  double band_mm = 0.0;  ///< Δ_k
  double program_s = 0.0;
  double total_s = 0.0;
  std::vector<Point> point;  ///< every 20 s

  /// How many times smaller than without correction.
  [[nodiscard]] double improvement(Way way) const noexcept;
  /// Parts whose largest error exceeds the one without correction.
  [[nodiscard]] std::size_t worse(Way way) const noexcept;
};

/// Thermal states advance in closed form once a second by the program's cyclogram, so that hours
/// take less than a second. Before each part but the first the probe measures each axis. For
/// corrections in the text, the state filter takes the readings (thermal/online/state_filter); on
/// line they reach the layer with its frames, and the offset that its envelope let pass counts
/// (acting_layer).
///
/// Refused: a machine without a thermal passport or with no displacement along one of its axes, and
/// what the planner and nc/rewrite refuse.
[[nodiscard]] kernel::outcome::Result<Batch> run(const Job& job);

}  // namespace steadyrest::trial::batch
