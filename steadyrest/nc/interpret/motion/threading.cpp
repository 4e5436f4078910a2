// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/motion/threading.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr double kMostPasses = 100'000.0;

double word_or(const Step& step, char letter, double otherwise) noexcept {
  return step.has(letter) ? step[letter] : otherwise;
}

}  // namespace

bool Threading::spindle_turns(const Step& step) {
  // The feed follows the spindle; with the spindle stopped the move would never end.
  return (state_.spindle_direction != 0 &&
          (state_.spindle_speed_rev_s != 0.0 || state_.surface_speed_mm_s != 0.0)) ||
         refusals_.g_word(step, step.moves_by, "spindle_stands",
                          "threading with the spindle stopped");
}

void Threading::emit(const Axes& end, double pitch_mm) {
  // The pitch is the feed per revolution of this move only.
  const FeedMode mode = state_.feed_mode;
  const double feed = state_.feed_mm_s;
  state_.feed_mode = FeedMode::per_revolution;
  state_.feed_mm_s = std::abs(pitch_mm);
  out_.move(MoveKind::thread, end);
  state_.feed_mode = mode;
  state_.feed_mm_s = feed;
}

// K is the travel per revolution. G33.1 reverses the spindle at the end and retracts.
bool Threading::thread(const Step& step) {
  if (!step.has('K')) {
    return refusals_.g_word(step, g::kThread, "pitch_missing", "a thread without its pitch (K)");
  }
  if (!spindle_turns(step)) {
    return false;
  }
  const Axes end = end_point(step, control_);
  const double pitch_mm = step['K'] * state_.unit_mm;
  if (step.moves_by == g::kThread) {
    emit(end, pitch_mm);
    return true;
  }
  for (const char letter : std::string_view{"ABCUVW"}) {
    if (step.has(letter)) {
      return refusals_.letter(step, letter, "axis_in_cycle", "rigid tapping moves only X, Y and Z");
    }
  }
  if (pitch_mm == 0.0) {
    return refusals_.letter(step, 'K', "out_of_range", "a pitch of zero");
  }
  // G33.1 returns to its start with the spindle reversed, then restores the direction.
  const Axes start = state_.position;
  const int direction = state_.spindle_direction;
  emit(end, pitch_mm);
  state_.spindle_direction = -direction;
  out_.spindle();
  emit(start, pitch_mm);
  state_.spindle_direction = direction;
  out_.spindle();
  return true;
}

// "Fundamentals", "Tapping without compensating chuck": the sign of the pitch is the hand of the
// thread, G332 reverses by itself, and between them the spindle stands in position.
bool Threading::tap(const Step& step) {
  constexpr std::string_view kCentres = "IJK";
  const char letter = kCentres[axes_of(state_.plane).normal];
  if (!step.has(letter) || !(std::abs(step[letter]) > 0.0)) {
    return refusals_.g_word(step, step.moves_by, "pitch_missing",
                            "tapping without its pitch (K in G17, J in G18, I in G19)");
  }
  for (const char other : kCentres) {
    if (other != letter && step.has(other)) {
      return refusals_.letter(step, other, "pitch_missing",
                              "a pitch along an axis other than the tool's");
    }
  }
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (step.has(kAxisLetters[i]) && i != axes_of(state_.plane).normal) {
      return refusals_.letter(step, kAxisLetters[i], "axis_in_cycle",
                              "tapping moves only along the tool");
    }
  }
  if (!(state_.spindle_speed_rev_s > 0.0)) {
    return refusals_.g_word(step, step.moves_by, "speed_missing",
                            "tapping, but no spindle speed (S) is in force");
  }
  const bool right = step[letter] > 0.0;
  const bool in = step.moves_by == g::kTapIn;
  state_.spindle_direction = right == in ? 1 : -1;
  out_.spindle();
  emit(end_point(step, control_), step[letter] * state_.unit_mm);
  state_.spindle_direction = 0;
  out_.spindle();
  return true;
}

struct Threading::Cycle {
  double pitch_mm;
  double peak_mm;     ///< I: from the drive line to the thread's peak
  double first_mm;    ///< J: depth of the first pass
  double full_mm;     ///< K
  double end_mm;      ///< Z
  double slope;       ///< tan of the compound slide's angle
  double taper_mm;    ///< E
  double degression;  ///< R
  double springs;     ///< H: further passes at full depth
  bool entry;
  bool exit;
  double start_mm;  ///< Z at the start
  double drive_mm;  ///< X at the start
};

// G76 in LinuxCNC's form: one block with all words; depths are measured from the drive line.
bool Threading::read(const Step& step, Cycle& cycle) {
  for (const char letter : std::string_view{"PIJK"}) {
    if (!step.has(letter)) {
      return refusals_.g_word(step, g::kThreadCycle, "cycle_word_missing",
                              std::string{"G76 without its "} + letter + " word");
    }
  }
  for (const char letter : std::string_view{"ABCUVW"}) {
    if (step.has(letter)) {
      return refusals_.letter(step, letter, "axis_in_cycle",
                              "this axis cannot move in a canned cycle");
    }
  }
  const double unit = state_.unit_mm;
  // In G7 depths are diameters like X.
  const double across = state_.diameter ? 0.5 * unit : unit;
  const double ends = word_or(step, 'L', 0.0);
  cycle = {.pitch_mm = step['P'] * unit,
           .peak_mm = step['I'] * across,
           .first_mm = step['J'] * across,
           .full_mm = step['K'] * across,
           .end_mm = state_.position[2],
           .slope = std::tan(word_or(step, 'Q', 0.0) * std::numbers::pi / 180.0),
           .taper_mm = word_or(step, 'E', 0.0) * unit,
           .degression = word_or(step, 'R', 1.0),
           .springs = word_or(step, 'H', 0.0),
           .entry = ends == 1.0 || ends == 3.0,
           .exit = ends == 2.0 || ends == 3.0,
           .start_mm = state_.position[2],
           .drive_mm = state_.position[0]};
  return is_possible(step, cycle);
}

// Bounds that keep the loops below finite and the geometry real, each reported with its letter.
// Passes n until J·n^(1/R) reaches K: (K/J)^R.
bool Threading::is_possible(const Step& step, const Cycle& cycle) {
  const double springs = cycle.springs;
  const auto wrong = [&](bool is, char letter, std::string_view text) {
    return is && !refusals_.letter(step, letter, "out_of_range", text);
  };
  return !(wrong(!(cycle.pitch_mm > 0.0), 'P', "a pitch (P) that is not above zero") ||
           wrong(cycle.peak_mm == 0.0, 'I',
                 "G76 with I zero; its sign tells an inside thread from an outside one") ||
           wrong(!(cycle.first_mm > 0.0), 'J', "the first depth (J) must be above zero") ||
           wrong(!(cycle.full_mm > cycle.first_mm), 'K', "the full depth (K) must be above J") ||
           wrong(!(cycle.degression >= 1.0), 'R',
                 "the degression of depth (R) is too small; allowed: 1 or more") ||
           wrong(springs < 0.0 || springs > 1000.0 || springs != std::floor(springs), 'H',
                 "the number of spring passes (H) is not valid; allowed: whole numbers from 0") ||
           wrong(word_or(step, 'L', 0.0) > 3.0, 'L',
                 "the tapered ends (L) are out of range; allowed: 0 to 3") ||
           wrong(!(std::abs(word_or(step, 'Q', 0.0)) < 80.0), 'Q',
                 "the angle of the compound slide (Q) is too large; allowed: below 80") ||
           wrong((cycle.entry || cycle.exit) && !(cycle.taper_mm > 0.0), 'L',
                 "tapered ends need the length of the taper (E above zero)") ||
           wrong(!(std::pow(cycle.full_mm / cycle.first_mm, cycle.degression) < kMostPasses), 'J',
                 "a thread of more than 100000 passes"));
}

bool Threading::cycle(const Step& step) {
  Cycle cycle{};
  if (!read(step, cycle) || !spindle_turns(step)) {
    return false;
  }
  const Axes end = end_point(step, control_);
  cycle.end_mm = end[2];
  // Depth of pass n is J·n^(1/R): R1 gives equal depths, R2 equal areas of chip, as the area of a V
  // grows with the square of its depth (LinuxCNC manual, G76).
  double number = 1.0;
  for (double depth = cycle.first_mm; depth < cycle.full_mm;
       depth = cycle.first_mm * std::pow(++number, 1.0 / cycle.degression)) {
    pass(cycle, depth);
  }
  // The first pass at full depth, then H spring passes.
  for (double spring = 0.0; spring <= cycle.springs; spring += 1.0) {
    pass(cycle, cycle.full_mm);
  }
  Axes out = state_.position;
  out[0] = cycle.drive_mm;
  out[2] = cycle.end_mm;
  out_.move(MoveKind::rapid, out);
  return true;
}

// X positions of one pass. The drive line is X at the start, the peak is I away from it. The
// compound slide feeds in at its angle: a shallow pass begins and ends earlier by depth·tan.
void Threading::pass(const Cycle& cycle, double depth_mm) {
  const double side = cycle.peak_mm > 0.0 ? 1.0 : -1.0;  // inside: the tool goes outwards
  const double along = cycle.end_mm > cycle.start_mm ? 1.0 : -1.0;
  const double left_mm = cycle.full_mm - depth_mm;
  // Along a taper the tool travels further for the same Z, so the pitch along the path grows by the
  // same ratio.
  const double taper_pitch_mm =
      cycle.taper_mm > 0.0
          ? cycle.pitch_mm * std::hypot(cycle.taper_mm, cycle.full_mm) / cycle.taper_mm
          : cycle.pitch_mm;
  const double clear = cycle.drive_mm - side * left_mm;
  const double surface = clear + cycle.peak_mm;
  const double cut = cycle.drive_mm + cycle.peak_mm + side * depth_mm;
  const double begin = cycle.start_mm + along * depth_mm * cycle.slope;
  const double end = cycle.end_mm - along * left_mm * cycle.slope;
  Axes at = state_.position;
  const auto to = [&](double x, double z) -> const Axes& {
    at[0] = x;
    at[2] = z;
    return at;
  };
  out_.move(MoveKind::rapid, to(clear, begin));
  if (cycle.entry) {
    emit(to(surface, begin), taper_pitch_mm);
    emit(to(cut, begin + along * cycle.taper_mm), taper_pitch_mm);
  } else {
    out_.move(MoveKind::rapid, to(cut, begin));
  }
  if (cycle.exit) {
    emit(to(cut, end - along * cycle.taper_mm), cycle.pitch_mm);
    emit(to(surface + 0.0, end), taper_pitch_mm);
  } else {
    emit(to(cut, end), cycle.pitch_mm);
  }
  out_.move(MoveKind::rapid, to(clear, end));
}

}  // namespace steadyrest::nc::interpret
