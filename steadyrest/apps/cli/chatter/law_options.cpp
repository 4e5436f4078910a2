// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/law_options.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

using chatter::offline::Process;
using chatter::online::Law;

/// The map of one principal period is a product of pass maps. The pass count is bounded, and so is
/// the number of law periods that may make up one principal period.
constexpr double kMostPasses = 4096.0;  ///< of the solver, in the principal period
constexpr int kMostLawPeriods = 64;
/// Relative mismatch of period and tooth passes: none to speak of, hardly noticeable (0.5 % of
/// RVF), anything.
constexpr double kSame = 1e-10;
constexpr double kNear = 0.005;

/// RVA = amplitude/mean speed is what the theory uses; the shop thinks in rev/min (Haas setting
/// 165) or in per cent of the override. CLI11 has made sure that at most one of the three is given.
Result<double> amplitude(const LawOptions& o, double speed_rpm) {
  if (!o.rva && !o.amplitude_rpm && !o.amplitude_percent) {
    return refuse(fmt::format("--law {} needs an amplitude", o.law),
                  "give --rva, --amplitude-percent or --amplitude-rpm");
  }
  const double rva = o.rva             ? *o.rva
                     : o.amplitude_rpm ? *o.amplitude_rpm / speed_rpm
                                       : kernel::units::ratio_from_percent(*o.amplitude_percent);
  if (!(rva > 0.0 && rva < 1.0)) {
    return refuse(
        fmt::format("the amplitude is {:.6g} of the mean speed; it must be between 0 and 1", rva),
        "the spindle must not stop or reverse; 0.1 … 0.3 is usual");
  }
  return rva;
}

/// RVF = modulation frequency/rotation frequency, so RVF = 1/(period · rev/s).
Result<double> frequency(const LawOptions& o, double speed_rpm) {
  if (!o.rvf && !o.period_s) {
    return refuse(fmt::format("--law {} needs a period", o.law), "give --rvf or --period-s");
  }
  if (o.rvf && !(*o.rvf > 0.0 && std::isfinite(*o.rvf))) {
    return refuse(fmt::format("--rvf {}", *o.rvf), "give a ratio above 0, 0.01 … 0.5 is usual");
  }
  if (o.period_s && !(*o.period_s > 0.0 && std::isfinite(*o.period_s))) {
    return refuse(fmt::format("--period-s {}", *o.period_s), "give a period above 0");
  }
  return o.rvf ? *o.rvf : 1.0 / (*o.period_s * kernel::units::rev_s_from_rpm(speed_rpm));
}

/// The nearest RVF whose law has r periods in a whole number of passes.
/// A law period takes q = N/RVF tooth passes (N teeth; one pass per revolution where the pitch is
/// uneven). The monodromy matrix exists only over a whole number of passes, so r law periods must
/// make up an integer. The loop takes the smallest r at the tightest tolerance that works: exact,
/// then 0.5 %, then the nearest integer whatever it is. In the last round r = 1 nearly always fits,
/// so an irrational RVF costs half a pass at most.
Result<double> rational(double rvf, double passes_per_rev) {
  const double q = passes_per_rev / rvf;
  for (const double near : {kSame, kNear, 0.5}) {
    for (int r = 1; r <= kMostLawPeriods; ++r) {
      const double passes = std::round(q * r);
      if (passes >= 1.0 && passes <= kMostPasses && std::abs(q * r - passes) <= near * passes) {
        return near == kSame ? rvf : passes_per_rev * r / passes;
      }
    }
  }
  return refuse(fmt::format("a modulation period of {:.6g} tooth passes; allowed: {:.3g} … {}", q,
                            1.0 / kMostLawPeriods, kMostPasses),
                "give a shorter period or a larger RVF");
}

}  // namespace

void add_law_options(Verb& verb, LawOptions& options) {
  verb.add_option(
          "--law", options.law,
          "Spindle speed modulation: constant, square, pulse, triangle, sine, random or stop")
      ->check([](const std::string& word) {
        return chatter::online::law_of(word) ? std::string{} : word + " is not a law";
      });
  auto* rva = verb.add_option("--rva", options.rva, "Amplitude over mean speed, 0 … 1");
  auto* rpm = verb.add_option("--amplitude-rpm", options.amplitude_rpm,
                              "Alternatively, the amplitude in rev/min")
                  ->excludes(rva);
  verb.add_option("--amplitude-percent", options.amplitude_percent,
                  "Alternatively, the amplitude in % of the mean speed")
      ->excludes(rva)
      ->excludes(rpm);
  auto* rvf = verb.add_option("--rvf", options.rvf, "Modulation frequency over rotation frequency");
  verb.add_option("--period-s", options.period_s, "Alternatively, the period in s")->excludes(rvf);
  verb.add_option("--seed", options.seed, "Seed of the random law")->capture_default_str();
}

Result<ChosenLaw> chosen_law(const LawOptions& options, const Process& process, double speed_rpm) {
  ChosenLaw out;
  // A number without a law is a forgotten --law, not a constant speed.
  const bool numbers = options.rva || options.rvf || options.amplitude_rpm ||
                       options.amplitude_percent || options.period_s;
  if (options.law.empty() && numbers) {
    return refuse("a modulation without a law", "give --law, for example --law sine");
  }
  if (!options.modulated()) {
    if (numbers) {
      return refuse("--law constant with an amplitude or a period",
                    "leave them out, or name the law that they belong to");
    }
    return out;
  }
  const auto rva = amplitude(options, speed_rpm);
  const auto wanted = rva ? frequency(options, speed_rpm) : rva;
  if (!wanted) {
    return std::unexpected(wanted.error());
  }
  // With uneven pitch the delays differ from tooth to tooth and the cut repeats only once per
  // revolution.
  const bool even = process.even_pitch();
  const auto rvf = rational(*wanted, even ? static_cast<double>(process.tool.teeth) : 1.0);
  if (!rvf) {
    return std::unexpected(rvf.error());
  }
  out.modulation.law = *chatter::online::law_of(options.law);
  out.modulation.rva = *rva;
  out.modulation.rvf = *rvf;
  out.modulation.seed = options.seed;
  // The answer must say when it is about another RVF than the one asked for.
  if (*rvf != *wanted) {
    out.wanted_rvf = *wanted;
  }
  return out;
}

/// The law in the ratios of the literature and, at one speed, in the words of the shop.
void put_law(Json& json, const ChosenLaw& chosen, double speed_rpm) {
  const chatter::offline::Modulation& m = chosen.modulation;
  json["law"] = chatter::online::name(m.law);
  if (m.law == Law::constant) {
    return;
  }
  // Ratios always; rev/min and seconds only where there is one mean speed. A map passes 0.
  json["rva"] = m.rva;
  json["rvf"] = m.rvf;
  if (speed_rpm > 0.0) {
    json["amplitude_rpm"] = m.rva * speed_rpm;
    json["period_s"] = 1.0 / (m.rvf * kernel::units::rev_s_from_rpm(speed_rpm));
  }
  if (m.law == Law::random) {
    json["seed"] = m.seed;
  }
  if (chosen.wanted_rvf) {
    json["wanted_rvf"] = *chosen.wanted_rvf;
  }
}

/// The same in one line; a moved RVF is mentioned, for the answer is about that one.
std::string law_text(const ChosenLaw& chosen, double speed_rpm) {
  const chatter::offline::Modulation& m = chosen.modulation;
  const std::string_view name = chatter::online::name(m.law);
  if (m.law == Law::constant) {
    return std::string(name);
  }
  std::string out = fmt::format(
      "{} ±{:.4g} % ({:.4g} rpm) every {:.4g} s (RVA {:.4g}, RVF {:.6g})", name, 100.0 * m.rva,
      m.rva * speed_rpm, 1.0 / (m.rvf * kernel::units::rev_s_from_rpm(speed_rpm)), m.rva, m.rvf);
  if (chosen.wanted_rvf) {
    out += fmt::format("; RVF changed from {:.6g} to give a whole number of tooth passes",
                       *chosen.wanted_rvf);
  }
  return out;
}

}  // namespace steadyrest::apps::cli
