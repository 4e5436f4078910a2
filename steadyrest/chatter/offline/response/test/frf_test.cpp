// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>
#include <string>
#include <tuple>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/response/frf.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::text;
using testing::HasSubstr;
using Complex = std::complex<double>;

/// Eight rows of real = f/100, imag = −f/200.
std::string rows(const std::string& head) {
  std::string out = head + "\n";
  for (int f = 100; f <= 800; f += 100) {
    out += fmt::format("{},{},{}\n", f, f / 100.0, -f / 200.0);
  }
  return out;
}

void expect_near(Complex seen, Complex wanted) {
  EXPECT_NEAR(std::abs(seen - wanted), 0.0, 1e-9 * std::abs(wanted));
}

TEST(FrfCsv, TakesItsUnitFromTheHead) {
  for (const auto& [head, scale] :
       {std::pair{"frequency_hz,real_m_N,imag_m_N", 1e3},
        std::pair{"frequency_hz,real_mm_N,imag_mm_N", 1.0},
        std::pair{"Frequency (Hz),Real (um/N),Imag (um/N)", 1e-3},
        std::pair{"# tap test\n\nFrequency [Hz],real [µm/N],imag [µm/N]", 1e-3}}) {
    const auto read = parse_frf_csv(rows(head), "tap.csv");
    ASSERT_TRUE(read) << text(read.error());
    ASSERT_EQ(read->frequency_hz.size(), 8U);
    EXPECT_EQ(read->frequency_hz[1], 200.0);
    expect_near(read->compliance_mm_n[1], scale * Complex(2.0, -1.0));
  }
}

TEST(FrfCsv, TakesMagnitudeAndPhase) {
  std::string given = "frequency_hz;magnitude_um_N;phase_deg\r\n0;1;0\r\n";
  for (int f = 1; f <= 8; ++f) {
    given += fmt::format("{};2.0;-90\r\n", f);
  }
  const auto read = parse_frf_csv(given, "tap.csv");
  ASSERT_TRUE(read) << text(read.error());
  ASSERT_EQ(read->frequency_hz.size(), 8U);  // without 0 Hz
  expect_near(read->compliance_mm_n[0], {0.0, -0.002});
}

TEST(FrfCsv, TurnsVelocityAndAccelerationIntoDisplacement) {
  const double w = 2.0 * std::numbers::pi * 200.0;
  const Complex h(2.0, -1.0);
  for (const auto& [head, order, wanted] :
       {std::tuple{"frequency_hz,real_m_s2_N,imag_m_s2_N", 2, -1e3 * h / (w * w)},
        std::tuple{"Frequency [Hz],Real [(m/s²)/N],Imag [(m/s²)/N]", 2, -1e3 * h / (w * w)},
        std::tuple{"frequency_hz,real_mm_s2_N,imag_mm_s2_N", 2, -1.0 * h / (w * w)},
        std::tuple{"frequency_hz,real_g_N,imag_g_N", 2, -9806.65 * h / (w * w)},
        std::tuple{"frequency;real;imag\nHz;m/s2/N;m/s2/N", 2, -1e3 * h / (w * w)},
        std::tuple{"frequency_hz,real_m_s_N,imag_m_s_N", 1, 1e3 * h / Complex(0.0, w)}}) {
    std::string given = rows(head);
    if (given.find(';') != std::string::npos) {
      std::ranges::replace(given, ',', ';');
    }
    const auto read = parse_frf_csv(given, "tap.csv");
    ASSERT_TRUE(read) << text(read.error()) << head;
    EXPECT_EQ(read->measured_order, order);
    expect_near(read->compliance_mm_n[1], wanted);
  }
}

TEST(FrfCsv, KeepsTheCoherence) {
  std::string given = "frequency_hz;real_um_N;imag_um_N;coherence\n";
  for (int f = 1; f <= 8; ++f) {
    given += fmt::format("{};1,5;-0,25;0,{}\n", f, f);
  }
  const auto read = parse_frf_csv(given, "tap.csv");
  ASSERT_TRUE(read) << text(read.error());
  ASSERT_EQ(read->coherence.size(), 8U);
  EXPECT_DOUBLE_EQ(read->coherence[7], 0.8);
  expect_near(read->compliance_mm_n[0], {0.0015, -0.00025});
}

TEST(FrfCsv, RefusesByLine) {
  const auto refusal = [](const std::string& given) {
    const auto read = parse_frf_csv(given, "tap.csv");
    return read ? "accepted" : text(read.error());
  };
  const std::string head = "frequency_hz,real_um_N,imag_um_N";
  EXPECT_THAT(refusal(rows("frequency_hz,real_in_lbf,imag_in_lbf")),
              HasSubstr("tap.csv:1: units \"in/lbf\""));
  EXPECT_THAT(refusal(rows("frequency_hz,real,imag")), HasSubstr("allowed: m/N, mm/N, um/N"));
  EXPECT_THAT(refusal(rows("frequency_hz,real_um_N,imag_mm_N")), HasSubstr("the same in both"));
  EXPECT_THAT(refusal(rows("frequency_khz,real_um_N,imag_um_N")), HasSubstr("allowed: Hz"));
  EXPECT_THAT(refusal(rows("frequency_hz,magnitude_um_N,phase_rad")), HasSubstr("deg"));
  EXPECT_THAT(refusal(rows("t_s,x,y")), HasSubstr("tap.csv:1: the header is t,x,y"));
  EXPECT_THAT(refusal(rows("frequency_hz,real_um_N")), HasSubstr("2 columns"));
  EXPECT_THAT(refusal(head + "\n1,2,3\n"), HasSubstr("has 1 points"));
  EXPECT_THAT(refusal(rows(head) + "900,1"),
              HasSubstr("tap.csv:10: the row has 2 fields, the header 3"));
  EXPECT_THAT(refusal(rows(head) + "900,1,x\n"),
              HasSubstr("tap.csv:10: imag_um_N = \"x\" is not a finite number"));
  EXPECT_THAT(refusal(rows(head) + "900,nan,1\n"), HasSubstr("is not a finite number"));
  EXPECT_THAT(refusal(rows(head) + "800,1,1\n"), HasSubstr("tap.csv:10: frequency 800 Hz after"));
  EXPECT_THAT(refusal(""), HasSubstr("has 0 points"));
}

TEST(Frf, RefusesNoFile) {
  EXPECT_THAT(text(read_frf("no/such.uff").error()), HasSubstr("no/such.uff: cannot be opened"));
}

}  // namespace
}  // namespace steadyrest::chatter::offline
