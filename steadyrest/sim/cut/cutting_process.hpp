// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/sim/cut/cutting_edges.hpp>

namespace steadyrest::sim {

/// A cut in time, non-linear: the tool may leave the material and meets the surface left by every
/// earlier pass.
///
/// Law. Edge j at the angle φ, n = (sin φ, cos φ) (turning: n = (1, 0)), reaches
///   r = n·(X + s·eₓ) + runout, s the feed travelled;
/// material remains from ρ on, h = max(0, r − ρ); afterwards the surface of this tooth at this
/// angle is max(ρ, r). The next tooth at the same angle finds it there, lower by the fall of the
/// circle next to its top: (Δs·cos φ)²/D. Any number of missed passes is thus remembered. Forces on
/// the tool: F = −Σ b·(h·(Kt·t + Kr·n) + Kte·t + Kre·n + C/v·(n·Ẋ)·n) over the edges with h > 0, t
/// the direction of the cutting speed, b the height of an edge. The surface is stored over the
/// angle, not over time, so that the delay is exact whatever the speed does.
/// One step is 2π/steps() of the spindle. Modes are solved exactly for a force that is linear
/// within the step; the forces at its end are solved together with the displacement there (2 × 2
/// system), so that no step is unstable by itself. Second order: with the default 40 steps per
/// period of the fastest mode, border depths are good to 0.5 %. Memory: teeth · slices · steps
/// cells; step() allocates nothing.
/// Modes keep their direction when the path turns; the surface of the last turn moves with the
/// feed, which is exact on a straight path and good to the angle by which the path turns per
/// revolution. Limits: one engagement for all heights, cutting forces in proportion to the chip (no
/// size effect), no torsion. Sources: Tlusty, Ismail, CIRP Annals 30 (1981) 299 (multiple
/// regeneration); Schmitz, Smith, Machining Dynamics, 2nd ed. 2019, ch. 4 (time domain, process
/// damping).
class CuttingProcess {
 public:
  struct Config {
    Cutting cut;
    double slowest_rev_s = 10.0;     ///< the grid is made for this speed, > 0
    double steps_per_period = 40.0;  ///< of the fastest mode, 8 … 1000
    /// The linear theory's tool: it never leaves the cut, and a negative chip pushes back.
    bool keeps_contact = false;
  };
  struct Input {
    double speed_rev_s = 0.0;  ///< during this step, > 0
    double feed_per_tooth_mm = 0.0;
    bool in_cut = true;  ///< false: the tool turns in air; the next cut finds a fresh surface
    /// Direction of feed in the frame of the modes, a unit vector; the step's output is in the
    /// feed's own frame.
    std::array<double, 2> feed_direction{1.0, 0.0};
  };
  struct Output {
    double period_s = 0.0;  ///< duration of this step
    std::array<double, 2> displacement_mm{};
    std::array<double, 2> velocity_mm_s{};
    std::array<double, 2> force_n{};  ///< on the tool
    double torque_n_m = 0.0;          ///< of the cut against the spindle
    double power_w = 0.0;             ///< spindle load
    double chip_mm = 0.0;             ///< the thickest of all edges
    bool wall = false;                ///< a tooth's tip has just left the finished wall …
    double wall_mm = 0.0;             ///< … this far beyond its nominal place (> 0: overcut)
    double feed_mm = 0.0;             ///< travelled so far
  };

  static kernel::outcome::Result<CuttingProcess> make(const Config& config);

  Output step(const Input& input) noexcept;

  /// Adds a displacement to each mode, which may then grow or die out.
  void disturb(double displacement_mm) noexcept;
  /// Multiplies the vibration. Useful where the law is linear: keeps_contact, no feed, no runout,
  /// no edge terms.
  void scale(double factor) noexcept;

  [[nodiscard]] std::size_t steps() const noexcept { return edges_.steps; }
  [[nodiscard]] std::size_t slices() const noexcept { return edges_.slices; }
  [[nodiscard]] double angle_rad() const noexcept;

 private:
  struct ModeState {
    double q = 0.0;
    double v = 0.0;
    double g = 0.0;
  };
  struct Surface {
    double reach_mm = 0.0;
    double feed_mm = 0.0;  ///< travelled when it was cut
  };
  /// An edge near the cut in this step.
  struct Active {
    const EdgeCell* cell = nullptr;
    std::size_t write = 0;
    Surface left;
    double still_mm = 0.0;  ///< reach without vibration
    double gap_mm = 0.0;    ///< … less the surface
    double runout_mm = 0.0;
    bool tip = false;
    bool cuts = false;
  };
  struct Motion {
    std::array<double, 2> x{};
    std::array<double, 2> v{};
  };

  CuttingProcess(const Config& config, CuttingEdges edges);
  void turn_to(const std::array<double, 2>& direction) noexcept;
  void set_period(double period_s) noexcept;
  void lay_surface(double feed_per_tooth_mm) noexcept;
  void gather() noexcept;
  [[nodiscard]] Surface surface(const Edge& edge, std::size_t cell) const noexcept;
  [[nodiscard]] Motion free_motion() const noexcept;
  [[nodiscard]] Motion moved(const Motion& free, const std::array<double, 2>& force) const noexcept;
  bool touch(const std::array<double, 2>& x) noexcept;
  [[nodiscard]] std::array<double, 2> solve(const Motion& free) const noexcept;
  void finish(const Motion& now, Output& out) noexcept;
  void move_modes() noexcept;

  Cutting cut_;
  bool keeps_contact_;
  CuttingEdges edges_;
  double drop_1_mm_;  ///< 1/D in milling
  std::vector<ModeState> modes_;
  std::vector<ModalStep> steps_;
  std::vector<std::array<double, 2>> shape_;  ///< of the modes in the feed's frame
  std::array<double, 2> direction_{1.0, 0.0};
  std::vector<Surface> surface_;
  std::vector<Active> active_;
  std::size_t active_count_ = 0;
  std::array<std::array<double, 2>, 2> answer_{};       ///< X from the force at the step's end
  std::array<std::array<double, 2>, 2> answer_rate_{};  ///< Ẋ
  double period_s_ = 0.0;
  double damping_n_s_mm2_ = 0.0;  ///< C/v
  std::array<double, 2> force_{};
  std::size_t cell_ = 0;  ///< step within the turn
  std::size_t turns_ = 0;
  double feed_mm_ = 0.0;
  bool in_cut_ = false;
};

}  // namespace steadyrest::sim
