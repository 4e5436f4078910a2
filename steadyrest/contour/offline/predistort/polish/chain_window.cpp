// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/polish/chain_corner.hpp>
#include <steadyrest/contour/offline/predistort/polish/chain_window.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kScale = 0.3;      ///< of the largest error
constexpr double kEnough = 5e-3;    ///< a step that takes less than this share of J is the last
constexpr double kSmall = 0.03;     ///< of the limit: an error that is not worth a step
constexpr double kLeastArc = 0.02;  ///< mm, of a piece
constexpr double kMostTurn_rad = 0.9 * kernel::units::kTurn;
constexpr double kLeastFeedRatio = 0.25;  ///< of the programmed one
constexpr double kMostFeedRatio = 1.9;
/// A tool that is so much faster than its feed is as bad as one that is off by the limit.
constexpr double kFaster = 0.05;
/// A piece is slowed down by its feed, not by its curvature: there the control's own plan would
/// jump.
constexpr double kCurve = 5.0;
constexpr double kCurveSpare = 1.05;
constexpr double kMostRatio_ln = 4.0;
constexpr double kLeastNeighbour_mm = 0.05;
constexpr int kMostDampings = 6;
constexpr double kFirstDamping = 1e-2;
constexpr double kLeastDamping = 1e-6;
constexpr double kFlatSlope = 1e-9;   ///< of an unknown that changes nothing
constexpr double kProbe = 4.0;        ///< steps
constexpr double kCornerStep = 0.02;  ///< mm, and of a feed

/// Unknowns: [leave, arrive (mm, or rad where the direction is free), ln ρ], (curvature, ln length)
/// of the free arcs, ln feed of all.
std::size_t free_arcs(std::size_t pieces) {
  return pieces - 2;
}

/// Of the window with both of its neighbours.
double turn(const std::vector<ChainPiece>& chain, const ChainWindow::Task& task) {
  double out = 0.0;
  for (std::size_t i = task.leaves_free ? task.first : task.first - 1;
       i < (task.arrives_free ? task.last : task.last + 1); ++i) {
    out += chain[i].arc.curvature_1_mm * chain[i].arc.length_mm;
  }
  return out;
}

}  // namespace

std::optional<ChainWindow::Ends> ChainWindow::ends(const Task& task, const std::vector<double>& x,
                                                   std::vector<ChainPiece>& out) {
  const ChainPiece& first = task.chain[task.first];
  const ChainPiece& last = task.chain[task.last - 1];
  Ends made{.from = first.arc.start,
            .to = along(last.arc, last.arc.length_mm),
            .from_height_mm = first.height_mm,
            .to_height_mm = last.height_mm + last.slope * last.arc.length_mm};
  if (task.leaves_free) {
    made.from.angle_rad += x[0];
  } else {
    ChainPiece& before = out[task.first - 1];
    before.arc.length_mm += x[0];
    if (!(before.arc.length_mm >= kLeastNeighbour_mm)) {
      return std::nullopt;
    }
    made.from = along(before.arc, before.arc.length_mm);
    made.from_height_mm = before.height_mm + before.slope * before.arc.length_mm;
  }
  if (task.arrives_free) {
    made.to.angle_rad += x[1];
  } else {
    ChainPiece& after = out[task.last];
    const double rest = after.arc.length_mm - x[1];
    if (!(rest >= kLeastNeighbour_mm)) {
      return std::nullopt;
    }
    made.to = along(after.arc, x[1]);
    made.to_height_mm = after.height_mm += after.slope * x[1];
    after.arc = {made.to, after.arc.curvature_1_mm, rest};
  }
  return made;
}

// The heights are those of the task at the same share of the way.
void ChainWindow::rise(const Task& task, const Ends& between, std::vector<ChainPiece>& out) {
  const auto way = [&](const std::vector<ChainPiece>& chain) {
    double length = 0.0;
    for (std::size_t i = task.first; i < task.last; ++i) {
      length += chain[i].arc.length_mm;
    }
    return length;
  };
  const double was = way(task.chain);
  const double is = way(out);
  const ChainPiece& last = task.chain[task.last - 1];
  const double from_mm = between.from_height_mm - task.chain[task.first].height_mm;
  const double to_mm = between.to_height_mm - last.height_mm - last.slope * last.arc.length_mm;
  std::size_t at = task.first;
  double begins = 0.0;
  double place = 0.0;
  double height = between.from_height_mm;
  for (std::size_t i = task.first; i < task.last; ++i) {
    ChainPiece& piece = out[i];
    piece.height_mm = height;
    place += piece.arc.length_mm;
    const double share = place / is;
    for (; at + 1 < task.last && begins + task.chain[at].arc.length_mm < share * was; ++at) {
      begins += task.chain[at].arc.length_mm;
    }
    height = task.chain[at].height_mm + task.chain[at].slope * (share * was - begins) +
             std::lerp(from_mm, to_mm, share);
    piece.slope = (height - piece.height_mm) / piece.arc.length_mm;
  }
}

bool ChainWindow::put_feeds(const Task& task, std::span<const double> ln_ratio,
                            std::vector<ChainPiece>& out) {
  for (std::size_t i = task.first; i < task.last; ++i) {
    out[i].feed_mm_s = task.chain[i].feed_mm_s * std::exp(ln_ratio[i - task.first]);
    if (!(out[i].feed_mm_s <= kMostFeedRatio * out[i].programmed_mm_s) ||
        !(out[i].feed_mm_s >= kLeastFeedRatio * out[i].programmed_mm_s)) {
      return false;
    }
  }
  return true;
}

bool ChainWindow::build(const Task& task, const std::vector<double>& x,
                        std::vector<ChainPiece>& out) const {
  out = task.chain;
  if (task.corner) {
    // Unknowns: by how much the first piece is longer and the last begins later, ln feed of all.
    return turn_corner(std::span(out).subspan(task.first).first<3>(), x[0], x[1]) &&
           put_feeds(task, std::span(x).subspan(2), out);
  }
  const auto between = ends(task, x, out);
  if (!between || !(std::abs(x[2]) < kMostRatio_ln)) {
    return false;
  }
  Heading at = between->from;
  const std::size_t free = free_arcs(task.last - task.first);
  for (std::size_t i = 0; i < free; ++i) {
    PlanarArc& arc = out[task.first + i].arc;
    arc = {at, x[3 + 2 * i], std::exp(x[4 + 2 * i])};
    if (!(std::abs(arc.curvature_1_mm) * arc.length_mm <= kMostTurn_rad)) {
      return false;
    }
    at = along(arc, arc.length_mm);
  }
  const auto close = biarc(at, between->to, std::exp(x[2]));
  if (!close) {
    return false;
  }
  out[task.last - 2].arc = (*close)[0];
  out[task.last - 1].arc = (*close)[1];
  for (std::size_t i = task.first; i < task.last; ++i) {
    const PlanarArc& arc = out[i].arc;
    if (!(arc.length_mm >= kLeastArc) ||
        !(std::abs(arc.curvature_1_mm) * arc.length_mm <= kMostTurn_rad)) {
      return false;
    }
  }
  if (!put_feeds(task, std::span(x).subspan(3 + 2 * free), out)) {
    return false;
  }
  // Two arcs close the gap whatever they turn by: a whole turn more or less is another path.
  if (!(std::abs(turn(out, task) - turn(task.chain, task)) < 0.25 * kernel::units::kTurn)) {
    return false;
  }
  rise(task, *between, out);
  return true;
}

bool ChainWindow::follow(const Task& task, std::vector<ChainError::State>* states) {
  if (!motion_.run(trial_, task.rest_s, task.start.speed_mm_s)) {
    return false;
  }
  const bool moves = task.start.speed_mm_s > 0.0;
  error_.begin(task.start.at, moves ? task.start.until_s + motion_.after_s() : 0.0);
  error_.run(motion_.command(), off_, states);
  samples_ += off_.size();
  return true;
}

void ChainWindow::put_starts(const Task& task, Result& out) {
  trial_ = out.chain;
  std::vector<ChainError::State> states;
  out.starts.assign(1, task.start);
  if (!follow(task, &states) || states.empty()) {
    return;
  }
  for (std::size_t i = 1; i <= task.first && i < out.chain.size(); ++i) {
    const double begins_s = motion_.begin_s()[i];
    const auto before = static_cast<std::size_t>(std::max(0.0, begins_s / period_s_));
    const ChainError::State& at = states[std::clamp<std::size_t>(before, 1, states.size()) - 1];
    out.starts.push_back(
        {.at = at,
         .until_s = std::max(0.0, begins_s - static_cast<double>(before) * period_s_),
         .speed_mm_s = math::geometry::norm(at.axes.mean_mm_s)});
  }
}

bool ChainWindow::value(const Task& task, const std::vector<double>& x, Value& out) {
  if (!build(task, x, trial_)) {
    return false;
  }
  if (!follow(task)) {
    return false;
  }
  const auto& begin = motion_.begin_s();
  // From where the first piece may begin, a little before.
  const double from_s = begin[task.first - (task.leaves_free ? 0 : 1)];
  out.residual.clear();
  out.cost = 0.0;
  out.worst_mm = 0.0;
  const double weight = std::sqrt(period_s_);
  const auto put = [&](double residual) {
    out.residual.push_back(residual);
    out.cost += residual * residual;
  };
  const auto first = static_cast<std::size_t>(std::max(0.0, from_s / period_s_ - 1.0));
  // Behind the servos' memory of the window nothing changes, but for the stop at the chain's end.
  const auto last = static_cast<std::size_t>((begin[task.last] + forget_s_) / period_s_);
  for (std::size_t j = first; j < std::min(last, off_.size()); ++j) {
    const double side = off_[j].side_mm / scale_mm_;
    const double height = off_[j].height_mm / scale_mm_;
    const double off_mm = std::hypot(off_[j].side_mm, off_[j].height_mm);
    out.worst_mm = std::max(out.worst_mm, off_mm);
    put(weight * side);
    put(weight * side * side * side);
    put(weight * height);
    put(weight * height * height * height);
    put(weight * off_[j].fast_ratio / kFaster);
    if (price_.over > 0.0) {
      put(weight * price_.over * std::max(0.0, off_mm / price_.limit_mm - price_.aim));
    }
  }
  for (std::size_t i = task.first; i < task.last; ++i) {
    const double seconds = begin[i + 1] - begin[i];
    const double lacks = std::max(0.0, 1.0 - seconds / price_.least_piece_s);
    put(std::sqrt(price_.least_piece_s) * 10.0 * lacks);
    put(kCurve *
        std::max(0.0, kCurveSpare * trial_[i].feed_mm_s / motion_.curve_mm_s(trial_[i]) - 1.0));
  }
  // The end of the last piece is known to a period only.
  const ChainPiece& end = trial_.back();
  out.seconds = begin[trial_.size() - 1] + end.arc.length_mm / std::max(1.0, end.feed_mm_s);
  out.cost += price_.time * out.seconds;
  return true;
}

ChainWindow::Unknowns ChainWindow::unknowns(const Task& task) {
  const std::size_t count = task.last - task.first;
  if (task.corner) {
    return {std::vector<double>(2 + count, 0.0), std::vector<double>(2 + count, kCornerStep)};
  }
  const std::size_t free = free_arcs(count);
  Unknowns out{std::vector<double>(3 + 2 * free + count, 0.0),
               std::vector<double>(3 + 2 * free + count, 0.02)};
  const auto& chain = task.chain;
  out.x[2] = std::log(biarc_ratio(chain[task.last - 2].arc, chain[task.last - 1].arc));
  out.step[0] = out.step[1] = 0.005;  // mm or rad
  for (std::size_t i = 0; i < free; ++i) {
    const PlanarArc& arc = chain[task.first + i].arc;
    out.x[3 + 2 * i] = arc.curvature_1_mm;
    out.x[4 + 2 * i] = std::log(std::max(arc.length_mm, kLeastArc));
    // What moves its end by some micrometres.
    out.step[3 + 2 * i] = 0.01 / std::max(0.01, arc.length_mm * arc.length_mm);
    out.step[4 + 2 * i] = std::min(0.05, 0.005 / std::max(arc.length_mm, kLeastArc));
  }
  return out;
}

// Another duration has another number of samples: the residuals of the pieces come last.
ChainWindow::Slope ChainWindow::slope(const Task& task, const Unknowns& at, const Value& now) {
  const auto n = static_cast<Eigen::Index>(at.x.size());
  const auto rows = static_cast<Eigen::Index>(now.residual.size());
  const auto pieces = static_cast<Eigen::Index>(2 * (task.last - task.first));
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, n);
  Slope out{.normal = {}, .gradient = Eigen::VectorXd::Zero(n)};
  Value moved;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    std::vector<double> x = at.x;
    double by = at.step[i];
    x[i] += by;
    if (!value(task, x, moved)) {
      by = -by;
      x[i] = at.x[i] + by;
      if (!value(task, x, moved)) {
        continue;
      }
    }
    const auto others = static_cast<Eigen::Index>(moved.residual.size());
    const auto of = [by](double was, double is) { return (is - was) / by; };
    for (Eigen::Index j = 0; j < std::min(rows, others) - pieces; ++j) {
      jacobian(j, k) = of(now.residual[static_cast<std::size_t>(j)],
                          moved.residual[static_cast<std::size_t>(j)]);
    }
    for (Eigen::Index j = 1; j <= pieces; ++j) {
      jacobian(rows - j, k) = of(now.residual[static_cast<std::size_t>(rows - j)],
                                 moved.residual[static_cast<std::size_t>(others - j)]);
    }
    out.gradient[k] = 0.5 * price_.time * of(now.seconds, moved.seconds);
  }
  const Eigen::Map<const Eigen::VectorXd> residual(now.residual.data(), rows);
  out.gradient += jacobian.transpose() * residual;
  out.normal = jacobian.transpose() * jacobian;
  return out;
}

bool ChainWindow::newton(const Task& task, Unknowns& at, Value& now, double& damping) {
  const Slope here = slope(task, at, now);
  Value trial;
  for (int tries = 0; tries < kMostDampings; ++tries) {
    Eigen::MatrixXd damped = here.normal;
    for (Eigen::Index k = 0; k < damped.rows(); ++k) {
      damped(k, k) += damping * (here.normal(k, k) + kFlatSlope) + kFlatSlope;
    }
    const Eigen::VectorXd move = damped.ldlt().solve(-here.gradient);
    std::vector<double> x = at.x;
    for (std::size_t k = 0; k < x.size(); ++k) {
      x[k] += move[static_cast<Eigen::Index>(k)];
    }
    if (move.allFinite() && value(task, x, trial) && trial.cost < now.cost) {
      at.x = std::move(x);
      std::swap(now, trial);
      damping = std::max(kLeastDamping, 0.3 * damping);
      return true;
    }
    damping *= 5.0;
  }
  return false;
}

// Where the control begins to slow down J has cliffs that no derivative sees.
void ChainWindow::probe(const Task& task, Unknowns& at, Value& now) {
  Value trial;
  for (std::size_t k = 0; k < at.x.size(); ++k) {
    for (const double by : {-kProbe, kProbe}) {
      std::vector<double> x = at.x;
      x[k] += by * at.step[k];
      if (value(task, x, trial) && trial.cost < now.cost) {
        at.x = std::move(x);
        std::swap(now, trial);
      }
    }
  }
}

bool ChainWindow::rescale(const Task& task, const Unknowns& at, Value& now) {
  const double scale = std::max(price_.limit_mm, kScale * now.worst_mm);
  if (scale >= 0.7 * scale_mm_ && scale <= scale_mm_) {
    return false;
  }
  scale_mm_ = scale;
  return value(task, at.x, now);
}

std::optional<ChainWindow::Result> ChainWindow::improve(const Task& task) {
  Unknowns at = unknowns(task);
  scale_mm_ = price_.limit_mm;
  Value now;
  if (!value(task, at.x, now)) {
    return std::nullopt;
  }
  Result out{.before = now.cost, .after = now.cost, .chain = trial_, .starts = {}};
  if (now.worst_mm >= price_.enough_mm &&
      now.cost - price_.time * now.seconds >= kSmall * kSmall * now.seconds) {
    rescale(task, at, now);
    double damping = kFirstDamping;
    for (int step = 0; step < price_.steps; ++step) {
      const double was = now.cost;
      if (newton(task, at, now, damping) && was - now.cost >= kEnough * now.cost) {
        continue;
      }
      probe(task, at, now);
      damping = kFirstDamping;
      if (now.cost > (1.0 - 5.0 * kEnough) * was && !rescale(task, at, now)) {
        break;
      }
    }
    scale_mm_ = price_.limit_mm;
    if (value(task, at.x, now) && now.cost < out.before) {
      out.after = now.cost;
      out.chain = trial_;
    }
  }
  put_starts(task, out);
  return out;
}

}  // namespace steadyrest::contour::offline
