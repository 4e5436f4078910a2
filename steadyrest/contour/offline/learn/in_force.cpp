// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/learn/in_force.hpp>
#include <steadyrest/contour/offline/learn/path_follower.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Motion;

constexpr double kSamples = 1.5;  ///< by which two times may differ
constexpr double kGap = 3.5;      ///< periods between two samples that are a gap
constexpr double kStill_s = 0.1;
constexpr double kStill_mm = 1e-6;
constexpr double kLeastWindow = 5.0;  ///< periods

class Judge {
 public:
  Judge(const PartRecord& record, kernel::signal::PathView path, const PlannedMotion& plan,
        const JudgeConfig& config)
      : record_(record), path_(path), plan_(plan), config_(config) {}

  Judged run() {
    place();
    mark_.assign(record_.size(), Use::learns);
    for (std::size_t from = 0; from < record_.size();) {
      std::size_t to = from + 1;
      while (to < record_.size() && out_.use[to] == out_.use[from]) {
        ++to;
      }
      if (out_.use[from] == Use::learns) {
        compare(from, to);
      }
      from = to;
    }
    spread();
    return std::move(out_);
  }

 private:
  void place() {
    PathFollower follower(path_, config_.near_mm);
    double at = 0.0;
    for (std::size_t i = 0; i < record_.size(); ++i) {
      const auto found = follower.next(record_.command_mm[i]);
      at = found.value_or(at);
      const std::size_t segment = geometry::segment_at(path_, at);
      out_.position_mm.push_back(at);
      out_.segment.push_back(segment);
      const bool cuts = path_[segment].motion == Motion::feed;
      out_.use.push_back(!found ? Use::off_path : cuts ? Use::learns : Use::no_cut);
    }
  }

  /// The samples from … to − 1 are one cut.
  void compare(std::size_t from, std::size_t to) {
    std::size_t first = from;
    double still_from_s = record_.time_s[from];
    double stood_until_s = -1e300;
    for (std::size_t i = from + 1; i < to; ++i) {
      if (record_.time_s[i] - record_.time_s[i - 1] > kGap * record_.period_s) {
        mark(i - 1, i, Use::paused);
        first = i;
      }
      if (geometry::distance(record_.command_mm[i], record_.command_mm[i - 1]) > kStill_mm) {
        still_from_s = record_.time_s[i];
      }
      if (record_.time_s[i] - still_from_s >= kStill_s) {
        stood_until_s = record_.time_s[i];
      }
      while (first < i && record_.time_s[i] - record_.time_s[first + 1] >= config_.window_s) {
        ++first;
      }
      const double passed = record_.time_s[i] - record_.time_s[first];
      const bool whole = passed >= config_.window_s || (i + 1 == to && first == from);
      if (whole && passed > kLeastWindow * record_.period_s && differs(first, i, passed)) {
        const bool stood = stood_until_s >= record_.time_s[first];
        mark(first, i, stood ? Use::paused : Use::overridden);
      }
    }
  }

  [[nodiscard]] bool differs(std::size_t first, std::size_t last, double passed_s) const {
    const auto left = plan_.stay(out_.position_mm[first]);
    const auto arrived = plan_.stay(out_.position_mm[last]);
    const double least = arrived.from_s - left.to_s;
    const double most = arrived.to_s - left.from_s;
    const double room = config_.feed_share * most + kSamples * record_.period_s;
    return passed_s < least - room || passed_s > most + room;
  }

  // A pause is in windows that also contain moves: it wins.
  void mark(std::size_t first, std::size_t last, Use why) {
    for (std::size_t i = first; i <= last; ++i) {
      if (mark_[i] != Use::paused) {
        mark_[i] = why;
      }
    }
  }

  /// Takes the marks over, and what follows them until the servos have settled.
  void spread() {
    double until_s = -1e300;
    Use why = Use::learns;
    for (std::size_t i = 0; i < record_.size(); ++i) {
      const Use found = out_.use[i] == Use::off_path ? Use::off_path : mark_[i];
      if (found != Use::learns) {
        why = found;
        until_s = record_.time_s[i] + config_.settle_s;
      }
      if (out_.use[i] == Use::learns && record_.time_s[i] <= until_s) {
        out_.use[i] = why;
      }
    }
  }

  const PartRecord& record_;
  kernel::signal::PathView path_;
  const PlannedMotion& plan_;
  const JudgeConfig& config_;
  Judged out_;
  std::vector<Use> mark_;
};

}  // namespace

std::string_view reason_of(Use use) noexcept {
  switch (use) {
    case Use::learns:
      return "learnt from";
    case Use::no_cut:
      return "no cut";
    case Use::off_path:
      return "the commands are not on the program's path";
    case Use::paused:
      return "standing still inside the cut";
    case Use::overridden:
      return "another feed than planned";
    case Use::too_large:
      return "more error than the machine file can be wrong by";
  }
  return "";
}

Judged judge(const PartRecord& record, kernel::signal::PathView path, const PlannedMotion& plan,
             const JudgeConfig& config) {
  return Judge(record, path, plan, config).run();
}

}  // namespace steadyrest::contour::offline
