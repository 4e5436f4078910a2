// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/block_words.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/replace/spindle_words.hpp>
#include <steadyrest/nc/rewrite/replace/survey_program.hpp>
#include <steadyrest/nc/rewrite/text/replaced_text.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::FeedMode;
using interpret::Move;
using interpret::MoveKind;
using kernel::outcome::Result;

constexpr double kSameRatio = 1e-9;

bool same_ratio_of_spans(double a, double b) noexcept {
  return std::abs(a - b) < kSameRatio;
}

const read::Word* word_of(const read::Block& block, char letter) noexcept {
  for (const read::Word& word : block.words()) {
    if (word.letter == letter) {
      return &word;
    }
  }
  return nullptr;
}

bool feeds(const Move& move) noexcept {
  return move.kind == MoveKind::linear || move.kind == MoveKind::arc ||
         move.kind == MoveKind::spline || move.kind == MoveKind::thread;
}

/// Runs a program and divides it at its S words.
class SpanSurvey {
 public:
  SpanSurvey(interpret::ProgramRun& run, KeptMoves& kept, read::Dialect dialect)
      : run_(run), kept_(kept), dialect_(dialect), spans_(1) {}

  void line(std::string_view text) {
    const std::uint32_t number = run_.line();
    if (run_.in_main()) {
      marks_.mark(number, seen_, false);
    }
    // With the switch in its other position a skipped line acts.
    const bool acts = run_.executed() || run_.block().deleted();
    const read::Word* speed = word_of(run_.block(), 'S');
    if (speed != nullptr && acts && is_speed(*speed)) {
      spans_.push_back({});
      SpindleSpan& span = spans_.back();
      span.speed = {number, speed->value};
      span.stays = std::string(fault(*speed, text));
      span.line_fixed = !span.stays.empty();
      fed_ = false;
    }
    if (const read::Word* feed = word_of(run_.block(), 'F'); feed != nullptr && acts && !dwells()) {
      add_feed(number, *feed, text);
    }
    if (run_.at_opaque() && !spans_.empty() && spans_.back().stays.empty()) {
      spans_.back().stays =
          fmt::format("line {} is not understood, and may use the speed in force", number);
    }
    for (const Move& move : kept_.moves) {
      if (feeds(move)) {
        add_cut(number, move);
      }
    }
    kept_.clear();
  }

  std::vector<SpindleSpan> take() {
    for (SpindleSpan& span : spans_) {
      if (marks_.is_repeated(span.speed.line)) {
        span.stays = sentence(Stays::repeated);
        span.line_fixed = true;
      }
      for (const ValueLine& feed : span.feeds) {
        if (span.stays.empty() && marks_.is_repeated(feed.line)) {
          span.stays = feed_fault(feed.line, sentence(Stays::repeated));
        }
      }
      if (span.speed.line == 0) {
        span.stays = "the program does not set the speed";
        span.line_fixed = true;
      }
    }
    return std::move(spans_);
  }

 private:
  /// On a sinumerik F and S of G4 are a time and turns.
  [[nodiscard]] bool dwells() const {
    return dialect_ == read::Dialect::sinumerik &&
           std::ranges::any_of(kept_.moves,
                               [](const Move& move) { return move.kind == MoveKind::dwell; });
  }
  /// Not a limit (G92 S, G25 S) or turns.
  [[nodiscard]] bool is_speed(const read::Word& word) const {
    const interpret::State& state = run_.state();
    const double rpm = kernel::units::rpm_from_rev_s(state.spindle_speed_rev_s);
    constexpr double kSameSpeed = 1e-6;
    const bool limit = std::ranges::any_of(run_.block().words(), [](const read::Word& one) {
      return one.letter == 'G' && interpret::g::code_of(one.value) == interpret::g::kSetOrigin;
    });
    return !limit && !dwells() &&
           (state.surface_speed || std::abs(rpm - word.value) <= kSameSpeed * (1.0 + rpm));
  }
  static std::string feed_fault(std::uint32_t line, std::string_view why) {
    return fmt::format("the feed of line {} must stay: {}", line, why);
  }
  /// Why this word cannot be replaced; empty when it can.
  [[nodiscard]] std::string_view fault(const read::Word& word, std::string_view text) const {
    if (!run_.at_top() || !run_.in_main()) {
      return sentence(Stays::repeated);
    }
    if (run_.block().deleted()) {
      return sentence(Stays::switchable);
    }
    // The letter must be found in the line: no other word may contain it.
    const bool plain = std::ranges::all_of(run_.block().words(), [](const read::Word& w) {
      return w.letter != 0 && w.qualifier != read::Qualifier::text;
    });
    if (is_calculated(word) || !plain) {
      return sentence(Stays::calculated);
    }
    return too_long_to_keep(dialect_, text) ? sentence(Stays::too_long) : std::string_view{};
  }
  void add_feed(std::uint32_t number, const read::Word& feed, std::string_view text) {
    SpindleSpan& span = spans_.back();
    const FeedMode mode = run_.state().feed_mode;
    fed_ = true;
    if (mode == FeedMode::per_revolution) {
      return;
    }
    std::string_view why = fault(feed, text);
    why = mode == FeedMode::inverse_time ? sentence(Stays::feed_mode) : why;
    if (!why.empty() && span.stays.empty()) {
      span.stays = feed_fault(number, why);
    }
    span.feeds.push_back({number, feed.value});
  }
  void add_cut(std::uint32_t number, const Move& move) {
    SpindleSpan& span = spans_.back();
    const interpret::State& state = run_.state();
    if (span.first_cut == 0) {
      span.first_cut = number;
      span.tool = state.tool_in_spindle;
    }
    span.last_cut = number;
    constexpr interpret::ModeMask kOfSpan =
        interpret::kSpeedMode | interpret::kSpindleMode | interpret::kFeedMode |
        mode(interpret::GGroup::feed_mode) | mode(interpret::GGroup::spindle_mode);
    if (run_.doubt().opaque && span.stays.empty()) {
      span.stays = fmt::format("line {} depends on a block that is not understood", number);
    }
    if ((run_.doubt().lost & kOfSpan) != 0 && span.stays.empty()) {
      span.stays = fmt::format("the control decides the speed or the feed of line {}", number);
    }
    span.surface_speed = span.surface_speed || move.surface_speed_mm_s != 0.0;
    if ((move.kind == MoveKind::thread || move.override_locked) && span.stays.empty()) {
      span.stays = fmt::format("line {} taps or cuts a thread", number);
    }
    if (move.feed_mode == FeedMode::per_minute) {
      span.most_feed_mm_s = std::max(span.most_feed_mm_s, move.feed_mm_s);
      if (!fed_ && span.carried_feed == 0.0) {
        span.carried_feed = kernel::units::mm_min_from_mm_s(state.feed_mm_s) / state.feed_unit_mm;
      }
    }
  }

  interpret::ProgramRun& run_;
  KeptMoves& kept_;
  read::Dialect dialect_;
  std::vector<SpindleSpan> spans_;
  Survey marks_;
  std::vector<bool> seen_;
  bool fed_ = false;  ///< an F word since the last S word
};

std::string number_text(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  while (text.find('.') != std::string::npos && (text.back() == '0' || text.back() == '.')) {
    const bool point = text.back() == '.';
    text.pop_back();
    if (point) {
      break;
    }
  }
  return text;
}

}  // namespace

Result<std::vector<SpindleSpan>> spindle_spans(const std::string& program,
                                               const interpret::Config& config) {
  return survey_program<SpanSurvey>(program, config);
}

void keep_carried_feeds(std::vector<SpindleSpan>& spans, std::vector<double>& ratio) {
  for (std::size_t i = spans.size(); i-- > 1;) {
    if (spans[i].carried_feed > 0.0 && spans[i].line_fixed &&
        !same_ratio_of_spans(ratio[i], ratio[i - 1])) {
      ratio[i - 1] = 1.0;
      spans[i - 1].stays =
          fmt::format("line {} takes its feed over and must stay", spans[i].speed.line);
    }
  }
}

Result<NewLines> speed_lines(const std::string& program, read::Dialect dialect,
                             const std::vector<SpindleSpan>& spans,
                             const std::vector<double>& ratio) {
  std::map<std::uint32_t, std::vector<std::string>> words;  // by line
  constexpr int kFeedDecimals = 4;
  const auto feed = [&](std::uint32_t line, double value) {
    words[line].push_back("F" + number_text(value, kFeedDecimals));
  };
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const SpindleSpan& span = spans[i];
    const bool changed = !same_ratio_of_spans(ratio[i], 1.0);
    if (changed) {
      words[span.speed.line].push_back("S" + number_text(span.speed.value * ratio[i], 0));
      for (const ValueLine& one : span.feeds) {
        feed(one.line, one.value * ratio[i]);
      }
    }
    // A feed of the span before is said again where the ratio changes.
    if (i > 0 && span.carried_feed > 0.0 && !same_ratio_of_spans(ratio[i], ratio[i - 1])) {
      feed(span.speed.line, span.carried_feed * ratio[i]);
    }
  }
  NewLines out;
  auto source = SourceLines::open(program);
  if (!source) {
    return std::unexpected(source.error());
  }
  while (source->next()) {
    const auto found = words.find(source->number());
    if (found == words.end()) {
      continue;
    }
    std::string text(source->line());
    for (const std::string& word : found->second) {
      text = with_word(dialect, text, word);
    }
    out[source->number()] = {std::move(text)};
  }
  if (auto whole = source->whole(); !whole) {
    return std::unexpected(whole.error());
  }
  return out;
}

}  // namespace steadyrest::nc::rewrite
