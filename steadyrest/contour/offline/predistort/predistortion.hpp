// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/contour/offline/predistort/barred_lines.hpp>
#include <steadyrest/contour/offline/predistort/followed_run.hpp>
#include <steadyrest/contour/offline/predistort/hold/feed_caps.hpp>
#include <steadyrest/contour/offline/predistort/hold/held_stretches.hpp>
#include <steadyrest/contour/offline/predistort/hold/rapid_waits.hpp>
#include <steadyrest/contour/offline/predistort/phase_progress.hpp>
#include <steadyrest/contour/offline/predistort/polish/polish_rounds.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/contour/offline/predistort/round_score.hpp>
#include <steadyrest/contour/offline/predistort/shape/joints.hpp>

namespace steadyrest::contour::offline {

/// As shares of the gains.
struct GainUncertainty {
  double each = 0.05;   ///< how far each may be off its model
  double apart = 0.05;  ///< how far they may be off one another: cautious()
};

/// One program being predistorted: what was tried, and the best of it.
class Predistortion {
 public:
  template <typename T>
  using Result = kernel::outcome::Result<T>;

  Predistortion(const std::string& file, const nc::interpret::Config& config,
                const kernel::machine::Machine& machine, const PredistortConfig& how,
                const GainUncertainty& gains);

  Result<Predistorted> run();

 private:
  /// Of a part of two minutes; longer parts get fewer.
  static constexpr int kRefinements = 8;
  static constexpr int kMostHolds = 16;
  static constexpr int kHoldRounds = 2;
  static constexpr double kOverHeld = 60.0;  ///< price of an error over a limit (ChainPrice)
  static constexpr int kHoldPasses = 4;      ///< of windows
  static constexpr int kHoldRuns = kHoldPasses * 40 + 1;
  static constexpr int kLastRounds = 2;  ///< with the best share at each corner
  /// Tried at corners in addition to the default; parts that take longer are left with the default.
  static constexpr std::array kBeyond = {0.0, 0.3, 0.4, 0.5, 0.55, 0.65, 0.7, 0.8};
  static constexpr int kCornerRuns = static_cast<int>(kBeyond.size()) + kLastRounds;

  /// The best text that the proof accepts.
  Result<void> proved();

  /// The program of the best part so far, where what was made is not surely better.
  Result<void> keep_best_part();

  /// Attempts until no run gets worse.
  Result<void> revise(int& revision);

  /// Runs that are good as they are, and those that nothing can win without harm, stay.
  void bar_hopeless();

  /// Machines that differ by their lag differ by the whole of what is corrected; gains are known to
  /// both sides of the file's.
  [[nodiscard]] bool judged_by_each() const noexcept { return out_.lag_uncertainty > 0.0; }

  /// Bars the runs that the best round makes worse. False where there are none.
  bool bar_worse();

  /// All feeds as programmed.
  void begin_caps();
  /// Back to the program as it is. False where no block may be changed.
  bool begin();

  /// Plain rounds until no run gets worse; the program as it is where that has no end. Where lags
  /// are not known they tell most of the runs that must stay, at little cost.
  Result<void> sift();

  /// All rounds with the blocks that may be changed now.
  Result<void> attempt(int revision);

  /// The result is the program as it is, but for its waits, until a round is better.
  void keep_original();

  Result<void> read();

  /// Writes and runs the program as it is, but for its waits.
  Result<void> begin_with();
  /// Waits between rapids and the cut, where a limit is to be held (RapidWaits).
  Result<void> wait_behind_rapids();
  /// The limit to be held; 0: none, or the program with its waits holds it.
  [[nodiscard]] double hold_mm() const noexcept {
    return first_->over.empty() ? 0.0 : how_.hold_mm;
  }
  /// Those whose block must stay go.
  Result<void> drop_waits();

  [[nodiscard]] std::vector<SegmentUse> use() const;

  Result<void> learn_from_parts();
  [[nodiscard]] Lessons lessons() const;

  [[nodiscard]] Judging judging() { return judging(model_, out_.others); }
  [[nodiscard]] Judging judging(const ServoModels& model, const OtherModels& others);

  /// Rounds until the speeds agree; the best is kept.
  Result<void> rounds(int count);

  /// The pieces for the speed in hand; lines whose pieces would go too far are barred.
  std::vector<Piece> pieces_within();

  [[nodiscard]] Result<Changed> write(const std::vector<Piece>& made) const;

  Result<void> try_text(Changed changed);

  /// Places in runs that this makes worse for some machine.
  [[nodiscard]] std::vector<double> harmed_mm(const RunErrors& after) const;

  [[nodiscard]] PolishTask polish_task();
  void be_coarse();  ///< the next fits …
  void be_fine();    ///< … until now
  /// A coarse fit for the speed in hand.
  std::vector<Piece> coarse_pieces();
  Result<TriedPieces> try_pieces(const std::vector<Piece>& made);

  /// A command of few pieces, its windows made better and its stops led beyond.
  Result<void> polish();

  /// Tries other shares at all corners and keeps the best at each.
  Result<void> try_corners();

  /// Where the path alone does not keep the limit: by windows, where that leaves something by lower
  /// feeds too; each stretch gets what holds it best.
  Result<void> hold();
  /// Where windows are stuck just above the limit: slower there, and windows from there.
  Result<void> nudge();
  /// The text of the best stretches, without windows where the proof refuses them.
  Result<void> take_best_stretches();
  /// The feeds fall where windows leave an error (FeedCaps).
  Result<void> hold_by_windows();
  /// Of open stretches, shaped first where the windows are no longer than usual.
  Result<void> hold_window_sweeps(std::vector<Piece> pieces, std::size_t inner);
  /// From the best round so far.
  Result<void> hold_by_feeds();

  /// What the best round leaves on the model whose inverse is written (cautious()).
  Result<std::vector<ErrorSample>> left();

  /// Takes half of it away, like what a record has shown; less where that is too much.
  Result<void> refine();

  const std::string& file_;
  const nc::interpret::Config& config_;
  kernel::machine::Machine machine_;  ///< as parts have shown it
  const PredistortConfig& how_;
  GainUncertainty gains_;
  ServoModels model_;
  ServoInverse inverse_;
  PhaseProgress progress_;
  Learnt learnt_;
  nc::rewrite::CutBlocks blocks_;
  nc::plan::PlannedPath path_;
  Waits waits_;
  /// The program as it is, but for its waits.
  struct First {
    nc::rewrite::NewLines lines;
    nc::rewrite::Replaced replaced;
    ErrorFigures figures;
    double seconds = 0.0;
    CommandSpeed speed;
    std::vector<BlockStart> starts;
    std::vector<ErrorPlace> over;
  };
  std::optional<First> first_;
  CommandSpeed speed_;              ///< of the last run
  CommandSpeed best_speed_;         ///< that the best round's pieces were made for
  std::vector<BlockStart> starts_;  ///< of the last run
  Changed best_;
  std::vector<ErrorSample> best_errors_;
  std::vector<ErrorPlace> best_over_;
  std::vector<ErrorPlace> over_;  ///< of the last run
  std::optional<FeedCaps> caps_;
  double tolerance_mm_ = ShapeConfig{}.tolerance_mm;  ///< of the fit
  double smooth_ = ShapeConfig{}.smooth;
  bool holds_ = false;                 ///< feeds may fall
  std::optional<HeldStretches> held_;  ///< where a limit is to be held
  HeldStretches::By by_ = HeldStretches::By::feeds;
  std::vector<Piece> made_;  ///< of the text tried last
  double best_cost_s_ = 0.0;
  std::vector<Corner> corners_;    ///< as led in the last pieces
  std::vector<double> corner_mm_;  ///< their errors in the last run
  std::optional<RoundScore> score_;
  TriedPieces last_;  ///< the last run
  double best_mm_ = -1.0;
  std::optional<BarredLines> barred_;
  std::optional<CutRuns> runs_;
  std::optional<RunErrors> runs_before_;
  std::optional<RunErrors> runs_after_;  ///< of the best round
  Predistorted out_;
};

}  // namespace steadyrest::contour::offline
