// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/uff_function.hpp>
#include <steadyrest/chatter/offline/response/uff_lines.hpp>
#include <steadyrest/chatter/offline/response/uff_values.hpp>
#include <steadyrest/table/text.hpp>

// Universal files are Fortran records of 80 columns: −1 opens and closes a dataset, five title
// lines, record 6 gives the function, record 7 the form of the data, records 8 to 11 the axes.
// Other datasets between the functions are skipped; a truncated one is refused, since a cut-off
// response would fit modes that do not exist.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::Result;
using MaybeRefusal = std::optional<Refusal>;

class FunctionReader {
 public:
  FunctionReader(std::string_view text, const std::string& file, std::span<const int> wanted)
      : lines_(text, file), wanted_(wanted) {}

  Result<std::vector<UffFunction>> read() {
    while (lines_.next()) {
      if (!lines_.is_delimiter()) {
        continue;
      }
      if (!lines_.next()) {
        break;
      }
      if (auto fault = dataset(uff_trimmed(lines_.line()))) {
        return std::unexpected(std::move(*fault));
      }
    }
    if (out_.empty()) {
      Refusal none = lines_.bad("has no dataset 58", "export frequency responses (UFF dataset 58)");
      none.line = 0;
      return std::unexpected(std::move(none));
    }
    // Units may be written behind the functions that they are for.
    for (UffFunction& function : out_) {
      function.units = function.units ? function.units : units_;
    }
    return std::move(out_);
  }

 private:
  MaybeRefusal dataset(std::string_view kind) {
    if (kind == "58" || kind.starts_with("58b") || kind.starts_with("58B")) {
      auto form = uff_form(kind, lines_);
      return form ? function(*form) : MaybeRefusal(std::move(form.error()));
    }
    if (kind == "164") {
      if (auto fault = units()) {
        return fault;
      }
    }
    return lines_.is_delimiter() || lines_.pass_over() ? std::nullopt
                                                       : MaybeRefusal(lines_.truncated());
  }

  /// Code and name; then the factors, which the plain SI may leave out.
  MaybeRefusal units() {
    if (!lines_.next()) {
      return lines_.truncated();
    }
    if (lines_.is_delimiter()) {
      return std::nullopt;
    }
    UffUnits out;
    out.line = lines_.number();
    const auto code = uff_whole(uff_columns(lines_.line(), 0, 10));
    out.name = std::string(table::shown(uff_columns(lines_.line(), 10, 20)));
    if (!lines_.next()) {
      return lines_.truncated();
    }
    const auto words = uff_words(lines_.line());
    const auto factor = [&words](std::size_t i) {
      return (i < words.size() ? uff_number(words[i]) : std::nullopt).value_or(0.0);
    };
    if (lines_.is_delimiter() && code == 1) {
      units_ = std::move(out);
      return std::nullopt;
    }
    out.per_m = factor(0);
    out.per_n = factor(1);
    units_ = std::move(out);
    return std::nullopt;
  }

  MaybeRefusal function(const UffForm& form) {
    constexpr int kTitles = 5;
    UffFunction out;
    for (int i = 0; i < kTitles; ++i) {
      if (!lines_.next()) {
        return lines_.truncated();
      }
      if (i == 0) {
        out.title = std::string(uff_columns(lines_.line(), 0, 80));
      }
    }
    out.units = units_;
    UffAxis z;
    if (auto fault = identity(out)) {
      return fault;
    }
    if (std::ranges::find(wanted_, out.type) == wanted_.end()) {
      return unread(form, std::move(out));
    }
    auto shape = uff_shape(lines_, out.type == kUffTimeResponse);
    if (!shape) {
      return std::move(shape.error());
    }
    // Order of the records is fixed: abscissa, ordinate numerator, denominator, z axis.
    for (UffAxis* axis : {&out.abscissa, &out.numerator, &out.denominator, &z}) {
      if (auto fault = characteristics(*axis)) {
        return fault;
      }
    }
    if (auto fault = uff_values(form, *shape, lines_, out)) {
      return fault;
    }
    out.end = lines_.number();
    if (!lines_.pass_over()) {
      return lines_.truncated();
    }
    out_.push_back(std::move(out));
    return std::nullopt;
  }

  /// A function of another type: only its place and its points are kept.
  MaybeRefusal unread(const UffForm& form, UffFunction&& out) {
    constexpr int kForm = 5;  // records 7 … 11
    for (int i = 0; i < kForm && form.bytes != UffForm::Bytes::none; ++i) {
      if (!lines_.next()) {
        return lines_.truncated();
      }
    }
    if (form.bytes != UffForm::Bytes::none) {
      if (!lines_.ends_after(form.announced)) {
        return lines_.bad(
            fmt::format("{} bytes are announced, but no −1 follows them", form.announced),
            "the file is truncated or was transferred as text; copy it as binary");
      }
      lines_.bytes(form.announced);
    }
    if (!lines_.pass_over()) {
      return lines_.truncated();
    }
    out_.push_back(std::move(out));
    return std::nullopt;
  }

  /// Record 6, by column: 2(I5,I10), 2(1X,10A1,I10,I4). Names may be blank or have blanks.
  MaybeRefusal identity(UffFunction& out) {
    if (!lines_.next()) {
      return lines_.truncated();
    }
    const std::string_view line = lines_.line();
    out.line = lines_.number();
    const auto words = uff_words(line);
    const auto type = words.empty() ? std::nullopt : uff_whole(words.front());
    if (!type) {
      return missing_number();
    }
    out.type = static_cast<int>(*type);
    constexpr std::size_t kResponse = 30;
    constexpr std::size_t kReference = 55;
    constexpr std::size_t kWords = 10;
    out.points_read =
        point(uff_columns(line, kResponse + 1, 10), uff_columns(line, kResponse + 11, 10),
              uff_columns(line, kResponse + 21, 4), out.response) &&
        point(uff_columns(line, kReference + 1, 10), uff_columns(line, kReference + 11, 10),
              uff_columns(line, kReference + 21, 4), out.reference);
    if (!out.points_read && words.size() == kWords) {  // not in columns
      out.points_read = point(words[4], words[5], words[6], out.response) &&
                        point(words[7], words[8], words[9], out.reference);
    }
    return std::nullopt;
  }

  static bool point(std::string_view entity, std::string_view node, std::string_view direction,
                    UffPoint& out) {
    const auto whole = [](std::string_view word) {
      return word.empty() ? std::optional(0L) : uff_whole(word);
    };
    const auto at = whole(node);
    const auto along = whole(direction);
    if (!at || !along || std::abs(*along) > 6) {
      return false;
    }
    out = {entity == "NONE" ? "" : std::string(table::shown(entity)), *at, *along};
    return true;
  }

  [[nodiscard]] Refusal missing_number() const {
    return lines_.bad("a whole number is missing in this record",
                      "the file may be truncated here; export it again");
  }

  /// Records 8 … 11: type (10 columns), three exponents (5 each), label and unit (1 + 20 each).
  MaybeRefusal characteristics(UffAxis& axis) {
    if (!lines_.next()) {
      return lines_.truncated();
    }
    const auto words = uff_words(lines_.line());
    const auto kind = words.empty() ? std::nullopt : uff_whole(words.front());
    if (!kind) {
      return missing_number();
    }
    // By column, not by word: the label before the unit may be blank or contain blanks.
    constexpr std::size_t kLabelAt = 26;
    constexpr std::size_t kUnitAt = 47;
    const auto name = [this](std::size_t at) {
      const std::string_view word = uff_columns(lines_.line(), at, 20);
      return table::lower(word) == "none" ? std::string() : std::string(word);
    };
    axis = {lines_.number(), static_cast<int>(*kind), name(kLabelAt), name(kUnitAt)};
    return std::nullopt;
  }

  UffLines lines_;
  std::span<const int> wanted_;
  std::optional<UffUnits> units_;
  std::vector<UffFunction> out_;
};

}  // namespace

std::string_view uff_type_name(int type) noexcept {
  constexpr std::array<std::string_view, 28> kNames = {"unknown kind",
                                                       "time response",
                                                       "auto spectrum",
                                                       "cross spectrum",
                                                       "frequency response",
                                                       "transmissibility",
                                                       "coherence",
                                                       "auto correlation",
                                                       "cross correlation",
                                                       "power spectral density",
                                                       "energy spectral density",
                                                       "probability density",
                                                       "spectrum",
                                                       "cumulative distribution",
                                                       "peaks and valleys",
                                                       "stress over cycles",
                                                       "strain over cycles",
                                                       "orbit",
                                                       "mode indicator function",
                                                       "force pattern",
                                                       "partial power",
                                                       "partial coherence",
                                                       "eigenvalue",
                                                       "eigenvector",
                                                       "shock response spectrum",
                                                       "filter",
                                                       "multiple coherence",
                                                       "order function"};
  return type >= 0 && static_cast<std::size_t>(type) < kNames.size()
             ? std::span(kNames)[static_cast<std::size_t>(type)]
             : std::string_view("unknown kind");
}

std::string uff_point_name(const UffPoint& point) {
  constexpr std::array kLetters = {"", "X", "Y", "Z", "RX", "RY", "RZ"};
  const auto along = static_cast<std::size_t>(std::abs(point.direction));
  std::string out = point.entity.empty() ? "node " : point.entity + ":";
  out += fmt::format("{}", point.node);
  return along == 0 ? out : out + (point.direction < 0 ? " −" : " +") + kLetters.at(along);
}

Result<std::vector<UffFunction>> read_uff_functions(std::string_view text, const std::string& file,
                                                    std::span<const int> wanted) {
  return FunctionReader(text, file, wanted).read();
}

}  // namespace steadyrest::chatter::offline
