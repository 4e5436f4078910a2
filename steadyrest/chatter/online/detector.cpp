// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// A sample passes the order filter, the once-per-revolution check and the energies; the filter's
// residual goes to the spectrum, which is ready every eighth of a window. Each spectrum starts a
// query to FreeShare, whose answer, some samples later, starts judge(). Both work in small
// portions, so that no sample costs more than its share of the cycle.
//
// When it alarms (R energy ratio, F free ratio, C line energy, as in the header; each spectrum
// whose strongest line stands clear of the noise, once the cut has settled, brings a suspicion):
//
//   constant speed  R > sure, or R > on and C > margin·floor, or F > bound ─┐
//                   F not small, and the last revolution has the line too ──┴ suspects ≥ confirm ┐
//   any speed       F − bound, summed up, never below 0 ───────────────── evidence ≥ enough() ┴ on
//   over            R < off, or F < half of free while the speed moves, for a whole window
//
// floor and bound: CutLevels. While a line is suspicious `hold` keeps it from being learnt as
// forced.
namespace steadyrest::chatter::online {

using kernel::outcome::Reason;

namespace {

using kernel::units::kTurn;

// Effect of halving and doubling on the tests: README, "What the constants do". Their combined
// rates: bench/chatter/detector_hunt.
constexpr double kSteady = 0.003;   // relative spread of the speed that still counts as constant
constexpr double kGuardBins = 1.5;  // half width of a line in the spectrum
constexpr double kWideBins = 8.0;   // tooth orders nearer than this leave no gap
constexpr double kRoomBins = 4.0;   // spindle orders nearer than this leave none beside them
constexpr double kJump = 4.0;       // in the tooth orders' energy: the tool enters or leaves
constexpr double kFirstJump = 2.5;  // the same from air, which has no tooth orders that sweep
constexpr double kAllJump = 2.5;    // in the whole signal's energy
constexpr double kNoiseJump = 7.0;  // the same into the first cut, over the noise's own spread
constexpr double kSlowRev = 20.0;   // memory of the energy that a jump is measured against
constexpr double kWitnessShare = 0.25;
constexpr double kLearnRev = 1.5;     // until the filter has learnt a new cut
constexpr double kLasting = 0.7;      // of the window's line energy, still in the last revolution
constexpr double kOffSpindle = 6.0;   // runout's orders absorb a part of chatter too
constexpr double kFreeNoise = 2.0;    // the noise's spread
constexpr double kFreeSteady = 0.05;  // of a line that the energy ratio finds suspect
constexpr double kFreeSure = 0.25;    // at constant speed chatter without the other witnesses
constexpr double kFreeMargin = 1.2;   // over what the cut has shown
constexpr double kFreeOff = 0.5;
constexpr double kEvidenceStep = 0.2;  // most that one spectrum gives
constexpr double kEvidenceFall = 0.1;  // most that one spectrum takes
constexpr double kEvidence = 0.25;
constexpr double kLaterS = 0.17;  // a cut stable this long is trusted more
constexpr double kLaterEvidence = 0.45;
constexpr double kLaterBound = 1.5;
constexpr double kLongestHoldS = 2.0;
constexpr double kHop = 1.0 / 8.0;     // of the window, between spectra
constexpr double kSameTeeth = 1.3;     // energy of the tooth orders, now over lately
constexpr double kRingPeriods = 30.0;  // at a damping of 3 % nothing is left
constexpr double kLowHz = 300.0;
constexpr double kFoldsRev = 20.0;  // until the folds that a cut has are learnt
constexpr double kOutweighs = 0.9;  // of the energy
constexpr double kLoud = 0.3;       // of the energy: lines that may be orders at a wrong speed
constexpr double kAlone = 0.5;      // at a wrong speed all orders are lines
constexpr double kLastsS = 0.3;
constexpr double kProvedS = 0.2;  // a line that its phase has shown to be no order for so long

}  // namespace

double Detector::speed_of(const Input& input) const noexcept {
  return std::isnan(input.angle_rev) ? track_.ratio() * input.speed_rev_s : input.speed_rev_s;
}

const Detector::Output& Detector::update(const Input& input) noexcept {
  out_.fresh = false;
  if (!std::isfinite(input.speed_rev_s) || std::isinf(input.angle_rev)) {
    out_.reason = Reason::input_not_finite;
    return out_;
  }
  const double turn_share = input.speed_rev_s / config_.sample_rate_hz;
  // Fewer than four samples in a revolution: no order can be told from another.
  if (!(turn_share > 0.0 && turn_share < 0.25)) {
    out_.reason = Reason::input_out_of_range;
    return out_;
  }
  follow_speed(input);
  const double speed_rev_s = speed_of(input);
  out_.speed_rev_s = state_.mean_speed_rev_s;
  out_.speed_sd = std::isnan(input.angle_rev) ? track_.sd() : 0.0;
  const bool gap = sensor_.update(input.value);
  out_.reason = !std::isfinite(input.value) ? Reason::input_not_finite : state_.reason;
  const OrderFilter::Output forced =
      filter_.update(gap ? std::numeric_limits<double>::quiet_NaN() : input.value, state_.angle_rev,
                     speed_rev_s, state_.speed_spread >= kSteady, state_.hold);
  const double value = gap ? forced.estimate : input.value;
  if (std::isnan(input.angle_rev) && state_.speed_spread < kSteady) {
    track_.update(filter_, state_.angle_rev, speed_rev_s, config_.sample_rate_hz,
                  {.energy = state_.residual_energy,
                   .cut_rev = state_.settled_rev,
                   .gap = gap,
                   .loud = !out_.chatter && out_.energy_ratio > kLoud});
  }
  out_.residual = forced.residual;
  revolution_ = spread_.update(value - forced.mean, state_.angle_rev);
  follow_energy(forced, value - forced.mean, turn_share);
  // Not a line until the filter has had time to learn it.
  const double shown = state_.settled_rev > kLearnRev ? forced.residual : 0.0;
  const double tooth_hz = static_cast<double>(config_.teeth) * state_.mean_speed_rev_s;
  const bool gaps = tooth_hz > kWideBins * spectrum_.resolution_hz();
  const bool steady = state_.speed_spread < kSteady;
  // At constant speed residues of the tooth orders are ignored. Where they are closer than a line
  // is wide, nothing would remain, and while the speed moves they sweep.
  const double guard_hz = gaps && steady ? kGuardBins * spectrum_.resolution_hz() : 0.0;
  // A spectrum that finds FreeShare still busy is dropped: the next comes 13 ms later.
  const bool room = state_.mean_speed_rev_s > kRoomBins * spectrum_.resolution_hz();
  const LineSpectrum::Orders ignored{.spacing_hz = tooth_hz,
                                     .guard_hz = guard_hz,
                                     .spindle_hz = steady && room ? out_.speed_rev_s : 0.0};
  if (const auto& lines = spectrum_.update(shown, ignored); lines.fresh) {
    const LineChoice::Output& line = choice_.look(lines,
                                                  {.orders = filter_.orders(),
                                                   .learning = state_.settled_rev < kFoldsRev,
                                                   .clipped = sensor_.clips()},
                                                  out_.speed_rev_s, out_.speed_sd);
    if (!share_.busy()) {
      line_ = line;
      share_.ask(line.frequency_hz, state_.mean_speed_rev_s, state_.settled);
    }
  }
  if (const auto& share = share_.update(value, state_.angle_rev); share.fresh) {
    judge(share);
  }
  return out_;
}

void Detector::follow_speed(const Input& input) noexcept {
  const double speed_rev_s = speed_of(input);
  if (!state_.started) {
    state_.started = true;
    state_.mean_speed_rev_s = speed_rev_s;
    state_.told_rev_s = input.speed_rev_s;
    state_.angle_rev = std::isnan(input.angle_rev) ? 0.0 : input.angle_rev;
  } else if (std::isnan(input.angle_rev)) {
    // Without an angle the speed is integrated. The error only turns all orders together, slowly,
    // and the filter follows.
    state_.angle_rev += speed_rev_s / config_.sample_rate_hz;
  } else {
    state_.angle_rev = input.angle_rev;
  }
  // Memory of half a window: mean and spread match what the spectrum sees.
  const double keep = 2.0 / static_cast<double>(spectrum_.length());
  state_.mean_speed_rev_s += keep * (speed_rev_s - state_.mean_speed_rev_s);
  // Only the told speed says whether it is modulated; the track's corrections do not.
  state_.told_rev_s += keep * (input.speed_rev_s - state_.told_rev_s);
  const double off = std::abs(input.speed_rev_s / state_.told_rev_s - 1.0);
  state_.speed_spread += keep * (off - state_.speed_spread);
}

void Detector::follow_energy(const OrderFilter::Output& forced, double moving,
                             double turn_share) noexcept {
  state_.forced_energy += turn_share * (forced.forced_energy - state_.forced_energy);
  state_.tooth_energy += turn_share * (forced.tooth_energy - state_.tooth_energy);
  // A plain mean until the memory is full, then exponential.
  const double slow = std::max(turn_share / kSlowRev, turn_share / (state_.seen_rev + turn_share));
  state_.seen_rev = std::min(state_.seen_rev + turn_share, kSlowRev);
  state_.slow_energy += slow * (forced.tooth_energy - state_.slow_energy);
  state_.residual_energy +=
      turn_share * (forced.residual * forced.residual - state_.residual_energy);
  state_.settled_rev += turn_share;
  ++state_.settled;
  state_.energy += turn_share * (moving * moving - state_.energy);
  const double before = std::max(state_.slow_all, config_.least_energy);
  state_.slow_all += slow * (moving * moving - state_.slow_all);
  // The mean energy of white noise over a revolution spreads by √turn_share; out of the cut there
  // is nothing else.
  const double first_jump = std::min(kAllJump, 1.0 + kNoiseJump * std::sqrt(turn_share));
  const bool entered =
      state_.tooth_energy > (state_.opened ? kJump : kFirstJump) *
                                std::max(state_.slow_energy, config_.least_energy) ||
      state_.energy > (state_.opened ? kAllJump : first_jump) * before;
  const double pause_rev = state_.opened ? kSlowRev : config_.settle_rev;
  // Growing chatter raises the energy just as an entry does. While anything is suspect, a jump does
  // not open a cut.
  const bool calm = !out_.chatter && !state_.hold && state_.suspects == 0;
  if (entered && calm && state_.settled_rev > pause_rev) {
    state_.opened = true;
    state_.seen_rev = 0.0;
    // A new cut brings new forced vibration: everything learnt about the last one is dropped.
    filter_.open(state_.speed_spread >= kSteady);
    state_.settled_rev = 0.0;
    state_.settled = 0;
    levels_.begin();
  }
}

/// Period doubling that runout cannot give: what is at half tooth orders has grown beyond all that
/// this cut has shown, while the teeth's own orders have stayed as they were. A fold that lies
/// there too beats with it.
bool Detector::doubles() const noexcept {
  const auto teeth = static_cast<double>(config_.teeth);
  const bool half = std::fmod(2.0 * out_.line.order, teeth) == 0.0 &&
                    std::fmod(out_.line.order, teeth) != 0.0 && !out_.line.folded &&
                    out_.line.orders == 1;
  const double changed = state_.tooth_energy / std::max(state_.slow_energy, 1e-300);
  return half && levels_.judged_s() > config_.learn_s &&
         line_.line_energy > config_.margin * levels_.all_energy() &&
         out_.energy_ratio > config_.sure_ratio && changed > 1.0 / kSameTeeth &&
         changed < kSameTeeth;
}

/// Runout, even at a resonance, does not outweigh the teeth's own orders tenfold. Where the speed
/// is not known well enough to tell a line from an order of runout, its size and duration do.
bool Detector::outweighs() const noexcept {
  return out_.line.by_speed &&
         std::fmod(out_.line.order, static_cast<double>(config_.teeth)) != 0.0 &&
         line_.alone > kAlone && out_.energy_ratio > kOutweighs && out_.line.followed_s > kLastsS &&
         state_.settled_rev > kFoldsRev;
}

bool Detector::witnessed(double line_energy, double order) const noexcept {
  if (!revolution_.known) {
    return true;
  }
  // E(x(t) − x(t − T))² of a line of this energy is 2·E·(1 − cos 2π·order), half of which
  // RevolutionSpread measures: a line on a spindle order does not change from turn to turn.
  const double expected = line_energy * (1.0 - std::cos(kTurn * order));
  return revolution_.changed_energy >= kWitnessShare * expected;
}

Detector::Kind Detector::kind_of(double frequency_hz) const noexcept {
  const double tooth_hz = static_cast<double>(config_.teeth) * state_.mean_speed_rev_s;
  const double order = frequency_hz / tooth_hz;
  // Period doubling has its lines at odd multiples of half the tooth-passing frequency.
  const double from_half_hz = std::abs(order - std::floor(order) - 0.5) * tooth_hz;
  return from_half_hz < 0.5 * spectrum_.resolution_hz() ? Kind::flip : Kind::hopf;
}

void Detector::judge(const FreeShare::Output& share) noexcept {
  const LineChoice::Output& lines = line_;
  const double hop_s = kHop * static_cast<double>(spectrum_.length()) / config_.sample_rate_hz;
  const double all = lines.line_energy + lines.order_energy + state_.forced_energy;
  const bool steady = state_.speed_spread < kSteady;
  out_.fresh = true;
  out_.line = lines.order;
  out_.line_energy = lines.line_energy;
  out_.forced_energy = state_.forced_energy;
  out_.energy_ratio = all > 0.0 ? lines.line_energy / all : 0.0;
  // Two fits, by tooth orders and by all spindle orders; the smaller residual counts. Any fit
  // leaves noise, so twice its expected share is subtracted first.
  const double off_orders = std::min(share.off_teeth, kOffSpindle * share.off_spindle) -
                            kFreeNoise * share.noise_share * lines.noise_energy;
  out_.free_ratio = share.known && share.energy > 0.0
                        ? out_.energy_ratio * std::clamp(off_orders / share.energy, 0.0, 1.0)
                        : 0.0;
  out_.spread_ratio = revolution_.known && revolution_.energy > 0.0
                          ? revolution_.changed_energy / revolution_.energy
                          : 0.0;
  const bool cuts = all > config_.least_energy;
  const bool settled = state_.settled_rev > config_.settle_rev;
  levels_.judge(settled ? hop_s : 0.0);
  // What the tool's entry has struck rings; below, FreeShare takes its own image for free.
  const bool rung =
      lines.frequency_hz > kLowHz || static_cast<double>(state_.settled) * lines.frequency_hz >
                                         kRingPeriods * config_.sample_rate_hz;
  const bool strong = cuts && settled && rung && lines.peak_ratio > config_.line_ratio;
  // Vibration at an order of the spindle is forced, whatever its course.
  state_.forced = steady && out_.line.forced && !doubles() && !outweighs();
  const bool line = strong && !state_.forced && (!steady || lasts() || state_.evidence > 0.0);
  // A cumulative sum with a floor at 0 (Page 1954): many weak signs in a row decide like a few
  // strong ones, and a single spectrum, which gives at most 0.2, never does.
  const double over =
      strong ? std::clamp(out_.free_ratio - free_bound(), -kEvidenceFall, kEvidenceStep)
             : -kEvidenceFall;
  state_.evidence = std::clamp(state_.evidence + over, 0.0, enough());
  const bool suspect = line && (over > 0.0 || (steady && suspect_steady(share)));
  // Hopf chatter is not a spindle order: once it is reported, runout may be learnt again; otherwise
  // what was learnt at its beginning would stay forever. For the same reason flip is held only for
  // a while.
  const bool suspicious = line && out_.energy_ratio > 0.5 * config_.on_ratio;
  state_.held_s = suspicious ? state_.held_s + hop_s : 0.0;
  state_.hold =
      suspicious && state_.held_s < kLongestHoldS && (!out_.chatter || out_.kind == Kind::flip);
  state_.suspects = suspect ? state_.suspects + 1 : state_.suspects - std::min(state_.suspects, 1U);
  if (settled && !out_.chatter) {
    levels_.learn({.line_energy = lines.line_energy,
                   .all_energy = lines.line_energy + lines.order_energy,
                   .free_ratio = out_.free_ratio,
                   .suspect = suspect},
                  hop_s);
  }
  // One spectrum between two bursts does not end chatter.
  const bool below = steady ? out_.energy_ratio < config_.off_ratio
                            : out_.free_ratio < kFreeOff * config_.free_ratio;
  state_.quiet = below || !line ? state_.quiet + 1 : 0;
  decide(steady);
  name(line, cuts);
}

void Detector::decide(bool steady) noexcept {
  if (!out_.chatter && !state_.forced &&
      (state_.evidence >= enough() || (steady && state_.suspects >= config_.confirm))) {
    out_.chatter = true;
    state_.quiet = 0;
  } else if (out_.chatter && static_cast<double>(state_.quiet) * kHop >= 1.0) {
    out_.chatter = false;
    state_.suspects = 0;
    state_.evidence = 0.0;
    levels_.begin();
  }
}

void Detector::name(bool line, bool cuts) noexcept {
  if (out_.chatter && line) {
    out_.frequency_hz = line_.frequency_hz;
    out_.kind = kind_of(line_.frequency_hz);
  } else if (!out_.chatter) {
    out_.frequency_hz = line ? line_.frequency_hz : 0.0;
    out_.kind = cuts && state_.forced_energy > line_.noise_energy ? Kind::forced : Kind::none;
  }
  state_.reason = out_.chatter ? Reason::chatter_detected
                  : !cuts      ? Reason::not_cutting
                               : Reason::none;
  out_.reason = state_.reason;
}

/// The line is still in the last revolution, and the second check does not contradict it.
bool Detector::lasts() const noexcept {
  return state_.residual_energy > kLasting * line_.line_energy &&
         witnessed(line_.line_energy, line_.frequency_hz / state_.mean_speed_rev_s);
}

bool Detector::suspect_steady(const FreeShare::Output& share) const noexcept {
  const bool grown = levels_.judged_s() > config_.learn_s &&
                     line_.line_energy > config_.margin * levels_.line_energy();
  return (out_.energy_ratio > config_.sure_ratio ||
          (out_.energy_ratio > config_.on_ratio && grown)) &&
         (!share.known || out_.free_ratio > kFreeSteady || out_.line.followed_s > kProvedS);
}

double Detector::free_bound() const noexcept {
  // Even a stable cut has some free ratio, from noise or slow ringing; only more than that counts.
  const double least = state_.speed_spread < kSteady ? kFreeSure : config_.free_ratio;
  return std::max(later() ? kLaterBound * least : least, kFreeMargin * levels_.free_ratio());
}

bool Detector::later() const noexcept {
  return static_cast<double>(state_.settled) > kLaterS * config_.sample_rate_hz;
}

double Detector::enough() const noexcept {
  return later() ? kLaterEvidence : kEvidence;
}

void Detector::reset() noexcept {
  filter_.reset();
  spectrum_.reset();
  share_.reset();
  line_ = {};
  sensor_.reset();
  track_.reset();
  choice_.reset();
  spread_.reset();
  revolution_ = {};
  levels_.begin();
  state_ = {};
  out_ = {};
}

}  // namespace steadyrest::chatter::online
