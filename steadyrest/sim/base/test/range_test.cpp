// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/sim/base/range.hpp>

namespace steadyrest::sim {
namespace {

using testing::HasSubstr;

std::string fault_of(std::initializer_list<Range> ranges) {
  const auto judged = in_range("[[axis]] X", ranges);
  return judged ? "" : judged.error().what;
}

TEST(Range, HasBothOfItsEnds) {
  EXPECT_EQ(fault_of({{"gain", 1.0, 1.0, 2.0}, {"lag", 2.0, 1.0, 2.0}}), "");
  EXPECT_NE(fault_of({{"gain", 0.999, 1.0, 2.0}}), "");
  EXPECT_NE(fault_of({{"gain", 2.001, 1.0, 2.0}}), "");
}

// A comparison with NaN is false either way round; none of them may pass.
TEST(Range, HasNoNan) {
  EXPECT_NE(fault_of({{"gain", kernel::units::kNan, -1e300, 1e300}}), "");
  EXPECT_NE(fault_of({{"gain", kernel::units::kInfinity, -1e300, 1e300}}), "");
}

TEST(Range, TheRefusalSaysWhoseNumberItIsAndWhatIsAllowed) {
  const auto judged = in_range("[[axis]] X", {{"gain", 1.5, 0.0, 2.0}, {"lag", 7.0, 0.25, 0.5}});
  ASSERT_FALSE(judged);
  EXPECT_THAT(judged.error().what, HasSubstr("[[axis]] X: lag is 7; allowed: 0.25 to 0.5"));
  EXPECT_THAT(judged.error().to_do, HasSubstr("machine file"));
}

TEST(Range, TheFirstOfSeveralIsNamed) {
  EXPECT_THAT(fault_of({{"one", 9, 0, 1}, {"two", 9, 0, 1}}), HasSubstr("one is 9"));
  EXPECT_EQ(fault_of({}), "");
}

}  // namespace
}  // namespace steadyrest::sim
