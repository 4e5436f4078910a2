// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Axes;
using interpret::GGroup;
using interpret::MoveKind;
using interpret::Step;
using kernel::outcome::Result;

namespace {

// What a line may hold to be a place (README, "The law of a safe place"): a list of what is
// allowed, so that an unforeseen word never makes a place.
constexpr std::array kPlainG = {0.0, 1.0, 17.0, 18.0, 19.0, 40.0, 61.0, 64.0, 80.0, 90.0, 94.0};
constexpr std::array kPlainM = {3.0, 4.0, 5.0, 7.0, 8.0, 9.0};
constexpr std::array<std::string_view, 4> kFrameWords = {"TRANS", "ATRANS", "ROT", "AROT"};

bool straight(MoveKind kind) noexcept {
  return kind == MoveKind::rapid || kind == MoveKind::linear || kind == MoveKind::dwell;
}

bool is(std::string_view name, std::string_view upper_name) noexcept {
  return std::ranges::equal(
      name, upper_name, {}, [](char c) { return c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c; },
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

Walk::Walk(read::LineSource source, const interpret::Config& config, const Survey& survey,
           const Way& way)
    : source_(std::move(source)),
      survey_(survey),
      said_(config),
      rules_(interpret::rules_of(config.dialect)),
      start_known_(config.start_known),
      mill_(config.axes.find('Y') != std::string::npos),
      method_(way.method),
      external_free_(way.method == Method::fanuc && way.external_offset_free) {}

Result<std::unique_ptr<Walk>> Walk::open(const std::string& path, const interpret::Config& config,
                                         const Survey& survey, const Way& way) {
  auto source = read::LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  std::unique_ptr<Walk> made(new Walk(std::move(*source), config, survey, way));
  auto run = interpret::ProgramRun::make(made->source_, config, made->kept_);
  if (!run) {
    return std::unexpected(run.error());
  }
  made->run_.emplace(std::move(*run));
  return made;
}

Result<std::unique_ptr<Walk>> Walk::make(const std::string& path, const interpret::Config& config,
                                         const Survey& survey, const Way& way) {
  auto made = open(path, config, survey, way);
  if (made && survey.other) {
    auto other = open(path, switched(config), *survey.other, way);
    if (!other) {
      return std::unexpected(other.error());
    }
    (*made)->other_ = std::move(*other);
  }
  return made;
}

// The state before the next line.
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
    before_.known |= before_.given;
    return;
  }
  const Axes offset = before_.offset;
  const bool turned = before_.rotation_deg != state.rotation_in_force_deg;
  before_.offset = state.offset;
  before_.active_offset = state.active_offset;
  before_.work_offset_on = state.work_offset_on;
  before_.unit_mm = state.unit_mm;
  before_.incremental = state.incremental;
  before_.inverse_time = state.feed_mode == interpret::FeedMode::inverse_time;
  before_.cutter = state.cutter_side != 0;
  before_.rotation_deg = state.rotation_in_force_deg;
  before_.diameter = state.diameter;
  const auto differing = [](const Axes& a, const Axes& b) {
    std::uint32_t out = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      out |= static_cast<std::uint32_t>(a[i] != b[i]) << i;
    }
    return out;
  };
  // X and Y: rotations are about Z.
  constexpr std::uint32_t kInPlane = 0b11;
  // A tool length, shift, reference point or probe may affect any axis: the values in force at the
  // start are unknown.
  std::uint32_t lost = facts_.loses || facts_.shifts ? ~0U : differing(state.offset, offset);
  lost |= turned ? kInPlane : 0U;
  const bool kept = start_known_ && !facts_.loses;
  before_.known &= kept ? ~0U : ~lost;
  std::uint32_t arc = 0;
  for (const interpret::Move& move : moves()) {
    lost |= move.kind == MoveKind::dwell ? 0U : differing(move.start, move.end);
    arc |= move.kind == MoveKind::arc && state.motion <= 30 && !state.incremental ? named() : 0U;
  }
  before_.given = (before_.given & ~lost) | given();
  // An arc's end is known, but only a straight move sends an axis to a place (given).
  before_.known |= before_.given | arc;
}

/// Axes that the last line names by absolute words, a mask.
std::uint32_t Walk::named() const noexcept {
  std::uint32_t out = 0;
  for (std::uint32_t left = facts_.axes; left != 0; left &= left - 1) {
    out |= std::uint32_t{1}
           << interpret::kAxisOfLetter[static_cast<std::size_t>(std::countr_zero(left))];
  }
  return out;
}

/// Axes that the last line has sent to a place in work coordinates, a mask.
std::uint32_t Walk::given() const noexcept {
  if (moves().size() != 1 || facts_.machine_frame || run_->state().incremental ||
      !straight(moves().front().kind) || run_->state().motion > 10 ||
      !said_.has(mode(GGroup::distance))) {
    return 0;
  }
  return named();
}

bool Walk::step() {
  const bool more = step_alone();
  if (other_ != nullptr) {
    follow();
  }
  return more;
}

// Top-level lines come in the same order in both positions, so the walks meet at each one that both
// execute.
void Walk::follow() {
  while (run_->at_top() && !other_->over_ &&
         !(other_->run_->at_top() && other_->line() >= line())) {
    other_->over_ = !other_->step_alone();
  }
}

/// The other walk is at the same line, and text written there means the same.
bool Walk::together() const noexcept {
  const Before& others = other_->before_;
  return other_->run_->at_top() && other_->line() == line() && others.unit_mm == before_.unit_mm &&
         others.active_offset == before_.active_offset &&
         others.work_offset_on == before_.work_offset_on &&
         others.incremental == before_.incremental;
}

bool Walk::step_alone() {
  remember();
  kept_.clear();
  facts_ = {};
  const bool more = run_->step();
  ++steps_;
  ends_ = std::ranges::any_of(events(), [](const interpret::Event& event) {
    return event.kind == interpret::EventKind::end;
  });
  // From a tool change to its G43 (D) the tool length in force is not the tool's: no line there is
  // a place.
  while (interval_ < survey_.without_length.size() &&
         survey_.without_length[interval_].second < steps_) {
    ++interval_;
  }
  if (run_->at_top()) {
    top_line_ = run_->line();
  }
  if (const interpret::Asked& asked = run_->asked(); asked.any) {
    constexpr std::uint32_t kFirst = 1;
    said_.look(asked, before_.known,
               kFirst << before_.active_offset | kFirst << run_->state().active_offset,
               line_or_call());
  }
  if (run_->executed()) {
    look(run_->block());
    if (external_free_) {
      look_for_external();
    }
  }
  return more;
}

void Walk::look_at_g(const read::Word& word) {
  // As the decoders read it: G[59.3-31.2] is G28.1, although not to the last bit.
  const double code = interpret::g::code_of(word.value) / 10.0;
  if (code == 0.0 || code == 1.0) {
    says_ ? said_.motion() : void();
    return;
  }
  says_ ? said_.look(word) : void();
  facts_.plain = facts_.plain && std::ranges::find(kPlainG, code) != kPlainG.end();
  facts_.machine_frame = facts_.machine_frame || code == 53.0 || code == 28.0 || code == 30.0;
  facts_.data = facts_.data || code == 10.0;
  facts_.reference = facts_.reference || code == 28.1 || code == 30.1;
  // G38 probing, G43, G43.1, G43.2 and G49: after them a position is known only once it is
  // programmed.
  facts_.loses = facts_.loses || facts_.machine_frame || (code > 38.0 && code < 39.0) ||
                 code == 49.0 || (code >= 43.0 && code < 44.0);
  facts_.shifts = facts_.shifts || code == 52.0 || (code >= 92.0 && code < 93.0);
  facts_.settable =
      facts_.settable || (rules_.settable_frames &&
                          ((code >= 54.0 && code <= 57.0) || (code >= 500.0 && code < 600.0)));
}

void Walk::look(const read::Block& block) {
  // The control may have been in another mode until the program set this one.
  constexpr interpret::ModeMask kMeaning =
      mode(GGroup::units) | mode(GGroup::distance) | mode(GGroup::work_offset);
  const bool meaning = said_.has(kMeaning);
  const auto said_before = said_.among(kMeaning);
  // A line that the switch may skip sets nothing.
  says_ = !block.deleted();
  facts_.plain = !block.words().empty();
  for (const read::Word& word : block.words()) {
    look_at(word);
  }
  facts_.loses = facts_.loses || (!meaning && said_.among(kMeaning) != said_before);
}

void Walk::look_at(const read::Word& word) {
  const bool letter = word.letter >= 'A' && word.letter <= 'Z';
  const std::uint32_t bit = letter ? Step::bit(word.letter) : 0U;
  if ((bit & interpret::kAxisMask) != 0) {
    (word.qualifier == read::Qualifier::incremental ? facts_.incremental : facts_.axes) |= bit;
    return;
  }
  switch (word.letter) {
    case 'G':
      look_at_g(word);
      return;
    case 'N':
      return;
    case 'F':
    case 'S':
      says_ ? said_.look(word) : void();
      return;
    case 'M':
      says_ ? said_.look(word) : void();
      facts_.plain = facts_.plain && std::ranges::find(kPlainM, word.value) != kPlainM.end();
      facts_.loses = facts_.loses || word.value == 6.0 || word.value == 61.0;
      return;
    case 'L':
      facts_.data_form = word.value;
      break;
    case 'P':
      facts_.data_set = word.value;
      break;
    default:
      facts_.machine_frame = facts_.machine_frame || is(word.name, "SUPA");
      facts_.loses = facts_.loses || facts_.machine_frame ||
                     (rules_.edge_chooses_length && (word.letter == 'D' || word.letter == 'T'));
      facts_.shifts = facts_.shifts || std::ranges::any_of(kFrameWords, [&](std::string_view name) {
                        return is(word.name, name);
                      });
      break;
  }
  facts_.plain = false;
}

bool Walk::may_write(std::size_t index) const noexcept {
  return may_write_alone(index) &&
         (other_ == nullptr || (together() && other_->may_write_alone(index)));
}

// A rotation is about Z and leaves every axis but X and Y alone. Only X has diameters.
bool Walk::may_write_alone(std::size_t index) const noexcept {
  const interpret::State& now = run_->state();
  const bool turned = before_.rotation_deg != 0.0 || now.rotation_in_force_deg != 0.0;
  return run_->at_top() && run_->executed() && !run_->block().deleted() &&
         !survey_.is_repeated(run_->line()) && !before_.cutter && now.cutter_side == 0 &&
         (!turned || index > 1) && (index != 0 || (!before_.diameter && !now.diameter)) &&
         !now.text_frame.on && now.active_offset < interpret::kWorkOffsets;
}

// No mode before or after the line in which a shift would distort the path.
bool Walk::calm(std::size_t index) const noexcept {
  const interpret::State& now = run_->state();
  const bool with_length = interval_ >= survey_.without_length.size() ||
                           steps_ <= survey_.without_length[interval_].first;
  // None yet, G0, G1 or G80; motions are counted in tenths.
  const bool motion =
      before_.motion == -1 || before_.motion == 0 || before_.motion == 10 || before_.motion == 800;
  return may_write_alone(index) && with_length && motion && facts_.plain && !before_.incremental &&
         !now.incremental && !before_.inverse_time &&
         now.feed_mode != interpret::FeedMode::inverse_time && !before_.diameter && !now.diameter &&
         (!any_move_ || straight(before_.last_move));
}

Site Walk::site(char letter, std::size_t index) const {
  const Site own = missing(index) == nullptr ? site_if_said(letter, index) : Site::none;
  if (own == Site::none || other_ == nullptr) {
    return own;
  }
  // A place must be the same in both positions of block delete, or the switch would change the
  // correction's effect.
  const bool same =
      together() && other_->missing(index) == nullptr &&
      other_->site_if_said(letter, index) == own &&
      (own != Site::clearance || other_->before_.position[index] == before_.position[index]);
  return same ? own : Site::none;
}

const Walk::Unsaid* Walk::unsaid(char letter, std::size_t index) const {
  return site_if_said(letter, index) == Site::none ? nullptr : missing(index);
}

/// What could change the meaning of a correction and the program has not set.
const Walk::Unsaid* Walk::missing(std::size_t index) const noexcept {
  static constexpr Unsaid kDistance{"whether positions are absolute (G90)", "write G90 before it"};
  static constexpr Unsaid kOffset{"which work offset is active",
                                  "write G54 (or the one you mean) before it, or give the "
                                  "control's variable file (--variables)"};
  static constexpr Unsaid kRotation{"whether a rotation is stored in the work offset",
                                    "give the control's variable file (--variables)"};
  static constexpr Unsaid kDiameter{"whether X is a radius (G8)", "write G8 before it"};
  // The PLC or the temperature compensation moves the axis: no mode of the program affects that.
  if (beside_program(method_)) {
    return nullptr;
  }
  if (!said_.has(mode(GGroup::distance))) {
    return &kDistance;
  }
  if (in_work_offset(method_) && !said_.has(mode(GGroup::work_offset))) {
    return &kOffset;
  }
  if (method_ != Method::linuxcnc) {
    return nullptr;
  }
  return index < 2 && !start_known_                                         ? &kRotation
         : index == 0 && !mill_ && !said_.has(mode(GGroup::lathe_diameter)) ? &kDiameter
                                                                            : nullptr;
}

Site Walk::site_if_said(char letter, std::size_t index) const {
  if (moves().size() != 1 || !calm(index)) {
    return Site::none;
  }
  const std::uint32_t bit = Step::bit(letter);
  const interpret::Move& move = moves().front();
  if ((facts_.axes & bit) != 0) {
    return move.kind == MoveKind::rapid    ? Site::rapid
           : move.kind == MoveKind::linear ? Site::feed
                                           : Site::none;
  }
  // An added G0 moves the axis; between two rapids that leaves no mark on the part.
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

}  // namespace steadyrest::nc::rewrite
