// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include <steadyrest/nc/rewrite/walk/plain_survey.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// Most CAM programs have no subprograms, loops or `/` lines. For those the text shows everything:
// no line is repeated, and tool changes and G43 are words. One pass over the characters then
// replaces a run of the interpreter. Anything else (parameters, O-words, M98, `/`) ends this, and
// survey() runs the program.

/// From `blank` on nothing needs to be done.
enum class Role : std::uint8_t { other, code, round, rest, blank, digit, point, sign, word };

constexpr std::array<Role, 256> roles() {
  std::array<Role, 256> out{};
  out[' '] = out['\t'] = Role::blank;
  // Only G and M words matter to the survey, so other letters, digits and signs are skipped.
  for (unsigned c = '0'; c <= '9'; ++c) {
    out[c] = Role::digit;
  }
  out['.'] = Role::point;
  out['+'] = out['-'] = out['%'] = Role::sign;
  // E and O are missing: O begins an O-word or a program number.
  for (const char c : std::string_view{"ABCDFHIJKLNPQRSTUVWXYZ"}) {
    out[static_cast<unsigned char>(c)] = Role::word;
    out[static_cast<unsigned char>(c - 'A' + 'a')] = Role::word;
  }
  out['G'] = out['g'] = out['M'] = out['m'] = Role::code;
  out['('] = Role::round;
  out[';'] = Role::rest;
  return out;
}

constexpr std::array<Role, 256> kRoles = roles();
constexpr int kMostDigits = 3;

Role role(char c) noexcept {
  return kRoles[static_cast<unsigned char>(c)];
}

/// Weights of a line's characters: 0 where nothing needs to be done, 1 for each G, 256 for anything
/// else that matters. A sum of 1 is a single G and nothing more. No line is long enough for 256 Gs.
constexpr std::array<std::uint32_t, 256> weights() {
  std::array<std::uint32_t, 256> out{};
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = kRoles[c] >= Role::blank ? 0U : 1U << 8U;
  }
  out['G'] = out['g'] = 1U;
  return out;
}

constexpr std::array<std::uint32_t, 256> kWeights = weights();

/// The digits from `at` on, ignoring blanks between them, and how many; `at` moves past them.
std::pair<int, int> digits(std::string_view line, std::size_t& at) noexcept {
  int value = 0;
  int count = 0;
  for (; at < line.size(); ++at) {
    const Role next = role(line[at]);
    if (next != Role::digit && next != Role::blank) {
      break;
    }
    // Counts one digit more than allowed, so that the count shows the excess.
    if (next == Role::digit && count <= kMostDigits) {
      value = 10 * value + (line[at] - '0');
      ++count;
    }
  }
  return {value, count};
}

/// At most one G, a whole number other than 43, and nothing else to be done: nearly all lines.
bool is_simple(std::string_view line) noexcept {
  const auto weight_of = [](char c) { return kWeights[static_cast<unsigned char>(c)]; };
  std::uint32_t weight = 0;
  std::size_t i = 0;
  for (; i + 4 <= line.size(); i += 4) {  // four at once: the sums do not depend on each other
    weight += (weight_of(line[i]) + weight_of(line[i + 1])) +
              (weight_of(line[i + 2]) + weight_of(line[i + 3]));
  }
  for (; i < line.size(); ++i) {
    weight += weight_of(line[i]);
  }
  // No G at all, only axes and the like: no need to look closer.
  if (weight != 1U) {
    return weight == 0;
  }
  std::size_t at = 0;
  while (weight_of(line[at]) == 0) {
    ++at;
  }
  const auto [number, count] = digits(line, ++at);
  // A decimal point may make it G43.1: the slow path decides.
  return count > 0 && count <= kMostDigits && number != 43 &&
         (at == line.size() || role(line[at]) != Role::point);
}

}  // namespace

bool PlainSurvey::look(std::string_view line) {
  ++line_;
  if (!plain_) {
    return false;
  }
  survey_.end_line = line_;
  if (is_simple(line)) {
    return true;
  }
  for (std::size_t at = 0;;) {
    // is_simple() skips roles from `blank` on too.
    while (at < line.size() && role(line[at]) >= Role::blank) {
      ++at;
    }
    if (at >= line.size()) {
      return false;
    }
    const Role now = role(line[at]);
    // A `;` comment goes to the end of the line.
    if (now == Role::rest) {
      return false;
    }
    // An unclosed bracket is left to the reader, which refuses it.
    if (now == Role::round) {
      at = line.find(')', at);
    }
    plain_ =
        now == Role::code ? code(line, at) : now == Role::round && at != std::string_view::npos;
    if (!plain_) {
      return false;
    }
    at += now == Role::round ? 1U : 0U;
  }
}

/// Reads a G or M word at `at` and moves past it. False when it is not a plain one.
bool PlainSurvey::code(std::string_view line, std::size_t& at) {
  const bool m = (static_cast<unsigned char>(line[at]) | 0x20U) == 'm';
  const auto [number, count] = digits(line, ++at);
  if (count == 0 || count > kMostDigits) {
    return false;
  }
  if (at < line.size() && role(line[at]) == Role::point) {  // G43.1; more may round to another code
    if (m || digits(line, ++at).second > 1) {
      return false;
    }
  }
  // G43 to G43.9 apply the tool length, M6 and M61 change the tool.
  if (m && (number == 6 || number == 61)) {
    changed_at_ = line_;
  } else if (!m && number == 43 && changed_at_ != 0) {
    survey_.without_length.emplace_back(changed_at_, line_);
    changed_at_ = 0;
  }
  // M98 and M99 call and return, on some controls M97 too: lines may be repeated.
  return !(m && number >= 97 && number <= 99);
}

kernel::outcome::Result<Survey> survey(const std::string& path, const interpret::Config& config,
                                       PlainSurvey& plain) {
  auto found = plain.take();
  return found ? std::move(*found) : survey(path, config);
}

}  // namespace steadyrest::nc::rewrite
