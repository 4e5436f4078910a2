// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <zlib.h>

#include <steadyrest/thermal/offline/log_table.hpp>
#include <steadyrest/thermal/offline/row_splitter.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr std::size_t kMaxBytes = 512U << 20U;
constexpr std::size_t kMaxColumns = 256;

struct Unit {
  std::string_view ending;
  Quantity quantity;
  double factor;
  double offset;
};
constexpr std::array kUnits = {
    Unit{"_um", Quantity::displacement, 1e-3, 0.0},
    Unit{"_mm", Quantity::displacement, 1.0, 0.0},
    Unit{"_c", Quantity::temperature, 1.0, 0.0},
    Unit{"_k", Quantity::temperature, 1.0, -273.15},
    Unit{"_f", Quantity::temperature, 5.0 / 9.0, -160.0 / 9.0},
};
struct Named {
  std::string_view name;
  Quantity quantity;
  double factor;
};
constexpr std::array kNamed = {
    Named{"time_s", Quantity::time, 1.0},
    Named{"t_s", Quantity::time, 1.0},
    Named{"time_ms", Quantity::time, 1e-3},
    Named{"t_ms", Quantity::time, 1e-3},
    Named{"time_min", Quantity::time, 60.0},
    Named{"t_min", Quantity::time, 60.0},
    Named{"time_h", Quantity::time, 3600.0},
    Named{"t_h", Quantity::time, 3600.0},
    Named{"spindle_rpm", Quantity::speed, 1 / 60.0},
    Named{"speed_rpm", Quantity::speed, 1 / 60.0},
};

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return out;
}

LogColumn column_named(std::string_view name) {
  LogColumn out;
  out.name = std::string(name);
  const std::string low = lower(name);
  if (const auto* found = std::ranges::find(kNamed, low, &Named::name); found != kNamed.end()) {
    out.quantity = found->quantity;
    out.factor = found->factor;
    return out;
  }
  for (const Unit& unit : kUnits) {
    if (low.size() > unit.ending.size() && low.ends_with(unit.ending)) {
      out.quantity = unit.quantity;
      out.factor = unit.factor;
      out.offset = unit.offset;
      return out;
    }
  }
  return out;
}

/// An absent value, as loggers write it.
bool absent(std::string_view field) {
  const std::string low = lower(field);
  return low.empty() || low == "nan" || low == "-" || low == "null" || low == "na" || low == "n/a";
}

class TableReader {
 public:
  explicit TableReader(std::string file) : file_(std::move(file)) {}

  Result<LogTable> read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) {
      text.remove_prefix(kByteOrderMark.size());
    }
    while (!text.empty() && !fault_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      if (const auto row = trimmed(text.substr(0, end)); !row.empty() && row.front() != '#') {
        split(text.substr(0, end));
        fields_of_head_ == 0 ? take_head() : take_row();
      }
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!fault_ && fields_of_head_ == 0) {
      line_ = 0;
      refuse("the log is empty", "give a CSV with a head and rows");
    }
    if (fault_) {
      return std::unexpected(std::move(*fault_));
    }
    finish();
    return std::move(out_);
  }

 private:
  void refuse(std::string what, std::string to_do) {
    fault_ = Refusal{Kind::bad_input, file_, line_, std::move(what), std::move(to_do)};
  }

  void split(std::string_view row) {
    if (fields_of_head_ == 0) {
      splitter_.head(row);
    }
    splitter_.split(row, fields_);
  }

  void take_head() {
    out_.head_line = line_;
    fields_of_head_ = fields_.size();
    if (fields_of_head_ > kMaxColumns) {
      return refuse(fmt::format("{} columns; {} are allowed", fields_of_head_, kMaxColumns),
                    "leave out what is not needed");
    }
    for (const std::string_view name : fields_) {
      all_.push_back(column_named(name));
    }
    need(Quantity::time, "a time", "name one column time_s (or t_s, time_min)");
    need(Quantity::speed, "the spindle's speed", "name one column spindle_rpm");
    need(Quantity::displacement, "a displacement",
         "name the displacements with their unit: ch1_um, z_um, x_mm");
    for (std::size_t i = 1; i < fields_.size() && !fault_; ++i) {
      const auto before = fields_.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(fields_.begin(), before, fields_[i]) != before && !fields_[i].empty()) {
        refuse(fmt::format("the column {} stands twice in the head", shown(fields_[i])),
               "give each column its own name");
      }
    }
  }

  void need(Quantity quantity, std::string_view what, std::string_view to_do) {
    const auto count = std::ranges::count(all_, quantity, &LogColumn::quantity);
    if (fault_ || (count == 1 || (count > 1 && quantity == Quantity::displacement))) {
      return;
    }
    refuse(count == 0 ? fmt::format("the head has no column for {}", what)
                      : fmt::format("the head has {} columns for {}", count, what),
           std::string(to_do));
  }

  void take_row() {
    if (fields_.size() != fields_of_head_) {
      return refuse(
          fmt::format("the row has {} fields, the head {}", fields_.size(), fields_of_head_),
          "give each row a field for each column, decimals with a point");
    }
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      LogColumn& column = all_[i];
      if (column.quantity == Quantity::other) {
        continue;
      }
      double value = std::numeric_limits<double>::quiet_NaN();
      if (!absent(fields_[i])) {
        const char* const begin = std::to_address(fields_[i].begin());
        const char* const end = std::to_address(fields_[i].end());
        const auto parsed = std::from_chars(begin, end, value);
        if (parsed.ec != std::errc{} || parsed.ptr != end || !std::isfinite(value)) {
          return refuse(
              fmt::format("{} = \"{}\" is not a finite number", column.name, shown(fields_[i])),
              "write numbers with a decimal point; leave the field empty where there is no value");
        }
      }
      column.value.push_back(column.factor * value + column.offset);
    }
    out_.line.push_back(line_);
  }

  void finish() {
    for (LogColumn& column : all_) {
      if (column.quantity == Quantity::other) {
        out_.passed_over.push_back(column.name);
      } else {
        out_.column.push_back(std::move(column));
      }
    }
  }

  std::string file_;
  std::size_t line_ = 0;
  RowSplitter splitter_;
  std::size_t fields_of_head_ = 0;
  std::vector<std::string_view> fields_;
  std::vector<LogColumn> all_;
  std::optional<Refusal> fault_;
  LogTable out_;
};

struct CloseGzip {
  void operator()(gzFile file) const noexcept { gzclose_r(file); }
};

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out(text.substr(0, kMost));
  std::ranges::replace_if(
      out, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text.size() > kMost ? out + "…" : out;
}

Result<std::string> read_packed(const std::string& path) {
  const auto refuse = [&](Kind kind, std::string what, std::string to_do) {
    return std::unexpected(Refusal{kind, path, 0, std::move(what), std::move(to_do)});
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return refuse(Kind::bad_input, "is a folder", "give a log as CSV, or CSV packed by gzip");
  }
  const std::unique_ptr<gzFile_s, CloseGzip> in(gzopen(path.c_str(), "rb"));
  if (in == nullptr) {
    return refuse(Kind::bad_input, "cannot be read", "give the path of a log");
  }
  std::string out;
  constexpr unsigned kBlock = 1U << 18U;
  int got = 1;
  while (got > 0 && out.size() <= kMaxBytes) {
    const std::size_t before = out.size();
    out.resize(before + kBlock);
    got = gzread(in.get(), out.data() + before, kBlock);
    out.resize(before + static_cast<std::size_t>(std::max(got, 0)));
  }
  int state = Z_OK;
  gzerror(in.get(), &state);
  if (got < 0 || (state != Z_OK && state != Z_STREAM_END)) {
    return refuse(Kind::bad_input, "is packed, and cut off or damaged",
                  "copy it again, or unpack what can be read");
  }
  if (out.size() > kMaxBytes) {
    return refuse(Kind::bad_input, fmt::format("is larger than {} MB", kMaxBytes >> 20U),
                  "log less often: a row in 15 s is enough");
  }
  return out;
}

Result<LogTable> parse_log_table(std::string_view text, const std::string& file) {
  if (text.find('\0') != std::string_view::npos) {
    return std::unexpected(Refusal{Kind::bad_input, file, 0, "is not text in UTF-8",
                                   "save the log as CSV in UTF-8 or ASCII"});
  }
  return TableReader(file).read(text);
}

}  // namespace steadyrest::thermal::offline
