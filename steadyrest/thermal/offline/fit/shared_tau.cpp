// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <steadyrest/thermal/offline/fit/shared_tau.hpp>

// Two probes of one body should show one time constant. Axes are paired from the most alike on, as
// in agglomerative clustering; each merger refits all members with the mean τ and stays only if the
// evidence lost is less than the value of the saved parameters.
namespace steadyrest::thermal::offline {
namespace {

constexpr double kLeastSd = 0.005;  ///< of ln τ; nothing is more certain
constexpr double kTooFar = 1.0;     ///< in ln τ: not worth a trial

using Group = std::vector<std::size_t>;

/// ln τ of each mode, then of those with a separate one at rest.
std::vector<double> ln_taus(const Structure& s) {
  std::vector<double> out;
  out.reserve(2 * s.mode.size());
  for (const Structure::Mode& m : s.mode) {
    out.push_back(std::log(m.tau_s));
  }
  for (const Structure::Mode& m : s.mode) {
    if (m.rest_tau_s > 0.0) {
      out.push_back(std::log(m.rest_tau_s));
    }
  }
  return out;
}

void set_ln_taus(Structure& s, const std::vector<double>& ln_tau) {
  std::size_t at = 0;
  for (Structure::Mode& m : s.mode) {
    m.tau_s = std::exp(ln_tau[at++]);
  }
  for (Structure::Mode& m : s.mode) {
    if (m.rest_tau_s > 0.0) {
      m.rest_tau_s = std::exp(ln_tau[at++]);
    }
  }
}

/// The same modes, with separate time constants at rest for the same ones.
bool alike(const Structure& a, const Structure& b) {
  return std::ranges::equal(a.mode, b.mode, [](const Structure::Mode& x, const Structure::Mode& y) {
    return (x.rest_tau_s > 0.0) == (y.rest_tau_s > 0.0);
  });
}

double weight(const AxisFit& fit, std::size_t mode) {
  // Inverse variance; the floor keeps one axis from dictating to all others.
  const double sd = std::max(fit.ln_tau_sd[mode], kLeastSd);
  return 1.0 / (sd * sd);
}

double farthest(const AxisFit& a, const AxisFit& b) {
  const auto of_a = ln_taus(a.structure);
  const auto of_b = ln_taus(b.structure);
  double most = 0.0;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    most = std::max(most, std::abs(of_a[i] - of_b[i]));
  }
  return most;
}

class Sharing {
 public:
  Sharing(const Log& log, const std::vector<std::size_t>& channel, const FitRequest& request,
          const std::vector<AxisFit>& own)
      : log_(log), channel_(channel), request_(request), own_(own) {}

  /// The members fitted with their mean time constants; empty if one of them is refused.
  [[nodiscard]] std::optional<std::vector<AxisFit>> together(const Group& group) const {
    const AxisFit& first = own_[group.front()];
    const std::size_t modes = first.structure.mode.size();
    std::vector<double> mean(ln_taus(first.structure).size(), 0.0);
    std::vector<double> sum(modes, 0.0);
    for (const std::size_t i : group) {
      const auto ln_tau = ln_taus(own_[i].structure);
      for (std::size_t k = 0; k < ln_tau.size(); ++k) {  // one at rest weighs like its mode
        mean[k] += weight(own_[i], mode_of(first.structure, k)) * ln_tau[k];
      }
      for (std::size_t m = 0; m < modes; ++m) {
        sum[m] += weight(own_[i], m);
      }
    }
    for (std::size_t k = 0; k < mean.size(); ++k) {
      mean[k] /= sum[mode_of(first.structure, k)];
    }
    std::vector<AxisFit> out;
    for (const std::size_t i : group) {
      AxisFit held = own_[i];
      set_ln_taus(held.structure, mean);
      for (std::size_t m = 0; m < modes; ++m) {
        // The weighted mean has the standard deviation 1/√Σw, each member's own one times √(w/Σw).
        const double surer = std::sqrt(weight(own_[i], m) / sum[m]);
        held.ln_tau_sd[m] *= surer;
        held.axis.mode[m].tau_sd_ratio *= surer;
      }
      FitRequest request = request_;
      request.like = &held;
      // The whole fit again with these time constants fixed: levels, error model's weights, band
      // and evidence all change.
      auto fit = identify(log_, channel_[i], own_[i].axis.name, request);
      if (!fit) {
        return std::nullopt;
      }
      out.push_back(std::move(*fit));
    }
    return out;
  }

 private:
  // Time constants at rest come after those of all modes, in the same order (ln_taus).
  static std::size_t mode_of(const Structure& s, std::size_t k) {
    std::size_t at = s.mode.size();
    for (std::size_t m = 0; m < s.mode.size(); ++m) {
      if (k == m || (s.mode[m].rest_tau_s > 0.0 && k == at++)) {
        return m;
      }
    }
    return 0;
  }

  const Log& log_;
  const std::vector<std::size_t>& channel_;
  const FitRequest& request_;
  const std::vector<AxisFit>& own_;
};

// Axes are assumed independent: the evidences of a group add up.
double evidence(const std::vector<AxisFit>& fit, const Group& group) {
  double sum = 0.0;
  for (const std::size_t i : group) {
    sum += fit[i].log_evidence;
  }
  return sum;
}

}  // namespace

std::vector<Group> share_tau(const Log& log, const std::vector<std::size_t>& channel,
                             const FitRequest& request, std::vector<AxisFit>& fit) {
  // Means always use the axes' own results, not those of earlier mergers.
  const std::vector<AxisFit> own = fit;
  const Sharing sharing(log, channel, request, own);
  std::vector<Group> group;
  std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> pairs;
  for (std::size_t i = 0; i < own.size(); ++i) {
    group.push_back({i});
    for (std::size_t j = 0; j < i; ++j) {
      if (alike(own[i].structure, own[j].structure) && farthest(own[i], own[j]) < kTooFar) {
        pairs.push_back({farthest(own[i], own[j]), {j, i}});
      }
    }
  }
  std::ranges::sort(pairs);
  for (const auto& [far, pair] : pairs) {
    // The present group of an axis.
    const auto with = [&group](std::size_t i) {
      return std::ranges::find_if(group, [i](const Group& g) { return std::ranges::count(g, i); });
    };
    const auto a = with(pair.first);
    const auto b = with(pair.second);
    if (a == b) {
      continue;
    }
    Group both = *a;
    both.insert(both.end(), b->begin(), b->end());
    auto together = sharing.together(both);
    if (!together) {
      continue;
    }
    double shared = 0.0;
    for (const AxisFit& f : *together) {
      shared += f.log_evidence;
    }
    const auto taus = static_cast<double>(ln_taus(own[pair.first].structure).size());
    const FitData data = fit_data(log, channel[pair.first], request.from_s, request.to_s);
    // ½·ln(rows) for each parameter saved: Bayes' criterion, halved to the scale of a log evidence.
    const double saved = 0.5 * taus * std::log(static_cast<double>(data.rows()));
    if (shared + saved < evidence(fit, both)) {
      continue;
    }
    for (std::size_t k = 0; k < both.size(); ++k) {
      fit[both[k]] = std::move((*together)[k]);
    }
    *a = both;
    group.erase(b);
  }
  std::erase_if(group, [](const Group& g) { return g.size() < 2; });
  for (Group& g : group) {
    std::ranges::sort(g);
  }
  return group;
}

}  // namespace steadyrest::thermal::offline
