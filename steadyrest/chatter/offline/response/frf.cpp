// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/chatter/offline/response/uff58.hpp>
#include <steadyrest/chatter/offline/response/uff_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/text/text_check.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// Names and units of a header are read separately, so that any order of differentiation and any
// length unit is converted to displacement in mm/N once, here.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using table::Fault;

/// A column's name and its unit, both in small letters: `real`, `um/n`.
struct Column {
  std::string name;
  std::string unit;
};

Column column_of(std::string_view name) {
  const std::string word = table::lower(name);
  const std::size_t end = word.find_first_of("_([ ");
  Column out{word.substr(0, end), end == std::string::npos ? "" : word.substr(end + 1)};
  std::ranges::replace(out.unit, '_', '/');
  return out;
}

/// A response's unit: mm/N per unit, and how often it is differentiated.
struct Unit {
  std::string_view name;
  double mm_n;
  int order;
};
constexpr std::array kUnits = {
    Unit{"m/n", 1e3, 0},     Unit{"mm/n", 1.0, 0},           Unit{"um/n", 1e-3, 0},
    Unit{"m/s/n", 1e3, 1},   Unit{"mm/s/n", 1.0, 1},         Unit{"m/s2/n", 1e3, 2},
    Unit{"mm/s2/n", 1.0, 2}, Unit{"g/n", kGravity_mm_s2, 2},
};

class FrfSink final : public table::Sink {
 public:
  std::optional<Fault> head(const table::Head& head) override {
    constexpr std::string_view kWay =
        "begin with frequency_hz,real_um_N,imag_um_N or frequency_hz,magnitude_um_N,phase_deg; "
        "coherence may follow";
    const auto bad = [&](std::string what) { return Fault{0, std::move(what), std::string(kWay)}; };
    std::vector<Column> column;
    column.reserve(head.name.size());
    for (const std::string& name : head.name) {
      column.push_back(column_of(name));
    }
    if (column.size() < 3) {
      return bad(fmt::format("the header has {} columns; 3 are needed", column.size()));
    }
    polar_ = column[1].name == "magnitude";
    if (column[0].name != "frequency" || (!polar_ && column[1].name != "real") ||
        column[2].name != (polar_ ? "phase" : "imag")) {
      return bad(fmt::format("the header is {},{},{}", table::shown(column[0].name),
                             table::shown(column[1].name), table::shown(column[2].name)));
    }
    if (column[0].unit != "hz") {
      return Fault{0, fmt::format("frequency in \"{}\"; allowed: Hz", column[0].unit),
                   "write frequency_hz"};
    }
    const auto* const unit = std::ranges::find(kUnits, column[1].unit, &Unit::name);
    if (unit == kUnits.end() ||
        (polar_ ? column[2].unit != "deg" : column[2].unit != column[1].unit)) {
      return bad(fmt::format(R"(units "{}" and "{}"; allowed: m/N, mm/N, um/N, of acceleration )"
                             "m/s2/N, mm/s2/N, g/N, of velocity m/s/N, mm/s/N{}",
                             table::shown(column[1].unit), table::shown(column[2].unit),
                             polar_ ? " and deg" : ", the same in both"));
    }
    out_.measured_order = unit->order;
    mm_n_ = unit->mm_n;
    for (std::size_t i = 3; i < column.size(); ++i) {
      if (column[i].name == "coherence" && !coherence_) {
        coherence_ = i;
      } else if (!head.name[i].empty()) {
        return bad(fmt::format("the column {} is unknown", table::shown(head.name[i])));
      }
    }
    return std::nullopt;
  }

  std::optional<Fault> row(const table::Row& row) override {
    std::array<double, 3> value{};
    for (std::size_t i = 0; i < value.size(); ++i) {
      const auto read = row.number(i);
      if (!read) {
        return read.error();
      }
      value[i] = *read;
    }
    if (!seen_.empty() && !(value[0] > seen_.back())) {
      return Fault{row.line(), fmt::format("frequency {} Hz after {} Hz", value[0], seen_.back()),
                   "sort the rows by rising frequency"};
    }
    seen_.push_back(value[0]);
    double coherence = 1.0;
    if (coherence_) {
      const auto read = row.number(*coherence_);
      if (!read) {
        return read.error();
      }
      coherence = *read;
      if (coherence < 0.0 || coherence > 1.0 + 1e-6) {
        return Fault{row.line(), fmt::format("coherence {:g}; allowed: 0 … 1", coherence),
                     "give the coherence as a ratio, or leave the column out"};
      }
    }
    // At 0 Hz a mobility or an accelerance says nothing about displacement.
    if (!(value[0] > 0.0)) {
      return std::nullopt;
    }
    const std::complex<double> measured =
        polar_ ? mm_n_ * value[1] * std::polar(1.0, value[2] * std::numbers::pi / 180.0)
               : mm_n_ * std::complex<double>(value[1], value[2]);
    const std::complex<double> h = displacement_of(measured, value[0], out_.measured_order);
    if (!possible(h)) {
      return Fault{row.line(), fmt::format("the response at {} Hz is out of range", value[0]),
                   "check the unit in the header"};
    }
    out_.frequency_hz.push_back(value[0]);
    out_.compliance_mm_n.push_back(h);
    if (coherence_) {
      out_.coherence.push_back(coherence);
    }
    return std::nullopt;
  }

  [[nodiscard]] Frf take() { return std::move(out_); }

 private:
  Frf out_;
  std::vector<double> seen_;
  bool polar_ = false;
  double mm_n_ = 1.0;
  std::optional<std::size_t> coherence_;
};

}  // namespace

Result<Frf> parse_frf_csv(std::string_view text, const std::string& file,
                          const table::Format& format) {
  FrfSink sink;
  table::RowReader rows(format, sink);
  auto fault = table::read_rows(text, rows);
  Frf out = sink.take();
  if (!fault && out.frequency_hz.size() < kLeastPoints) {
    fault = Fault{0,
                  fmt::format("has {} points above 0 Hz; at least {} are needed",
                              out.frequency_hz.size(), kLeastPoints),
                  "give the whole response"};
  }
  if (fault) {
    return refuse(file, fault->line, fault->what, fault->to_do);
  }
  return out;
}

Result<std::vector<Frf>> read_frf(const std::string& path, const table::Format& format) {
  auto text = passport::read_text(path);
  if (!text) {
    text.error().to_do = "give a measured response: CSV or universal file format 58";
    return std::unexpected(text.error());
  }
  if (text->size() > passport::kMaxFileBytes) {
    return refuse(path, fmt::format("larger than {} MB", passport::kMaxFileBytes >> 20U),
                  "export the response of the drive point alone");
  }
  std::vector<Frf> out;
  if (is_universal(*text)) {
    auto all = parse_uff58(*text, path);
    if (!all) {
      return std::unexpected(all.error());
    }
    out = std::move(*all);
  } else {
    auto one = parse_frf_csv(*text, path, format);
    if (!one) {
      return std::unexpected(one.error());
    }
    out.push_back(std::move(*one));
  }
  for (Frf& frf : out) {
    frf.file = path;
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
