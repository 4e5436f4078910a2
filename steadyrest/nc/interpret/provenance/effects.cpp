// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include <steadyrest/nc/interpret/decode/codes.hpp>
#include <steadyrest/nc/interpret/provenance/effects.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/name.hpp>
#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::string_view kLettersOfAxes = "XYZABCUVW";

/// Of a G word that is not modal, or that moves positions beside its mode.
void add_places(Effects& effects, int code, GGroup group) noexcept {
  const bool cuts = code >= g::kRapid && code <= g::kArcCounterClockwise;
  switch (group) {
    case GGroup::non_modal:
      if (code != g::kDwell) {
        effects.axes = Effects::kAllAxes;
        effects.offsets = effects.offsets ||
                          (code != g::kHome && code != g::kSecondHome && code != g::kMachineFrame);
      }
      break;
    case GGroup::motion:
      // Cycles, probes, splines and threads end where their words alone do not say.
      effects.axes |= cuts || code == g::kCycleEnd ? 0U : Effects::kAllAxes;
      break;
    case GGroup::tool_length:
    case GGroup::work_offset:
      effects.axes = Effects::kAllAxes;
      effects.offsets = true;
      break;
    default:
      break;
  }
}

/// A line that is not executed, character by character.
class Scan {
 public:
  explicit Scan(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) {}

  Skipped run() {
    while (char c = next()) {
      if (c == ';') {
        break;
      }
      if (c == '(') {
        at_ = std::find(at_, end_, ')');
      } else if (c == '#') {
        assignment();
      } else if (c == '@' || c == '^') {
        out_.effects.axes |= 3U;
      } else if (read::is_letter(c)) {
        word(read::upper(c));
      }
    }
    return std::move(out_);
  }

 private:
  char next() noexcept {
    while (at_ != end_ && read::is_blank(*at_)) {
      ++at_;
    }
    return at_ == end_ ? '\0' : *at_++;
  }
  char peek() noexcept {
    while (at_ != end_ && read::is_blank(*at_)) {
      ++at_;
    }
    return at_ == end_ ? '\0' : *at_;
  }
  /// A number in plain digits; false where it is an expression, which is passed over.
  bool number(double& value) {
    std::string digits;
    for (char c = peek(); read::is_digit(c) || c == '.' || c == '-' || c == '+'; c = peek()) {
      digits += c;
      ++at_;
    }
    const read::Number number = read::read_number(digits);
    value = number.value;
    if (!digits.empty() && number.length == digits.size()) {
      return true;
    }
    expression();
    return false;
  }
  /// #5, #<name>, [ … ] or NAME[ … ].
  void expression() {
    while (peek() == '#' || peek() == '-' || peek() == '+') {
      ++at_;
    }
    if (peek() == '<') {
      at_ = std::find(at_, end_, '>');
      at_ += at_ == end_ ? 0 : 1;
      return;
    }
    double ignored = 0.0;
    if (read::is_digit(peek())) {
      number(ignored);
      return;
    }
    while (read::is_letter(peek())) {
      ++at_;
    }
    brackets();
    if (peek() == '/') {  // ATAN[y]/[x]
      ++at_;
      brackets();
    }
  }
  void brackets() {
    if (peek() != '[') {
      return;
    }
    int depth = 0;
    for (; at_ != end_; ++at_) {
      depth += *at_ == '[' ? 1 : *at_ == ']' ? -1 : 0;
      if (depth == 0) {
        ++at_;
        return;
      }
    }
  }
  void assignment() {
    if (peek() == '<') {
      read::Name name;
      const char* const after = read::read_name(at_, end_, name);
      at_ = after == nullptr ? end_ : after;
      out_.names.emplace_back(name.view());
    } else {
      double index = 0.0;
      if (number(index)) {
        out_.numbers.push_back(static_cast<int>(std::clamp(index, 0.0, 1e6)));
      } else {
        out_.any_number = true;
      }
    }
    if (peek() == '=') {
      ++at_;
      double ignored = 0.0;
      number(ignored);
    }
  }
  void word(char letter) {
    double code = 0.0;
    const bool plain = number(code);
    if (letter == 'O') {  // the flow of the program looks at these itself
      at_ = end_;
    } else if (letter != 'N') {
      out_.effects.add(letter, code, plain, false);
    }
  }

  const char* at_;
  const char* end_;
  Skipped out_;
};

}  // namespace

ModeMask modes_of_g(double code, bool settable_frames) noexcept {
  if (settable_frames && (code == 70.0 || code == 71.0 || code == 700.0 || code == 710.0)) {
    return mode(GGroup::units);
  }
  if (settable_frames && code >= 500.0 && code < 600.0) {
    return mode(GGroup::work_offset);
  }
  if (settable_frames && code >= 641.0 && code < 646.0) {
    return mode(GGroup::path_mode);
  }
  const auto found = group_of_g(g::code_of(code));
  return found.known && found.group != GGroup::non_modal ? mode(found.group) : 0;
}

ModeMask modes_of_m(double code) noexcept {
  const auto found = group_of_m(static_cast<int>(code));
  if (!found.known) {
    return 0;
  }
  switch (found.group) {
    case MGroup::tool_change:
      return kToolMode;
    case MGroup::spindle:
      return kSpindleMode;
    case MGroup::coolant:
      return kCoolantMode;
    case MGroup::override_switch:
      return kOverrideMode;
    default:
      return 0;
  }
}

bool Effects::moves() const noexcept {
  return all || ends || program || offsets || axes != 0 || (modes & ~kHarmlessModes) != 0;
}

void Effects::add(const Effects& other) noexcept {
  modes |= other.modes;
  axes |= other.axes;
  offsets = offsets || other.offsets;
  ends = ends || other.ends;
  program = program || other.program;
  input = input || other.input;
  all = all || other.all;
}

void Effects::add(char letter, double code, bool has_code, bool settable_frames) noexcept {
  if (letter == 'G' || letter == 'M') {
    if (!has_code) {
      all = true;
      return;
    }
    if (letter == 'G') {
      modes |= modes_of_g(code, settable_frames);
      const auto found = group_of_g(g::code_of(code));
      add_places(*this, g::code_of(code), found.known ? found.group : GGroup::non_modal);
      return;
    }
    const int m_code = static_cast<int>(code);
    modes |= modes_of_m(code);
    ends = ends || m_code == m::kEnd || m_code == m::kEndAndRewind;
    input = input || m_code == m::kWaitForInput;
    program = program || m_code == m::kCall || m_code == m::kReturn;
    // The control may lift the spindle to change the tool.
    axes |= (modes_of_m(code) & kToolMode) != 0 ? kAllAxes : 0U;
    if (m_code >= m::kKeepModes && m_code <= m::kKeepModesForCall) {
      modes = ~ModeMask{0};
    }
    return;
  }
  if (const auto axis = kLettersOfAxes.find(letter); axis != std::string_view::npos) {
    axes |= std::uint32_t{1} << axis;
  }
  modes |= letter == 'F' ? kFeedMode : letter == 'S' ? kSpeedMode : 0U;
}

Effects effects_of(const read::Block& block, bool settable_frames) noexcept {
  Effects effects;
  for (const read::Word& word : block.words()) {
    if (word.letter == '@' || word.letter == '^') {
      effects.axes |= 3U;
    } else if (word.letter == 0) {
      effects.all = true;
    } else {
      effects.add(word.letter, word.value, true, settable_frames);
    }
  }
  return effects;
}

Skipped skipped(std::string_view line) {
  return Scan(line).run();
}

}  // namespace steadyrest::nc::interpret
