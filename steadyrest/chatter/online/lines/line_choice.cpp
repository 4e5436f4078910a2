// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/chatter/online/lines/line_choice.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kLeastBeside = 0.1;   // of all lines' energy
constexpr double kLeastGuarded = 2.0;  // the same
constexpr double kShownGuarded_s = 0.15;

}  // namespace

const LineChoice::Output& LineChoice::look(const LineSpectrum::Output& lines,
                                           const OrderGate::Shown& shown, double speed_rev_s,
                                           double speed_sd) noexcept {
  const auto ask = [&](OrderGate& gate, const LineSpectrum::Line& line, double energy) {
    return gate.look({.frequency_hz = line.frequency_hz,
                      .advance_turns = line.advance_turns,
                      .seconds = lines.advance_s,
                      .energy = energy},
                     shown, speed_rev_s, speed_sd);
  };
  const OrderGate::Output strongest = ask(strongest_, lines.strongest, lines.line_energy);
  const OrderGate::Output beside = ask(beside_, lines.beside, lines.beside.energy);
  const OrderGate::Output guarded = ask(guarded_, lines.guarded, lines.guarded.energy);
  const auto take = [&](const LineSpectrum::Line& line, double energy, double others,
                        const OrderGate::Output& order) {
    out_ = {.frequency_hz = line.frequency_hz,
            .peak_ratio = line.peak_ratio,
            .line_energy = energy,
            .order_energy = others,
            .noise_energy = lines.noise_energy,
            .alone = line.energy / std::max(lines.line_energy, 1e-300),
            .order = order};
  };
  const bool is_beside = lines.beside.frequency_hz > 0.0 && !beside.forced &&
                         lines.beside.energy > kLeastBeside * lines.line_energy;
  if (lines.guarded.energy > kLeastGuarded * lines.line_energy && !guarded.forced &&
      guarded.followed_s > kShownGuarded_s) {
    take(lines.guarded, lines.guarded.energy, lines.line_energy, guarded);
  } else if (strongest.forced && is_beside) {
    take(lines.beside, lines.beside.energy, lines.line_energy - lines.beside.energy, beside);
  } else {
    take(lines.strongest, lines.line_energy, 0.0, strongest);
  }
  return out_;
}

void LineChoice::reset() noexcept {
  strongest_.reset();
  beside_.reset();
  guarded_.reset();
  out_ = {};
}

}  // namespace steadyrest::chatter::online
