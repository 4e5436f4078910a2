// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <steadyrest/nc/interpret/step.hpp>
#include <steadyrest/nc/rewrite/walk.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Axes;
using interpret::MoveKind;
using interpret::Step;
using kernel::outcome::Result;

namespace {

constexpr std::array kPlainG = {0.0, 1.0, 17.0, 18.0, 19.0, 40.0, 61.0, 64.0, 80.0, 90.0, 94.0};
constexpr std::array kPlainM = {3.0, 4.0, 5.0, 7.0, 8.0, 9.0};

bool straight(MoveKind kind) noexcept {
  return kind == MoveKind::rapid || kind == MoveKind::linear || kind == MoveKind::dwell;
}

bool is_supa(std::string_view name) noexcept {
  return std::ranges::equal(
      name, std::string_view{"SUPA"}, {},
      [](char c) { return c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c; },
      [](char c) { return static_cast<int>(c); });
}

}  // namespace

std::string_view name(Site site) noexcept {
  switch (site) {
    case Site::rapid:
      return "rapid";
    case Site::clearance:
      return "clearance";
    case Site::feed:
      return "feed";
    case Site::none:
      break;
  }
  return "none";
}

Result<std::unique_ptr<Walk>> Walk::make(const std::string& path, const interpret::Config& config,
                                         const Survey& survey) {
  auto source = read::LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  std::unique_ptr<Walk> made(new Walk(std::move(*source), survey));
  auto run = interpret::ProgramRun::make(made->source_, config, made->kept_);
  if (!run) {
    return std::unexpected(run.error());
  }
  made->run_.emplace(std::move(*run));
  made->sinumerik_ = config.dialect == read::Dialect::sinumerik;
  return made;
}

// The state as it stands before the next line.
void Walk::remember() {
  const interpret::State& state = run_->state();
  before_.position = state.position;
  before_.motion = state.motion;
  if (!moves().empty()) {
    before_.last_move = moves().back().kind;
    any_move_ = true;
  }
  if (run_->moved_alone() && !state.incremental) {  // nearly always; no other axis has moved
    before_.given |= given();
    return;
  }
  const Axes offset = before_.offset;
  before_.offset = state.offset;
  before_.work_offset = state.work_offset[state.active_offset];
  before_.active_offset = state.active_offset;
  before_.work_offset_on = state.work_offset_on;
  before_.unit_mm = state.unit_mm;
  before_.incremental = state.incremental;
  before_.inverse_time = state.feed_mode == interpret::FeedMode::inverse_time;
  before_.cutter = state.cutter_side != 0;
  before_.rotated = state.rotation_in_force_deg != 0.0;
  before_.diameter = state.diameter;
  std::uint32_t lost = 0;
  const auto add = [&lost](const Axes& a, const Axes& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      lost |= static_cast<std::uint32_t>(a[i] != b[i]) << i;
    }
  };
  add(state.offset, offset);
  for (const interpret::Move& move : moves()) {
    if (move.kind != MoveKind::dwell) {
      add(move.start, move.end);
    }
  }
  before_.given = (before_.given & ~lost) | given();
}

/// Axes that the last line has sent to a place in work coordinates, a mask.
std::uint32_t Walk::given() const noexcept {
  if (moves().size() != 1 || facts_.machine_frame || run_->state().incremental ||
      !straight(moves().front().kind) || run_->state().motion > 10) {
    return 0;
  }
  std::uint32_t out = 0;
  for (std::uint32_t left = facts_.axes; left != 0; left &= left - 1) {
    out |= std::uint32_t{1}
           << interpret::kAxisOfLetter[static_cast<std::size_t>(std::countr_zero(left))];
  }
  return out;
}

bool Walk::step() {
  remember();
  kept_.clear();
  facts_ = {};
  const bool more = run_->step();
  ++steps_;
  ends_ = std::ranges::any_of(events(), [](const interpret::Event& event) {
    return event.kind == interpret::EventKind::end;
  });
  while (interval_ < survey_.without_length.size() &&
         survey_.without_length[interval_].second < steps_) {
    ++interval_;
  }
  if (run_->at_top()) {
    top_line_ = run_->line();
  }
  if (run_->executed()) {
    look(run_->block());
  }
  return more;
}

void Walk::look_at_g(double code) {
  if (code == 0.0 || code == 1.0) {
    return;
  }
  facts_.plain = facts_.plain && std::ranges::find(kPlainG, code) != kPlainG.end();
  facts_.machine_frame = facts_.machine_frame || code == 53.0 || code == 28.0 || code == 30.0;
  facts_.data = facts_.data || code == 10.0;
  facts_.settable =
      facts_.settable ||
      (sinumerik_ && ((code >= 54.0 && code <= 57.0) || (code >= 500.0 && code < 600.0)));
}

void Walk::look(const read::Block& block) {
  facts_.plain = !block.words().empty();
  for (const read::Word& word : block.words()) {
    const bool letter = word.letter >= 'A' && word.letter <= 'Z';
    const std::uint32_t bit = letter ? Step::bit(word.letter) : 0U;
    if ((bit & interpret::kAxisMask) != 0) {
      (word.qualifier == read::Qualifier::incremental ? facts_.incremental : facts_.axes) |= bit;
    } else if (word.letter == 'G') {
      look_at_g(word.value);
    } else if (word.letter == 'M') {
      facts_.plain = facts_.plain && std::ranges::find(kPlainM, word.value) != kPlainM.end();
    } else if (word.letter == 'L') {
      facts_.data_form = word.value;
      facts_.plain = false;
    } else if (word.letter == 'P') {
      facts_.data_set = word.value;
      facts_.plain = false;
    } else if (word.letter != 'F' && word.letter != 'S' && word.letter != 'N') {
      facts_.plain = false;
      facts_.machine_frame = facts_.machine_frame || is_supa(word.name);
    }
  }
}

bool Walk::may_write() const noexcept {
  const interpret::State& now = run_->state();
  return run_->at_top() && run_->executed() && !run_->block().deleted() &&
         !survey_.is_repeated(run_->line()) && !before_.cutter && now.cutter_side == 0 &&
         !before_.rotated && now.rotation_in_force_deg == 0.0;
}

// No mode in force, before and behind the line, in which a shift would bend something.
bool Walk::calm() const noexcept {
  const interpret::State& now = run_->state();
  const bool with_length = interval_ >= survey_.without_length.size() ||
                           steps_ <= survey_.without_length[interval_].first;
  const bool motion =
      before_.motion == -1 || before_.motion == 0 || before_.motion == 10 || before_.motion == 800;
  return may_write() && with_length && motion && facts_.plain && !before_.incremental &&
         !now.incremental && !before_.inverse_time &&
         now.feed_mode != interpret::FeedMode::inverse_time && !before_.diameter && !now.diameter &&
         (!any_move_ || straight(before_.last_move));
}

Site Walk::site(char letter, std::size_t index) const {
  if (moves().size() != 1 || !calm()) {
    return Site::none;
  }
  const std::uint32_t bit = Step::bit(letter);
  const interpret::Move& move = moves().front();
  if ((facts_.axes & bit) != 0) {
    return move.kind == MoveKind::rapid    ? Site::rapid
           : move.kind == MoveKind::linear ? Site::feed
                                           : Site::none;
  }
  const bool between_rapids = any_move_ && before_.last_move == MoveKind::rapid &&
                              move.kind == MoveKind::rapid && before_.motion == 0;
  const bool given = (before_.given & (std::uint32_t{1} << index)) != 0;
  return between_rapids && given && (facts_.incremental & bit) == 0 ? Site::clearance : Site::none;
}

bool Walk::moves_axis(std::size_t index) const noexcept {
  return std::ranges::any_of(moves(), [index](const interpret::Move& move) {
    return move.kind != MoveKind::dwell && move.start[index] != move.end[index];
  });
}

Frame Walk::frame(char letter, std::size_t index) const {
  const interpret::State& now = run_->state();
  if (now.active_offset != before_.active_offset || now.work_offset_on != before_.work_offset_on ||
      facts_.settable) {
    return Frame::changed;
  }
  if (!facts_.data || (facts_.axes & Step::bit(letter)) == 0) {
    return Frame::kept;
  }
  const bool of_active =
      facts_.data_set <= 0.0 || facts_.data_set == static_cast<double>(now.active_offset) + 1.0;
  if (facts_.data_form == 20.0) {
    return of_active ? Frame::kept : Frame::measured;
  }
  return of_active && now.work_offset[now.active_offset][index] != before_.work_offset[index]
             ? Frame::changed
             : Frame::kept;
}

}  // namespace steadyrest::nc::rewrite
