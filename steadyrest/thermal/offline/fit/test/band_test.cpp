// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/band.hpp>

namespace steadyrest::thermal::offline {
namespace {

constexpr std::size_t kBandRows = 100;  ///< a minute apart
constexpr double kMetWithin_um = 0.3;
constexpr double kBand95 = 1.96;

/// Blocks at one speed, whose readings miss the forecast by so much; parameters are known exactly.
Band band_of(const std::vector<std::vector<double>>& error_um) {
  const std::size_t rows = kBandRows * error_um.size();
  Log log;
  log.speed_rev_s.assign(rows, 50.0);
  FitData data;
  data.log = &log;
  data.noise_um = kMetWithin_um;
  LeftOut left_out;
  left_out.residual_um.resize(static_cast<Eigen::Index>(rows));
  for (std::size_t i = 0; i < rows; ++i) {
    data.row.push_back(i);
    data.time_s.push_back(60.0 * static_cast<double>(i));
    left_out.residual_um(static_cast<Eigen::Index>(i)) = error_um[i / kBandRows][i % kBandRows];
  }
  for (std::size_t b = 0; b < error_um.size(); ++b) {
    data.block.push_back({b * kBandRows, (b + 1) * kBandRows});
  }
  const Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(rows), 1);
  return calibrate(data, left_out, columns, Eigen::MatrixXd::Zero(1, 1));
}

/// So many readings off by `off_um`, the last before the hourly probe; the others are met exactly.
std::vector<double> off_at_the_end(std::size_t count, double off_um) {
  std::vector<double> out(kBandRows, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    out[59 - k] = off_um;
  }
  return out;
}

/// Student's t over the normal law's 1.96, from tables, and one block more.
constexpr double kOfTwo = 12.706 / kBand95;
double one_more(double blocks) {
  return std::sqrt(1.0 + 1.0 / blocks);
}

// One block met to within the noise, one off by 3 σ in an eighth of its readings: the band of the
// first holds too few of the other's, however much wider. The RMS is that of both, by Student's t.
TEST(Band, IsNoWiderWhereWidthDoesNotHelp) {
  const double off_um = 3.0 * kMetWithin_um;
  const Band band = band_of({std::vector<double>(kBandRows, 0.0), off_at_the_end(12, off_um)});
  // 1.96²·(noise² + d²) = off², so that more than 94 % lie within.
  const double drift_um = std::sqrt(std::pow(off_um / kBand95, 2) - kMetWithin_um * kMetWithin_um);
  EXPECT_NEAR(band.drift_um, drift_um * kOfTwo * one_more(2.0), 1e-6);
}

// Where width does help it is taken: three blocks off by 1, 1 and 20 noises. The two smaller ones
// make a band by Student's t for two, which the third still leaves.
TEST(Band, IsWiderByWhatABlockOfItsOwnKindLacks) {
  const double far_um = 40.0 * kMetWithin_um;
  const double near_um = 3.0 * kMetWithin_um;
  const Band band =
      band_of({std::vector<double>(kBandRows, near_um), std::vector<double>(kBandRows, -near_um),
               std::vector<double>(kBandRows, far_um)});
  const auto rms = [](double off_um) {
    return std::sqrt(std::pow(off_um / kBand95, 2) - kMetWithin_um * kMetWithin_um);
  };
  const double of_all = rms(far_um) * 4.303 / kBand95 * one_more(3.0);
  const double of_two = rms(near_um) * kOfTwo * one_more(2.0);
  EXPECT_NEAR(band.drift_um, of_all * rms(far_um) / of_two, 1e-6 * band.drift_um);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
