// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/chatter/offline/cycle/gauss_nodes.hpp>
#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/small_inverse.hpp>
#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The linear map of a vibration over one principal period of the cut, spectrally accurate.
///
/// The spindle's angle θ is the independent variable: the delay is then the tooth pitch at any
/// speed, and teeth enter and leave at fixed angles. The period is divided into pieces within which
/// everything is smooth. In each piece the modes' equations
///   dq/dθ = v/Ω,  dv/dθ = (−2ζω·v − ω²·q + 1000/m·shape·F)/Ω,
///   F = −a·Σ_j [H_j·(x(θ) − x(θ − δ_j)) + P_j/(Ω/2π)·ẋ]
/// are collocated at Gauss–Legendre nodes. With K the modes' answer to forces at the nodes and
/// Φ·s that to the state at the piece's start, the forces follow from (I + a·(HK + PK̇))·F =
/// −a·(HΦ + PΦ̇)·s + a·Σ H_j·x_delayed; the depth a enters linearly (except with helical teeth), so
/// K is built once for a speed. With one delay and no damping the displacements follow without F:
/// (I + a·KH)·(x − x_delayed) = Φ·s − x_delayed. The error falls exponentially with the nodes: at
/// the default accuracy multipliers are good to 1e-9.
///
/// State: q and v/ω of each mode, then the displacements at the nodes of the cutting pieces within
/// the longest delay before the period's end. Unit: mm.
namespace steadyrest::chatter::offline {

class DelayCycle {
 public:
  struct Config {
    double speed_rev_s = 0.0;  ///< mean, > 0
    Modulation modulation;
    /// If not empty, it replaces `modulation`: one period of the speed, stretched to the nearest
    /// whole number of passes.
    std::vector<SpeedRamp> course;
    double most_depth_mm = 1.0;  ///< set_depth() stays accurate up to here
    double fineness = 1.0;       ///< number of nodes over the default; for convergence studies
  };

  /// Refuses a modulation whose period shares no multiple with the tooth pitch below 4096 pitches,
  /// and anything beyond_reach().
  static kernel::outcome::Result<DelayCycle> make(const Process& process, const Config& config);

  /// Depth of cut in mm, ≥ 0. Must be called before apply().
  void set_depth(double depth_mm);

  [[nodiscard]] Eigen::Index state_size() const noexcept { return state_size_; }
  /// The state's first numbers: q and v/ω of each mode.
  [[nodiscard]] Eigen::Index modal_size() const noexcept {
    return 2 * static_cast<Eigen::Index>(process_.modes.size());
  }
  /// Tooth passes (revolutions where the pitch is uneven) in the period.
  [[nodiscard]] std::size_t passes() const noexcept { return passes_; }
  /// Periods of the modulation law in the principal period; 1 without modulation.
  [[nodiscard]] std::size_t law_periods() const noexcept { return law_periods_; }
  [[nodiscard]] double period_s() const noexcept { return period_s_; }
  [[nodiscard]] double pass_rad() const noexcept { return pass_rad_; }

  /// From the state at the beginning of a pass (0 … passes() − 1) to that at its end.
  void advance(std::size_t pass, Eigen::Ref<Eigen::VectorXd> state);
  /// The adjoint of advance(): `row` times the map of the pass.
  void retreat(std::size_t pass, Eigen::Ref<Eigen::VectorXd> row);
  /// Over the whole period.
  void apply(Eigen::Ref<Eigen::VectorXd> state);

  /// The displacement along x at the nodes of the last pass that advance() did, with the time since
  /// the period's start and each node's weight in an integral over time.
  struct Sample {
    double t_s = 0.0;
    double weight_s = 0.0;
    double x_mm = 0.0;
  };
  [[nodiscard]] std::vector<Sample> last_pass(std::size_t pass) const;

 private:
  /// Where a delayed displacement is read: values of a piece in this pass or the previous one.
  struct Read {
    std::size_t piece = 0;   ///< within the pass
    bool before = true;      ///< of the previous pass
    Eigen::Index node = 0;   ///< the node itself …
    Eigen::RowVectorXd row;  ///< … or, when not empty, weights of all its nodes
  };
  struct Delayed {
    std::vector<Eigen::Matrix2d> h;  ///< of the tooth at each node
    std::vector<Read> read;          ///< at each node
  };
  struct Piece : ModalAnswers {
    double begin_rad = 0.0;  ///< within the pass
    double end_rad = 0.0;
    Eigen::Index nodes = 0;
    bool cuts = false;
    Eigen::VectorXd sigma_s;  ///< length of the piece over Ω at each node
    Eigen::MatrixXd answer;   ///< KH, or HK + PK̇ of the forces
    Eigen::MatrixXd hphi;     ///< HΦ + PΦ̇
    Eigen::MatrixXd rh;       ///< RH
    std::vector<Delayed> delayed;
    SmallInverse inverse;    ///< of I + a·answer at the present depth
    Eigen::VectorXd x;       ///< displacements when last passed
    Eigen::Index slot = -1;  ///< their place in the state; −1: never read
  };

  DelayCycle() = default;
  void plan(const SpeedProfile& speed, const Config& config);
  [[nodiscard]] std::vector<Piece> pieces_of_pass(const SpeedProfile& speed,
                                                  const Config& config) const;
  void fill(const SpeedProfile& speed, std::size_t pass, std::size_t i);
  void fill_plain(Piece& piece) const;
  void fill_cut(Piece& piece) const;
  void fill_reads(std::size_t pass, std::size_t i);
  [[nodiscard]] Read read_at(double angle_rad) const;
  void delayed(const Piece& piece, const Eigen::Ref<Eigen::VectorXd>& state,
               Eigen::Ref<Eigen::VectorXd> out) const;
  /// Adds the forces' weights to those of the displacements from which delayed() made them.
  void undelayed(const Piece& piece, const Eigen::VectorXd& forces,
                 Eigen::Ref<Eigen::VectorXd> row) const;

  Process process_;
  Eigen::Index components_ = 1;  ///< 1: only x vibrates
  bool plain_ = true;            ///< one delay and no process damping
  double pass_rad_ = 0.0;
  double period_s_ = 0.0;
  double depth_mm_ = 0.0;
  std::size_t passes_ = 1;
  std::size_t law_periods_ = 1;
  std::vector<std::vector<Piece>> pieces_;  ///< [pass][piece]; the same borders in each pass
  Eigen::Index state_size_ = 0;
  Eigen::VectorXd modal_;  ///< of advance()
  Eigen::VectorXd right_;
  Eigen::VectorXd solved_;
};

}  // namespace steadyrest::chatter::offline
