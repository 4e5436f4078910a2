// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::FeedMode;
using interpret::Move;
using kernel::outcome::Result;
using kernel::units::mm_min_from_mm_s;
using kernel::units::rpm_from_rev_s;

constexpr double kLeastFeed = 0.2;  ///< of the block's F, where the path is changed
constexpr double kMostFeed = 2.0;
/// F is written with four decimals, S in whole rpm.
constexpr double kRounding_ratio = 1e-4;
constexpr double kRounding_mm_s = 1e-6;

bool same_feed(double a_mm_s, double b_mm_s) noexcept {
  return std::abs(a_mm_s - b_mm_s) <= kRounding_mm_s + kRounding_ratio * std::abs(a_mm_s);
}

/// By how much the spindle turns faster, where the feed may follow it.
double speed_ratio(const Permitted& permitted, const Move& original, const Move& changed) noexcept {
  const bool follows = permitted.speeds && original.feed_mode == FeedMode::per_minute &&
                       original.spindle_rev_s * changed.spindle_rev_s > 0.0;
  return follows ? changed.spindle_rev_s / original.spindle_rev_s : 1.0;
}

std::string feed_text(const Move& move) {
  return move.feed_mode == FeedMode::per_minute
             ? fmt::format("{:.6g} mm/min", mm_min_from_mm_s(move.feed_mm_s))
             : fmt::format("{:.6g} mm/rev", move.feed_mm_s);
}

}  // namespace

Result<Permitted> permitted_of(const std::string& changed, const std::vector<Told>& told,
                               std::optional<double> tube_mm,
                               const kernel::machine::Machine* machine) {
  const auto refuse = [&](std::string what) {
    return kernel::outcome::refuse(changed, std::move(what),
                                   "make the changed program again with this version");
  };
  Permitted out;
  std::optional<double> told_mm;
  for (const Told& one : told) {
    if (one.name == "tube-mm") {
      double value = 0.0;
      const char* const end = one.value.data() + one.value.size();
      const auto read = std::from_chars(one.value.data(), end, value);
      if (read.ptr != end || !(value > 0.0) || !std::isfinite(value)) {
        return refuse(fmt::format("its record says --tube-mm {}, which is no tube", one.value));
      }
      told_mm = value;
    }
    std::string_view rest = one.name == "changes" ? std::string_view(one.value) : "";
    while (!rest.empty()) {
      const std::string_view change = rest.substr(0, rest.find(','));
      rest.remove_prefix(std::min(rest.size(), change.size() + 1));
      if (change != "predistort" && change != "feeds" && change != "speeds" && change != "dwells") {
        return refuse(fmt::format("its record says --changes {}, which is not known", change));
      }
      out.path = out.path || change == "predistort";
      out.feeds = out.feeds || change == "feeds";
      out.speeds = out.speeds || change == "speeds";
      out.dwells = out.dwells || change == "dwells";
    }
  }
  if (!out.path && !out.feeds && !out.speeds) {
    return refuse("the record in its head does not say what was changed");
  }
  out.tube_mm = tube_mm.value_or(told_mm.value_or(out.path ? kUsualTube_mm : kSamePath_mm));
  if (machine != nullptr) {
    out.least_rev_s = machine->spindle.min_rev_s;
    out.most_rev_s = machine->spindle.max_rev_s;
    out.axes = machine->axes;
  }
  return out;
}

std::string feed_fault(const Permitted& permitted, const Move& block, const Move& fresh) {
  if (fresh.feed_mode != block.feed_mode) {
    return "has a feed of another kind";
  }
  const double spindle = speed_ratio(permitted, block, fresh);
  const double most = (permitted.path ? kMostFeed : 1.0) * std::max(1.0, spindle);
  // Lower feeds may be as low as the limit of the error asks for.
  const double least =
      permitted.feeds ? 0.0 : (permitted.path ? kLeastFeed : 1.0) * std::min(1.0, spindle);
  const double feed = fresh.feed_mm_s;
  const bool high = feed > most * block.feed_mm_s * (1.0 + kRounding_ratio) + kRounding_mm_s;
  const bool low = feed < least * block.feed_mm_s * (1.0 - kRounding_ratio) - kRounding_mm_s;
  if (feed > 0.0 && !high && !low) {
    return {};
  }
  return fmt::format("has a feed of {}; in place of {} at {:.6g} to {:.6g} times that is allowed",
                     feed_text(fresh), feed_text(block), least, most);
}

// program feeds writes F only where it changes, and puts it back before a block that must stay.
std::string kept_feed_fault(const Permitted& permitted, const Move& original, const Move& changed,
                            bool replaceable) {
  const double ratio = speed_ratio(permitted, original, changed);
  const bool cuts =
      original.kind == interpret::MoveKind::linear || original.kind == interpret::MoveKind::arc;
  const bool lower = permitted.feeds && replaceable && cuts && !original.override_locked &&
                     changed.feed_mm_s > 0.0 && changed.feed_mm_s < original.feed_mm_s;
  if (original.feed_mode == changed.feed_mode &&
      (lower || same_feed(original.feed_mm_s, changed.feed_mm_s) ||
       same_feed(ratio * original.feed_mm_s, changed.feed_mm_s))) {
    return {};
  }
  return fmt::format("runs at {} in place of {}", feed_text(changed), feed_text(original));
}

std::string spindle_fault(const Permitted& permitted, double original, double changed) {
  if (original == changed) {
    return {};
  }
  std::string at = fmt::format("the spindle turns at {:.6g} rpm in place of {:.6g}",
                               rpm_from_rev_s(changed), rpm_from_rev_s(original));
  if (!permitted.speeds || !(original * changed > 0.0)) {
    return at;
  }
  const double speed = std::abs(changed);
  if (speed < permitted.least_rev_s * (1.0 - kRounding_ratio) ||
      speed > permitted.most_rev_s * (1.0 + kRounding_ratio)) {
    return fmt::format("{}; the machine allows {:.6g} to {:.6g} rpm", at,
                       rpm_from_rev_s(permitted.least_rev_s), rpm_from_rev_s(permitted.most_rev_s));
  }
  return {};
}

}  // namespace steadyrest::nc::rewrite
