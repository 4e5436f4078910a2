// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/response/test/uff.hpp>
#include <steadyrest/chatter/offline/response/uff58.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::text;
using test::UffText;
using testing::HasSubstr;

std::string binary_refusal(const std::string& given) {
  const auto read = parse_uff58(given, "tap.uff");
  return read ? "accepted" : text(read.error());
}

/// Both byte orders, both sizes, even and uneven with an abscissa of either size.
std::vector<std::string> all_forms(const UffText& like) {
  std::vector<std::string> out;
  for (const int order : {1, 2}) {
    for (const int data : {5, 6}) {
      UffText uff = like;
      uff.data = data;
      out.push_back(uff.made_binary(order));
      uff.even = false;
      out.push_back(uff.made_binary(order, 4));
      if (data == 6) {
        out.push_back(uff.made_binary(order, 8));
      }
    }
  }
  return out;
}

TEST(Uff58Binary, ReadsWhatTheTextFormSays) {
  UffText uff;
  uff.value = {0.25, -1.5};
  const auto wanted = parse_uff58(uff.made(), "tap.uff");
  ASSERT_TRUE(wanted) << text(wanted.error());
  const auto forms = all_forms(uff);
  ASSERT_EQ(forms.size(), 10U);
  for (const std::string& form : forms) {
    const auto read = parse_uff58(form, "tap.uff");
    ASSERT_TRUE(read) << text(read.error());
    EXPECT_EQ(read->front().frequency_hz, wanted->front().frequency_hz);
    EXPECT_EQ(read->front().compliance_mm_n, wanted->front().compliance_mm_n);
  }
}

// Bytes may look like a line of −1, and the −1 may follow them at once.
TEST(Uff58Binary, IsFollowedByWhateverStandsInTheFile) {
  UffText looks;
  looks.data = 6;
  const std::uint64_t minus_one = 0x0A312D202020200AULL;  // "\n    -1\n"
  looks.value = {std::bit_cast<double>(minus_one), -2.0};
  UffText spectrum;
  spectrum.function = 2;
  const std::string file =
      spectrum.made_binary(1) + looks.made_binary(1) + looks.made_binary(2) + UffText().made();
  const auto read = parse_uff58(file, "tap.uff");
  ASSERT_TRUE(read) << text(read.error());
  EXPECT_EQ(read->size(), 3U);
  const auto at_once = parse_uff58(UffText().made_binary(1, 4, "    -1\n"), "tap.uff");
  EXPECT_TRUE(at_once) << text(at_once.error());
  // Some writers announce a wrong number of bytes: record 7 counts.
  std::string wrong = UffText().made_binary(1);
  wrong.replace(wrong.find("          64"), 12, "          32");
  EXPECT_TRUE(parse_uff58(wrong, "tap.uff"));
}

TEST(Uff58Binary, UsesItsCoherence) {
  UffText coherence;
  coherence.function = 6;
  coherence.data = 2;
  coherence.value = {0.75, 0.0};
  const auto read = parse_uff58(UffText().made_binary(2) + coherence.made_binary(2), "tap.uff");
  ASSERT_TRUE(read) << text(read.error());
  EXPECT_EQ(read->front().coherence, std::vector<double>(8, 0.75));
}

TEST(Uff58Binary, RefusesForeignNumbersByName) {
  EXPECT_THAT(binary_refusal(UffText().made_binary(1, 4, "\n    -1\n", 1)),
              HasSubstr("tap.uff:2: dataset 58b: the binary form with VAX"));
  EXPECT_THAT(binary_refusal(UffText().made_binary(2, 4, "\n    -1\n", 3)), HasSubstr("IBM 370"));
  EXPECT_THAT(binary_refusal(UffText().made_binary(2, 4, "\n    -1\n", 7)),
              HasSubstr("number format 2"));
  EXPECT_THAT(binary_refusal("    -1\n    58b     1     2\n    -1\n"), HasSubstr("lines of text"));
  EXPECT_THAT(binary_refusal("    -1\n    58b\n    -1\n"), HasSubstr("byte order"));
  UffText nan;
  nan.value = {std::numeric_limits<double>::quiet_NaN(), 0.0};
  EXPECT_THAT(binary_refusal(nan.made_binary(1)), HasSubstr("point 1 is not a finite number"));
}

// Any count and any length: refused, and nothing is reserved for points that are not there.
TEST(Uff58Binary, RefusesWhatIsCutOffOrAnnouncesMore) {
  const std::string whole = UffText().made_binary(1);
  for (std::size_t bytes = 8; bytes + 3 < whole.size(); ++bytes) {
    EXPECT_NE(binary_refusal(whole.substr(0, bytes)), "accepted") << bytes;
  }
  UffText many;
  many.points = 9'999'999;
  EXPECT_THAT(binary_refusal(many.made_binary(1)),
              HasSubstr("9999999 points of 8 bytes do not end at"));
  many.points = 999'999'999;
  EXPECT_THAT(binary_refusal(many.made_binary(1)), HasSubstr("values; allowed"));
  UffText spectrum;
  spectrum.function = 2;
  std::string skipped = spectrum.made_binary(1);
  skipped.replace(skipped.find("          64"), 12, "   999999999");
  EXPECT_THAT(binary_refusal(skipped),
              HasSubstr("999999999 bytes are announced, but no −1 follows"));
}

}  // namespace
}  // namespace steadyrest::chatter::offline
