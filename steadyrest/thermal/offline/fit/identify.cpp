// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Cholesky>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/fit/band.hpp>
#include <steadyrest/thermal/offline/fit/dense_fit.hpp>
#include <steadyrest/thermal/offline/fit/fit_refusal.hpp>
#include <steadyrest/thermal/offline/fit/fitted_axis.hpp>
#include <steadyrest/thermal/offline/fit/identify.hpp>
#include <steadyrest/thermal/offline/fit/structure_search.hpp>
#include <steadyrest/thermal/offline/log/level_table.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>

// Three ways to a structure: free_structure() searches and judges by left-out hours,
// known_structure() takes time constants from a passport (--tau-from), held_structure() takes those
// shared by axes. finish() is common to all: linear fit, band from the left-out readings, passport.
// A Structure holds only what is not linear; the linear part is solved again for each one.
namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using kernel::outcome::Result;
using kernel::units::kNan;

constexpr double kDriftGuess = 0.07;     ///< of the range, before anything is known
constexpr double kStrongEvidence = 6.0;  ///< in Bayes' criterion
constexpr double kUnsure = 0.15;         ///< of known levels and gains, from run to run

struct Judged {
  Structure structure;
  std::vector<double> ln_tau_sd;
  std::vector<double> ln_tau_alone_sd;
  LeftOut left_out;
  double criterion = 0.0;
};

class Identification {
 public:
  Identification(const Log& log, std::size_t channel, const FitRequest& request)
      : log_(log),
        request_(request),
        data_(fit_data(log, channel, request.from_s, request.to_s)),
        range_um_(data_.rows() > 0 ? data_.reading_um.maxCoeff() - data_.reading_um.minCoeff()
                                   : 0.0),
        table_rev_s_(request.table ? held_speeds_rev_s(log, request.from_s, request.to_s)
                                   : std::vector<double>{}),
        // A first guess to whiten with; likely_error() replaces it once a structure is there.
        error_{std::max(kDriftGuess * range_um_, data_.noise_um), 4.0 * 3600.0, data_.noise_um} {}

  Judged free_structure(const std::function<void(double)>& progress) {
    SearchLimits limits;
    limits.most_modes = request_.modes.value_or(3);
    // Without blocks to leave out nothing would stop a search among many sensors from fitting
    // noise.
    limits.most_ambients = request_.ambient && has_blocks() ? 2 : 0;
    limits.sensor = sensors();
    std::vector<Structure> found =
        has_blocks() ? search(data_, error_, limits,
                              [&](double share) { progress ? progress(0.6 * share) : void(); })
                     : by_modes(limits.most_modes);
    for (Structure& s : found) {  // starting values come from the powers
      s.table_rev_s = table_rev_s_;
    }
    std::vector<Judged> all;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!request_.modes || found[i].mode.size() == *request_.modes) {
        all.push_back(judged(found[i]));
      }
      if (progress) {
        progress(0.6 + 0.3 * static_cast<double>(i) / static_cast<double>(found.size()));
      }
    }
    Judged best = has_blocks() ? simplest(all) : likeliest(all);
    const ErrorModel guess = error_;
    error_ = likely_error(columns(best.structure), data_, prior(best.structure));
    Judged likely = judged(best.structure);
    // The likeliest for small steps may forecast worse over long ones.
    if (has_blocks() && likely.left_out.mean_loss > best.left_out.mean_loss) {
      error_ = guess;
      return with_rest(dense_or(std::move(best), limits, guess));
    }
    return with_rest(dense_or(std::move(likely), limits, guess));
  }

  // No search: structure and error model are the axis's own, the time constants the group's.
  Judged held_structure() {
    const AxisFit& like = *request_.like;
    error_ = like.error;
    Judged out{like.structure, like.ln_tau_sd, {}, {}, 0.0};
    for (const auto& mode : like.axis.mode) {
      out.ln_tau_alone_sd.push_back(mode.tau_sd_ratio);
    }
    if (has_blocks()) {
      out.left_out = leave_out(out.structure, data_, error_, prior(out.structure));
    }
    return out;
  }

  // A passport's time constants are taken as they are; its levels and gains serve as a prior
  // (known_prior).
  Judged known_structure() {
    const ThermalAxis& known = *request_.known;
    if (known.drift_mm > 0.0) {
      error_.drift_um = kernel::units::um_from_mm(known.drift_mm);
      error_.tau_s = known.drift_tau_s;
    }
    Judged out;
    out.structure = structure_of(*request_.known, log_);
    for (const auto& mode : request_.known->mode) {
      out.ln_tau_sd.push_back(mode.tau_sd_ratio);
      out.ln_tau_alone_sd.push_back(mode.tau_sd_ratio);
    }
    return out;
  }

  [[nodiscard]] AxisFit finish(const Judged& chosen, const std::string& name) const {
    const Eigen::MatrixXd all = columns(chosen.structure);
    const LinearFit fit = fit_linear(all, data_, error_, prior(chosen.structure));
    AxisFit out;
    out.channel = log_.displacement[data_.channel].name;
    out.condition = fit.condition;
    out.blocks = data_.block.size();
    out.end_s = data_.time_s.back();
    const Eigen::VectorXd residual = data_.reading_um - all * fit.amplitude;
    out.rms_um = std::sqrt(residual.squaredNorm() / static_cast<double>(data_.rows()));
    Band band{2.0 * out.rms_um, 4.0 * 3600.0, kNan, kNan};
    out.left_out_um = out.left_out_probed_um = kNan;
    if (request_.known != nullptr) {
      band.drift_um = kernel::units::um_from_mm(request_.known->drift_mm);
      band.tau_s = request_.known->drift_tau_s;
    } else if (has_blocks()) {
      band = calibrated(chosen, all, fit);
      band.drift_um = std::hypot(band.drift_um, by_chosen_inputs_um(chosen.structure, all, fit));
      out.left_out_um = chosen.left_out.free_rms_um;
      out.left_out_probed_um = chosen.left_out.probed_rms_um;
    }
    out.coverage = band.free_coverage;
    out.coverage_probed = band.probed_coverage;
    out.structure = chosen.structure;
    out.error = error_;
    out.log_evidence = log_evidence(fit, prior(chosen.structure));
    out.axis = fitted_axis(chosen.structure, data_, fit, chosen.ln_tau_alone_sd);
    out.ln_tau_sd = chosen.ln_tau_sd;
    out.ln_tau_sd.resize(out.axis.mode.size());
    out.axis.name = name;
    if (request_.known != nullptr) {
      out.axis.max_speed_rev_s =
          std::max(out.axis.max_speed_rev_s, request_.known->max_speed_rev_s);
    }
    out.axis.drift_mm = kernel::units::mm_from_um(band.drift_um);
    out.axis.drift_tau_s = band.tau_s;
    // The drift at the log's end, averaged over a few readings to suppress their noise.
    constexpr Eigen::Index kLast = 5;
    out.axis.drift_state_mm =
        kernel::units::mm_from_um(residual.tail(std::min(kLast, residual.size())).mean());
    out.horizon_sd_um = horizon_sd_um(out.axis, request_.horizon_s);
    return out;
  }

  [[nodiscard]] const FitData& data() const noexcept { return data_; }
  [[nodiscard]] const std::vector<double>& table_rev_s() const noexcept { return table_rev_s_; }

 private:
  [[nodiscard]] bool has_blocks() const { return data_.block.size() >= kLeastBlocks; }
  [[nodiscard]] Eigen::MatrixXd columns(const Structure& s) const {
    return columns_of(s, log_, data_.row);
  }
  [[nodiscard]] LinearPrior prior(const Structure& s) const {
    LinearPrior out = wide_prior(s, data_);
    if (request_.known != nullptr) {
      known_prior(*request_.known, kUnsure, s, out);
    }
    return out;
  }

  /// Time constants count as separate parameters: the effect of one standard deviation of each.
  [[nodiscard]] Band calibrated(const Judged& chosen, const Eigen::MatrixXd& all,
                                const LinearFit& fit) const {
    constexpr double kStep = 0.02;
    const auto p = static_cast<Eigen::Index>(chosen.structure.linear());
    const auto modes = static_cast<Eigen::Index>(chosen.structure.mode.size());
    Eigen::MatrixXd wide(all.rows(), p + modes);
    wide.leftCols(p) = all.leftCols(p);
    const Eigen::VectorXd here = all * fit.amplitude;
    for (Eigen::Index i = 0; i < modes; ++i) {
      const auto m = static_cast<std::size_t>(i);
      Structure moved = chosen.structure;
      moved.mode[m].tau_s *= std::exp(kStep);
      moved.mode[m].rest_tau_s *= std::exp(kStep);
      // Numerical derivative by ln τ times its standard deviation: a column with unit variance
      // alongside those of the linear parameters.
      wide.col(p + i) =
          (columns(moved) * fit.amplitude - here) * (chosen.ln_tau_alone_sd[m] / kStep);
    }
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(p + modes, p + modes);
    covariance.topLeftCorner(p, p) = fit.covariance.topLeftCorner(p, p);
    return calibrate(data_, chosen.left_out, wide, covariance);
  }

  /// Possible error of the chosen inputs where the surroundings change: n blocks determine a gain
  /// b, against everything else that changed from block to block, to b/√n. Σ b²·σ²/n, σ the spread
  /// of the blocks' mean temperatures.
  [[nodiscard]] double by_chosen_inputs_um(const Structure& structure, const Eigen::MatrixXd& all,
                                           const LinearFit& fit) const {
    double variance_um2 = 0.0;
    const auto blocks = static_cast<Eigen::Index>(data_.block.size());
    for (std::size_t j = 0; j < structure.ambient.size() && !structure.dense; ++j) {
      const auto column = static_cast<Eigen::Index>(structure.levels() + j);
      Eigen::VectorXd mean(blocks);
      for (Eigen::Index b = 0; b < blocks; ++b) {
        const FitData::Block& block = data_.block[static_cast<std::size_t>(b)];
        mean(b) = all.col(column)
                      .segment(static_cast<Eigen::Index>(block.begin),
                               static_cast<Eigen::Index>(block.end - block.begin))
                      .mean();
      }
      // b times the spread σ of the input's block means.
      const double spread_um = fit.amplitude(column) *
                               (mean.array() - mean.mean()).matrix().norm() /
                               std::sqrt(static_cast<double>(blocks - 1));
      variance_um2 += spread_um * spread_um / static_cast<double>(blocks);
    }
    return student(data_.block.size()) * std::sqrt(variance_um2);
  }

  [[nodiscard]] std::vector<std::size_t> sensors() const {
    std::vector<std::size_t> out;
    for (std::size_t s = 0; s < log_.temperature.size(); ++s) {
      if (request_.sensors.empty() ||
          std::ranges::find(request_.sensors, log_.temperature[s].name) != request_.sensors.end()) {
        out.push_back(s);
      }
    }
    return out;
  }

  static std::vector<Structure> by_modes(std::size_t most) {
    std::vector<Structure> out;
    for (std::size_t modes = 1; modes <= most; ++modes) {
      Structure s;
      for (std::size_t i = 0; i < modes; ++i) {
        // Only starting points, in s: about 35 min for one mode, for several from about 15 min
        // upwards by factors of 5.
        s.mode.push_back(
            {60.0 * std::pow(5.0, static_cast<double>(i) + (modes == 1 ? 2.2 : 1.7)), 0.0});
      }
      out.push_back(std::move(s));
    }
    return out;
  }

  [[nodiscard]] Judged judged(const Structure& structure) const {
    const LinearPrior known = prior(structure);
    // First the time constants, from the whole log; then the blocks are left out with these fixed,
    // which costs every structure the same small bias.
    Refined refined = refine(structure, data_, error_, known);
    Judged out{std::move(refined.structure),
               std::move(refined.ln_tau_sd),
               std::move(refined.ln_tau_alone_sd),
               {},
               0.0};
    out.criterion = bayes_criterion(fit_linear(columns(out.structure), data_, error_, known),
                                    out.structure, data_.rows());
    if (has_blocks()) {
      out.left_out = leave_out(out.structure, data_, error_, known);
    }
    return out;
  }

  // One standard error (Breiman et al. 1984, §3.4.3): among structures that forecast equally well
  // within the scatter of the blocks, the simplest generalises best.
  static Judged simplest(const std::vector<Judged>& all) {
    const auto best =
        std::ranges::min_element(all, {}, [](const Judged& j) { return j.left_out.mean_loss; });
    const Judged* out = &*best;
    for (const Judged& j : all) {
      const auto rank = [](const Judged& x) {
        return std::pair(x.structure.parameters(), x.left_out.mean_loss);
      };
      // Fewest parameters first; the loss decides between equally simple ones.
      if (as_good(j.left_out, best->left_out) && rank(j) < rank(*out)) {
        out = &j;
      }
    }
    return *out;
  }
  static Judged likeliest(const std::vector<Judged>& all) {
    return *std::ranges::min_element(all, {}, &Judged::criterion);
  }

  /// The left-out hours chose the inputs of `few`, so they do not judge it as fairly as one that
  /// takes all inputs; the evidence does.
  [[nodiscard]] Judged dense_or(Judged few, const SearchLimits& limits, const ErrorModel& guess) {
    if (limits.most_ambients == 0) {
      return few;
    }
    std::optional<Dense> found = dense_fit(data_, guess, limits, request_.modes.value_or(1));
    if (!found) {
      return few;
    }
    found->structure.table_rev_s = table_rev_s_;
    // Each with its own error model, or the richer structure would be judged with the wider drift
    // of the poorer.
    const double evidence_few = evidence(few.structure);
    const ErrorModel error_few = std::exchange(error_, found->error);
    Judged dense = judged(found->structure);
    error_ = likely_error(columns(dense.structure), data_, prior(dense.structure));
    if (evidence(dense.structure) > evidence_few + kStrongEvidence) {
      return dense;
    }
    error_ = error_few;
    return few;
  }
  [[nodiscard]] double evidence(const Structure& s) const {
    const LinearPrior known = prior(s);
    // Dense lags are fixed in advance, not chosen, and cost nothing in the criterion.
    const auto lags = std::ranges::count_if(
        s.ambient, [&s](const Structure::Ambient& a) { return a.tau_s > 0.0 && !s.dense; });
    const auto chosen = static_cast<double>(s.mode.size()) + static_cast<double>(lags);
    return log_evidence(fit_linear(columns(s), data_, error_, known), known) -
           0.5 * chosen * std::log(static_cast<double>(data_.rows()));
  }

  /// A separate time constant for a stopped spindle, for each mode that gains by it.
  [[nodiscard]] Judged with_rest(Judged chosen) const {
    for (std::size_t m = 0; m < chosen.structure.mode.size() && has_blocks(); ++m) {
      Structure tried = chosen.structure;
      // Starts a little off τ: at τ itself the residuals do not show the difference between the
      // two.
      tried.mode[m].rest_tau_s = 1.1 * tried.mode[m].tau_s;
      Judged other = judged(tried);
      if (other.criterion < chosen.criterion - kStrongEvidence &&
          other.left_out.mean_loss < chosen.left_out.mean_loss &&
          !as_good(chosen.left_out, other.left_out)) {
        chosen = std::move(other);
      }
    }
    return chosen;
  }

  const Log& log_;
  const FitRequest& request_;
  FitData data_;
  double range_um_;
  std::vector<double> table_rev_s_;  ///< empty: powers of the speed
  ErrorModel error_;
};

}  // namespace

Result<AxisFit> identify(const Log& log, std::size_t channel, const std::string& name,
                         const FitRequest& request, const std::function<void(double)>& progress) {
  Identification work(log, channel, request);
  if (auto refusal = unfit(work.data(), request, work.table_rev_s())) {
    return std::unexpected(std::move(*refusal));
  }
  const Judged chosen = request.known != nullptr  ? work.known_structure()
                        : request.like != nullptr ? work.held_structure()
                                                  : work.free_structure(progress);
  AxisFit fit = work.finish(chosen, name);
  if (auto refusal = too_uncertain(fit, work.data(), request)) {
    return std::unexpected(std::move(*refusal));
  }
  return fit;
}

}  // namespace steadyrest::thermal::offline
