// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "nc_corrected.hpp"

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>
#include <steadyrest/nc/rewrite/prove/verify.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

// A corrected program is changed at random and given to verify. Whatever it accepts is checked in a
// second way: by the moves of both programs, run from work offsets that verify has not seen.
namespace {

namespace fuzz = steadyrest::fuzz;
namespace interpret = steadyrest::nc::interpret;
namespace rewrite = steadyrest::nc::rewrite;
using interpret::Move;
using interpret::MoveKind;

void require(bool truth, const char* claim) {
  if (!truth) {
    std::fprintf(stderr, "verify has accepted, but not so: %s\n", claim);
    std::abort();
  }
}

struct Lines {
  explicit Lines(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
      lines.emplace_back(text.substr(at, end + 1 - at));
      at = end + 1;
    }
  }
  [[nodiscard]] bool inserted(std::size_t index) const {
    return lines[index].find("STEADYREST ") != std::string::npos;
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const std::string& line : lines) {
      all += line;
    }
    return all;
  }
  std::vector<std::string> lines;
};

class Trace final : public interpret::Sink {
 public:
  void on_move(const Move& move) override {
    // The spline's points lie in the interpreter's memory, which may be gone.
    moves.push_back(move);
    moves.back().spline = {};
  }
  void on_event(const interpret::Event& event) override {
    events.push_back(event);
    events.back().tool_name = {};
  }
  std::vector<Move> moves;
  std::vector<interpret::Event> events;
  interpret::State left;
};

bool run(std::string_view text, const interpret::Config& config, Trace& trace) {
  auto source = steadyrest::nc::read::LineSource::from_text(text);
  auto run = interpret::ProgramRun::make(source, config, trace);
  while (run->step()) {
  }
  trace.left = run->state();
  return run->take().refused.empty();
}

/// Rounding in two different sums may leave 1e-7 mm; the smallest correction is far larger.
bool near(double a, double b) {
  return std::abs(a - b) <= 1e-7;
}

bool near_axes(const interpret::Axes& a, const interpret::Axes& b) {
  return std::ranges::equal(a, b, near);
}

const rewrite::AxisPlan* plan_of(const rewrite::Plan& plan, std::size_t axis) {
  const auto at = std::ranges::find(plan.axes, axis, &rewrite::AxisPlan::index);
  return at == plan.axes.end() ? nullptr : &*at;
}

/// Which correction of the plan a shift is: 0 none, k after step k; −1 an unknown one.
int step_of(const rewrite::AxisPlan* plan, double shift_mm) {
  constexpr double kWritten_mm = 1.28e-3;  // half of the control's least input, 0.0001 inch
  if (near(shift_mm, 0.0)) {
    return 0;
  }
  for (std::size_t i = 0; plan != nullptr && i < plan->steps.size(); ++i) {
    if (std::abs(shift_mm + plan->steps[i].displacement_um * 1e-3) < kWritten_mm) {
      return static_cast<int>(i) + 1;
    }
  }
  return -1;
}

/// The second way: both programs are run from offsets that verify never saw, and their moves are
/// compared in machine coordinates. A correction that is right only for the offsets it was proved
/// with shows here.
class Judge {
 public:
  Judge(const fuzz::Job& job, const Lines& changed) : job_(job), changed_(changed) {}

  void judge() {
    interpret::Config config = job_.config;
    // Offsets with a quarter millimetre, different for each system, so that mixing two of them
    // shows.
    config.external[2] = job_.settings.method == rewrite::Method::fanuc ? -0.75 : 0.0;
    for (std::size_t i = 0; i < config.work_offset.size(); ++i) {
      const double own_mm = 1.5 * static_cast<double>(i);
      config.work_offset[i][0] = -40.25 + own_mm;
      config.work_offset[i][1] = 12.5 - own_mm;
      config.work_offset[i][2] = 7.125 + own_mm;
    }
    Trace before;
    Trace after;
    if (!run(job_.text, config, before)) {
      return;  // with these offsets it is another program
    }
    require(run(changed_.text(), config, after), "the changed program is read");
    const bool beside = rewrite::beside_program(job_.settings.method);
    std::size_t paired = 0;
    // Moves of inserted lines are judged alone; all others go in pairs with the original's.
    for (const Move& move : after.moves) {
      if (changed_.inserted(move.line - 1)) {
        require(!beside, "an R-parameter moves nothing");
        added(move, paired == 0 ? nullptr : &before.moves[paired - 1]);
      } else {
        require(paired < before.moves.size(), "no move more");
        pair(before.moves[paired++], move);
      }
    }
    require(paired == before.moves.size(), "no move less");
    // The head may stop for the operator (fanuc, haas: M0), before all moves.
    std::erase_if(after.events, [&](const interpret::Event& event) {
      return event.kind == interpret::EventKind::stop && event.value == 0.0 &&
             changed_.inserted(event.line - 1) &&
             (after.moves.empty() || event.line < after.moves.front().line);
    });
    require(std::ranges::equal(before.events, after.events,
                               [](const auto& a, const auto& b) {
                                 return a.kind == b.kind && a.value == b.value;
                               }),
            "the same events");
    require(near_axes(before.left.offset, after.left.offset) &&
                near_axes(before.left.external, after.left.external) &&
                std::ranges::equal(before.left.work_offset, after.left.work_offset, near_axes),
            "the offsets are left as they were");
    if (beside) {
      parameters();
    } else {
      all_steps();
    }
  }

 private:
  // Kind, feed and modes must be equal; the end may differ by a correction of the plan, and
  // corrections must come in the plan's order.
  void pair(const Move& before, const Move& after) {
    require(before.kind == after.kind && before.feed_mode == after.feed_mode &&
                before.feed_mm_s == after.feed_mm_s && before.path_mode == after.path_mode &&
                before.path_tolerance_mm == after.path_tolerance_mm &&
                before.turns == after.turns && before.normal == after.normal &&
                before.dwell_s == after.dwell_s && before.spindle_rev_s == after.spindle_rev_s &&
                before.override_locked == after.override_locked,
            "a move of the same kind, feed and modes");
    if (before.kind == MoveKind::dwell) {
      return;
    }
    const interpret::Axes from = machine_of(before, before.end);
    const interpret::Axes to = machine_of(after, after.end);
    for (std::size_t axis = 0; axis < from.size(); ++axis) {
      const double shift_mm = to[axis] - from[axis];
      const auto* const plan =
          rewrite::beside_program(job_.settings.method) ? nullptr : plan_of(job_.plan, axis);
      const int step = step_of(plan, shift_mm);
      require(step >= 0, "a shift that the plan has");
      require(step == 0 || step >= reached_[axis], "the plan's order");
      reached_[axis] = std::max(reached_[axis], step);
    }
    if (before.kind == MoveKind::arc) {
      arc(before, after);
    }
  }

  // An arc is shifted as a whole. Start moved without its centre bends it, and no control complains
  // below some tens of micrometres.
  static void arc(const Move& before, const Move& after) {
    const interpret::Axes start = machine_of(before, before.start);
    const interpret::Axes moved = machine_of(after, after.start);
    const interpret::Axes end = machine_of(before, before.end);
    const interpret::Axes moved_end = machine_of(after, after.end);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool in_plane = before.normal[axis] == 0.0;
      require(!in_plane || near(moved[axis] - start[axis], moved_end[axis] - end[axis]),
              "an arc that is not bent");
    }
  }

  void added(const Move& move, const Move* last) const {
    require(move.kind == MoveKind::rapid && last != nullptr, "what is added is a rapid");
    const interpret::Axes from = machine_of(*last, last->end);
    const interpret::Axes to = machine_of(move, move.end);
    for (std::size_t axis = 0; axis < from.size(); ++axis) {
      require(step_of(plan_of(job_.plan, axis), to[axis] - from[axis]) >= 0,
              "what is added goes to where the axis stood, and what is planned");
    }
  }

  // Every step of the plan is reached. With a wide window two steps may share a place, and the
  // first is then skipped.
  void all_steps() const {
    for (const rewrite::AxisPlan& axis : job_.plan.axes) {
      require(axis.steps.empty() || reached_[axis.index] == static_cast<int>(axis.steps.size()) ||
                  job_.settings.window_s > 10.0,
              "every step of the plan");
    }
  }

  // The values that R50 gets, in order: none but the plan's, zero at the end.
  void parameters() const {
    int reached = 0;
    double value = 0.0;
    for (std::size_t i = 0; i < changed_.lines.size(); ++i) {
      const std::string& line = changed_.lines[i];
      const std::size_t at = line.find("R50=");
      if (!changed_.inserted(i) || at == std::string::npos) {
        continue;
      }
      value = std::strtod(line.c_str() + at + 4, nullptr);
      const int step = step_of(&job_.plan.axes.front(), value);
      require(step == 0 || step > reached, "values of the plan, in its order");
      reached = std::max(reached, step);
    }
    require(value == 0.0, "zero at the end");
    require(reached == static_cast<int>(job_.plan.axes.front().steps.size()), "the last step too");
  }

  const fuzz::Job& job_;
  const Lines& changed_;
  std::array<int, 9> reached_{};
};

/// One edit of the corrected program: what, where (counted among the inserted lines), and with
/// what. Only inserted lines change, because verify compares the others as text.
void edit(Lines& text, std::uint8_t what, std::uint8_t where, std::uint8_t a, std::uint8_t b) {
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < text.lines.size(); ++i) {
    if (text.inserted(i)) {
      own.push_back(i);
    }
  }
  if (own.empty()) {
    return;
  }
  const std::size_t at = own[where % own.size()];
  const auto place = text.lines.begin() + static_cast<long>(at);
  std::string& line = text.lines[at];
  static constexpr std::array<std::string_view, 14> kWords = {
      "G91 ", "G0 ",   "G1 ", "Z0 ", "X1 ",    "M5 ", "G20 ",
      "G55 ", "F100 ", "S1 ", "T1 ", "G4 P1 ", "/",   "G53 "};
  constexpr std::string_view kCharacters = "0123456789.-+ XYZGMPLR[]#();\"";
  switch (what % 9U) {
    case 0:
      text.lines.erase(place);
      break;
    case 1: {  // elsewhere
      const std::string moved = line;
      text.lines.erase(place);
      text.lines.insert(text.lines.begin() + a % (static_cast<long>(text.lines.size()) + 1), moved);
      break;
    }
    case 2:
      text.lines.insert(place, std::string{line});
      break;
    case 3:
      line[a % line.size()] = kCharacters[b % kCharacters.size()];
      break;
    case 4:
      line.insert(a % line.size(), 1, kCharacters[b % kCharacters.size()]);
      break;
    case 5:
      line.erase(a % line.size(), 1);
      break;
    case 6:
      line.insert(a % 2U == 0 ? 0 : line.find_first_of("(;") % line.size(),
                  kWords[b % kWords.size()]);
      break;
    case 7:
      std::swap(line, text.lines[own[a % own.size()]]);
      break;
    default: {  // a line of one's own, with a mark
      const std::string_view mark =
          text.lines[at].find(';') != std::string::npos ? ";STEADYREST x\n" : "(STEADYREST x)\n";
      text.lines.insert(text.lines.begin() + a % (static_cast<long>(text.lines.size()) + 1),
                        std::string{kWords[b % kWords.size()]} + std::string{mark});
    }
  }
}

/// compensate first, then the edits, then verify. A refusal is not a finding; whatever it accepts
/// must survive the judge.
void play(const fuzz::Job& job, std::string_view edits) {
  const fuzz::Files& files = fuzz::files();
  fuzz::write_file(files.original, job.text);
  if (!rewrite::compensate(files.original, files.changed, job.plan, job.config, fuzz::mill(),
                           job.settings)) {
    return;
  }
  Lines changed(fuzz::read_file(files.changed));
  for (std::size_t i = 0; i + 4 <= edits.size(); i += 4) {
    const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(edits[i + k]); };
    edit(changed, byte(0), byte(1), byte(2), byte(3));
  }
  fuzz::write_file(files.changed, changed.text());
  const auto proof = rewrite::verify(files.original, files.changed, job.plan, job.config,
                                     fuzz::mill(), job.settings);
  if (!proof) {
    require(edits.size() >= 4, "what compensate has proved is proved again");
    return;
  }
  require(rewrite::strip(files.changed, files.changed).has_value() &&
              fuzz::read_file(files.changed) == job.text,
          "strip restores the original");
  const Lines whole(changed.text());  // an edit may have joined or parted lines
  Judge(job, whole).judge();
}

}  // namespace

// '0' to '3' for the control, a byte for the plan, a program, and after a NUL groups of four bytes
// that tell how to change the corrected program. Everything else is a program for every control.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  const std::size_t chosen = size < fuzz::kHead ? 99 : static_cast<std::size_t>(data[0]) - '0';
  if (chosen < fuzz::kMethods.size()) {
    const std::size_t nul = std::min(text.find('\0', fuzz::kHead), size);
    fuzz::Job job(text.substr(fuzz::kHead, nul - fuzz::kHead), fuzz::kMethods[chosen], data[1]);
    if (job.plan_it(data[1])) {
      play(job, nul < size ? text.substr(nul + 1) : std::string_view{});
    }
    return 0;
  }
  for (const rewrite::Method method : fuzz::kMethods) {
    fuzz::Job job(text, method, 0);
    if (job.plan_it(0)) {
      play(job, {});
    }
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return fuzz::mutate_program(
      data, size, most, seed,
      {.head = fuzz::kHead, .dialects = 4, .dialect_of = fuzz::kDialectOf.data(), .edits = true});
}
