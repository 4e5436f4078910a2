// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <steadyrest/nc/read/text/name.hpp>

namespace steadyrest::nc::read {

/// What a word's value means, where the dialect can say so for a single word.
enum class Qualifier : std::uint8_t {
  none,
  absolute,     ///< sinumerik AC(…)
  incremental,  ///< sinumerik IC(…)
  text,         ///< a string: T="DRILL", MSG("…")
  fine          ///< sinumerik $P_IFRAME[X,FI]: further than what is stored ($P_UIFR)
};

/// One word of a block: an address and its value.
///
/// The reader delivers finished numbers: it evaluates expressions while reading, as controls do, so
/// the interpreter only ever sees values of one type.
struct Word {
  char letter = 0;  ///< upper case; 0 when the address is a name of several letters
  Qualifier qualifier = Qualifier::none;
  bool decimal_point = false;  ///< the value was written with a decimal point
  bool calculated = false;     ///< the value was an expression
  bool unknown = false;        ///< calculated from a value that the control decides
  bool has_value = false;      ///< sinumerik: SUPA, FNORM, … have none
  double value = 0.0;
  std::string_view name;  ///< sinumerik: the address as written, `CR`, `TURN`, `SUPA`
  std::string_view text;  ///< the whole word as written in the line; of a string, its content
};

/// What a line says about the order of execution: an O-word with its keyword.
enum class FlowKind : std::uint8_t {
  none,
  label,  ///< `O1234` alone: the number of a program or subprogram
  sub,
  endsub,
  call,
  back,  ///< return
  when,  ///< if
  elseif,
  otherwise,  ///< else
  endif,
  loop_while,  ///< while
  endwhile,
  loop_do,  ///< do
  repeat,
  endrepeat,
  leave_loop,   ///< break
  next_turn,    ///< continue
  cycle,        ///< sinumerik CYCLE…( )
  modal_cycle,  ///< sinumerik MCALL; without a label its end
  mark,         ///< heidenhain LBL: a place that calls and jumps name
  mark_end,     ///< heidenhain LBL 0: back from a call
  call_mark,    ///< heidenhain CALL LBL; `count` 1: REP, with the repeats in values[0]
  jump_mark,    ///< heidenhain FN 9 to FN 12: to the label if values[0] is not 0
  call_file     ///< heidenhain CALL PGM
};

// The values are not zeroed for each line: `count` says how many there are.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
struct Flow {
  static constexpr std::size_t kMostArguments = 30;
  FlowKind kind = FlowKind::none;
  Name label;  ///< a whole number, or a name in lower case
  std::size_t count = 0;
  std::uint32_t given = 0;    ///< sinumerik: bit n: value n is not left out
  std::uint32_t unknown = 0;  ///< bit n: the control decides value n
  static constexpr std::uint32_t kUnknownLabel = std::uint32_t{1} << 31U;
  double repeats = 1.0;                       ///< sinumerik: P
  std::array<double, kMostArguments> values;  ///< arguments, condition or returned value
};

/// A comment that a control acts on, and not only shows.
enum class Acting : std::uint8_t {
  none,
  message,  ///< (MSG,…), (DEBUG,…): shown when the moves before it are done
  abort,    ///< (ABORT,…) ends the program
  foreign   ///< (PY,…), ;py,…, (PYRUN,…), (PYRELOAD): what it does only the control knows
};

/// One line of a program, split into words. Reused from line to line: no allocation.
class Block {
 public:
  static constexpr std::size_t kMostWords = 128;

  Block() = default;
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  ~Block() = default;

  void reset(std::uint32_t line) noexcept {
    line_ = line;
    count_ = 0;
    deleted_ = false;
    end_mark_ = false;
    flow_.kind = FlowKind::none;
    acting_ = Acting::none;
    shown_ = words_.data();
  }
  /// Refers to the words of another line with the same text, which must outlive their use.
  void take_words(const Block& other) noexcept {
    count_ = other.count_;
    deleted_ = other.deleted_;
    acting_ = other.acting_;
    comment_ = other.comment_;
    shown_ = other.shown_;
  }
  /// A new word to fill in: only its qualifier (none), `calculated` and `unknown` are set. nullptr
  /// when the block is full.
  [[nodiscard]] Word* add() noexcept {
    if (count_ == kMostWords) {
      return nullptr;
    }
    Word& word = words_[count_++];
    word.qualifier = Qualifier::none;
    word.calculated = false;
    word.unknown = false;
    return &word;
  }
  /// False when the block is full.
  bool push(const Word& word) noexcept {
    if (count_ == kMostWords) {
      return false;
    }
    words_[count_++] = word;
    return true;
  }
  [[nodiscard]] std::span<const Word> words() const noexcept { return {shown_, count_}; }
  [[nodiscard]] std::uint32_t line() const noexcept { return line_; }

  /// The line begins with the block-delete mark `/`.
  [[nodiscard]] bool deleted() const noexcept { return deleted_; }
  void set_deleted() noexcept { deleted_ = true; }
  /// The line is the closing `%`.
  [[nodiscard]] bool end_mark() const noexcept { return end_mark_; }
  void set_end_mark() noexcept { end_mark_ = true; }
  /// Its last comment, where the control acts on it, without the brackets.
  [[nodiscard]] Acting acting() const noexcept { return acting_; }
  [[nodiscard]] std::string_view comment() const noexcept { return comment_; }
  void set_comment(Acting acting, std::string_view comment) noexcept {
    acting_ = acting;
    comment_ = comment;
  }
  /// The line's O-word.
  [[nodiscard]] const Flow& flow() const noexcept { return flow_; }
  [[nodiscard]] Flow& flow() noexcept { return flow_; }

 private:
  std::uint32_t line_ = 0;
  std::size_t count_ = 0;
  bool deleted_ = false;
  bool end_mark_ = false;
  Acting acting_ = Acting::none;
  std::string_view comment_;
  Flow flow_;
  std::array<Word, kMostWords> words_{};
  const Word* shown_ = words_.data();  ///< its own words, or another block's
};

}  // namespace steadyrest::nc::read
