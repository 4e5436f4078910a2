// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/apps/cli/motion/verb_motion_encoder.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/motion/offline/calculus/unit_calculus.hpp>

// The encoder calculus of Kombarov 2011 (KhAI), eqs. 5 to 8: lines per revolution, signal
// frequency, speed and count, from whichever are known. Four counts a line (quadrature).
namespace steadyrest::apps::cli {
namespace motion_encoder {
namespace {

namespace offline = motion::offline;
using kernel::units::mm_min_from_mm_s;
using kernel::units::mm_s_from_mm_min;
using kernel::units::rev_s_from_rpm;
using kernel::units::rpm_from_rev_s;
using offline::Number;

struct Options {
  std::optional<double> max_frequency_hz;
  std::optional<double> lead_mm;
  std::optional<double> feed_mm_min;
  std::optional<double> speed_rpm;
  std::optional<double> lines_per_rev;
  std::optional<double> count_mm;
};

/// Collects the numbers of the answer; the first refusal ends it.
class Sheet {
 public:
  // Collecting on after a fault would print half an answer; only the first refusal is kept.
  Sheet& put(const char* key, const char* name, const Number& value, const char* unit) {
    if (!value && !refusal_) {
      refusal_ = value.error();
    }
    if (!refusal_) {
      answer_.json[key] = *value;
      table_.row({name, fmt::format("{:.6g}{}{}", *value, *unit == '\0' ? "" : " ", unit)});
    }
    return *this;
  }
  Outcome outcome() {
    if (refusal_) {
      return refused(*refusal_);
    }
    answer_.text = table_.text();
    return answer_;
  }

 private:
  Answer answer_;
  Table table_;
  std::optional<Refusal> refusal_;
};

/// Eq. 8: count = lead/(4·lines).
void put_lines(Sheet& sheet, const Options& options, const Number& lines) {
  sheet.put("lines_per_rev", "lines per revolution", lines, "");
  if (!lines) {
    return;
  }
  // What can be bought; a whole number that rounding left a hair too small is still that number.
  const double whole = std::floor(*lines * (1.0 + 1e-12));
  sheet.put("whole_lines_per_rev", "whole lines", whole, "");
  if (options.lead_mm) {
    sheet.put("count_mm", "count", offline::count_of_lines_mm(*options.lead_mm, *lines), "mm");
  }
  sheet.put("count_deg", "count (rotary)", 360.0 / (offline::kCountsPerLine * *lines), "°");
}

/// Revolutions per second of the encoder: the spindle's, or feed over lead. Empty if neither is
/// given.
std::optional<double> turn_rev_s(const Options& options) {
  if (options.speed_rpm) {
    return rev_s_from_rpm(*options.speed_rpm);
  }
  if (options.feed_mm_min && options.lead_mm) {
    return *options.lead_mm > 0.0 ? mm_s_from_mm_min(*options.feed_mm_min) / *options.lead_mm : 0.0;
  }
  return std::nullopt;
}

/// The encoder is known: eq. 5 gives its signal frequency f = lines·n, and eqs. 6 and 7 solved for
/// the speed give the fastest that the electronics follow.
Outcome of_lines(const Options& options, double lines) {
  Sheet sheet;
  put_lines(sheet, options, lines);
  if (const auto turn = turn_rev_s(options)) {
    sheet.put("signal_frequency_hz", "signal frequency", offline::signal_frequency_hz(lines, *turn),
              "Hz");
  }
  if (options.max_frequency_hz) {
    const double limit = *options.max_frequency_hz;
    const Number turn = offline::speed_for_lines_rev_s(limit, lines);
    sheet.put("speed_rpm", "largest speed", turn ? Number(rpm_from_rev_s(*turn)) : turn, "rpm");
    if (options.lead_mm) {
      const Number feed = offline::feed_for_lines_mm_s(limit, *options.lead_mm, lines);
      sheet.put("feed_mm_min", "largest feed", feed ? Number(mm_min_from_mm_s(*feed)) : feed,
                "mm/min");
    }
  }
  return sheet.outcome();
}

/// The speed is known: eq. 6 (feed) or 7 (rev/min) gives the most lines that the frequency limit
/// allows, and eq. 8 the count.
Outcome of_speed(const Options& options) {
  Sheet sheet;
  const double limit = *options.max_frequency_hz;
  if (options.speed_rpm) {
    put_lines(sheet, options, offline::lines_for_speed(limit, rev_s_from_rpm(*options.speed_rpm)));
  } else {
    put_lines(
        sheet, options,
        offline::lines_for_feed(limit, *options.lead_mm, mm_s_from_mm_min(*options.feed_mm_min)));
  }
  return sheet.outcome();
}

/// What is known decides the direction. A known encoder comes before a speed, which then serves
/// only for its signal frequency.
Outcome run(const Options& options) {
  if ((options.feed_mm_min || options.count_mm) && !options.lead_mm) {
    return refused(bad_input("a linear axis needs a lead",
                             "give --lead-mm, the travel per turn of the encoder"));
  }
  if (options.lines_per_rev) {
    return of_lines(options, *options.lines_per_rev);
  }
  if (options.count_mm) {
    const Number lines = offline::lines_of_count(*options.lead_mm, *options.count_mm);
    return lines ? of_lines(options, *lines) : refused(lines.error());
  }
  if (!options.max_frequency_hz) {
    return refused(bad_input("the encoder's frequency limit is missing",
                             "give --max-frequency-hz, or --lines-per-rev for a known encoder"));
  }
  if (!options.feed_mm_min && !options.speed_rpm) {
    return refused(bad_input("neither a speed nor the number of lines is given",
                             "give --feed-mm-min with --lead-mm, or --speed-rpm, to get the lines; "
                             "--lines-per-rev to get the largest speed"));
  }
  return of_speed(options);
}

}  // namespace
}  // namespace motion_encoder

void add_verb_motion_encoder(Session& session, Verb& verb) {
  auto options = std::make_shared<motion_encoder::Options>();
  verb.add_option("--max-frequency-hz", options->max_frequency_hz,
                  "Largest frequency of one channel of the encoder");
  verb.add_option("--lead-mm", options->lead_mm, "Travel of the axis per turn of the encoder");
  auto* feed = verb.add_option("--feed-mm-min", options->feed_mm_min, "Feed of a linear axis");
  verb.add_option("--speed-rpm", options->speed_rpm, "Speed of a spindle in rev/min")
      ->excludes(feed);
  auto* lines = verb.add_option("--lines-per-rev", options->lines_per_rev,
                                "Lines of a known encoder; gives its largest feed and speed");
  verb.add_option("--count-mm", options->count_mm, "Count you want; gives the lines")
      ->excludes(lines);
  check_size(verb);
  session.on(verb, [options](Progress& /*progress*/) { return motion_encoder::run(*options); });
}

}  // namespace steadyrest::apps::cli
