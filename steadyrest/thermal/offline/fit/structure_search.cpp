// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include <steadyrest/thermal/offline/fit/column_grid.hpp>
#include <steadyrest/thermal/offline/fit/structure_search.hpp>

// A forward search over the grid. The products of all columns are formed once per block; leaving a
// block out then means subtracting its normal matrix, and a candidate costs one small factorisation
// per block instead of a pass over the log.
namespace steadyrest::thermal::offline {
namespace {

const std::array<std::vector<int>, 3> kPowers = {std::vector{1}, std::vector{2}, std::vector{1, 2}};
constexpr std::size_t kLags = kGridLag_min.size();
constexpr std::size_t kKeep = 2;                  ///< of each kind
constexpr std::size_t kCarried = 60;              ///< sets of inputs tried with more modes
using Lag = std::pair<std::size_t, std::size_t>;  ///< sensor among the limits', lag

struct Candidate {
  std::vector<std::size_t> tau;
  std::size_t power = 0;
  std::vector<Lag> lag;
  double loss = std::numeric_limits<double>::infinity();
};

/// Products of all columns for each block: whitened, raw, and less the last probe's.
class Products {
 public:
  // Fitted white, judged raw: the drift decides the weight of the rows, while the error that a user
  // meets is the plain difference, running free and after an hourly probe.
  Products(const FitData& data, const ErrorModel& error, const SearchLimits& limits)
      : grid_(data, limits.sensor), zero_(1.0 / (9.0 * data.noise_um * data.noise_um)) {
    const Eigen::MatrixXd& all = grid_.columns();
    for (const FitData::Block& block : data.block) {
      const auto begin = static_cast<Eigen::Index>(block.begin);
      const auto rows = static_cast<Eigen::Index>(block.end - block.begin);
      Eigen::MatrixXd part = all.middleRows(begin, rows);
      Eigen::MatrixXd zeroed(part.rows(), part.cols());
      for (Eigen::Index c = 0; c < part.cols(); ++c) {
        // probed() is linear in the column, so it may be subtracted from each column in advance.
        zeroed.col(c) = probed(data, block, part.col(c));
      }
      free_.emplace_back(part.transpose() * part / static_cast<double>(rows));
      probed_.emplace_back(zeroed.transpose() * zeroed / static_cast<double>(rows));
      std::vector<std::size_t> fresh;
      for (const std::size_t f : data.fresh) {
        if (f > block.begin && f < block.end) {
          fresh.push_back(f - block.begin);
        }
      }
      whiten(error, std::span(data.time_s).subspan(block.begin, block.end - block.begin), fresh,
             part);
      white_.emplace_back(part.transpose() * part);
    }
    sum_ = white_.front();
    for (std::size_t b = 1; b < white_.size(); ++b) {
      sum_ += white_[b];
    }
  }

  [[nodiscard]] double loss(const Candidate& c) const {
    std::vector<Eigen::Index> column;
    column.push_back(0);
    for (const std::size_t t : c.tau) {
      for (const int p : kPowers[c.power]) {
        column.push_back(grid_.power(t, p));
      }
      for (std::size_t s = 0; s < grid_.stretches(); ++s) {
        column.push_back(grid_.start(t, s));
      }
    }
    for (const Lag& l : c.lag) {
      column.push_back(grid_.lag(l.first, l.second));
    }
    const auto p = static_cast<Eigen::Index>(column.size());
    const Eigen::Index y = sum_.cols() - 1;
    Eigen::MatrixXd normal(p, p);
    Eigen::VectorXd right(p);
    double sum = 0.0;
    for (std::size_t b = 0; b < white_.size(); ++b) {
      for (Eigen::Index i = 0; i < p; ++i) {
        const Eigen::Index ci = column[static_cast<std::size_t>(i)];
        for (Eigen::Index j = 0; j <= i; ++j) {
          const Eigen::Index cj = column[static_cast<std::size_t>(j)];
          // Normal equations of all blocks but b: leaving one out is a subtraction.
          normal(i, j) = sum_(cj, ci) - white_[b](cj, ci);
        }
        // The ridge keeps nearly equal columns solvable; without inputs the gauge's zero has its
        // own precision.
        normal(i, i) += ci == 0 && c.lag.empty() ? zero_ : kRidge;
        right(i) = sum_(y, ci) - white_[b](y, ci);
      }
      const Eigen::VectorXd a = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
      sum += block_loss(left(free_[b], column, a), left(probed_[b], column, a));
    }
    return sum / static_cast<double>(white_.size());
  }

 private:
  static constexpr double kRidge = 1e-3;  ///< amplitudes of some 30 µm

  static double left(const Eigen::MatrixXd& m, const std::vector<Eigen::Index>& column,
                     const Eigen::VectorXd& a) {
    const Eigen::Index y = m.cols() - 1;
    double sum = m(y, y);
    for (Eigen::Index i = 0; i < a.size(); ++i) {
      const Eigen::Index ci = column[static_cast<std::size_t>(i)];
      // ‖y − X·a‖² from the products alone: yᵀy − 2aᵀXᵀy + aᵀXᵀX·a.
      double row = 0.5 * a(i) * m(ci, ci) - m(y, ci);
      for (Eigen::Index j = 0; j < i; ++j) {
        row += a(j) * m(column[static_cast<std::size_t>(j)], ci);
      }
      sum += 2.0 * a(i) * row;
    }
    // A difference of large numbers: rounding may push it below 0.
    return std::max(sum, 0.0);
  }
  ColumnGrid grid_;
  double zero_;  ///< precision of the gauge's zero, if the first reading sets it
  std::vector<Eigen::MatrixXd> white_;
  std::vector<Eigen::MatrixXd> free_;
  std::vector<Eigen::MatrixXd> probed_;
  Eigen::MatrixXd sum_;
};

class Search {
 public:
  Search(const FitData& data, const ErrorModel& error, const SearchLimits& limits,
         const std::function<void(double)>& progress)
      : products_(data, error, limits), limits_(limits), progress_(progress) {}

  // Inputs outermost, modes inside: a pair of sensors is worth trying with three modes only if it
  // did well with one.
  std::vector<Structure> run() {
    std::vector<Structure> out;
    for (std::size_t inputs = 0; inputs <= limits_.most_ambients; ++inputs) {
      std::vector<std::vector<Lag>> sets = sets_of(inputs);
      for (std::size_t modes = 1; modes <= limits_.most_modes && !sets.empty(); ++modes) {
        std::vector<Candidate> all;
        for (std::size_t power = 0; power < kPowers.size(); ++power) {
          std::vector<Candidate> kind = tried(sets, modes, power);
          for (const Candidate& c : best(kind, kKeep)) {
            out.push_back(structure(c));
          }
          std::ranges::move(best(kind, kCarried), std::back_inserter(all));
        }
        sets.clear();
        // More modes are tried only with sets of inputs that did well with fewer, else there would
        // be far too many pairs.
        for (const Candidate& c : best(all, kCarried)) {
          sets.push_back(c.lag);
        }
        if (progress_) {
          progress_((static_cast<double>(inputs) +
                     static_cast<double>(modes) / static_cast<double>(limits_.most_modes)) /
                    static_cast<double>(limits_.most_ambients + 1));
        }
      }
    }
    return out;
  }

 private:
  // None, one or two inputs; more would be fitted to the accidents of a few runs.
  [[nodiscard]] std::vector<std::vector<Lag>> sets_of(std::size_t inputs) const {
    std::vector<Lag> one;
    for (std::size_t s = 0; s < limits_.sensor.size(); ++s) {
      for (std::size_t l = 0; l < kLags; ++l) {
        one.emplace_back(s, l);
      }
    }
    std::vector<std::vector<Lag>> out;
    if (inputs == 0) {
      out.emplace_back();
    }
    for (std::size_t i = 0; inputs == 1 && i < one.size(); ++i) {
      out.push_back({one[i]});
    }
    for (std::size_t i = 0; inputs == 2 && i < one.size(); ++i) {
      for (std::size_t j = i + 1; j < one.size(); ++j) {
        // Two lags of one sensor are nearly the same column.
        if (one[i].first != one[j].first) {
          out.push_back({one[i], one[j]});
        }
      }
    }
    return out;
  }

  [[nodiscard]] std::vector<Candidate> tried(const std::vector<std::vector<Lag>>& sets,
                                             std::size_t modes, std::size_t power) const {
    std::vector<Candidate> out;
    const auto taus = grid_modes(modes, modes);
    for (const auto& set : sets) {
      Candidate least;
      // For each set of inputs only the best time constants continue: neighbours on the grid differ
      // little.
      for (const auto& tau : taus) {
        Candidate c{tau, power, set, 0.0};
        c.loss = products_.loss(c);
        if (c.loss < least.loss) {
          least = std::move(c);
        }
      }
      out.push_back(std::move(least));
    }
    return out;
  }

  /// The best ones, one per set of inputs. Inputs with other lags are other inputs: the lags are
  /// refined from their starting values (0 stays 0), and the best one changes with the number of
  /// modes.
  static std::vector<Candidate> best(std::vector<Candidate> from, std::size_t count) {
    std::ranges::sort(from, {}, &Candidate::loss);
    std::vector<Candidate> out;
    for (Candidate& c : from) {
      const bool there =
          std::ranges::any_of(out, [&](const Candidate& o) { return o.lag == c.lag; });
      if (!there && out.size() < count && std::isfinite(c.loss)) {
        out.push_back(std::move(c));
      }
    }
    return out;
  }

  [[nodiscard]] Structure structure(const Candidate& c) const {
    Structure out;
    out.power = kPowers[c.power];
    for (const std::size_t t : c.tau) {
      out.mode.push_back({60.0 * kGridTau_min[t], 0.0});
    }
    for (const auto& [sensor, l] : c.lag) {
      out.ambient.push_back({limits_.sensor[sensor], 60.0 * kGridLag_min[l]});
    }
    return out;
  }

  Products products_;
  const SearchLimits& limits_;
  const std::function<void(double)>& progress_;
};

}  // namespace

std::vector<Structure> search(const FitData& data, const ErrorModel& error,
                              const SearchLimits& limits,
                              const std::function<void(double share)>& progress) {
  return Search(data, error, limits, progress).run();
}

}  // namespace steadyrest::thermal::offline
