// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <system_error>

#include <steadyrest/supervisor/wish_text.hpp>

namespace steadyrest::supervisor {
namespace {

using chatter::online::Modulation;

constexpr std::array<std::string_view, 6> kOutcomes = {"taken",    "rejected",     "room_off",
                                                       "no_model", "out_of_range", "listening"};
constexpr std::string_view kModulate = "modulate";
constexpr std::string_view kMeasure = "measure";

/// Words one after another, a space between them.
class Pen {
 public:
  explicit Pen(WishText& text) noexcept : text_(text) {}
  Pen& word(std::string_view word) noexcept {
    if (text_.size > 0) {
      put(" ");
    }
    put(word);
    return *this;
  }
  /// The shortest digits that read back as the same number.
  template <class Number>
  Pen& number(Number value) noexcept {
    std::array<char, 32> digits{};
    const auto [end, fault] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return word({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

 private:
  void put(std::string_view part) noexcept {
    const std::size_t count = std::min(part.size(), text_.bytes.size() - text_.size);
    std::copy_n(part.begin(), count, text_.bytes.begin() + static_cast<std::ptrdiff_t>(text_.size));
    text_.size += count;
  }
  WishText& text_;
};

/// Takes such words off; what is not there makes it bad.
class Words {
 public:
  explicit Words(std::string_view text) noexcept : rest_(text) {}
  std::string_view word() noexcept {
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    const std::string_view out = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    good_ = good_ && !out.empty();
    return out;
  }
  template <class Number>
  Number number() noexcept {
    const std::string_view digits = word();
    Number value{};
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    good_ = good_ && read.ec == std::errc() && read.ptr == digits.data() + digits.size();
    return value;
  }
  void demand(bool what) noexcept { good_ = good_ && what; }
  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] std::string_view rest() const noexcept { return rest_; }

 private:
  std::string_view rest_;
  bool good_ = true;
};

/// A name is one word.
std::string_view name_of(const Measured& measured) noexcept {
  const std::string_view name = measured.name.view();
  return name.empty() || name.find(' ') != std::string_view::npos ? "?" : name;
}

Modulation modulation_of(Words& words) noexcept {
  const auto law = chatter::online::law_of(words.word());
  words.demand(law.has_value());
  Modulation out{.law = law.value_or(chatter::online::Law::constant)};
  out.amplitude_ratio = words.number<double>();
  out.amplitude_rev_s = words.number<double>();
  out.period_s = words.number<double>();
  out.mean_ratio = words.number<double>();
  out.seed = words.number<std::uint64_t>();
  return out;
}

Measured measured_of(Words& words) noexcept {
  Measured out;
  out.axis = words.number<std::size_t>();
  out.name = ShortText<16>(words.word());
  out.displacement_mm = words.number<double>();
  out.sd_mm = words.number<double>();
  return out;
}

}  // namespace

std::string_view word(WishOutcome outcome) noexcept {
  return kOutcomes[std::min(static_cast<std::size_t>(outcome), kOutcomes.size() - 1)];
}

WishText text_of(const Wish& wish, WishOutcome outcome) noexcept {
  WishText text;
  Pen pen(text);
  if (const auto* const modulation = std::get_if<Modulation>(&wish.what)) {
    pen.word(kModulate).word(chatter::online::name(modulation->law));
    pen.number(modulation->amplitude_ratio).number(modulation->amplitude_rev_s);
    pen.number(modulation->period_s).number(modulation->mean_ratio).number(modulation->seed);
  } else if (const auto* const measured = std::get_if<Measured>(&wish.what)) {
    pen.word(kMeasure).number(measured->axis).word(name_of(*measured));
    pen.number(measured->displacement_mm).number(measured->sd_mm);
  }
  pen.word(word(outcome)).word(wish.author.view());
  return text;
}

std::optional<RecordedWish> wish_of(std::string_view text) noexcept {
  Words words(text);
  RecordedWish out;
  const std::string_view kind = words.word();
  if (kind == kModulate) {
    out.wish.what = modulation_of(words);
  } else if (kind == kMeasure) {
    out.wish.what = measured_of(words);
  } else {
    return std::nullopt;
  }
  const auto* const outcome = std::ranges::find(kOutcomes, words.word());
  if (!words.good() || outcome == kOutcomes.end()) {
    return std::nullopt;
  }
  out.outcome = static_cast<WishOutcome>(outcome - kOutcomes.begin());
  out.wish.author = ShortText<64>(words.rest());
  return out;
}

}  // namespace steadyrest::supervisor
