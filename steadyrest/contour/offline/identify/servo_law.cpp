// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include <steadyrest/contour/offline/identify/servo_law.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr int kStates = 5;  // x, x′, x″, h, h′
constexpr int kCommand = 5;
constexpr int kSlope = 6;
constexpr double kRestShare = 1e-3;  // of the largest step
constexpr double kGone = 1e-9;       // of a response's largest

using State = Eigen::Matrix<double, kStates, 1>;
using Step = Eigen::Matrix<double, kStates, kStates>;
using Rates = Eigen::Matrix<double, 7, 7>;

Rates rates_of(const ServoLaw& law) {
  Rates out = Rates::Zero();
  out(kCommand, kSlope) = 1.0;
  const int last = law.lag_s <= 0.0 ? 0 : law.second <= 0.0 ? 1 : 2;
  for (int i = 0; i < last; ++i) {
    out(i, i + 1) = 1.0;
  }
  const double inertia = last == 0   ? 1.0
                         : last == 1 ? law.lag_s
                                     : law.second * law.lag_s * law.lag_s;
  out(last, 0) -= law.gain_1_s / inertia;
  out(last, kCommand) = law.gain_1_s / inertia;
  out(last, kSlope) = law.feed_forward / inertia;
  if (last > 0) {
    out(last, 1) -= 1.0 / inertia;
  }
  if (last == 2) {
    out(last, 2) -= law.lag_s / inertia;
  }
  if (law.mode_weight != 0.0) {
    const double w = law.mode_rad_s;
    const double damped = 2.0 * law.mode_damping * w;
    out(3, 4) = 1.0;
    out.row(4) = damped * out.row(0);
    out(4, 0) += w * w;
    out(4, 3) -= w * w;
    out(4, 4) -= damped;
  }
  return out;
}

/// One cycle: the command turns `part` of it after the sample, as the delay is not whole cycles.
struct Cycle {
  Step states;
  State position;  ///< by the last knot of the command that has arrived
  State before;    ///< by the step to it
  State after;     ///< by the step from it
  long whole = 0;
  double part = 0.0;

  Cycle(const ServoLaw& law, double period_s) {
    const double cycles = law.delay_s / period_s;
    whole = std::lround(std::floor(cycles + 1e-9));
    part = std::max(0.0, cycles - static_cast<double>(whole));
    const Rates rates = rates_of(law);
    const Rates first = Rates(rates * (part * period_s)).exp();
    const Rates second = Rates(rates * ((1.0 - part) * period_s)).exp();
    const Step then = second.topLeftCorner<kStates, kStates>();
    states = then * first.topLeftCorner<kStates, kStates>();
    const State by_command = first.block<kStates, 1>(0, kCommand);
    position = then * by_command + second.block<kStates, 1>(0, kCommand);
    before = then * (first.block<kStates, 1>(0, kSlope) / period_s - part * by_command);
    after = second.block<kStates, 1>(0, kSlope) / period_s;
  }
};

State output_of(const ServoLaw& law) {
  State out = State::Zero();
  out[0] = 1.0 - law.mode_weight;
  out[3] = law.mode_weight;
  return out;
}

/// The law's own states alone: fewer are several times faster.
template <int N>
Eigen::VectorXd run_states(const Cycle& cycle, const State& output, const std::array<int, 5>& kept,
                           const ServoLaw& law, std::span<const double> command) {
  using Few = Eigen::Matrix<double, N, 1>;
  Eigen::Matrix<double, N, N> states;
  Few position;
  Few before;
  Few after;
  Few seen;
  for (int i = 0; i < N; ++i) {
    const int from = kept[static_cast<std::size_t>(i)];
    position[i] = cycle.position[from];
    before[i] = cycle.before[from];
    after[i] = cycle.after[from];
    seen[i] = output[from];
    for (int j = 0; j < N; ++j) {
      states(i, j) = cycle.states(from, kept[static_cast<std::size_t>(j)]);
    }
  }
  const std::vector<int> turns =
      law.lost != 0.0 ? reversals(command, rest_step(command)) : std::vector<int>();
  const auto last = static_cast<long>(command.size()) - 1;
  // From the first command: large positions cost digits.
  const double origin = command[0];
  const auto at = [&](long n) {
    return command[static_cast<std::size_t>(std::clamp(n - cycle.whole, 0L, last))] - origin;
  };
  Eigen::VectorXd out(last + 1);
  Few state = Few::Zero();
  double left = 0.0;
  double direction = 0.0;
  double was = at(-1);
  double now = at(0);
  for (long n = 0; n <= last; ++n) {
    out[n] = origin + seen.dot(state) - law.rest_error;
    const double next = at(n + 1);
    const double from = state[0];
    state = (states * state + position * now + before * (now - was) + after * (next - now)).eval();
    was = now;
    now = next;
    const long turn = n + 1 - cycle.whole;
    if (!turns.empty() && turn >= 0 && turn <= last) {
      const int turned = turns[static_cast<std::size_t>(turn)];
      direction = turned != 0 ? turned : direction;
      left = turned != 0 ? law.lost : left;
      // Motion in the new direction is lost until it adds up.
      const double moved = std::clamp(direction * (state[0] - from), 0.0, std::max(left, 0.0));
      state[0] -= direction * moved;
      left -= moved;
    }
  }
  return out;
}

/// Places of the states that the law has.
std::vector<int> states_of(const ServoLaw& law) {
  std::vector<int> out{0};
  if (law.lag_s > 0.0) {
    out.push_back(1);
  }
  if (law.lag_s > 0.0 && law.second > 0.0) {
    out.push_back(2);
  }
  if (law.mode_weight != 0.0) {
    out.insert(out.end(), {3, 4});
  }
  return out;
}

}  // namespace

double rest_step(std::span<const double> command) {
  double largest = 0.0;
  for (std::size_t n = 1; n < command.size(); ++n) {
    largest = std::max(largest, std::abs(command[n] - command[n - 1]));
  }
  return kRestShare * largest;
}

std::vector<int> reversals(std::span<const double> command, double least) {
  std::vector<int> out(command.size(), 0);
  int direction = 0;
  for (std::size_t n = 1; n < command.size(); ++n) {
    const double step = command[n] - command[n - 1];
    const int now = step > least ? 1 : step < -least ? -1 : direction;
    out[n] = direction != 0 && now != direction ? now : 0;
    direction = now;
  }
  return out;
}

Eigen::VectorXd simulated(const ServoLaw& law, std::span<const double> command, double period_s) {
  const Cycle cycle(law, period_s);
  const State output = output_of(law);
  const auto states = states_of(law);
  std::array<int, 5> kept{};
  std::ranges::copy(states, kept.begin());
  switch (states.size()) {
    case 1:
      return run_states<1>(cycle, output, kept, law, command);
    case 2:
      return run_states<2>(cycle, output, kept, law, command);
    case 3:
      return run_states<3>(cycle, output, kept, law, command);
    case 4:
      return run_states<4>(cycle, output, kept, law, command);
    default:
      return run_states<5>(cycle, output, kept, law, command);
  }
}

Eigen::MatrixXd free_responses(const ServoLaw& law, double period_s, std::size_t count) {
  const Cycle cycle(law, period_s);
  const State output = output_of(law);
  const auto states = states_of(law);
  const auto most = static_cast<long>(count);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(most, static_cast<long>(states.size()));
  long rows = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    State state = State::Zero();
    state[states[i]] = 1.0;
    double largest = 0.0;
    double size = 0.0;
    const auto column = out.col(static_cast<long>(i));
    long n = 0;
    for (double lately = 1.0; n < most && lately > kGone * largest; ++n) {
      out(n, static_cast<long>(i)) = output.dot(state);
      size += std::pow(column[n], 2);
      lately = std::max(std::abs(column[n]), 0.99 * lately);
      largest = std::max(largest, std::abs(column[n]));
      state = (cycle.states * state).eval();
    }
    out.col(static_cast<long>(i)) /= size > 0.0 ? std::sqrt(size) : 1.0;
    rows = std::max(rows, n);
  }
  return out.topRows(rows);
}

}  // namespace steadyrest::contour::offline
