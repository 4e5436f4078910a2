// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/uff58.hpp>
#include <steadyrest/chatter/offline/response/uff_function.hpp>
#include <steadyrest/chatter/offline/response/uff_units.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// A fit needs responses where the force acts, in its direction: of a file with many points only
// those are taken. A direction with a minus turns the response around.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr double kSameFrequency = 1e-6;
constexpr long kLastTranslation = 3;

bool same_place(const UffPoint& a, const UffPoint& b) {
  const bool entity = a.entity.empty() || b.entity.empty() || a.entity == b.entity;
  return entity && a.node == b.node && std::abs(a.direction) == std::abs(b.direction);
}

/// Response and force at one point along one line, or the file does not say where the force is.
bool drive_point(const UffFunction& function) {
  return !function.points_read || !function.reference.stated() ||
         same_place(function.response, function.reference);
}

class FrfMaker {
 public:
  FrfMaker(std::vector<UffFunction> functions, const std::string& file)
      : functions_(std::move(functions)), file_(file) {}

  Result<std::vector<Frf>> make() {
    std::vector<const UffFunction*> drive;
    if (auto fault = choose(drive)) {
      return std::unexpected(std::move(*fault));
    }
    std::vector<Frf> out;
    for (const UffFunction* function : drive) {
      auto frf = converted(*function);
      if (!frf) {
        return std::unexpected(std::move(frf.error()));
      }
      out.push_back(std::move(*frf));
    }
    for (const UffFunction& function : functions_) {
      if (function.type == kUffCoherence) {
        use_coherence(function, drive, out);
      }
    }
    out.front().notes = std::move(notes_);
    return out;
  }

 private:
  [[nodiscard]] Refusal bad(std::size_t line, std::string what, std::string to_do) const {
    return bad_input(file_, line, std::move(what), std::move(to_do));
  }

  /// The responses at the drive point; what is left out is noted.
  std::optional<Refusal> choose(std::vector<const UffFunction*>& drive) {
    const UffFunction* cross = nullptr;
    std::size_t crosses = 0;
    std::map<int, std::size_t> others;
    for (const UffFunction& function : functions_) {
      if (function.type != kUffFrequencyResponse) {
        others[function.type] += function.type == kUffCoherence ? 0 : 1;
      } else if (drive_point(function)) {
        drive.push_back(&function);
      } else {
        cross = cross == nullptr ? &function : cross;
        ++crosses;
      }
    }
    if (drive.empty() && cross == nullptr) {
      const UffFunction& first = functions_.front();
      return bad(first.line,
                 fmt::format("function type {} ({}), and no frequency response (type {})",
                             first.type, uff_type_name(first.type), kUffFrequencyResponse),
                 "export frequency responses");
    }
    if (drive.empty()) {
      return bad(cross->line,
                 fmt::format("the response of {} to a force at {}, and none at its own point{}",
                             uff_point_name(cross->response), uff_point_name(cross->reference),
                             crosses > 1 ? fmt::format(" among {}", crosses) : std::string()),
                 "export the drive point: hammer and sensor at the same point, in the same "
                 "direction");
    }
    for (const auto& [type, count] : others) {
      if (count > 0) {
        notes_.push_back(
            fmt::format("{} of function type {} ({}) skipped", count, type, uff_type_name(type)));
      }
    }
    return one_point(drive, crosses);
  }

  std::optional<Refusal> one_point(const std::vector<const UffFunction*>& drive,
                                   std::size_t crosses) {
    const UffFunction& first = *drive.front();
    for (const UffFunction* other : drive) {
      if (drive.size() > 1 &&
          (!other->points_read || !same_place(other->response, first.response))) {
        return bad(other->line,
                   fmt::format("responses at {} and at {}: they are not one measurement",
                               uff_point_name(first.response), uff_point_name(other->response)),
                   "export the point and the direction of the fit alone");
      }
    }
    if (std::abs(first.response.direction) > kLastTranslation) {
      return bad(first.line, fmt::format("a rotation: {}", uff_point_name(first.response)),
                 "export the response of a displacement to a force");
    }
    if (crosses > 0) {
      notes_.push_back(fmt::format("{} taken, the drive point; {} {} of other points skipped",
                                   uff_point_name(first.response), crosses,
                                   crosses == 1 ? "response" : "responses"));
    }
    if (!first.points_read || !first.reference.stated()) {
      notes_.emplace_back("where the force acted is not stated; taken as the drive point");
    }
    return std::nullopt;
  }

  Result<Frf> converted(const UffFunction& function) {
    if (!function.complex()) {
      return std::unexpected(
          bad(function.line + 1,
              fmt::format("ordinate data type {}; complex is 5 (single) or 6 (double)",
                          function.number_type),
              "export real and imaginary part"));
    }
    auto hz = hz_of(function);
    auto scale = hz ? scale_of(function) : std::unexpected(hz.error());
    if (!scale) {
      scale.error().file = file_;
      return std::unexpected(std::move(scale.error()));
    }
    if (*hz != 1.0) {
      const std::string note = fmt::format(
          "abscissa in {} converted to Hz",
          function.abscissa.unit.empty() ? function.abscissa.label : function.abscissa.unit);
      if (std::ranges::find(notes_, note) == notes_.end()) {
        notes_.push_back(note);
      }
    }
    // −X over −X is +X over +X; one minus alone turns the response around.
    const bool turned = function.points_read && function.reference.stated() &&
                        (function.response.direction < 0) != (function.reference.direction < 0);
    if (turned) {
      notes_.push_back(fmt::format("response along {} to a force along {}: sign reversed",
                                   uff_point_name(function.response),
                                   uff_point_name(function.reference)));
    }
    return sampled(function, *hz, turned ? -scale->mm_n : scale->mm_n, scale->order);
  }

  Result<Frf> sampled(const UffFunction& function, double hz, double mm_n, int order) const {
    Frf frf;
    frf.measured_order = order;
    if (function.points_read && function.response.direction != 0) {
      UffPoint point = function.response;
      point.direction = std::abs(point.direction);
      frf.point = uff_point_name(point);
    }
    double last = -1.0;
    for (std::size_t i = 0; i < function.at.size(); ++i) {
      const double f = hz * function.at[i];
      if (!(f > last)) {
        return std::unexpected(bad(function.end,
                                   fmt::format("frequency {} Hz after {} Hz", f, last),
                                   "export with rising frequencies"));
      }
      last = f;
      // Division by (iω)² or iω: at 0 Hz acceleration and velocity say nothing about displacement.
      if (f <= 0.0) {
        continue;
      }
      const std::complex<double> compliance = displacement_of(mm_n * function.value[i], f, order);
      if (!possible(compliance)) {
        return std::unexpected(bad(function.end,
                                   fmt::format("the response at {} Hz is out of range", f),
                                   "check the units"));
      }
      frf.frequency_hz.push_back(f);
      frf.compliance_mm_n.push_back(compliance);
    }
    if (frf.frequency_hz.size() < kLeastPoints) {
      return std::unexpected(bad(function.end,
                                 fmt::format("{} points above 0 Hz; at least {} are needed",
                                             frf.frequency_hz.size(), kLeastPoints),
                                 "give the whole response"));
    }
    return frf;
  }

  /// Whether a coherence is of these points; of a file's only two functions, whatever it names.
  [[nodiscard]] bool belongs(const UffFunction& coherence, const UffFunction& response) const {
    return functions_.size() == 2 ||
           (same_place(response.response, coherence.response) &&
            (!coherence.reference.stated() || same_place(response.reference, coherence.reference) ||
             same_place(response.response, coherence.reference)));
  }

  void use_coherence(const UffFunction& coherence, const std::vector<const UffFunction*>& drive,
                     std::vector<Frf>& out) {
    std::string why = "it is of none of the responses taken";
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!belongs(coherence, *drive[i]) || !out[i].coherence.empty()) {
        continue;
      }
      const auto unfit = put(coherence, out[i]);
      if (!unfit) {
        notes_.push_back(fmt::format("coherence of {} read", uff_point_name(coherence.response)));
        return;
      }
      why = *unfit;
    }
    notes_.push_back(fmt::format("the coherence in line {} is not used: {}", coherence.line, why));
  }

  /// Why it cannot be used, if it cannot.
  static std::optional<std::string> put(const UffFunction& coherence, Frf& out) {
    constexpr double kRounding = 1e-4;  // of single precision and few digits
    const auto hz = hz_of(coherence);
    if (!hz || coherence.complex()) {
      return hz ? "its values are complex" : hz.error().what;
    }
    std::vector<double> found;
    std::size_t at = 0;
    for (const double f : out.frequency_hz) {
      while (at < coherence.at.size() && *hz * coherence.at[at] < f * (1.0 - kSameFrequency)) {
        ++at;
      }
      if (at == coherence.at.size() || *hz * coherence.at[at] > f * (1.0 + kSameFrequency)) {
        return fmt::format("it has no value at {:.6g} Hz", f);
      }
      const double value = coherence.value[at].real();
      if (!(value >= -kRounding && value <= 1.0 + kRounding)) {
        return fmt::format("{:.4g} at {:.6g} Hz; allowed: 0 … 1", value, f);
      }
      found.push_back(std::clamp(value, 0.0, 1.0));
    }
    out.coherence = std::move(found);
    return std::nullopt;
  }

  std::vector<UffFunction> functions_;
  const std::string& file_;
  std::vector<std::string> notes_;
};

}  // namespace

Result<std::vector<Frf>> parse_uff58(std::string_view text, const std::string& file) {
  constexpr std::array kFitTypes = {kUffFrequencyResponse, kUffCoherence};
  auto functions = read_uff_functions(text, file, kFitTypes);
  if (!functions) {
    return std::unexpected(std::move(functions.error()));
  }
  return FrfMaker(std::move(*functions), file).make();
}

}  // namespace steadyrest::chatter::offline
