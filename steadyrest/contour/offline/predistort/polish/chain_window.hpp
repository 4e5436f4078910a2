// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include <steadyrest/contour/offline/predistort/polish/chain_error.hpp>
#include <steadyrest/contour/offline/predistort/polish/chain_motion.hpp>

namespace steadyrest::contour::offline {

/// Eigen sums a product in blocks as large as the processor's caches, and a window ends elsewhere
/// with another last digit: with blocks of one size a text is the same on every processor. Set
/// before anything runs.
inline const bool kBlocksAreFixed = [] {
  constexpr std::ptrdiff_t kLevel1 = 48L * 1024;
  constexpr std::ptrdiff_t kLevel2 = 2L * 1024 * 1024;
  constexpr std::ptrdiff_t kLevel3 = 105L * 1024 * 1024;
  Eigen::setCpuCacheSizes(kLevel1, kLevel2, kLevel3);
  return true;
}();

/// What a better command is worth.
struct ChainPrice {
  double limit_mm = 0.01;
  /// Of a second: as much as so many seconds with the error at the limit.
  double time = 5.0;
  double block = 0.003;          ///< of a piece: as much as so many seconds
  double least_piece_s = 0.004;  ///< block time of the control
  /// Of an error beyond `aim` limits: √J′ for each second and limit beyond. 0: none.
  double over = 0.0;
  double aim = 0.85;
  int steps = 16;          ///< of a window, at most
  double enough_mm = 0.0;  ///< a window whose largest error is less stays
};

/// A command without bends between two neighbours that stay where they are, made better piece by
/// piece; or the three pieces that lead it beyond a corner and back (turn_corner()).
///
/// Law. The pieces are arcs. Unknowns x: where the first leaves its neighbour and where the last
/// arrives at its, the curvature and length of all but the last two, the ratio of those two, which
/// close the gap as a biarc, and all feeds. Minimised is
///   J(x) = ∫ (ε/L)² + (ε/L)⁶ dt + λ·T
/// over the window and until the servos have forgotten it, ε the tool's distance from the path
/// (ChainError) under the control's motion (ChainMotion), L the limit, λ the price of time: Gauss
/// and Newton's steps with Levenberg's damping, derivatives by differences. The sixth power keeps
/// the largest error near the limit; to hold it, ∫ (over·(ε/limit − aim)₊)² dt is added. A piece
/// that would be shorter than the control's block time costs as much as an error at the limit
/// throughout it.
class ChainWindow {
 public:
  ChainWindow(ChainMotion& motion, ChainError& error, const ChainPrice& price, double period_s,
              double forget_s)
      : motion_(motion), error_(error), price_(price), period_s_(period_s), forget_s_(forget_s) {}

  /// The axes some time before a piece begins.
  struct Start {
    ChainError::State at;
    double until_s = 0.0;     ///< from then until it begins
    double speed_mm_s = 0.0;  ///< of the command; 0: it is at rest until the piece begins
  };
  /// Pieces [first, last) may change. At a stop their first point stays and its direction is
  /// free; elsewhere the neighbour is in the chain and goes on without a bend. So it is at the
  /// end.
  struct Task {
    std::vector<ChainPiece> chain;
    std::size_t first = 0;
    std::size_t last = 0;
    bool leaves_free = false;
    bool arrives_free = false;
    /// Three pieces: beyond a corner, straight across and on. Their lengths may change.
    bool corner = false;
    Start start;          ///< of the chain
    double rest_s = 0.0;  ///< how long the command rests after the chain
  };
  struct Result {
    double before = 0.0;  ///< J
    double after = 0.0;
    std::vector<ChainPiece> chain;
    std::vector<Start> starts;  ///< of the pieces up to `first`, the chain's start first
  };
  /// Nothing where the pieces do not go together. Else never worse than the task.
  [[nodiscard]] std::optional<Result> improve(const Task& task);
  /// Of the motions that were followed until now.
  [[nodiscard]] std::size_t samples() const noexcept { return samples_; }

 private:
  struct Value {
    double cost = 0.0;
    double seconds = 0.0;
    double worst_mm = 0.0;
    std::vector<double> residual;
  };
  struct Unknowns {
    std::vector<double> x;
    std::vector<double> step;  ///< of a difference
  };
  /// JᵀJ and half of the gradient of the cost.
  struct Slope {
    Eigen::MatrixXd normal;
    Eigen::VectorXd gradient;
  };
  /// What the changed pieces lie between.
  struct Ends {
    Heading from;
    Heading to;
    double from_height_mm = 0.0;
    double to_height_mm = 0.0;
  };
  static Unknowns unknowns(const Task& task);
  /// The neighbours in `out` become longer or shorter.
  static std::optional<Ends> ends(const Task& task, const std::vector<double>& x,
                                  std::vector<ChainPiece>& out);
  static void rise(const Task& task, const Ends& between, std::vector<ChainPiece>& out);
  Slope slope(const Task& task, const Unknowns& at, const Value& now);
  bool newton(const Task& task, Unknowns& at, Value& now, double& damping);
  void probe(const Task& task, Unknowns& at, Value& now);
  /// True where the largest error asks for another L; the cost is with that.
  bool rescale(const Task& task, const Unknowns& at, Value& now);
  static bool put_feeds(const Task& task, std::span<const double> ln_ratio,
                        std::vector<ChainPiece>& out);
  bool build(const Task& task, const std::vector<double>& x, std::vector<ChainPiece>& out) const;
  bool value(const Task& task, const std::vector<double>& x, Value& out);
  bool follow(const Task& task, std::vector<ChainError::State>* states = nullptr);
  void put_starts(const Task& task, Result& out);

  ChainMotion& motion_;
  ChainError& error_;
  ChainPrice price_;
  double period_s_;
  double forget_s_;
  double scale_mm_ = 0.0;  ///< the L of J at present
  std::size_t samples_ = 0;
  std::vector<ChainPiece> trial_;
  std::vector<ChainError::Off> off_;
};

}  // namespace steadyrest::contour::offline
